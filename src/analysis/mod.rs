//! Analysis: statistics over values, space-time diagrams and the speed of waves in them, and linear theory: the speed
//! of sound in a crowd and the largest stable time step. It uses only the engine.

pub mod statistics;

pub mod wave;

pub mod sound;

pub mod stability;

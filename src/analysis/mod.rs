//! Analysis: statistics over values, space-time diagrams and the speed of waves in them, linear theory (the speed of
//! sound in a crowd and the largest stable time step), integrals over walls by
//! quadrature, the ways to a destination on a grid, and lines that people cross. It uses only the engine.

pub mod statistics;

pub mod wave;

pub mod sound;

pub mod stability;

pub mod wall_integrals;

pub mod way_field;

pub mod crossing;

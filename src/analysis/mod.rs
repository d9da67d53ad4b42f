//! Analysis: statistics over values, space-time diagrams and the speed of waves in them, linear theory (the speed of
//! sound in a crowd and the largest stable time step), integrals over walls by
//! quadrature, the ways to a destination on a grid, lines that people cross, and the search for parameters: screening,
//! CMA-ES, and how well values determine parameters. It uses only the engine.

pub mod statistics;

pub mod wave;

pub mod sound;

pub mod stability;

pub mod wall_integrals;

pub mod way_field;

pub mod crossing;

pub mod cma_es;

pub mod morris;

pub mod identifiability;

//! Analysis: statistics over values, bands of mean curves, space-time diagrams and the speed of waves in them, the
//! speed of fronts, pushes through rows of people, spectra of oscillations, the speed of sound in a
//! crowd, the routes to a destination on a grid, lines that people cross, Voronoi
//! cells, quantities for safety engineers (local density, exposure, level of service, crowd pressure, forces on bodies
//! and walls), and the search for parameters: screening, CMA-ES, and the identifiability of parameters. It uses only
//! the engine.

#![warn(missing_docs, clippy::unwrap_used)]

pub use common::{round, statistics};

pub mod bootstrap;

pub mod wave;

pub mod front;

pub mod push;

pub mod oscillation;

pub mod sound;

pub mod way_field;

pub mod crossing;

pub mod voronoi;

pub mod site;

pub mod surroundings;

pub mod local;

pub mod evaluated;

pub mod exposure;

pub mod service;

pub mod crowd_pressure;

pub mod body_forces;

pub mod wall_forces;

pub mod cma_es;

pub mod morris;

pub mod identifiability;

//! Analysis of finished frames and trajectories: statistics over runs, space-time diagrams and wave speeds, and
//! densities, fields, fundamental diagrams and flows of any trajectory (§8).

pub mod statistics;

pub mod wave;

pub mod measure;

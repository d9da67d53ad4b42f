//! What all layers share and what knows no crowd: statistics, rounded numbers, and output files.

#![warn(missing_docs, clippy::unwrap_used)]

pub mod statistics;

pub mod round;

pub mod outputs;

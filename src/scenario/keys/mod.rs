//! The keys of a scenario file, list by list: structs with a field per key, its description, default and range. What
//! they say is built into a scene in [`build`](super::build).

pub mod calibrated;
pub mod catalog;
pub mod curve;
pub mod distribution;
pub mod from;
pub mod goals;
pub mod interventions;
pub mod levels;
pub mod limits;
pub mod names;
pub mod numerics;
pub mod parameters;
pub mod people;
pub mod periodic;
pub mod places;
pub mod preset;
pub mod profiles;
pub mod shapes;

//! The engine: geometry, kernels, the state of the crowd, forces, and the loop of §4.1. It does not depend on files,
//! scenario names or output. A [`Simulation`](simulation::Simulation) is built from a [`Scene`](scene::Scene) and
//! advances it frame by frame; all results of a frame can be read from its [`Frame`](frame::Frame). [`breakdown`] lists
//! everything that acts on one agent, term by term.

#![warn(missing_docs, clippy::unwrap_used)]

// What is hidden is public for the other crates of this workspace, and no part of what the library promises.

pub mod math;

#[doc(hidden)]
pub mod limits;

pub mod period;

#[doc(hidden)]
pub mod random;

pub mod distribution;

pub mod geometry;

pub mod levels;

pub mod routes;

pub mod journeys;

#[doc(hidden)]
pub mod kernel;

pub mod clock;

pub mod agents;

pub mod traits;

#[doc(hidden)]
pub mod neighbors;

#[doc(hidden)]
pub mod pairs;

#[doc(hidden)]
pub mod boundary;

pub mod frame;

#[doc(hidden)]
pub mod density;

pub mod forces;

pub mod profile;

pub mod placement;

#[doc(hidden)]
pub mod packing;

pub mod entrance;

pub mod scene;

pub mod stability;

pub mod simulation;

pub mod breakdown;

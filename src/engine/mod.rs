//! The engine: geometry, kernels, the state of the crowd, forces, and the loop of §4.1. It knows no files, no
//! names of scenarios and no output. A [`Scene`](scene::Scene) goes in, a
//! [`Simulation`](simulation::Simulation) advances it frame by frame, and everything that a frame computes can
//! be read from its [`Frame`](frame::Frame). Linear theory ([`sound`], [`stability`]) and the term-by-term
//! [`breakdown`] of one agent belong here, because they use nothing else.

pub mod math;

pub mod random;

pub mod geometry;

pub mod kernel;

pub mod clock;

pub mod agents;

pub mod neighbors;

pub mod pairs;

pub mod boundary;

pub mod frame;

pub mod density;

pub mod forces;

pub mod profile;

pub mod placement;

pub mod scene;

pub mod sound;

pub mod stability;

pub mod simulation;

pub mod breakdown;

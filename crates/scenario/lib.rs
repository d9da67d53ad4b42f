//! Scenario files of the sandbox for dense crowds, and their runs: the crate `sandbox` shows both.

#![warn(missing_docs, clippy::unwrap_used)]

pub use sandbox_engine::{analysis, engine};

#[path = "../../src/scenario/mod.rs"]
pub mod scenario;

#[path = "../../src/runs/mod.rs"]
pub mod runs;

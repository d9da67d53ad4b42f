//! The engine of the sandbox for dense crowds, and the analysis of what it computes: the crate `sandbox` shows both.

#![warn(missing_docs, clippy::unwrap_used)]

#[path = "../../src/engine/mod.rs"]
pub mod engine;

#[path = "../../src/analysis/mod.rs"]
pub mod analysis;

//! Runs of scenarios: the drive loop ([`Run::drive`](drive::Run::drive)), the check of output files (`outputs`),
//! checkpoints, and summaries of results. For many runs, a `Case` is one run with its `Identity`, and a `Job` is a
//! piece of work whose result is kept in a `Store`.

#![warn(missing_docs, clippy::unwrap_used)]

// What is hidden is public for the other crates of this workspace, and no part of what the library promises.

#[doc(hidden)]
pub use common::outputs;

pub mod drive;

#[doc(hidden)]
pub mod identity;

#[doc(hidden)]
pub mod notes;

pub mod checkpoint;

pub mod summary;

#[doc(hidden)]
pub mod error;

#[doc(hidden)]
pub mod memory;

#[doc(hidden)]
pub mod parallel;

#[doc(hidden)]
pub mod store;

#[doc(hidden)]
pub mod job;

#[doc(hidden)]
pub mod case;

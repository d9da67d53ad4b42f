//! Runs of scenarios: the drive loop ([`Run::drive`](drive::Run::drive)), the check of output files ([`outputs`]),
//! checkpoints, and summaries of results. For many runs, a [`Case`](case::Case) is one run with its
//! [`Identity`](identity::Identity), and a [`Job`](job::Job) is a piece of work whose result is kept in a
//! [`Store`](store::Store).

#![warn(missing_docs, clippy::unwrap_used)]

pub use common::outputs;

pub mod drive;

pub mod identity;

pub mod notes;

pub mod checkpoint;

pub mod summary;

pub mod error;

pub mod memory;

pub mod parallel;

pub mod store;

pub mod job;

pub mod case;

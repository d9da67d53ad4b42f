//! Runs of scenarios: the drive loop ([`Run::drive`](drive::Run::drive)), the files that a run may write ([`outputs`]),
//! checkpoints, and summaries of results; and many runs: a [`Case`](case::Case) is one run with its
//! [`Identity`](identity::Identity), a [`Job`](job::Job) is a piece of work whose result a [`Store`](store::Store)
//! keeps.

pub mod drive;

pub mod identity;

pub mod outputs;

pub mod checkpoint;

pub mod summary;

pub mod error;

pub mod memory;

pub mod parallel;

pub mod store;

pub mod job;

pub mod case;

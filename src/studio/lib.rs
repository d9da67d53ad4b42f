//! `sandbox studio`: a page in the browser of this machine in which one draws a floor, plays it, and intervenes while
//! it runs.
//!
//! A server on the loopback address serves the page and answers its requests. Each run has a thread of its own, which
//! computes frames at the speed asked for and never waits for the page: it leaves the latest frames in a
//! [`feed`](feed::Feed) of limited length. What a page asks of a run is a closure that the thread of the run calls
//! between two frames. `docs/reference/studio.md` has the requests.

#![warn(missing_docs, clippy::unwrap_used)]

mod answer;

mod beside;

mod feed;

mod doors;

mod snapshots;

mod pace;

mod player;

mod controls;

mod play;

mod drawing;

mod drawings;

mod saved;

mod page;

mod plays;

mod requests;

mod server;

pub use server::{Server, ServerError, Studio};

//! The paper's tables and figures (§6) at one command.
//!
//! A [`Product`] is a table or a figure: it lists the [`Case`]s that it needs, and writes files from
//! their results. The [`runner`] computes what the [`Store`] does not have yet; what two products
//! share is computed once.

mod case;
mod error;
#[cfg(feature = "plot")]
mod figures;
mod product;
mod runner;
mod snapshot;
mod store;

pub use case::{Case, CaseResult, Key, Observer, Probe};
pub use error::ReproduceError;
pub use product::{PRODUCTS, Plan, Product, reproduce};
pub use runner::{Listener, Results, run};
pub use snapshot::{Snapshot, SnapshotAt};
pub use store::Store;

//! The paper's tables and figures (§6) with one command.
//!
//! A [`Product`] is a table or a figure: it lists the [`Case`]s that it needs, and writes files from their results.
//! [`run`] computes the cases that are not in the [`Store`] yet. Cases that several products share are computed once.

mod case;
mod comparison;
mod error;
mod figures;
mod product;
mod published;
mod questions;
mod ranking;
mod runner;
mod snapshot;
mod store;
mod table1;
mod table2;
mod text;

pub use case::{Case, CaseResult, Key, Observer, Probe};
pub use comparison::{Band, Comparison, Spread};
pub use error::ReproduceError;
pub use product::{PRODUCTS, Plan, Product, reproduce};
pub use published::{CrossingRow, EvacuationRow, Published, Table, published};
pub use ranking::{Ranked, Ranking, rankings};
pub use runner::{Listener, Results, run};
pub use snapshot::{Snapshot, SnapshotAt};
pub use store::Store;
pub use table1::{Row, case as table1_case};
pub use table2::Table as CrossingTable;
pub use text::put_between;

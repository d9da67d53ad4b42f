//! The paper's tables and figures (§6), and studies of open questions, with one command.
//!
//! A [`Product`] is a table or a figure: studies under `scenarios/studies/` that compute its runs, and a function that
//! writes files from their results. Runs that several products share are computed once.

mod comparison;
mod estimated;
mod figures;
mod list;
mod product;
mod published;
mod questions;
mod ranking;
mod row;
mod table1;
mod table2;

pub use comparison::{Band, Comparison};
pub use estimated::{ESTIMATED, estimated};
pub use list::{PRODUCTS, reproduce};
pub use product::{Needs, Product};
pub use published::{Published, PublishedRow, PublishedTable, Varied, published};
pub use ranking::{Ranked, Ranking, rankings};
pub use row::Row;
pub use table1::{published_for, rows as table1_rows};
pub use table2::CrossingTable;

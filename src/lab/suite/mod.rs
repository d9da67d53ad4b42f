//! Suites: studies with expected results.
//!
//! A [`Case`] of a suite has [`Check`]s of the study's runs: a quantity, the labels of its runs, and what is expected.
//! All of it is data, the key `cases` of the study's file. A [`Report`] has the judgments of all cases, profiles and
//! seeds.

mod changed;
mod check;
mod counts;
mod data;
mod deviations;
mod diagrams;
mod file;
mod finding;
mod keys;
mod known;
mod passed;
mod pictures;
mod quantity;
mod report;
mod run;
mod runner;
mod runs_check;
mod status;

pub use changed::Changed;
pub use check::{Judgment, Runs, in_tolerances};
pub use file::Suite;
pub use finding::{Finding, Skipped};
pub use keys::{Case, Check, Expected};
pub use passed::Passed;
pub use report::Report;
pub use run::{Chosen, Judged, Planned};
pub use status::{Status, shipped};

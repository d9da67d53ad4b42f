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
mod keys;
mod known;
mod pictures;
mod quantity;
mod report;
mod run;
mod status;

pub use changed::Changed;
pub use check::{Judgment, Runs, in_tolerances};
pub use file::Suite;
pub use keys::{Case, Check, Expected};
pub use report::{Finding, Report, Skipped};
pub use run::{Chosen, Judged, Planned};
pub use status::{Passed, Status};

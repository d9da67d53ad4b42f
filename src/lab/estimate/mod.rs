//! Results with their errors: the user names the error, and an [`Answer`] has values that hold it, at the least cost.
//!
//! [`run`](fn@run) makes runs of a [`Question`] at several time steps and with several seeds, round by round, until
//! the confidence intervals are as narrow as asked for. An interval holds two errors: that of chance, from the seeds,
//! and that of the time step, from the means at different steps (`limit.rs`). `plan.rs` chooses which runs come next.

mod answer;
mod compared;
mod coverage;
mod coverage_report;
mod forecast;
mod limit;
mod pictures;
mod plan;
mod question;
mod report;
mod rows;
mod run;
mod series;
mod wanted;

pub use answer::{ABOUT, Answer, AtStep, Counts, Row};
pub use compared::{Change, Compared, compared, is_answer};
pub use coverage::{Coverage, Covered, Pool, coverage};
pub use forecast::Forecast;
pub use limit::{Level, Limit};
pub use pictures::sheet;
pub use plan::{Goal, Offer, PILOT, further, predicted};
pub use question::{Question, QuestionError, Rung};
pub use rows::{Answers, Questions};
pub use run::{Look, Runs, run};
pub use series::{Means, Reached, Series};
pub use wanted::{Limits, Request, Tolerance, Wanted};

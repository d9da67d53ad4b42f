//! Results with their errors: the user names the error, and an [`Answer`] has values that hold it, at the least cost.
//!
//! [`run`](fn@run) makes runs of a [`Question`] at several time steps and with several seeds, round by round, until
//! the confidence intervals are as narrow as asked for. An interval holds two errors: that of chance, from the seeds,
//! and that of the time step, from the means at different steps (`limit.rs`). `plan.rs` chooses which runs come next.

mod answer;
mod bounds;
mod compared;
mod cut;
mod ensemble;
mod forecast;
mod known;
mod limit;
mod pictures;
mod plan;
mod prior;
mod question;
mod report;
mod row_pictures;
mod rows;
mod run;
mod series;
mod wanted;

pub use answer::{ABOUT, Answer, AtStep, Counts, ModelError, OfPreset, Row, Timed};
pub use bounds::Bounded;
pub use compared::{Change, Compared, compared, is_answer};
pub use ensemble::{Ensemble, ParametersPart};
pub use forecast::Forecast;
pub use limit::{Level, Limit};
pub use plan::{Goal, MOST_PREDICTED, Offer, first_round, further, pilot, predicted, range};
pub use prior::{Known, Prior};
pub use question::{Question, QuestionError, Rung};
pub use report::names;
pub use rows::{Answers, Questions};
pub use run::{Look, Runs, Sample, StepRuns, run};
pub use series::{Means, Reached, Series};
pub use wanted::{Bound, Limits, Request, Sampling, Tolerance, Wanted};

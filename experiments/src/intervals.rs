//! The intervals of `sandbox estimate`: how often they hold the value, and what estimates know before their first run.

mod coverage;
mod knowledge;
mod report;
mod scenes;

pub use coverage::{Coverage, Covered, Pool, coverage, scenes};
pub use knowledge::{KNOWLEDGE, Knowledge, knowledge};
pub use report::COVERAGE;

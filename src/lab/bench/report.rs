//! The results of a benchmark.

use serde::Serialize;
use serde_json::{Value, json};

use super::plan::Plan;
use crate::error::LabError;
use crate::machine::Machine;
use engine::pairs::Vectors;
use output::document::{Block, Document, Findings, Names};
use output::plot::Sheet;
use output::table::Table;

/// The results of a benchmark.
#[derive(Debug, Clone, Serialize)]
pub struct Timings {
    /// The table for readers.
    #[serde(skip)]
    pub table: Table,
    /// The rows for programs: one object each.
    pub rows: Value,
    /// Notes that explain the results.
    pub notes: Vec<String>,
    /// The picture.
    #[serde(skip)]
    pub sheet: Sheet,
}

/// The results of a benchmark, with the machine and the plan.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    benchmark: &'static str,
    about: &'static str,
    machine: Machine,
    /// The vector instructions for sums over pairs.
    vectors: Vectors,
    /// Threads, unless a row says otherwise.
    threads: usize,
    repeats: usize,
    quick: bool,
    #[serde(flatten)]
    times: Timings,
}

impl Report {
    /// The results of a benchmark, with this machine and the plan.
    pub fn of(benchmark: &'static str, about: &'static str, plan: &Plan, times: Timings) -> Self {
        Self {
            benchmark,
            about,
            machine: Machine::here(),
            vectors: Vectors::here(),
            threads: rayon::current_num_threads(),
            repeats: plan.repeats,
            quick: plan.quick,
            times,
        }
    }

    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let quick = ["", "; quick: these times are meaningless"][usize::from(self.quick)];
        let how = format!(
            "{}: {}\n{}\n{}, {} thread(s), {} repeat(s){quick}",
            self.benchmark, self.about, self.machine, self.vectors, self.threads, self.repeats,
        );
        let mut blocks = vec![Block::Text(how), Block::table(self.times.table.clone())];
        blocks.extend(self.times.notes.iter().map(Block::text));
        let sheet = self.times.sheet.clone();
        blocks.push(Block::figure(self.benchmark, sheet, ""));
        let document = Document::of(format!("Benchmark {}", self.benchmark), blocks);
        let findings = Findings::new(self.benchmark, document, json!(self));
        Ok(findings.with_table(self.benchmark, &self.times.table)?)
    }
}

/// The names of the files of a benchmark.
pub fn names(benchmark: &str) -> Names {
    Names::new(benchmark, &[benchmark], &[benchmark])
}

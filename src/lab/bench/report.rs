//! The results of a benchmark: as text, as JSON, as files.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::{Value, json};

use super::plan::Plan;
use crate::error::LabError;
use crate::machine::Machine;
use engine::pairs::Vectors;
use output::plot::Sheet;
use output::table::Table;
use runs::store::Store;

/// The results of a benchmark.
#[derive(Debug, Clone, Serialize)]
pub struct Findings {
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
    findings: Findings,
}

impl Report {
    /// The findings of a benchmark, with this machine and the plan.
    pub fn of(
        benchmark: &'static str,
        about: &'static str,
        plan: &Plan,
        findings: Findings,
    ) -> Self {
        Self {
            benchmark,
            about,
            machine: Machine::here(),
            vectors: Vectors::here(),
            threads: rayon::current_num_threads(),
            repeats: plan.repeats,
            quick: plan.quick,
            findings,
        }
    }

    /// The text for a terminal.
    pub fn text(&self) -> String {
        let quick = ["", "; quick: these times are meaningless"][usize::from(self.quick)];
        let mut text = format!(
            "{}: {}\n{}\n{}, {} thread(s), {} repeat(s){quick}\n\n{}",
            self.benchmark,
            self.about,
            self.machine,
            self.vectors,
            self.threads,
            self.repeats,
            self.findings.table.text()
        );
        for note in &self.findings.notes {
            text += &format!("\n{note}\n");
        }
        text
    }

    /// The JSON for programs.
    pub fn json(&self) -> Value {
        json!(self)
    }

    /// Writes the JSON, and the picture as SVG and PNG, and returns the paths.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>, LabError> {
        let json = format!("{:#}\n", self.json());
        created(folder)?.write(&format!("{}.json", self.benchmark), json.as_bytes())?;
        self.findings.sheet.save(&folder.join(self.benchmark))?;
        Ok(files(self.benchmark, folder))
    }
}

/// A folder for files, created if it does not exist.
///
/// # Errors
/// It cannot be created.
pub fn created(folder: &Path) -> Result<Store, LabError> {
    let shown = folder.display();
    let unwritable = |error| LabError::Data(format!("cannot write {shown}: {error}"));
    fs::create_dir_all(folder).map_err(unwritable)?;
    Ok(Store::at(folder))
}

/// The files that a benchmark writes into a folder.
pub fn files(name: &str, folder: &Path) -> Vec<PathBuf> {
    let file = |extension: &str| folder.join(format!("{name}.{extension}"));
    ["json", "svg", "png"].map(file).into()
}

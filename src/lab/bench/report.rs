//! The results of a benchmark: as text, as JSON, as files.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::{Value, json};

use super::Plan;
use super::error::BenchError;
use super::machine::Machine;
use crate::analysis::statistics::Range;
use crate::engine::pairs::Vectors;
use crate::output::plot::Sheet;
use crate::output::table::OldTable as Table;
use crate::runs::outputs::write_whole;

/// The circumstances of all measurements.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Setting {
    /// The machine.
    pub machine: Machine,
    /// The vector instructions for sums over pairs.
    pub vectors: Vectors,
    /// Threads, unless a row says otherwise.
    pub threads: usize,
    /// Number of repeats.
    pub repeats: usize,
    /// Small crowds and few steps: the times are meaningless.
    pub quick: bool,
}

impl Setting {
    /// The circumstances of this process.
    pub fn of(plan: &Plan) -> Self {
        Self {
            machine: Machine::here(),
            vectors: Vectors::here(),
            threads: rayon::current_num_threads(),
            repeats: plan.repeats,
            quick: plan.quick,
        }
    }
}

/// The three numbers with `digits` decimals.
pub fn three(range: &Range, digits: usize) -> [String; 3] {
    [range.minimum, range.median, range.maximum].map(|value| format!("{value:.digits$}"))
}

/// The results of a benchmark.
#[derive(Debug, Clone)]
pub struct Findings {
    /// The table for readers.
    pub table: Table,
    /// The rows for programs: one object each.
    pub rows: Value,
    /// Notes that explain the results.
    pub notes: Vec<String>,
    /// The picture.
    pub sheet: Sheet,
}

/// The results of a benchmark, and their circumstances.
#[derive(Debug, Clone)]
pub struct Report {
    /// The benchmark.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// The circumstances of the measurements.
    pub setting: Setting,
    /// The results.
    pub findings: Findings,
}

impl Report {
    /// The text for a terminal.
    pub fn text(&self) -> String {
        let Setting {
            machine,
            vectors,
            threads,
            repeats,
            quick,
        } = &self.setting;
        let quick = if *quick {
            "; quick: these times say nothing"
        } else {
            ""
        };
        let mut text = format!(
            "{}: {}\n{machine}\n{vectors}, {threads} thread(s), {repeats} repeat(s){quick}\n\n{}",
            self.name,
            self.about,
            self.findings.table.text()
        );
        for note in &self.findings.notes {
            text += &format!("\n{note}\n");
        }
        text
    }

    /// The JSON for programs.
    pub fn json(&self) -> Value {
        json!({
            "benchmark": self.name,
            "about": self.about,
            "machine": self.setting.machine,
            "vectors": self.setting.vectors,
            "threads": self.setting.threads,
            "repeats": self.setting.repeats,
            "quick": self.setting.quick,
            "rows": self.findings.rows,
            "notes": self.findings.notes,
        })
    }

    /// Writes the JSON, and the picture as SVG and PNG, and returns the paths.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>, BenchError> {
        let written = files(self.name, folder);
        fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
        let path = &written[0];
        let json = format!("{:#}\n", self.json());
        let saved = write_whole(path, |file| file.write_all(json.as_bytes()));
        saved.map_err(|error| unwritable(path, &error))?;
        self.findings.sheet.save(&folder.join(self.name))?;
        Ok(written)
    }
}

fn unwritable(path: &Path, error: &io::Error) -> BenchError {
    BenchError::Unwritable {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

/// The files that a benchmark writes into a folder, the JSON first.
pub fn files(name: &str, folder: &Path) -> Vec<PathBuf> {
    let file = |extension: &str| folder.join(format!("{name}.{extension}"));
    ["json", "svg", "png"].map(file).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_left_and_numbers_right() {
        let mut table = Table::new(1, &["crowd", "ms"]);
        table.rows.push(vec!["sf".to_owned(), "12.5".to_owned()]);
        table.rows.push(vec!["rvo".to_owned(), "1".to_owned()]);
        assert_eq!(table.text(), "crowd    ms\nsf     12.5\nrvo       1\n");
    }
}

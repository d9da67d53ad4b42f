//! Results: on the terminal, in files of every kind, and in a folder.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::terminal::{talk, tell};
use super::values::document;
use output::document::{Findings, Names};
use output::plot::PlotError;
use runs::outputs::{Manner, Outputs};
use runs::store::Store;

/// Files with all results of a command.
#[derive(Args)]
pub struct DocumentOptions {
    /// Also write the results to this file, as its ending says: a document (.html, .pdf or .md), the tables (.csv) or
    /// one JSON object (.json); may be repeated
    #[arg(short = 'o', long = "document", value_name = "FILE", value_parser = document())]
    pub documents: Vec<PathBuf>,
}

impl DocumentOptions {
    /// Adds the files to those that a command writes.
    pub fn add_to(&self, outputs: &mut Outputs, names: &Names) {
        for file in &self.documents {
            outputs.writes("-o", file, Manner::File);
            for beside in names.beside(file) {
                outputs.writes("-o", &beside, Manner::Beside);
            }
        }
    }

    /// Whether there are any.
    pub fn are_given(&self) -> bool {
        !self.documents.is_empty()
    }

    /// Writes results to the files.
    pub fn save(&self, findings: &Findings) -> Result<(), Failure> {
        for file in &self.documents {
            let paths = findings.save(file)?;
            talk(&format!("note: {} written", listed(&paths, None)));
        }
        Ok(())
    }

    /// Gives results: on the terminal, as JSON or as text, in the files, and in the folder, if there is one.
    pub fn give(
        &self,
        findings: &Findings,
        as_json: bool,
        folder: Option<&Path>,
    ) -> Result<(), Failure> {
        let said = show(findings, as_json, folder);
        self.save(findings)?;
        said
    }
}

/// Shows results on the terminal, as JSON or as text, and writes them to the folder, if there is one.
pub fn show(findings: &Findings, as_json: bool, folder: Option<&Path>) -> Result<(), Failure> {
    let (json, text) = (|| findings.data.clone(), || findings.document.text());
    let said = tell(as_json, json, text);
    if let Some(folder) = folder {
        let paths = findings.write(folder).map_err(|error| match error {
            PlotError::Writing { path, reason } => {
                Store::at(folder).unwritable(&path, &reason).into()
            }
            other => Failure::from(other),
        })?;
        let names = listed(&paths, Some(folder));
        talk(&format!("note: written to {}: {names}", folder.display()));
    }
    said
}

/// Files in words, those in this folder by their names.
fn listed(paths: &[PathBuf], folder: Option<&Path>) -> String {
    let names = paths.iter().map(|path| {
        let inner = folder.and_then(|folder| path.strip_prefix(folder).ok());
        inner.unwrap_or(path).display().to_string()
    });
    names.collect::<Vec<_>>().join(", ")
}

/// Adds the files of a folder to those that a command writes. Another process may make them at the same time, so no
/// trial files are created.
pub fn add_folder(outputs: &mut Outputs, folder: &Path, names: &Names) {
    for file in names.in_folder() {
        outputs.writes("--out", &folder.join(file), Manner::Beside);
    }
}

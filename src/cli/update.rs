//! Options of commands that compute many cases, with `--update`, which inserts tables into a document.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::{PrintOptions, ReplaceOptions, use_threads};
use super::documents::{DocumentOptions, add_folder};
use super::failure::Failure;
use super::values::threads;
use output::document::{Findings, Names, put_between};
use runs::outputs::{Manner, Outputs, write_whole};
use runs::store::Store;
use scenario::input;

/// The document with the tables.
#[derive(Args)]
pub struct UpdateOptions {
    /// Also insert the tables into this file, between the lines <!-- NAME --> and <!-- /NAME -->
    #[arg(long, value_name = "FILE.md")]
    pub update: Option<PathBuf>,
}

#[derive(Args)]
pub struct CaseOptions {
    /// Folder for the results; cases finished there are not run again
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    #[command(flatten)]
    pub files: DocumentOptions,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub replace: ReplaceOptions,
    #[command(flatten)]
    pub document: UpdateOptions,
    /// Number of cases to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub print: PrintOptions,
}

impl CaseOptions {
    /// Applies the options, and opens the folder for the results, after a check that the document can be updated, has a
    /// place for one of the `tables` at least, and that results called `names` replace no other file.
    pub fn store(&self, tables: &[&str], names: &Names) -> Result<Store, Failure> {
        self.apply(tables)?;
        self.open(self.outputs([]), names)
    }

    /// Applies the options, and checks that the document can be updated.
    pub fn apply(&self, tables: &[&str]) -> Result<(), Failure> {
        use_threads(self.threads)?;
        self.print.apply();
        self.document.check(Some(&self.out), tables)
    }

    /// The files of a command that reads these inputs.
    pub fn outputs<'a>(&self, inputs: impl IntoIterator<Item = (&'a str, &'a Path)>) -> Outputs {
        let mut outputs = self.replace.outputs(&self.out);
        for (name, path) in inputs {
            outputs.reads(name, path);
        }
        outputs
    }

    /// Opens the folder for the results, after a check that the outputs and files called `names` replace no other file.
    pub fn open(&self, mut outputs: Outputs, names: &Names) -> Result<Store, Failure> {
        add_folder(&mut outputs, &self.out, names);
        outputs.may_replace(self.replace.force);
        self.files.add_to(&mut outputs, names);
        outputs.check()?;
        Ok(Store::open(&self.out)?)
    }

    /// Gives the results on the terminal, in the folder and in files.
    pub fn show(&self, findings: &Findings) -> Result<(), Failure> {
        self.files.give(findings, self.json, Some(&self.out))
    }

    /// The same, and updates the document.
    pub fn give(&self, findings: &Findings) -> Result<(), Failure> {
        self.give_parts(findings, |_| true)
    }

    /// The same, and updates these parts of the document.
    pub fn give_parts(
        &self,
        findings: &Findings,
        is_updated: impl Fn(&str) -> bool,
    ) -> Result<(), Failure> {
        let shown = self.show(findings);
        let parts = findings.document.parts(&findings.name).into_iter();
        self.document
            .put(parts.filter(|(name, _)| is_updated(name)))?;
        shown
    }
}

impl UpdateOptions {
    /// Checks that the document can be updated, has a place for one of the `tables` at least, and that no result in the
    /// folder `out` replaces it.
    ///
    /// # Errors
    /// The document cannot be updated.
    pub fn check(&self, out: Option<&Path>, tables: &[&str]) -> Result<(), Failure> {
        let Some(file) = &self.update else {
            return Ok(());
        };
        let place = fs::canonicalize(file).map_err(|error| failed(file, &error))?;
        let mut outputs = Outputs::new(true);
        outputs.writes("--update", file, Manner::Whole);
        outputs.check()?;
        let results = out.and_then(|out| fs::canonicalize(out).ok());
        if let Some(out) = out
            && results.is_some()
            && place.parent() == results.as_deref()
        {
            return Err(Failure::Input(format!(
                "--update {}: lies in the folder of --out {}, whose files are replaced; give another folder",
                file.display(),
                out.display()
            )));
        }
        let document = input::text(file).map_err(|error| failed(file, &error))?;
        let has_place = |table: &&str| put_between(&document, table, "").is_some();
        if tables.iter().any(has_place) {
            return Ok(());
        }
        let names = tables.iter();
        let lines = names.map(|table| format!("<!-- {table} --> and <!-- /{table} --> after it"));
        Err(Failure::Input(format!(
            "--update {}: no place for a table; add the lines {}",
            file.display(),
            lines.collect::<Vec<_>>().join(" or ")
        )))
    }

    /// Inserts texts at the places of the document that are marked with their names.
    ///
    /// # Errors
    /// The document cannot be read or written.
    pub fn put(
        &self,
        texts: impl IntoIterator<Item = (impl AsRef<str>, impl AsRef<str>)>,
    ) -> Result<(), Failure> {
        let Some(file) = &self.update else {
            return Ok(());
        };
        let put = || {
            let mut document = input::text(file)?;
            for (name, text) in texts {
                if let Some(changed) = put_between(&document, name.as_ref(), text.as_ref()) {
                    document = changed;
                }
            }
            write_whole(file, |whole| whole.write_all(document.as_bytes()))
        };
        put().map_err(|error| failed(file, &error))
    }
}

fn failed(file: &Path, error: &io::Error) -> Failure {
    Failure::Output(format!("cannot write {}: {error}", file.display()))
}

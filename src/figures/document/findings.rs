//! What a command found, and its files.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::{Block, Document, Figure};
use crate::plot::{PlotError, Print};
use crate::table::Table;
use common::outputs::write_file;

/// What a command found.
#[derive(Debug, Clone)]
pub struct Findings {
    /// The name of the files with all of it, without an ending.
    pub name: String,
    /// For readers.
    pub document: Document,
    /// The names of CSV files, without an ending, and their contents. The first is the main one.
    pub tables: Vec<(String, Vec<u8>)>,
    /// For programs: one object.
    pub data: Value,
}

/// The names of the files of findings, which are known before there are any.
#[derive(Debug, Clone, Default)]
pub struct Names {
    /// The name of the files with all of it, without an ending.
    pub name: String,
    /// The names of the tables; the first is the main one.
    pub tables: Vec<String>,
    /// The names of the figures.
    pub figures: Vec<String>,
}

impl Names {
    /// The names of findings with these tables and figures.
    pub fn new(name: &str, tables: &[&str], figures: &[&str]) -> Self {
        let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        Self {
            name: name.to_owned(),
            tables: owned(tables),
            figures: owned(figures),
        }
    }

    /// The same with a document whose figures are numbered, see [`Document::numbered`].
    pub fn numbered(self) -> Self {
        /// No document has more figures.
        const MOST: usize = 40;
        let figures = (1..=MOST).map(|k| format!("figure-{k}")).collect();
        Self { figures, ..self }
    }

    /// The names of several findings as one.
    pub fn joined(name: &str, all: &[Self]) -> Self {
        let all = all.iter();
        Self {
            name: name.to_owned(),
            tables: all.clone().flat_map(|one| one.tables.clone()).collect(),
            figures: all.flat_map(|one| one.figures.clone()).collect(),
        }
    }

    /// The names of the files in a folder: JSON, Markdown, the tables as CSV, and the figures.
    pub fn in_folder(&self) -> Vec<String> {
        let whole = ["json", "md"].map(|end| format!("{}.{end}", self.name));
        let tables = self.tables.iter().map(|table| format!("{table}.csv"));
        let figures = self.figures.iter().flat_map(|figure| {
            let ends = Print::of_program().extensions();
            ends.map(move |end| format!("{figure}.{end}"))
        });
        whole.into_iter().chain(tables).chain(figures).collect()
    }

    /// The files that are written beside a single file: further tables of a `.csv`, figures of an `.md`.
    pub fn beside(&self, file: &Path) -> Vec<PathBuf> {
        match ending(file) {
            Ending::Csv => {
                let further = self.tables.iter().skip(1);
                further.map(|table| sibling(file, table, "csv")).collect()
            }
            Ending::Markdown => {
                let figures = self.figures.iter();
                figures.map(|figure| sibling(file, figure, "svg")).collect()
            }
            Ending::Html | Ending::Pdf | Ending::Json => Vec::new(),
        }
    }
}

/// The kinds of files that have all findings.
enum Ending {
    Markdown,
    Html,
    Pdf,
    Csv,
    Json,
}

/// The endings of files that have all findings; others are written as HTML.
pub const ENDINGS: [&str; 5] = ["html", "pdf", "md", "csv", "json"];

fn ending(file: &Path) -> Ending {
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("md") => Ending::Markdown,
        Some("pdf") => Ending::Pdf,
        Some("csv") => Ending::Csv,
        Some("json") => Ending::Json,
        _ => Ending::Html,
    }
}

/// `FILE-NAME.END` beside `FILE.…`.
fn sibling(file: &Path, name: &str, end: &str) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{stem}-{name}.{end}"))
}

impl Findings {
    /// Findings without tables for programs.
    pub fn new(name: &str, document: Document, data: Value) -> Self {
        Self {
            name: name.to_owned(),
            document,
            tables: Vec::new(),
            data,
        }
    }

    /// Adds a table for programs.
    ///
    /// # Errors
    /// Never in practice, see [`Table::csv`].
    pub fn with_table(mut self, name: &str, table: &Table) -> Result<Self, csv::Error> {
        self.tables.push((name.to_owned(), table.csv()?));
        Ok(self)
    }

    /// Several findings as one, each a part with its title.
    pub fn joined(name: &str, title: &str, all: Vec<Self>) -> Self {
        let (mut blocks, mut tables, mut data) = (Vec::new(), Vec::new(), Map::new());
        for one in all {
            blocks.push(Block::Part(one.name.clone(), one.document.title));
            blocks.extend(one.document.blocks);
            tables.extend(one.tables);
            data.insert(one.name, one.data);
        }
        Self {
            tables,
            ..Self::new(name, Document::of(title, blocks), Value::Object(data))
        }
    }

    /// The JSON, as files have it.
    fn json(&self) -> Vec<u8> {
        format!("{:#}\n", self.data).into_bytes()
    }

    /// Writes everything into a folder, which is created if it does not exist. Returns the paths of
    /// [`Names::in_folder`].
    ///
    /// # Errors
    /// A figure cannot be drawn, or a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, PlotError> {
        let file = |name: &str, end: &str| folder.join(format!("{name}.{end}"));
        let link = |figure: &Figure| format!("{}.svg", figure.name);
        let markdown = self.document.markdown(&link).into_bytes();
        fs::create_dir_all(folder).map_err(|reason| PlotError::Writing {
            path: folder.to_owned(),
            reason,
        })?;
        let mut written = Vec::new();
        let mut write = |path: PathBuf, bytes: &[u8]| {
            save(&path, bytes)?;
            written.push(path);
            Ok::<(), PlotError>(())
        };
        write(file(&self.name, "json"), &self.json())?;
        write(file(&self.name, "md"), &markdown)?;
        for (name, bytes) in &self.tables {
            write(file(name, "csv"), bytes)?;
        }
        for figure in self.document.figures() {
            figure.sheet.save(&folder.join(&figure.name))?;
            let ends = Print::of_program().extensions();
            written.extend(ends.map(|end| file(&figure.name, end)));
        }
        Ok(written)
    }

    /// Writes everything to one file, by its ending, and returns the paths: it, and those of [`Names::beside`].
    ///
    /// # Errors
    /// A figure cannot be drawn, or a file cannot be written.
    pub fn save(&self, file: &Path) -> Result<Vec<PathBuf>, PlotError> {
        let mut beside = Vec::new();
        let bytes = match ending(file) {
            Ending::Html => self.document.html()?.into_bytes(),
            Ending::Pdf => self.document.pdf()?,
            Ending::Json => self.json(),
            Ending::Markdown => {
                let of = |figure: &Figure| sibling(file, &figure.name, "svg");
                for figure in self.document.figures() {
                    beside.push((of(figure), figure.sheet.svg(&Print::of_program())?));
                }
                let link = |figure: &Figure| {
                    let path = of(figure);
                    let name = path.file_name().unwrap_or_default();
                    name.to_string_lossy().into_owned()
                };
                self.document.markdown(&link).into_bytes()
            }
            Ending::Csv => {
                let mut tables = self.tables.iter();
                let none = || PlotError::NoTable(file.to_owned());
                let (_, main) = tables.next().ok_or_else(none)?;
                let further =
                    tables.map(|(name, bytes)| (sibling(file, name, "csv"), bytes.clone()));
                beside.extend(further);
                main.clone()
            }
        };
        let mut written = Vec::new();
        for (path, bytes) in std::iter::once((file.to_owned(), bytes)).chain(beside) {
            save(&path, &bytes)?;
            written.push(path);
        }
        Ok(written)
    }
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), PlotError> {
    write_file(path, bytes).map_err(|reason| PlotError::Writing {
        path: path.to_owned(),
        reason,
    })
}

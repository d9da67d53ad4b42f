//! Turns a study's file into validated cells.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::cell::{Cell, LABEL};
use super::choice::Root;
use super::plan::{File, Plan};
use crate::lab::error::LabError;
use crate::runs::error::{RunError, StoreError};
use crate::runs::job::Job;
use crate::runs::memory::Memory;
use crate::runs::parallel::side_by_side;
use crate::scenario::input;
use crate::scenario::quote::shown;
use crate::scenario::{Problem, ScenarioError, built_in, in_plain_words, read_document};

/// The maximum length of a name, bytes: results add to it, and file names are limited.
const LONGEST_NAME: usize = 200;

/// Why a study is invalid.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study's file is invalid.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// One of its cells is invalid.
    #[error("{file}: cell {cell}: {error}")]
    Cell {
        /// The study's file.
        file: String,
        /// The cell's number.
        cell: usize,
        /// The reason.
        error: RunError,
    },
    /// The cells cannot be checked in parallel.
    #[error(transparent)]
    Machine(#[from] StoreError),
}

impl From<StudyError> for LabError {
    fn from(error: StudyError) -> Self {
        Self::Data(error.to_string())
    }
}

/// A scenario over settings and seeds.
#[derive(Debug, Clone)]
pub struct Study {
    /// Its name, suitable as a file name.
    pub name: String,
    /// The contents of the file.
    pub document: Value,
    /// The names of the varied settings, without the seeds: keys of the list, then of the grid, as written.
    pub axes: Vec<String>,
    /// The number of keys of the grid among them.
    grid_axes: usize,
    /// Number of seeds per combination.
    pub seeds: usize,
    /// The cells in the order of their numbers. The seed changes fastest, then the last key of the grid; the list
    /// changes slowest.
    pub cells: Vec<Cell>,
    /// Memory that the cells share, bytes; `None` without a limit.
    pub memory: Option<u64>,
}

impl Study {
    /// The axes that distinguish cells: with labels, the list's other keys need not be shown.
    pub(super) fn short_axes(&self) -> Vec<String> {
        let others = self.axes.len() - self.grid_axes;
        match self.axes.split_at(others) {
            ([label, ..], grid) if label == LABEL => [std::slice::from_ref(label), grid].concat(),
            _ => self.axes.clone(),
        }
    }

    /// Whether the seed is among the varied settings.
    pub(super) fn varies_seed(&self) -> bool {
        self.axes.iter().any(|axis| axis == "seed")
    }

    /// The files that its scenarios are read from, without duplicates.
    pub fn inputs(&self) -> BTreeSet<&Path> {
        let cells = self.cells.iter();
        cells.flat_map(|cell| cell.case.files()).collect()
    }

    /// The jobs of its wanted cells, in order.
    pub fn jobs(&self, wanted: impl Fn(&Cell) -> bool) -> Vec<Job<'_>> {
        let cells = self.cells.iter().filter(|cell| wanted(cell));
        cells.map(|cell| cell.case.job(cell.to_string())).collect()
    }

    /// A study of these cells, which another file describes.
    pub fn of_cells(name: &str, cells: Vec<Cell>, memory: Option<u64>) -> Self {
        Self {
            name: name.to_owned(),
            document: Value::Null,
            axes: Vec::new(),
            grid_axes: 0,
            seeds: 1,
            cells,
            memory,
        }
    }

    /// Reads a study, and validates the scenario of every cell. Only as many cells are validated and computed at the
    /// same time as fit into `memory`, bytes.
    ///
    /// # Errors
    /// The first problem, with its place in the file or the number of the cell; or a single cell needs more memory.
    pub fn read(path: &Path, memory: Option<u64>) -> Result<Self, StudyError> {
        let text = input::text(path).map_err(|error| ScenarioError::Unreadable {
            file: path.display().to_string(),
            reason: error.to_string(),
        })?;
        let built_in = false;
        Self::parse_within(&text, Root { path, built_in }, |_| (), memory)
    }

    /// Reads a study from a file, or the built-in one of this name if there is no such file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn open(path: &Path, memory: Option<u64>) -> Result<Self, StudyError> {
        match path.to_str().filter(|_| !path.exists()) {
            Some(name) if built_in(&built_in_path(name)).is_some() => {
                Self::built_in(name, None, memory)
            }
            _ => Self::read(path, memory),
        }
    }

    /// A study that is built into the program: a file under `scenarios/studies/`, without its extension. `seeds`
    /// replaces the file's number of seeds.
    ///
    /// # Errors
    /// There is no such study, or an error of [`read`](Self::read).
    pub fn built_in(
        name: &str,
        seeds: Option<u64>,
        memory: Option<u64>,
    ) -> Result<Self, StudyError> {
        Self::changed(name, |file| file.with_seeds(seeds), memory)
    }

    /// The same with other profiles than those of its grid, if any are given.
    ///
    /// # Errors
    /// As [`built_in`](Self::built_in).
    pub fn built_in_for(
        name: &str,
        profiles: &[String],
        seeds: Option<u64>,
    ) -> Result<Self, StudyError> {
        Self::changed(name, |file| file.with_grid(profiles, seeds), None)
    }

    /// The same with those entries of its list whose labels have a file in `data`: their scenarios begin from it.
    ///
    /// # Errors
    /// As [`built_in`](Self::built_in).
    pub fn built_in_with(
        name: &str,
        data: &BTreeMap<&str, PathBuf>,
        (profiles, seeds): (&[String], Option<u64>),
    ) -> Result<Self, StudyError> {
        let change = |file: &mut File| {
            file.with_grid(profiles, seeds);
            file.with_data(data);
        };
        Self::changed(name, change, None)
    }

    /// A built-in study, changed.
    fn changed(
        name: &str,
        change: impl FnOnce(&mut File),
        memory: Option<u64>,
    ) -> Result<Self, StudyError> {
        let path = built_in_path(name);
        let text = built_in(&path).ok_or_else(|| ScenarioError::Unreadable {
            file: path.display().to_string(),
            reason: "no such study is built into the program".to_owned(),
        })?;
        let (path, built_in) = (path.as_path(), true);
        Self::parse_within(text, Root { path, built_in }, change, memory)
    }

    /// Reads a study from JSON. `path` is its name in messages; files that it refers to are relative to the folder of
    /// `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        let built_in = false;
        Self::parse_within(text, Root { path, built_in }, |_| (), None)
    }

    fn parse_within(
        text: &str,
        root: Root,
        change: impl FnOnce(&mut File),
        memory: Option<u64>,
    ) -> Result<Self, StudyError> {
        let file = root.path.display().to_string();
        let stem = root.path.file_stem().unwrap_or_default().to_string_lossy();
        let invalid = |problem| ScenarioError::Invalid {
            file: file.clone(),
            problem,
        };
        let document = read_document(text, &file)?;
        let mut written: File = parse(text, "a `scenario`").map_err(invalid)?;
        change(&mut written);
        let plan = Plan::new(&written, root).map_err(invalid)?;
        let name = written.name.unwrap_or_else(|| stem.into_owned());
        check_name(&name).map_err(invalid)?;
        let shared = Memory::new(memory);
        let cells: Vec<_> = (0..plan.count).map(|_| OnceLock::new()).collect();
        // Not on rayon's threads: these could start another cell while they hold memory for the first.
        side_by_side(plan.count, |index| {
            cells[index].set(plan.cell(index, &shared)).ok();
            Ok::<(), StoreError>(())
        })?;
        let cell = |(index, cell): (usize, OnceLock<Result<Cell, RunError>>)| {
            let failed = |error| StudyError::Cell {
                file: file.clone(),
                cell: index + 1,
                error,
            };
            cell.into_inner().map(|cell| cell.map_err(failed))
        };
        let cells = cells.into_iter().enumerate().filter_map(cell);
        Ok(Self {
            name,
            document,
            memory,
            seeds: plan.seeds.len(),
            grid_axes: plan.grid.len(),
            cells: cells.collect::<Result<_, _>>()?,
            axes: plan.names,
        })
    }
}

fn built_in_path(name: &str) -> PathBuf {
    Path::new("studies").join(format!("{name}.json"))
}

/// Whether the name is suitable for result files on every system.
pub(in crate::lab) fn check_name(name: &str) -> Result<(), Problem> {
    let reason = if name.is_empty() {
        "it is empty"
    } else if name.starts_with('.') {
        "it begins with a dot"
    } else if name.contains(|c: char| "/\\<>:\"|?*".contains(c) || c.is_control()) {
        "it has one of / \\ < > : \" | ? * or a control character"
    } else if name.len() > LONGEST_NAME {
        "it is too long"
    } else {
        return Ok(());
    };
    let reason = format!(
        "must be fit for a file's name, not \"{}\": {reason}; give a `name` without these, of at most \
         {LONGEST_NAME} bytes",
        shown(name)
    );
    Err(Problem::new("name", reason))
}

/// Checks names and types. `needs` names the required keys, for the message about a file that is not an object.
pub(in crate::lab) fn parse<T: DeserializeOwned>(text: &str, needs: &str) -> Result<T, Problem> {
    if !text.trim_start().starts_with('{') {
        let reason = format!("must be an object, {{…}}, with {needs}");
        return Err(Problem::new("", reason));
    }
    let mut deserializer = serde_json::Deserializer::from_str(text);
    serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let path = error.path().to_string();
        let said = error.inner();
        let place = format!(" at line {} column {}", said.line(), said.column());
        let said = said.to_string();
        let reason = in_plain_words(said.strip_suffix(&place).unwrap_or(&said));
        Problem::new(if path == "." { String::new() } else { path }, reason)
    })
}

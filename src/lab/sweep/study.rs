//! Turns a study's file into validated cells.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use super::cell::{Cell, LABEL};
use super::plan::{Changes, File, Plan};
use super::written::Written;
use crate::error::LabError;
use crate::jobs::each;
use runs::case::Source;
use runs::error::{RunError, StoreError};
use runs::job::Job;
use runs::memory::Memory;
use scenario::quote::shown;
use scenario::{Problem, ScenarioError, input};

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

/// The folder of the built-in studies.
pub(crate) const FOLDER: &str = "studies";

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
        Self::changed(&Written::read(path)?, &Changes::default(), memory)
    }

    /// Reads a study from a file, or the built-in one of this name if there is no such file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn open(path: &Path, memory: Option<u64>) -> Result<Self, StudyError> {
        Self::changed(&Written::open(path, FOLDER)?, &Changes::default(), memory)
    }

    /// The study in a file, by its keys, or the built-in one of this name; `None` if a scenario or nothing has this
    /// name.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn named(name: &str, memory: Option<u64>) -> Result<Option<Self>, StudyError> {
        /// The keys that studies have, and scenarios do not.
        const KEYS: [&str; 4] = ["scenario", "grid", "list", "seeds"];
        let path = Path::new(name);
        let has_keys = |document: Value| KEYS.iter().any(|key| document.get(key).is_some());
        let is_study = match path.is_file() {
            true => {
                let text = input::text(path).unwrap_or_default();
                serde_json::from_str(&text).is_ok_and(has_keys)
            }
            false => Source::shipped(name).is_none() && Written::built_in(FOLDER, name).is_ok(),
        };
        is_study.then(|| Self::open(path, memory)).transpose()
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
        let changes = Changes {
            seeds,
            ..Changes::default()
        };
        Self::changed(&Written::built_in(FOLDER, name)?, &changes, memory)
    }

    /// Reads a study from JSON. `path` is its name in messages; files that it refers to are relative to the folder of
    /// `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        Self::changed(&Written::of(text, path), &Changes::default(), None)
    }

    /// A study with these changes.
    pub(crate) fn changed(
        from: &Written,
        changes: &Changes,
        memory: Option<u64>,
    ) -> Result<Self, StudyError> {
        let (document, mut written) = from.parsed::<File>(File::NEEDS)?;
        written.change(changes);
        let invalid = |problem| from.invalid(problem);
        let plan = Plan::new(&written, from).map_err(invalid)?;
        let name = written.name.unwrap_or_else(|| from.stem());
        check_name(&name).map_err(invalid)?;
        let shared = Memory::new(memory);
        // Not on rayon's threads: these could start another cell while they hold memory for the first.
        let checked = each(plan.count, |index| plan.cell(index, &shared))?.into_iter();
        let cells = checked.enumerate().map(|(index, cell)| {
            cell.map_err(|error| StudyError::Cell {
                file: from.file(),
                cell: index + 1,
                error,
            })
        });
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

/// Whether the name is suitable for result files on every system.
pub(crate) fn check_name(name: &str) -> Result<(), Problem> {
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

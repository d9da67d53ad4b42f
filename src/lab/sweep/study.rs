//! Turns a study's file into validated cells.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::Deserialize;
use serde_json::Value;

use super::cell::{Cell, LABEL};
use super::choice::{Choice, Meaning, Root, SCENARIO, axis, choices, said, source};
use super::entries::Entries;
use super::seeds::Seeds;
use super::{StudyError, problem};
use crate::runs::case::{Case, Source};
use crate::runs::error::{RunError, StoreError};
use crate::runs::job::Job;
use crate::runs::memory::Memory;
use crate::runs::parallel::side_by_side;
use crate::scenario::input;
use crate::scenario::quote::shown;
use crate::scenario::{Problem, ScenarioError, Setting, built_in, in_plain_words, read_document};

/// Studies with more cells are rejected as mistakes.
pub(super) const MOST_CELLS: usize = 100_000;

/// The maximum length of a name, bytes: results add to it, and file names are limited.
const LONGEST_NAME: usize = 200;

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct File {
    name: Option<String>,
    #[serde(rename = "description")]
    _description: Option<String>,
    scenario: Option<String>,
    settings: Entries,
    measurements: Vec<Value>,
    list: Option<Vec<Entries>>,
    grid: Entries,
    seeds: Option<Seeds>,
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
    /// How many of them are keys of the grid.
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
    /// The axes that tell cells apart: with labels, the list's other keys need not be shown.
    pub(super) fn short_axes(&self) -> Vec<String> {
        let others = self.axes.len() - self.grid_axes;
        match self.axes.split_at(others) {
            ([label, ..], grid) if label == LABEL => [&[label.clone()], grid].concat(),
            _ => self.axes.clone(),
        }
    }

    /// Is the seed among the varied settings?
    pub(super) fn varies_seed(&self) -> bool {
        self.axes.iter().any(|axis| axis == "seed")
    }

    /// The files that its scenarios are read from, without duplicates.
    pub fn inputs(&self) -> BTreeSet<&Path> {
        self.cells
            .iter()
            .flat_map(|cell| cell.case.files())
            .collect()
    }

    /// The jobs of its wanted cells, in order.
    pub fn jobs(&self, wanted: impl Fn(&Cell) -> bool) -> Vec<Job<'_>> {
        let cells = self.cells.iter().filter(|cell| wanted(cell));
        cells.map(|cell| cell.case.job(cell.to_string())).collect()
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
        Self::parse_within(&text, Root::file(path), None, memory)
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
        let path = built_in_path(name);
        let text = built_in(&path).ok_or_else(|| ScenarioError::Unreadable {
            file: path.display().to_string(),
            reason: "no such study is built into the program".to_owned(),
        })?;
        Self::parse_within(text, Root::built_in(&path), seeds, memory)
    }

    /// Reads a study from JSON. `path` is its name in messages; files that it refers to are relative to the folder of
    /// `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        Self::parse_within(text, Root::file(path), None, None)
    }

    fn parse_within(
        text: &str,
        root: Root,
        seeds: Option<u64>,
        memory: Option<u64>,
    ) -> Result<Self, StudyError> {
        let file = root.path.display().to_string();
        let stem = root.path.file_stem().unwrap_or_default().to_string_lossy();
        let invalid = |problem| ScenarioError::Invalid {
            file: file.clone(),
            problem,
        };
        let document = read_document(text, &file)?;
        let mut written = parse(text).map_err(invalid)?;
        written.seeds = seeds.map(Seeds::Count).or(written.seeds);
        let plan = Plan::new(&written, root).map_err(invalid)?;
        let name = written.name.unwrap_or_else(|| stem.into_owned());
        check_name(&name).map_err(invalid)?;
        let shared = Memory::new(memory);
        let cells = Mutex::new(Vec::with_capacity(plan.count));
        // Not on rayon's threads: they could start another cell while they hold memory for the first.
        side_by_side(plan.count, |index| {
            let cell = plan.cell(index, &shared);
            let mut cells = cells.lock().unwrap_or_else(PoisonError::into_inner);
            cells.push((index, cell));
            Ok::<(), StoreError>(())
        })?;
        let mut cells = cells.into_inner().unwrap_or_else(PoisonError::into_inner);
        cells.sort_by_key(|&(index, _)| index);
        let failed = |(index, cell): (usize, Result<Cell, RunError>)| {
            cell.map_err(|error| StudyError::Cell {
                file: file.clone(),
                cell: index + 1,
                error,
            })
        };
        Ok(Self {
            name,
            document,
            memory,
            seeds: plan.seeds.len(),
            grid_axes: plan.grid.len(),
            cells: cells.into_iter().map(failed).collect::<Result<_, _>>()?,
            axes: plan.names,
        })
    }
}

fn built_in_path(name: &str) -> PathBuf {
    Path::new("studies").join(format!("{name}.json"))
}

/// Is the name suitable for result files on every system?
fn check_name(name: &str) -> Result<(), Problem> {
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
    Err(problem("name", reason))
}

/// Checks names and types.
fn parse(text: &str) -> Result<File, Problem> {
    if !text.trim_start().starts_with('{') {
        return Err(problem("", "must be an object, {…}, with a `scenario`"));
    }
    let mut deserializer = serde_json::Deserializer::from_str(text);
    serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let path = error.path().to_string();
        let said = error.inner();
        let place = format!(" at line {} column {}", said.line(), said.column());
        let said = said.to_string();
        let reason = in_plain_words(said.strip_suffix(&place).unwrap_or(&said));
        problem(if path == "." { String::new() } else { path }, reason)
    })
}

/// Everything that cells are combined from.
struct Plan {
    names: Vec<String>,
    /// The scenario of cells whose settings do not name one.
    scenario: Source,
    fixed: Vec<Choice>,
    /// Measurements in addition to those of the scenario, as settings.
    measurements: Vec<Setting>,
    /// The combinations of the list; a single empty one without a list.
    rows: Vec<Vec<Choice>>,
    /// The labels of these combinations.
    labels: Vec<Option<(String, Value)>>,
    /// The values of each axis of the grid.
    grid: Vec<Vec<Choice>>,
    /// The seeds as settings; a single `None` if the study gives no seeds.
    seeds: Vec<Option<Setting>>,
    count: usize,
}

impl Plan {
    fn new(file: &File, root: Root) -> Result<Self, Problem> {
        let fixed = choices(&file.settings, "settings", None)?;
        let mut labels = vec![None];
        let rows: Vec<Vec<Choice>> = match &file.list {
            None => vec![Vec::new()],
            Some(list) if list.is_empty() => return Err(problem("list", "must not be empty")),
            Some(list) if list.len() > MOST_CELLS => {
                let reason = format!("has {} cells; at most {MOST_CELLS} are allowed", list.len());
                return Err(problem("list", reason));
            }
            Some(list) => {
                labels.clear();
                let mut rows = Vec::with_capacity(list.len());
                for (k, entries) in list.iter().enumerate() {
                    let place = format!("list[{k}]");
                    let (label, entries) = entries.split_label(&place)?;
                    rows.push(choices(&entries, &place, Some(root))?);
                    labels.push(label.map(|label| (LABEL.to_owned(), label.into())));
                }
                rows
            }
        };
        let grid = file
            .grid
            .0
            .iter()
            .map(|(key, values)| axis(key, values, root));
        let grid = grid.collect::<Result<Vec<_>, _>>()?;
        let mut plan = Self {
            names: Vec::new(),
            scenario: match &file.scenario {
                Some(name) => source(name, SCENARIO, root)?,
                None => varied_scenario(&rows, &grid)?,
            },
            fixed,
            measurements: measurements(&file.measurements)?,
            rows,
            labels,
            grid,
            seeds: seeds(file.seeds.as_ref())?,
            count: 0,
        };
        plan.refuse_repetitions()?;
        let varied = plan.rows.iter().flatten().chain(plan.grid.iter().flatten());
        for choice in varied {
            if !plan.names.contains(&choice.key) {
                plan.names.push(choice.key.clone());
            }
        }
        if plan.labels.iter().any(Option::is_some) {
            plan.names.insert(0, LABEL.to_owned());
        }
        plan.count = plan.cells()?;
        Ok(plan)
    }

    /// The number of cells.
    fn cells(&self) -> Result<usize, Problem> {
        let sizes = self.grid.iter().map(Vec::len);
        let sizes = sizes.chain([self.rows.len(), self.seeds.len()]);
        let count = sizes.map(|size| size as f64).product::<f64>();
        if count > MOST_CELLS as f64 {
            let reason = format!("makes {count} cells; at most {MOST_CELLS} are allowed");
            return Err(problem("", reason));
        }
        Ok(count as usize)
    }

    /// Rejects settings that another one always overrides, and cells that would run twice.
    fn refuse_repetitions(&self) -> Result<(), Problem> {
        let mut seen = HashMap::new();
        for (k, row) in self.rows.iter().enumerate() {
            if let Some(other) = seen.insert(said(row), k) {
                let reason = format!("is the same as list[{other}]");
                return Err(problem(format!("list[{k}]"), reason));
            }
        }
        let seed = self.seeds[0].as_ref();
        let refuse = |choice: &Choice, other: String| {
            let reason = format!("is also given by {}; give it in one of them", shown(&other));
            Err(problem(&choice.place, reason))
        };
        let axes: Vec<&Choice> = self.grid.iter().filter_map(|axis| axis.first()).collect();
        for (k, choice) in axes.iter().enumerate() {
            let axis = format!("grid.{}", choice.key);
            let rows = self.rows.iter().flatten();
            let others = self.fixed.iter().chain(rows);
            if let Some(other) = others.into_iter().find(|other| other.is_as(choice)) {
                return refuse(other, axis);
            }
            if let Some(other) = axes[..k].iter().find(|other| other.is_as(choice)) {
                return Err(problem(
                    axis,
                    format!("is the same as grid.{}", shown(&other.key)),
                ));
            }
        }
        let all = self
            .fixed
            .iter()
            .chain(self.rows.iter().flatten())
            .chain(axes);
        for choice in all {
            let own = matches!(&choice.meaning, Meaning::Setting(own)
                if seed.is_some_and(|seed| seed.path() == own.path()));
            if own {
                return refuse(choice, "seeds".to_owned());
            }
        }
        Ok(())
    }

    /// The cell at `index`, counted from 0.
    fn cell(&self, index: usize, memory: &Memory) -> Result<Cell, RunError> {
        let mut rest = index;
        let mut digit = |size: usize| {
            let digit = rest % size;
            rest /= size;
            digit
        };
        let seed = self.seeds[digit(self.seeds.len())].clone();
        let grid: Vec<&Choice> = self
            .grid
            .iter()
            .rev()
            .map(|axis| &axis[digit(axis.len())])
            .collect();
        let row = digit(self.rows.len());
        let (row, label) = (&self.rows[row], &self.labels[row]);
        let varied: Vec<&Choice> = row.iter().chain(grid.into_iter().rev()).collect();
        let mut scenario = self.scenario.clone();
        let mut settings = Vec::new();
        for choice in self.fixed.iter().chain(varied.iter().copied()) {
            match &choice.meaning {
                Meaning::Scenario(source) => scenario = source.clone(),
                Meaning::Setting(setting) => settings.push(setting.clone()),
            }
        }
        settings.extend(self.measurements.iter().cloned());
        settings.extend(seed);
        let values = varied
            .iter()
            .map(|choice| (choice.key.clone(), choice.value.clone()));
        Ok(Cell {
            number: index + 1,
            values: label.iter().cloned().chain(values).collect(),
            case: Case::new(scenario, settings, memory)?,
        })
    }
}

/// One of the study's scenarios, if there is none at the top but every cell has one.
fn varied_scenario(rows: &[Vec<Choice>], grid: &[Vec<Choice>]) -> Result<Source, Problem> {
    let of = |choices: &[Choice]| {
        choices.iter().find_map(|choice| match &choice.meaning {
            Meaning::Scenario(source) => Some(source.clone()),
            Meaning::Setting(_) => None,
        })
    };
    let in_every_row: Option<Vec<Source>> = rows.iter().map(|row| of(row)).collect();
    let found = in_every_row.and_then(|sources| sources.into_iter().next());
    found
        .or_else(|| grid.iter().find_map(|axis| of(axis)))
        .ok_or_else(|| {
            let reason = "is missing: the name of a scenario (see `sandbox list`), or a file";
            problem(SCENARIO, reason)
        })
}

/// The settings that add these measurements to those of a scenario.
fn measurements(given: &[Value]) -> Result<Vec<Setting>, Problem> {
    let setting = |(k, value): (usize, &Value)| {
        let place = format!("measurements[{k}]");
        Setting::new("measurements.+", value.clone(), place.clone())
            .map_err(|error| problem(place, error.to_string()))
    };
    given.iter().enumerate().map(setting).collect()
}

fn seeds(given: Option<&Seeds>) -> Result<Vec<Option<Setting>>, Problem> {
    let Some(given) = given else {
        return Ok(vec![None]);
    };
    let setting = |(k, seed): (usize, u64)| {
        let text = format!("seeds[{k}]={seed}");
        let setting = Setting::new("seed", Value::from(seed), text);
        setting
            .map(Some)
            .map_err(|error| problem("seeds", error.to_string()))
    };
    given
        .all(MOST_CELLS)?
        .into_iter()
        .enumerate()
        .map(setting)
        .collect()
}

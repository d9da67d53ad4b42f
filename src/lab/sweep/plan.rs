//! Everything that the cells of a study are combined from.

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use super::cell::{Cell, LABEL, MOST_CELLS};
use super::choice::{Choice, Meaning, SCENARIO, axis, choices, said, source};
use super::entries::Entries;
use super::seeds::Seeds;
use super::written::Written;
use crate::gallery::distinct;
use runs::case::{Case, Source};
use runs::error::RunError;
use runs::memory::Memory;
use scenario::quote::shown;
use scenario::{Problem, ScenarioError, Setting};

/// The key of the grid that suites vary.
pub(crate) const PROFILE: &str = "profile";

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct File {
    pub(super) name: Option<String>,
    #[serde(rename = "description")]
    pub(super) _description: Option<String>,
    pub(super) scenario: Option<String>,
    pub(super) settings: Entries,
    pub(super) measurements: Vec<Value>,
    pub(super) list: Option<Vec<Entries>>,
    pub(super) grid: Entries,
    pub(super) seeds: Option<Seeds>,
    data: Vec<DataFile>,
    /// What suites expect of the runs.
    #[serde(rename = "reasons")]
    _reasons: IgnoredAny,
    #[serde(rename = "cases")]
    _cases: IgnoredAny,
    /// Settings that a command gives every cell.
    #[serde(skip)]
    given: Vec<Setting>,
}

/// A file that is not part of the program and that the scenarios of a run read: most often the trajectories from which
/// they begin.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DataFile {
    /// The label of the run.
    pub run: String,
    /// Its name in the folder with the data.
    pub file: String,
    /// Where it can be had.
    pub source: String,
    /// The setting that names it.
    #[serde(default = "trajectory")]
    pub setting: String,
}

fn trajectory() -> String {
    "from.trajectory".to_owned()
}

/// What a command changes in a study's file.
#[derive(Default)]
pub struct Changes<'a> {
    /// Profiles in place of those of the grid; none: those of the grid.
    pub profiles: &'a [String],
    /// The number of seeds in place of the file's.
    pub seeds: Option<u64>,
    /// The first seed in place of the file's.
    pub first_seed: Option<u64>,
    /// Settings of every cell, which override those of the file.
    pub settings: &'a [Setting],
    /// The paths of data files by the labels of their runs and their settings.
    pub data: BTreeMap<(String, String), PathBuf>,
}

/// Checks the names and types of a study's keys.
///
/// # Errors
/// The first problem, with its place in the file.
pub(crate) fn check_keys(of: &Written) -> Result<(), ScenarioError> {
    of.parsed::<File>(File::NEEDS).map(|_| ())
}

impl File {
    /// What a study needs, in words.
    pub(super) const NEEDS: &str = "a `scenario`";

    /// Applies the changes. Runs whose data are missing are left out.
    pub(super) fn change(&mut self, changes: &Changes) {
        self.seeds = changes.seeds.map(Seeds::Count).or(self.seeds.take());
        if let Some(first) = changes.first_seed {
            let seeds = self.seeds.as_ref().unwrap_or(&Seeds::Count(1));
            self.seeds = Some(seeds.from(first));
        }
        self.given = changes.settings.to_vec();
        if !changes.profiles.is_empty() {
            let grid = &mut self.grid.0;
            match grid.iter_mut().find(|(key, _)| key == PROFILE) {
                Some((_, profiles)) => *profiles = changes.profiles.into(),
                None => grid.push((PROFILE.to_owned(), changes.profiles.into())),
            }
        }
        let runs = &self.data;
        let list = self.list.iter_mut();
        list.for_each(|list| {
            list.retain_mut(|Entries(entries)| {
                let labeled = entries.iter().find(|(key, _)| key == LABEL);
                let label = labeled.and_then(|(_, label)| label.as_str());
                let own = runs.iter().filter(|data| Some(data.run.as_str()) == label);
                let found = own.map(|data| {
                    let path = changes
                        .data
                        .get(&(data.run.clone(), data.setting.clone()))?;
                    Some((data.setting.clone(), path.to_string_lossy().into()))
                });
                let paths: Option<Vec<(String, Value)>> = found.collect();
                let is_there = paths.is_some();
                entries.extend(paths.into_iter().flatten());
                is_there
            })
        });
    }
}

/// Everything that cells are combined from.
pub(super) struct Plan {
    /// The names of the varied settings, with the label first.
    pub(super) names: Vec<String>,
    /// The scenario of cells whose settings do not name one.
    scenario: Source,
    fixed: Vec<Choice>,
    /// Measurements in addition to those of the scenario, as settings; then settings that a command gives every cell.
    last: Vec<Setting>,
    /// The combinations of the list; a single empty one without a list.
    rows: Vec<Vec<Choice>>,
    /// The labels of these combinations.
    pub(super) labels: Vec<Option<(String, Value)>>,
    /// The values of each axis of the grid.
    pub(super) grid: Vec<Vec<Choice>>,
    /// The seeds as settings; a single `None` if the study gives no seeds.
    pub(super) seeds: Vec<Option<Setting>>,
    pub(super) count: usize,
}

impl Plan {
    pub(super) fn new(file: &File, root: &Written) -> Result<Self, Problem> {
        let fixed = choices(&file.settings, "settings", None)?;
        let single = [Entries::default()];
        let list = file.list.as_deref().unwrap_or(&single);
        if list.is_empty() {
            return Err(Problem::new("list", "must not be empty"));
        }
        if list.len() > MOST_CELLS {
            let reason = format!("has {} cells; at most {MOST_CELLS} are allowed", list.len());
            return Err(Problem::new("list", reason));
        }
        let (mut rows, mut labels) = (Vec::new(), Vec::new());
        for (k, entries) in list.iter().enumerate() {
            let place = format!("list[{k}]");
            let (label, entries) = entries.split_label(&place)?;
            rows.push(choices(&entries, &place, Some(root))?);
            labels.push(label.map(|label| (LABEL.to_owned(), label.into())));
        }
        let written = file.grid.0.iter();
        let checked = written.map(|(key, values)| axis(key, values, root));
        let grid = checked.collect::<Result<Vec<_>, _>>()?;
        let label = labels.iter().any(Option::is_some);
        let choices = rows.iter().flatten().chain(grid.iter().flatten());
        let varied = choices.map(|choice| choice.key.clone());
        let mut plan = Self {
            names: distinct(label.then(|| LABEL.to_owned()).into_iter().chain(varied)),
            scenario: match &file.scenario {
                Some(name) => source(name, SCENARIO, root)?,
                None => varied_scenario(&rows, &grid)?,
            },
            fixed,
            last: measurements(&file.measurements)?,
            rows,
            labels,
            grid,
            seeds: seeds(file.seeds.as_ref())?,
            count: 0,
        };
        plan.refuse_repetitions()?;
        plan.refuse_varied(&file.given)?;
        plan.last.extend(file.given.iter().cloned());
        plan.count = plan.cells()?;
        Ok(plan)
    }

    /// The number of cells.
    fn cells(&self) -> Result<usize, Problem> {
        let axes = self.grid.iter().map(Vec::len);
        let sizes = axes.chain([self.rows.len(), self.seeds.len()]);
        let count = sizes.map(|size| size as f64).product::<f64>();
        if count > MOST_CELLS as f64 {
            let reason = format!("makes {count} cells; at most {MOST_CELLS} are allowed");
            return Err(Problem::new("", reason));
        }
        Ok(count as usize)
    }

    /// Rejects settings that another one always overrides, and cells that would run twice.
    fn refuse_repetitions(&self) -> Result<(), Problem> {
        let mut seen = HashMap::new();
        for (k, row) in self.rows.iter().enumerate() {
            if let Some(other) = seen.insert(said(row), k) {
                let reason = format!("is the same as list[{other}]");
                return Err(Problem::new(format!("list[{k}]"), reason));
            }
        }
        let seed = self.seeds[0].as_ref();
        let refuse = |choice: &Choice, other: String| {
            let reason = format!("is also given by {}; give it in one of them", shown(&other));
            Err(Problem::new(&choice.place, reason))
        };
        let axes: Vec<&Choice> = self.grid.iter().filter_map(|axis| axis.first()).collect();
        for (k, choice) in axes.iter().enumerate() {
            let axis = format!("grid.{}", choice.key);
            let rows = self.rows.iter().flatten();
            let mut others = self.fixed.iter().chain(rows);
            let is_same = |other: &&Choice| other.path() == choice.path();
            if let Some(other) = others.find(is_same) {
                return refuse(other, axis);
            }
            if let Some(other) = axes[..k].iter().copied().find(is_same) {
                let reason = format!("is the same as grid.{}", shown(&other.key));
                return Err(Problem::new(axis, reason));
            }
        }
        let rows = self.rows.iter().flatten();
        let mut all = self.fixed.iter().chain(rows).chain(axes);
        match seed.and_then(|seed| all.find(|choice| choice.path() == Some(seed.path()))) {
            Some(choice) => refuse(choice, "seeds".to_owned()),
            None => Ok(()),
        }
    }

    /// Rejects settings of every cell that would override what the grid or the seeds vary.
    fn refuse_varied(&self, given: &[Setting]) -> Result<(), Problem> {
        let firsts = self.grid.iter().filter_map(|axis| axis.first());
        let axes = firsts.filter_map(|axis| Some((format!("grid.{}", axis.key), axis.path()?)));
        let first = self.seeds[0].as_ref();
        let seeds = first.map(|seed| ("seeds".to_owned(), seed.path()));
        for (place, path) in axes.chain(seeds) {
            let is_part =
                |of: &&Setting| of.path().starts_with(path) || path.starts_with(of.path());
            if let Some(setting) = given.iter().find(is_part) {
                let reason = format!("varies in {}, which has other values", shown(&place));
                return Err(Problem::new(setting.to_string(), reason));
            }
        }
        Ok(())
    }

    /// The cell at `index`, counted from 0.
    pub(super) fn cell(&self, index: usize, memory: &Memory) -> Result<Cell, RunError> {
        let mut rest = index;
        let mut digit = |size: usize| {
            let digit = rest % size;
            rest /= size;
            digit
        };
        let seed = self.seeds[digit(self.seeds.len())].clone();
        let axes = self.grid.iter().rev();
        let grid: Vec<&Choice> = axes.map(|axis| &axis[digit(axis.len())]).collect();
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
        settings.extend(self.last.iter().cloned());
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
    let common = in_every_row.and_then(|sources| sources.into_iter().next());
    let found = common.or_else(|| grid.iter().find_map(|axis| of(axis)));
    let reason = "is missing: the name of a scenario (see `sandbox list`), or a file";
    found.ok_or_else(|| Problem::new(SCENARIO, reason))
}

/// The settings that add these measurements to those of a scenario.
fn measurements(given: &[Value]) -> Result<Vec<Setting>, Problem> {
    let setting = |(k, value): (usize, &Value)| {
        let place = format!("measurements[{k}]");
        Setting::new("measurements.+", value.clone(), place.clone())
            .map_err(|error| Problem::new(place, error.to_string()))
    };
    given.iter().enumerate().map(setting).collect()
}

fn seeds(given: Option<&Seeds>) -> Result<Vec<Option<Setting>>, Problem> {
    let Some(given) = given else {
        return Ok(vec![None]);
    };
    let setting = |(k, seed): (usize, u64)| {
        let text = format!("seeds[{k}]={seed}");
        let setting = Setting::new("seed", Value::from(seed), text).map(Some);
        setting.map_err(|error| Problem::new("seeds", error.to_string()))
    };
    let seeds = given.all(MOST_CELLS)?.into_iter();
    seeds.enumerate().map(setting).collect()
}

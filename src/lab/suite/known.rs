//! Checks of a suite's file: what it expects, and whether its runs and quantities exist.

use std::collections::BTreeMap;

use super::file::Suite;
use super::keys::{Case, Check, Expected};
use super::quantity::{COUNTS, Other, Quantity};
use crate::sweep::{Cell, Study, StudyError, check_name};
use scenario::measurements::Measurement;
use scenario::quote::shown;
use scenario::{Problem, Scenario, suggestion};

/// The label of a run; empty without one.
pub fn label(cell: &Cell) -> &str {
    cell.label().unwrap_or_default()
}

/// Checks what can be checked without the study's runs.
pub fn check_cases(cases: &[Case], profiles: &[String]) -> Result<(), Problem> {
    if cases.is_empty() {
        return Err(Problem::new("cases", "must not be empty"));
    }
    each(cases, "cases", |case| {
        check_name(&case.name)?;
        if cases.iter().filter(|other| other.name == case.name).count() > 1 {
            return Err(Problem::new(
                "name",
                "must not be the name of several cases",
            ));
        }
        if case.checks.is_empty() {
            return Err(Problem::new("checks", "must not be empty"));
        }
        let mut missed = case.known_misses.keys().filter(|_| !profiles.is_empty());
        if let Some(profile) = missed.find(|profile| !profiles.contains(profile)) {
            let reason = unknown("the study's grid", "profile", profile, profiles);
            return Err(Problem::new("known_misses", reason));
        }
        each(&case.checks, "checks", Check::check_keys)
    })
}

/// Checks each item of the list `key`.
fn each<T>(
    items: &[T],
    key: &str,
    check: impl Fn(&T) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let mut items = items.iter().enumerate();
    items.try_for_each(|(k, item)| {
        check(item).map_err(|problem| problem.under(&format!("{key}[{k}]")))
    })
}

impl Check {
    fn check_keys(&self) -> Result<(), Problem> {
        let count = self.quantity.len() * self.of.len();
        let refused = self.function.and_then(|function| function.refuses(count));
        let (key, reason) = match (self.function, self.expected) {
            (_, _) if self.of.is_empty() => ("of", "must not be empty"),
            (_, _) if self.quantity.is_empty() => ("quantity", "must not be empty"),
            (None, _) if count > 1 => (
                "function",
                "missing: several values need a `mean`, `sum`, `difference`, `ratio` or `place`",
            ),
            (_, Expected::Between([low, high])) if low > high => (
                "expected.between",
                "must be two numbers, the smaller one first",
            ),
            (
                _,
                Expected::Near {
                    value: Some(0.0), ..
                },
            ) => (
                "expected.near.value",
                "must not be 0, for the tolerance is a part of it",
            ),
            (_, Expected::Near { tolerance, .. }) if tolerance <= 0.0 => (
                "expected.near.tolerance",
                "must be above 0, a part of the value such as 0.1",
            ),
            _ => match refused {
                Some(reason) => ("function", reason),
                None => return Ok(()),
            },
        };
        Err(Problem::new(key, reason))
    }
}

/// Checks that all runs and quantities exist. Runs whose data are missing are not in the study.
pub fn check_runs(suite: &Suite, study: &Study) -> Result<(), StudyError> {
    let invalid = |problem| suite.from.invalid(problem);
    let cells = study.cells.iter().rev().map(|cell| (label(cell), cell));
    let cells: BTreeMap<&str, &Cell> = cells.collect();
    let labels: Vec<&str> = cells
        .keys()
        .copied()
        .filter(|label| !label.is_empty())
        .collect();
    let has_data = |run: &String| suite.data.iter().any(|data| data.run == *run);
    let exists = |run: &String| match run.as_str() {
        label if cells.contains_key(label) || has_data(run) => Ok(()),
        "" => Err(format!("must be the label of a run: {}", labels.join(", "))),
        label => Err(unknown("the study's list", "label", label, &labels)),
    };
    each(&suite.cases, "cases", |case| {
        let mut drawn = case.picture.iter().map(|picture| &picture.run);
        let drawn = drawn.try_for_each(exists);
        drawn.map_err(|reason| Problem::new("picture.run", reason))?;
        each(&case.checks, "checks", |check| {
            let runs = check.of.iter().try_for_each(exists);
            runs.map_err(|reason| Problem::new("of", reason))?;
            let in_data = matches!(check.expected, Expected::Near { value: None, .. });
            if in_data && !check.of.iter().all(has_data) {
                let reason = "missing key `value`: the run has no `data` to measure it in";
                return Err(Problem::new("expected.near", reason));
            }
            Ok(())
        })
    })
    .map_err(invalid)?;
    for (run, cell) in cells {
        let scenario = cell.case.scenario()?;
        each(&suite.cases, "cases", |case| {
            let mut drawn = case.picture.iter().filter(|picture| picture.run == run);
            let end = scenario.duration_secs;
            if drawn.any(|picture| !(0.0..=end).contains(&picture.at_secs)) {
                let reason = format!("must be at least 0 and at most {end}, the end of the run");
                return Err(Problem::new("picture.at_secs", reason));
            }
            each(&case.checks, "checks", |check| {
                let own = check.of.iter().filter(|of| *of == run);
                let mut asked = own.flat_map(|_| &check.quantity);
                let unknown = asked.find_map(|quantity| quantity.unknown(run, &scenario));
                unknown.map_or(Ok(()), |reason| Err(Problem::new("quantity", reason)))
            })
        })
        .map_err(invalid)?;
    }
    Ok(())
}

impl Quantity {
    /// Why a run has no such quantity; `None` if it has.
    fn unknown(&self, run: &str, scenario: &Scenario) -> Option<String> {
        let missing = |what: &str, name: &String, all: Vec<String>| {
            let run = if run.is_empty() { "the run" } else { run };
            (!all.contains(name)).then(|| unknown(run, what, name, &all))
        };
        let measured = scenario.measurements.iter();
        let places = scenario.scene.journeys.places.iter();
        match self {
            Self::Named(name) => {
                let counts = COUNTS.map(str::to_owned);
                let all = measured.flat_map(Measurement::names).chain(counts);
                missing("quantity", name, all.collect())
            }
            Self::Other(Other::Passed(name)) => missing(
                "place",
                name,
                places.map(|place| place.name.clone()).collect(),
            ),
            Self::Other(Other::Flow(name)) => {
                let exits = places.filter(|place| place.is_exit());
                missing("exit", name, exits.map(|exit| exit.name.clone()).collect())
            }
            Self::Other(Other::Walks(of)) => {
                let walks = measured.filter(|one| matches!(one, Measurement::Walks(_)));
                let walks = walks.filter_map(|one| {
                    one.names()
                        .first()?
                        .strip_suffix("_agents")
                        .map(str::to_owned)
                });
                let groups = scenario.scene.groups.iter().map(|group| group.name.clone());
                let group = of.group.as_ref();
                missing("measurement of walks", &of.name, walks.collect())
                    .or_else(|| missing("group", group?, groups.collect()))
            }
        }
    }
}

/// Says that something has no `what` of this name, and which ones it has.
fn unknown<T: AsRef<str>>(of: &str, what: &str, name: &str, all: &[T]) -> String {
    let near = suggestion(name, all.iter().map(AsRef::as_ref));
    let all: Vec<String> = all.iter().map(|name| shown(name.as_ref())).collect();
    let all = if all.is_empty() {
        "none".to_owned()
    } else {
        all.join(", ")
    };
    format!(
        "{} has no {what} `{}`{near} (it has {all})",
        shown(of),
        shown(name)
    )
}

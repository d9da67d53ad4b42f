//! Checks of a suite's runs: whether the runs and quantities that it asks for exist.

use std::collections::BTreeMap;

use super::file::Suite;
use super::keys::Expected;
use super::known::{each, label, unknown};
use super::quantity::{COUNTS, Other, Quantity};
use crate::sweep::{Cell, Study, StudyError};
use scenario::measurements::Measurement;
use scenario::{Problem, Scenario};

/// Checks that all runs and quantities exist. Runs whose data are missing are not in the study.
pub fn check_runs(suite: &Suite, study: &Study) -> Result<(), StudyError> {
    let invalid = |problem| suite.from.invalid(problem);
    let labeled = study.cells.iter().rev().map(|cell| (label(cell), cell));
    let cells: BTreeMap<&str, &Cell> = labeled.collect();
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
        let mut runs = case.picture.iter().map(|picture| &picture.run);
        let drawn = runs.try_for_each(exists);
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
                let found = measured.filter(|one| matches!(one, Measurement::Walks(_)));
                let walks = found.filter_map(|one| {
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

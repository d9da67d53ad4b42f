//! What is known of the error of the model: the scenes of the built-in validation that have the same measurements.

use std::mem::{Discriminant, discriminant};

use serde::Serialize;

use super::question::Question;
use crate::error::LabError;
use crate::gallery::distinct;
use crate::suite::{Case, Suite};
use crate::sweep::{Cell, Changes};
use scenario::measurements::Measurement;
use scenario::{ScenarioError, catalog};

/// Results of an estimate, and the scenes of the validation with the same kind of measurement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Validated {
    /// The results.
    pub results: Vec<String>,
    /// The scenes; empty if none has this measurement.
    pub scenes: Vec<String>,
    /// The number of measured values that these scenes compare.
    pub values: usize,
    /// The profile.
    pub profile: String,
    /// Whether the validation says which scenes this profile misses.
    pub is_judged: bool,
    /// The scenes that it is known to miss, each with the reason.
    pub misses: Vec<(String, String)>,
}

/// The kind of a measurement.
type Kind = Discriminant<Measurement>;

/// The kind of the measurement that has a value of this name; `None` for results of every run.
fn kind_of(measured: &[Measurement], name: &str) -> Option<Kind> {
    let has_value = |one: &&Measurement| one.names().iter().any(|own| own == name);
    measured.iter().find(has_value).map(discriminant)
}

/// The kinds of the measured values that a case compares with runs, one for each.
fn kinds_of(case: &Case, runs: &[(&Cell, Vec<Measurement>)]) -> Vec<Kind> {
    let checks = case
        .checks
        .iter()
        .filter(|check| check.expected.is_measured());
    let kinds = checks.filter_map(|check| {
        let name = check.metric()?;
        let of = |cell: &Cell| {
            check
                .of
                .iter()
                .any(|of| of == cell.label().unwrap_or_default())
        };
        let mut own = runs.iter().filter(|(cell, _)| of(cell));
        own.find_map(|(_, measured)| kind_of(measured, name))
    });
    kinds.collect()
}

impl Validated {
    /// The results of a question, by the kind of their measurements; all results without scenes together at the end.
    /// Nothing is simulated.
    ///
    /// # Errors
    /// The validation of the program is invalid.
    pub fn of(question: &Question) -> Result<Vec<Self>, LabError> {
        let profile = &question.title[1];
        let suite = Suite::built_in("validation").map_err(invalid)?;
        let profiles = match catalog::names().contains(&profile.as_str()) {
            true => std::slice::from_ref(profile),
            false => suite.profiles.get(..1).unwrap_or_default(), // the scenes of another profile
        };
        let study = suite.study(&Changes {
            profiles,
            seeds: Some(1),
            ..Changes::default()
        })?;
        let cells = study.cells.iter();
        let measured = cells.map(|cell| Ok((cell, cell.case.scenario()?.measurements)));
        let read: Result<Vec<(&Cell, Vec<Measurement>)>, _> = measured.collect();
        let runs = read.map_err(invalid)?;
        let with_kinds = suite
            .without_data()
            .map(|case| (case, kinds_of(case, &runs)));
        let cases: Vec<(&Case, Vec<Kind>)> = with_kinds.collect();
        let request = &question.request;
        let wanted = request.wanted.iter().map(|wanted| &wanted.name);
        let names = distinct(wanted.chain(request.bounds.iter().map(|bound| &bound.name)));
        let kind = |name: &&String| kind_of(&question.measurements, name);
        // Results whose kind is measured in no scene are of one group.
        let has = |kind: &Kind| cases.iter().any(|(_, kinds)| kinds.contains(kind));
        let group = |name: &&String| kind(name).filter(has);
        let groups = distinct(names.iter().map(group));
        let (known, unknown): (Vec<_>, Vec<_>) = groups.into_iter().partition(Option::is_some);
        let validated = known.into_iter().chain(unknown).map(|of| {
            let count = |kinds: &[Kind]| kinds.iter().filter(|kind| Some(**kind) == of).count();
            let own = cases.iter().filter(|(_, kinds)| count(kinds) > 0);
            let misses = own.clone().filter_map(|(case, _)| {
                let why = case.known_misses.get(profile)?;
                Some((case.name.clone(), why.clone()))
            });
            Self {
                results: names
                    .iter()
                    .filter(|name| group(name) == of)
                    .map(|name| (*name).clone())
                    .collect(),
                scenes: own.clone().map(|(case, _)| case.name.clone()).collect(),
                values: own.clone().map(|(_, kinds)| count(kinds)).sum(),
                profile: profile.clone(),
                is_judged: suite.profiles.contains(profile),
                misses: misses.collect(),
            }
        });
        Ok(validated.collect())
    }

    /// In words.
    pub fn text(&self) -> String {
        let results = self.results.join(", ");
        if self.scenes.is_empty() {
            return format!(
                "Error of the model: no scene of `sandbox validate` measures {results}.\n"
            );
        }
        let misses: Vec<&str> = self.misses.iter().map(|(name, _)| name.as_str()).collect();
        let known = match (self.is_judged, misses.as_slice()) {
            (false, _) => "The profile is not one of those with known misses.".to_owned(),
            (true, []) => "The profile has no known misses there.".to_owned(),
            (true, names) => format!("Known misses of the profile: {}.", names.join(", ")),
        };
        format!(
            "Error of the model: `sandbox validate {} --profile '{}' --out DIR` compares the measurement of {results} \
             with {} values from experiments. {known}\n",
            self.scenes.join(" "),
            self.profile,
            self.values
        )
    }
}

fn invalid(error: ScenarioError) -> LabError {
    LabError::Data(error.to_string())
}

//! What is known of the error of the model: the scenes of the built-in validation that have the same measurements.

use serde::Serialize;

use super::question::{Kind, Question, kind_of};
use crate::error::LabError;
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

impl Validated {
    /// The results of a question, by the kind of their measurements. Nothing is simulated.
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
        let changes = Changes {
            profiles,
            seeds: Some(1),
            ..Changes::default()
        };
        let study = suite.study(&changes)?;
        let cells = study.cells.iter();
        let cells = cells.map(|cell| Ok((cell, cell.case.scenario()?.measurements)));
        let cells: Vec<(&Cell, Vec<Measurement>)> = cells
            .collect::<Result<_, ScenarioError>>()
            .map_err(invalid)?;
        let values_of = |case: &Case, kind: Kind| {
            let checks = case
                .checks
                .iter()
                .filter(|check| check.expected.is_measured());
            let has_kind = checks.filter(|check| {
                let mut own = cells.iter().filter(|(cell, _)| {
                    let label = cell.label().unwrap_or_default();
                    check.of.iter().any(|of| of == label)
                });
                own.any(|(_, measured)| {
                    check.metric().and_then(|name| kind_of(measured, name)) == Some(kind)
                })
            });
            has_kind.count()
        };
        let mut found: Vec<(Option<Kind>, Self)> = Vec::new();
        for (name, kind) in &question.kinds {
            if let Some((_, same)) = found.iter_mut().find(|(other, _)| other == kind) {
                same.results.push(name.clone());
                continue;
            }
            let cases = suite.without_data();
            let cases = cases.map(|case| (case, kind.map_or(0, |kind| values_of(case, kind))));
            let cases: Vec<(&Case, usize)> = cases.filter(|(_, values)| *values > 0).collect();
            let misses = cases.iter().filter_map(|(case, _)| {
                let why = case.known_misses.get(profile)?;
                Some((case.name.clone(), why.clone()))
            });
            let validated = Self {
                results: vec![name.clone()],
                scenes: cases.iter().map(|(case, _)| case.name.clone()).collect(),
                values: cases.iter().map(|(_, values)| values).sum(),
                profile: profile.clone(),
                is_judged: suite.profiles.contains(profile),
                misses: misses.collect(),
            };
            found.push((*kind, validated));
        }
        let (known, unknown): (Vec<Self>, Vec<Self>) = found
            .into_iter()
            .map(|(_, validated)| validated)
            .partition(|validated| !validated.scenes.is_empty());
        // All results without scenes together.
        let unknown = unknown.into_iter().reduce(|mut all, one| {
            all.results.extend(one.results);
            all
        });
        Ok(known.into_iter().chain(unknown).collect())
    }

    /// In words.
    pub fn text(&self) -> String {
        let results = self.results.join(", ");
        if self.scenes.is_empty() {
            return format!(
                "Error of the model: no scene of `sandbox validate` measures {results}.\n"
            );
        }
        let scenes = self.scenes.join(" ");
        let mut text = format!(
            "Error of the model: `sandbox validate {scenes} --profile '{}' --out DIR` compares the measurement of \
             {results} with {} values from experiments.",
            self.profile, self.values
        );
        let names: Vec<&str> = self.misses.iter().map(|(name, _)| name.as_str()).collect();
        text += &match (self.is_judged, names.as_slice()) {
            (false, _) => " The profile is not one of those with known misses.".to_owned(),
            (true, []) => " The profile has no known misses there.".to_owned(),
            (true, names) => format!(" Known misses of the profile: {}.", names.join(", ")),
        };
        text + "\n"
    }
}

fn invalid(error: ScenarioError) -> LabError {
    LabError::Data(error.to_string())
}

//! A calibration's file → checked parameters, scenes and measured values.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::file::{File, Rule, SceneKeys, Screening, Search};
use super::parameter::Parameter;
use super::reader::{Reader, Validation};
use super::scene::{Scene, Set, Target};
use crate::sweep::{Seeds, Written, check_name};
use analysis::cma_es::{CmaEs, LEAST_POPULATION};
use runs::memory::Memory;
use scenario::quote::shown;
use scenario::{Problem, ScenarioError, Setting};

/// Most parameters.
const MOST_PARAMETERS: usize = 50;
/// Most seeds.
const MOST_SEEDS: usize = 1000;
/// Most points of a generation, and most trajectories.
const MOST_POINTS: usize = 1000;
/// Most generations.
pub const MOST_GENERATIONS: usize = 10_000;
/// Largest residual of a file.
const LARGEST_RESIDUAL: f64 = 1e6;

/// A checked calibration.
pub struct Calibration {
    /// Its name, suitable as a file name.
    pub name: String,
    /// The contents of the file.
    pub document: Value,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// The scenes of all values.
    pub scenes: Vec<Scene>,
    /// The measured values: those of the fit first, then hold-out and transfer.
    pub targets: Vec<Target>,
    /// The seeds of the search.
    pub seeds: Vec<u64>,
    /// The seeds of the errors that are reported.
    pub final_seeds: Vec<u64>,
    /// The residuals of runs.
    pub rule: Rule,
    /// The screening, if there is one.
    pub screening: Option<Screening>,
    /// The search.
    pub search: Search,
    /// Memory that the runs share, bytes; `None` without a limit.
    pub memory: Option<u64>,
}

impl Calibration {
    /// Reads a calibration from a file, or the built-in one of this name if there is no such file: a file under
    /// `scenarios/calibration/`, without its extension.
    ///
    /// # Errors
    /// The first problem, with its place in the file.
    pub fn open(path: &Path, memory: Option<u64>) -> Result<Self, ScenarioError> {
        Self::of(&Written::open(path, "calibration")?, memory)
    }

    /// Reads a calibration from JSON. `path` is its name in messages; files that it refers to are relative to the
    /// folder of `path`.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn parse(text: &str, path: &Path) -> Result<Self, ScenarioError> {
        Self::of(&Written::of(text, path), None)
    }

    fn of(from: &Written, memory: Option<u64>) -> Result<Self, ScenarioError> {
        let (document, keys) = from.parsed("`parameters` and `fit`")?;
        let checked = Self::checked(keys, document, from, memory);
        checked.map_err(|problem| from.invalid(problem))
    }

    fn checked(
        keys: File,
        document: Value,
        from: &Written,
        memory: Option<u64>,
    ) -> Result<Self, Problem> {
        let name = keys.name.clone().unwrap_or_else(|| from.stem());
        check_name(&name)?;
        check_numbers(&keys)?;
        let seeds = |given: Option<&Seeds>, other: &[u64]| match given {
            Some(seeds) => seeds.all(MOST_SEEDS),
            None => Ok(other.to_vec()),
        };
        let own = seeds(keys.seeds.as_ref(), &[1])?;
        let final_seeds = seeds(keys.final_seeds.as_ref(), &own).map_err(|problem| Problem {
            path: format!("final_{}", problem.path),
            ..problem
        })?;
        let shared = Memory::new(memory);
        let validation = Validation::new();
        let mut reader = Reader {
            from,
            settings: &keys.settings,
            validation: &validation,
            memory: &shared,
            scenes: Vec::new(),
            targets: Vec::new(),
        };
        let sets: [&[SceneKeys]; 3] = [&keys.fit, &keys.hold_out, &keys.transfer];
        for ((set, scenes), key) in Set::ALL
            .into_iter()
            .zip(sets)
            .zip(["fit", "hold_out", "transfer"])
        {
            for (k, scene) in scenes.iter().enumerate() {
                reader.add(set, scene, &format!("{key}[{k}]"))?;
            }
        }
        if reader.targets.iter().all(|target| target.set != Set::Fit) {
            return Err(Problem::new("fit", "must not be empty"));
        }
        let (scenes, targets) = (reader.scenes, reader.targets);
        let calibration = Self {
            name,
            document,
            parameters: parameters(keys.parameters)?,
            scenes,
            targets,
            seeds: own,
            final_seeds,
            rule: keys.residual,
            screening: keys.screening,
            search: keys.search,
            memory,
        };
        calibration.check_parameters(&shared)?;
        Ok(calibration)
    }

    /// Checks that every parameter is a key of a scene of the fit, and valid at its start and at both bounds.
    fn check_parameters(&self, memory: &Memory) -> Result<(), Problem> {
        let starts: Vec<f64> = self.parameters.iter().map(|of| of.start).collect();
        let refused = |k: usize, scene: &Scene, error: String| {
            let reason = format!("{}: {error}", shown(&scene.name));
            Problem::new(format!("parameters[{k}]"), reason)
        };
        let fitted = self.fitted_scenes();
        for (k, parameter) in self.parameters.iter().enumerate() {
            let mut is_used = false;
            for (number, scene) in self.scenes.iter().enumerate() {
                let made = parameter.settings(parameter.start, &scene.document);
                let settings = made.map_err(|error| refused(k, scene, error.to_string()))?;
                is_used |= !settings.is_empty() && fitted.contains(&number);
                let alone = scene.case.with(settings, memory);
                alone.map_err(|error| refused(k, scene, error.to_string()))?;
            }
            if !is_used {
                let reason = "no scene of the fit has one of its keys";
                return Err(Problem::new(format!("parameters[{k}]"), reason));
            }
        }
        for (k, parameter) in self.parameters.iter().enumerate() {
            for value in [parameter.start, parameter.bounds[0], parameter.bounds[1]] {
                let mut values = starts.clone();
                values[k] = value;
                for scene in &self.scenes {
                    let case = self.settings(scene, &values).and_then(|settings| {
                        let case = scene.case.with(settings, memory);
                        case.map_err(|error| error.to_string())
                    });
                    case.map_err(|error| refused(k, scene, error))?;
                }
            }
        }
        Ok(())
    }

    /// The settings that set all parameters of a scene to these values.
    pub(super) fn settings(&self, scene: &Scene, values: &[f64]) -> Result<Vec<Setting>, String> {
        let parameters = self.parameters.iter().zip(values);
        let by_parameter =
            parameters.map(|(parameter, &value)| parameter.settings(value, &scene.document));
        let collected: Result<Vec<_>, _> = by_parameter.collect();
        let settings = collected.map_err(|error| error.to_string())?;
        Ok(settings.into_iter().flatten().collect())
    }

    /// The numbers of the scenes whose values are fitted.
    pub fn fitted_scenes(&self) -> BTreeSet<usize> {
        let fitted = self.targets.iter().filter(|target| target.set == Set::Fit);
        fitted.map(|target| target.scene).collect()
    }

    /// The values at coordinates between 0 and 1.
    pub fn values(&self, coordinates: &[f64]) -> Vec<f64> {
        let both = self.parameters.iter().zip(coordinates);
        both.map(|(parameter, &coordinate)| parameter.value(coordinate))
            .collect()
    }

    /// The coordinates of the starting point.
    pub fn start(&self) -> Vec<f64> {
        let parameters = self.parameters.iter();
        parameters.map(|one| one.coordinate(one.start)).collect()
    }

    /// The numbers of the parameters that are not frozen.
    pub fn free(&self) -> Vec<usize> {
        let all = 0..self.parameters.len();
        all.filter(|&k| !self.parameters[k].frozen).collect()
    }

    /// The points per generation of a search over some of the parameters.
    pub fn population(&self, parameters: usize) -> usize {
        let usual = || CmaEs::usual_population(parameters);
        self.search.population.unwrap_or_else(usual)
    }

    /// The other files that it is read from.
    pub fn inputs(&self) -> BTreeSet<PathBuf> {
        let scenes = self.scenes.iter();
        scenes
            .flat_map(|scene| scene.case.files())
            .map(Path::to_owned)
            .collect()
    }
}

/// The parameters, after a check that no two have a name or key in common.
fn parameters(all: Vec<super::file::ParameterKeys>) -> Result<Vec<Parameter>, Problem> {
    if all.is_empty() || all.len() > MOST_PARAMETERS {
        let reason = format!(
            "must have 1 to {MOST_PARAMETERS} parameters, not {}",
            all.len()
        );
        return Err(Problem::new("parameters", reason));
    }
    let mut parameters: Vec<Parameter> = Vec::new();
    for (k, keys) in all.into_iter().enumerate() {
        let place = format!("parameters[{k}]");
        let parameter = Parameter::new(keys, &place)?;
        for (j, other) in parameters.iter().enumerate() {
            let same_key = parameter.keys.iter().find(|key| other.keys.contains(key));
            let same = same_key.or((other.name == parameter.name).then_some(&parameter.name));
            if let Some(same) = same {
                let reason = format!("{} is also given by parameters[{j}]", shown(same));
                return Err(Problem::new(place, reason));
            }
        }
        parameters.push(parameter);
    }
    if parameters.iter().all(|parameter| parameter.frozen) {
        return Err(Problem::new("parameters", "must not all be frozen"));
    }
    Ok(parameters)
}

/// Checks that the numbers of the residual, the screening and the search are within their ranges.
fn check_numbers(keys: &File) -> Result<(), Problem> {
    let (rule, search) = (&keys.residual, &keys.search);
    let screening = keys.screening.unwrap_or_default();
    let population = search.population.unwrap_or(LEAST_POPULATION) as f64;
    let populations = [LEAST_POPULATION as f64, MOST_POINTS as f64];
    let trajectories = screening.trajectories as f64;
    let generations = [1.0, MOST_GENERATIONS as f64];
    for (place, value, [least, most]) in [
        ("residual.clip", rule.clip, [1.0, LARGEST_RESIDUAL]),
        (
            "residual.penalty",
            rule.penalty,
            [rule.clip, LARGEST_RESIDUAL],
        ),
        ("residual.stuck_secs", rule.stuck_secs, [0.0, 1e9]),
        (
            "screening.trajectories",
            trajectories,
            [1.0, MOST_POINTS as f64],
        ),
        (
            "screening.drop_below",
            screening.drop_below,
            [0.0, LARGEST_RESIDUAL],
        ),
        ("search.population", population, populations),
        ("search.generations", search.generations as f64, generations),
        ("search.spread", search.spread, [1e-3, 1.0]),
    ] {
        if !(least..=most).contains(&value) {
            let reason = format!("must be at least {least} and at most {most}, not {value}");
            return Err(Problem::new(place, reason));
        }
    }
    Ok(())
}

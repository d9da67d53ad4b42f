//! A scenario whose results are estimated, and the time steps on offer.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::wanted::Request;
use crate::error::LabError;
use crate::gallery::distinct;
use crate::model::Quantity;
use analysis::round;
use engine::clock::SHORTEST_TIME_STEP;
use engine::stability;
use runs::case::{Case, Source};
use runs::drive::Run;
use runs::error::RunError;
use runs::memory::Memory;
use runs::summary::Summary;
use scenario::measurements::Measurement;
use scenario::quote::shown;
use scenario::{Preset, Scenario, Setting, suggestion};

/// How often the first step may be halved.
const HALVINGS: u32 = 6;
/// Results of every run beside its measurements and its first values.
const OF_RUNS: [&str; 2] = ["evacuated", "time_secs"];
/// The results of every run that are times.
const TIMES: [&str; 4] = ["time_secs", "t50_secs", "t95_secs", "t100_secs"];

/// Why a question cannot be asked.
#[derive(Debug, thiserror::Error)]
pub enum QuestionError {
    /// The scenario is invalid or does not fit into memory.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The scenario does not measure a wanted result: the option, its name, those of all results, and a suggestion.
    #[error("{0} {1}: the scenario has no such result; it has {2}{3}")]
    Unknown(&'static str, String, String, String),
    /// A result is wanted twice.
    #[error("{0} {1}: given twice; give it once for each result")]
    Twice(&'static str, String),
    /// There is only one time step.
    #[error(
        "the time step of {0} s can be neither halved nor doubled, so its error cannot be found; give a longer \
         --time-step"
    )]
    OneStep(f64),
    /// This row of a study cannot be asked.
    #[error("{0}: {1}")]
    Row(String, Box<QuestionError>),
}

/// A time step on offer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// The time step, seconds.
    pub step: f64,
    /// The number of frames per coarse frame: the time between coarse frames is that of the scenario.
    pub coarse_every: u32,
}

/// A scenario whose results are estimated.
pub struct Question {
    /// What is asked for.
    pub request: Request,
    /// The names of all results of the scenario.
    pub names: Vec<String>,
    /// The name of the scenario, and its profile.
    pub title: [String; 2],
    /// The settings of all runs beside profile, step and seed, as typed.
    pub settings: Vec<String>,
    /// The first seed; the runs at each step have this seed and those after it.
    pub first_seed: u64,
    /// Notes on the scenario.
    pub notes: Vec<String>,
    /// The steps on offer, from the finest to the coarsest.
    pub rungs: Vec<Rung>,
    /// The number of the step to begin with.
    pub start: usize,
    /// Whether runs of the same population differ: RVO draws candidates.
    pub is_behavior_random: bool,
    /// The measurements of the scenario.
    pub(super) measurements: Vec<Measurement>,
    case: Case,
    memory: Option<u64>,
}

impl Question {
    /// A question about a scenario with settings. Where neither these nor the scenario name a preset, runs have
    /// [`Preset::Fast`]: its choices save time and leave statistics unchanged.
    ///
    /// # Errors
    /// The scenario is invalid, or has no result with a wanted name.
    pub fn new(
        source: Source,
        settings: Vec<Setting>,
        request: Request,
        memory: Option<u64>,
    ) -> Result<Self, QuestionError> {
        let is_typed = |setting: &&Setting| setting.path() != ["profile"];
        let brief = settings.iter().filter(is_typed).map(Setting::brief);
        let typed: Vec<String> = brief.collect();
        let case = Case::new(source, settings, &Memory::new(memory))?;
        Self::of(&case, typed, request, memory)
    }

    /// A question about a run with other seeds and steps; `typed` are its settings for the reader.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(
        case: &Case,
        typed: Vec<String>,
        request: Request,
        memory: Option<u64>,
    ) -> Result<Self, QuestionError> {
        let given = case.scenario().map_err(RunError::from)?;
        let preset = match given.document.get("preset") {
            Some(_) => Vec::new(),
            None => vec![Setting::of("preset", json!(Preset::Fast), "preset=fast")],
        };
        let case = case.with(preset, &Memory::new(memory))?;
        let scenario = case.scenario().map_err(RunError::from)?;
        let (rungs, start) = rungs(&scenario);
        if let [only] = rungs.as_slice() {
            return Err(QuestionError::OneStep(only.step));
        }
        let coarsest = (start + 1 == rungs.len()).then(|| {
            format!(
                "longer time steps than {} s are not known to be stable here: the first runs have this step and its \
                 half",
                round::brief(rungs[start].step)
            )
        });
        let question = Self {
            title: [&scenario.name, &scenario.profile_name].map(String::clone),
            settings: typed,
            first_seed: scenario.seed,
            notes: scenario.notes.iter().cloned().chain(coarsest).collect(),
            rungs,
            start,
            is_behavior_random: scenario.scene.needs().rvo,
            measurements: scenario.measurements.clone(),
            names: names(scenario)?,
            request,
            case,
            memory,
        };
        let Request { wanted, bounds, .. } = &question.request;
        question.check("--error", wanted.iter().map(|wanted| &wanted.name))?;
        question.check("--bound", bounds.iter().map(|bound| &bound.name))?;
        Ok(question)
    }

    /// Whether the scenario has these results, and each is given once.
    fn check<'n>(
        &self,
        option: &'static str,
        given: impl Iterator<Item = &'n String>,
    ) -> Result<(), QuestionError> {
        let mut seen = Vec::new();
        for name in given {
            if !self.names.contains(name) {
                let known = self.names.join(", ");
                let similar = suggestion(name, self.names.iter().map(String::as_str));
                return Err(QuestionError::Unknown(option, shown(name), known, similar));
            }
            if seen.contains(&name) {
                return Err(QuestionError::Twice(option, shown(name)));
            }
            seen.push(name);
        }
        Ok(())
    }

    /// What a result is about, by its unit; `None` if nothing is known of such results, as of deviations and of checks
    /// of the program.
    pub fn quantity(&self, result: &str) -> Option<Quantity> {
        if TIMES.contains(&result) {
            return Some(Quantity::Time);
        }
        let is_check = |of: &Measurement| matches!(of, Measurement::Integrity(_));
        let measured = self.measurements.iter().filter(|of| !is_check(of));
        let mut quantities = measured.flat_map(Measurement::quantities);
        let quantity = quantities.find(|quantity| quantity.name == result)?;
        let is_mean = !quantity.meaning.contains("standard deviation");
        Quantity::of_unit(quantity.unit).filter(|_| is_mean)
    }

    /// The run with the `k`-th seed at a step.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn case(&self, rung: Rung, k: usize) -> Result<Case, RunError> {
        self.at(rung, &[("seed", k)])
    }

    /// The run with the `k`-th seed and these parameters, at the step to begin with.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub(super) fn with_parameters(
        &self,
        parameters: &BTreeMap<String, f64>,
        k: usize,
    ) -> Result<Case, RunError> {
        let rung = self.rungs[self.start];
        let scenario = self.case.scenario().map_err(RunError::from)?;
        let own = scenario.document.get("parameters").cloned();
        let mut all: Map<String, Value> = own
            .and_then(|own| own.as_object().cloned())
            .unwrap_or_default();
        let given = parameters.iter();
        all.extend(given.map(|(name, &value)| (name.clone(), json!(value))));
        let step = [
            ("time_step_secs", json!(rung.step)),
            ("coarse_every", json!(rung.coarse_every)),
            ("seed", json!(self.seed(k))),
            ("parameters", Value::Object(all)),
        ];
        self.with(step)
    }

    /// The scenario.
    ///
    /// # Errors
    /// A file of it has changed and is invalid now.
    pub(super) fn scenario(&self) -> Result<Scenario, LabError> {
        let scenario = self.case.scenario().map_err(RunError::from);
        scenario.map_err(|error| LabError::of(self.title[0].clone(), error))
    }

    /// A run of a population, both counted from 0.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn of_population(
        &self,
        rung: Rung,
        population: usize,
        repetition: usize,
    ) -> Result<Case, RunError> {
        let keys = ["seed", "population_seed", "behavior_seed"];
        let numbers = [population, population, repetition];
        let seeds: Vec<(&str, usize)> = keys.into_iter().zip(numbers).collect();
        self.at(rung, &seeds)
    }

    /// A run at a step, with these seeds by their numbers.
    fn at(&self, rung: Rung, seeds: &[(&str, usize)]) -> Result<Case, RunError> {
        let step = [
            ("time_step_secs", json!(rung.step)),
            ("coarse_every", json!(rung.coarse_every)),
        ];
        let seeds = seeds.iter().map(|&(key, k)| (key, json!(self.seed(k))));
        self.with(step.into_iter().chain(seeds))
    }

    /// The `k`-th seed.
    pub fn seed(&self, k: usize) -> u64 {
        self.first_seed.wrapping_add(k as u64)
    }

    /// A run with further settings.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn with<'s>(
        &self,
        settings: impl IntoIterator<Item = (&'s str, Value)>,
    ) -> Result<Case, RunError> {
        let set = |(key, value)| {
            let text = format!("{key}={value}");
            Setting::of(key, value, &text)
        };
        let settings = settings.into_iter().map(set).collect();
        self.case.with(settings, &Memory::new(self.memory))
    }

    /// A name for files with the answer: scenario, profile and settings, with - for all that is not fit for a file's
    /// name.
    pub fn file_name(&self) -> String {
        /// Names are cut here.
        const LONGEST: usize = 100;
        let parts = self.title.iter().chain(&self.settings);
        let text = parts.map(String::as_str).collect::<Vec<_>>().join("-");
        let fit = |c: char| c.is_alphanumeric() || "_=.+".contains(c);
        let words = text.split(|c| !fit(c)).filter(|word| !word.is_empty());
        let joined = words.collect::<Vec<_>>().join("-");
        let visible = joined.trim_start_matches(['.', '-']);
        match visible.is_empty() {
            true => "estimate".to_owned(),
            false => visible.chars().take(LONGEST).collect(),
        }
    }

    /// The files that the scenario is read from.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.case.files()
    }

    /// The memory that runs share, bytes.
    pub fn memory(&self) -> Option<u64> {
        self.memory
    }
}

/// The names of all results of a scenario.
fn names(scenario: Scenario) -> Result<Vec<String>, RunError> {
    let first = Summary::first_names(&scenario.scene);
    let measured = Summary::of(&Run::new(scenario)?).metrics.into_keys();
    let of_runs = OF_RUNS.map(str::to_owned).into_iter().chain(first);
    Ok(distinct(measured.chain(of_runs)))
}

/// The steps on offer, from the finest to the coarsest, and the place of the scenario's own step among them: half of
/// it, a quarter of it, and so on, and about twice the step if that is stable. All divide the time between coarse
/// frames.
fn rungs(scenario: &Scenario) -> (Vec<Rung>, usize) {
    let clock = scenario.scene.clock;
    let (own, coarse) = (clock.coarse_every(), clock.coarse_step());
    let rung = |coarse_every: u32| Rung {
        step: coarse / f64::from(coarse_every),
        coarse_every,
    };
    let finer = (1..=HALVINGS).rev().map(|k| rung(own << k));
    let mut rungs: Vec<Rung> = finer.filter(|r| r.step >= SHORTEST_TIME_STEP).collect();
    let start = rungs.len();
    rungs.push(Rung {
        step: clock.time_step(),
        coarse_every: own,
    });
    let twice = rung(own.div_ceil(2));
    let stable = stability::time_step(&scenario.scene);
    if own > 1 && stable.is_some_and(|longest| twice.step <= longest) {
        rungs.push(twice);
    }
    (rungs, start)
}

//! A scenario whose results are estimated, and the time steps on offer.

use std::mem::{Discriminant, discriminant};

use serde_json::{Value, json};

use super::wanted::Request;
use crate::gallery::distinct;
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

/// The kind of a measurement.
pub(super) type Kind = Discriminant<Measurement>;

/// How often the first step may be halved.
const HALVINGS: u32 = 6;
/// Results of every run beside its measurements.
pub const OF_RUNS: [&str; 2] = ["evacuated", "time_secs"];

/// Why a question cannot be asked.
#[derive(Debug, thiserror::Error)]
pub enum QuestionError {
    /// The scenario is invalid or does not fit into memory.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The scenario does not measure a wanted result.
    #[error("{option} {name}: the scenario has no such result; it has {known}{suggestion}")]
    Unknown {
        /// `--error` or `--bound`.
        option: &'static str,
        /// The name.
        name: String,
        /// The names of all results.
        known: String,
        /// "; did you mean …?", or empty.
        suggestion: String,
    },
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
    /// The results asked for, with the kinds of their measurements; `None` for results of every run.
    pub(super) kinds: Vec<(String, Option<Kind>)>,
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
        let typed = settings
            .iter()
            .filter(|setting| setting.path() != ["profile"]);
        let typed = typed.map(Setting::brief).collect();
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
        let scenario = case.scenario().map_err(RunError::from)?;
        let has_preset = scenario.document.get("preset").is_some();
        let preset = Setting::of("preset", json!(Preset::Fast), "preset=fast");
        let preset = Some(preset).filter(|_| !has_preset);
        let case = case.with(preset.into_iter().collect(), &Memory::new(memory))?;
        let scenario = case.scenario().map_err(RunError::from)?;
        let [title, profile] = [&scenario.name, &scenario.profile_name].map(String::clone);
        let first_seed = scenario.seed;
        let mut notes = scenario.notes.clone();
        let (rungs, start) = rungs(&scenario);
        if let [only] = rungs.as_slice() {
            return Err(QuestionError::OneStep(only.step));
        }
        if start + 1 == rungs.len() {
            let step = rungs[start].step;
            notes.push(format!(
                "longer time steps than {} s are not known to be stable here: the first runs have this step and its \
                 half",
                round::brief(step)
            ));
        }
        let is_behavior_random = scenario.scene.needs().rvo;
        let asked = request.wanted.iter().map(|wanted| &wanted.name);
        let asked = distinct(asked.chain(request.bounds.iter().map(|bound| &bound.name)));
        let asked = asked.into_iter();
        let kinds = asked.map(|name| (name.clone(), kind_of(&scenario.measurements, name)));
        let kinds = kinds.collect();
        let first = Summary::first_names(&scenario.scene);
        let run = Run::new(scenario).map_err(RunError::from)?;
        let names = Summary::of(&run).metrics.into_keys();
        let names = distinct(names.chain(OF_RUNS.map(str::to_owned)).chain(first));
        let wanted = request.wanted.iter().map(|wanted| wanted.name.as_str());
        check("--error", wanted.collect(), &names)?;
        let bounds = request.bounds.iter().map(|bound| bound.name.as_str());
        check("--bound", bounds.collect(), &names)?;
        Ok(Self {
            request,
            names,
            title: [title, profile],
            settings: typed,
            first_seed,
            notes,
            rungs,
            start,
            is_behavior_random,
            kinds,
            case,
            memory,
        })
    }

    /// The run with the `k`-th seed at a step.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn case(&self, rung: Rung, k: usize) -> Result<Case, RunError> {
        let mut settings = at(rung);
        settings.push(set("seed", json!(self.seed(k))));
        self.case.with(settings, &Memory::new(self.memory))
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
        let mut settings = at(rung);
        settings.push(set("seed", json!(self.seed(population))));
        settings.push(set("population_seed", json!(self.seed(population))));
        settings.push(set("behavior_seed", json!(self.seed(repetition))));
        self.case.with(settings, &Memory::new(self.memory))
    }

    /// The `k`-th seed.
    fn seed(&self, k: usize) -> u64 {
        self.first_seed.wrapping_add(k as u64)
    }

    /// The run with the `k`-th seed and a preset, at its own step.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn with_preset(&self, preset: Preset, k: usize) -> Result<Case, RunError> {
        let seed = self.seed(k);
        let settings = vec![set("preset", json!(preset)), set("seed", json!(seed))];
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
        let name = words.collect::<Vec<_>>().join("-");
        let name: String = name
            .trim_start_matches(['.', '-'])
            .chars()
            .take(LONGEST)
            .collect();
        if name.is_empty() {
            "estimate".to_owned()
        } else {
            name
        }
    }

    /// The files that the scenario is read from.
    pub fn files(&self) -> impl Iterator<Item = &std::path::Path> {
        self.case.files()
    }

    /// The memory that runs share, bytes.
    pub fn memory(&self) -> Option<u64> {
        self.memory
    }
}

/// Whether the scenario has these results, and each is given once.
fn check(option: &'static str, given: Vec<&str>, names: &[String]) -> Result<(), QuestionError> {
    for (k, name) in given.iter().enumerate() {
        if !names.iter().any(|known| known == name) {
            return Err(QuestionError::Unknown {
                option,
                name: shown(name),
                known: names.join(", "),
                suggestion: suggestion(name, names.iter().map(String::as_str)),
            });
        }
        if given[..k].contains(name) {
            return Err(QuestionError::Twice(option, shown(name)));
        }
    }
    Ok(())
}

/// The settings of a step.
fn at(rung: Rung) -> Vec<Setting> {
    vec![
        set("time_step_secs", json!(rung.step)),
        set("coarse_every", json!(rung.coarse_every)),
    ]
}

/// A setting of the program's own.
fn set(key: &str, value: Value) -> Setting {
    let text = format!("{key}={value}");
    Setting::of(key, value, &text)
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

/// The kind of the measurement that has a value of this name.
pub(super) fn kind_of(measured: &[Measurement], name: &str) -> Option<Kind> {
    let has_value = |one: &&Measurement| one.names().iter().any(|own| own == name);
    measured.iter().find(has_value).map(discriminant)
}

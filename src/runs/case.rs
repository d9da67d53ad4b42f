//! A case: one run of a scenario with settings, and its result.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::drive::{End, Observer, Run};
use super::error::RunError;
use super::identity::Identity;
use super::job::{Job, Progress};
use super::memory::Memory;
use super::summary::Summary;
use engine::simulation::Fault;
use scenario::floor_plan::is_plan;
use scenario::input::is_standard_input;
use scenario::kinds;
use scenario::quote::shown;
use scenario::{
    Draft, Need, SHIPPED, Scenario, ScenarioError, Setting, built_in, config_in, read_text,
};

/// The source of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// A file that is built into the program, relative to `scenarios/`.
    BuiltIn(PathBuf),
    /// A scenario from a file, or for `-` from the standard input.
    File(PathBuf),
}

impl Source {
    /// The scenario of this name that ships with the program.
    pub fn shipped(name: &str) -> Option<Self> {
        let found = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        Some(Self::BuiltIn(format!("{}.json", found.name).into()))
    }

    /// The scenario of this name that ships with the program, otherwise a file.
    pub fn named(name: &str) -> Self {
        Self::at(PathBuf::from(name))
    }

    /// The same for a path as typed. The folder of a scenario of JuPedSim's web app stands for its JSON file.
    pub fn at(path: PathBuf) -> Self {
        let shipped = path.to_str().and_then(Self::shipped);
        shipped.unwrap_or_else(|| Self::File(config_in(&path).unwrap_or(path)))
    }

    /// The scenario's text, and the name of its file for messages. A floor plan is a scenario without people.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn text(&self) -> Result<(String, String), ScenarioError> {
        let (path, known) = match self {
            Self::BuiltIn(path) => (path, built_in(path)),
            Self::File(path) => (path, None),
        };
        let text = match (known, path.file_name()) {
            (Some(text), _) => text.to_owned(),
            (None, Some(name)) if is_plan(path) && path.is_file() => {
                json!({ "walkable_area": name.to_string_lossy() }).to_string()
            }
            _ => match kinds::of_name(path).filter(|_| path.is_file()) {
                None => read_text(path)?,
                Some(what) => {
                    let (file, reason) = (path.display().to_string(), what.to_owned());
                    return Err(ScenarioError::Unreadable { file, reason });
                }
            },
        };
        let name = match is_standard_input(path) {
            true => "standard input".to_owned(),
            false => path.display().to_string(),
        };
        Ok((text, name))
    }
}

/// One run, after validation. The scenario is read again when it runs.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scenario's seed.
    pub seed: u64,
    /// Estimated time on one core, seconds.
    pub expected_secs: f64,
    /// The memory that it needs.
    pub need: Need,
    /// The identity of its result: the engine and the whole scenario with its settings.
    pub key: Identity,
    source: Source,
    settings: Vec<Setting>,
    /// The files that its scenario refers to.
    plans: Vec<PathBuf>,
}

/// The result of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// As `sandbox run --json` reports it.
    #[serde(flatten)]
    pub summary: Summary,
    /// Number of counted arrivals.
    pub evacuated: usize,
    /// Computing time, seconds.
    pub wall_secs: f64,
}

impl Case {
    /// A run of this scenario with these settings. At most as many cases are validated at a time as fit into
    /// `memory`.
    ///
    /// # Errors
    /// The scenario or a setting is invalid, or the case needs more memory than there is.
    pub fn new(source: Source, settings: Vec<Setting>, memory: &Memory) -> Result<Self, RunError> {
        let (text, file) = source.text()?;
        let draft = Draft::read(&text, &file, &settings)?;
        let _lent = memory.lend(draft.need().bytes());
        let (scenario, need) = draft.within(memory.limit(), 0)?;
        Ok(Self {
            seed: scenario.seed,
            expected_secs: expected_secs(&scenario),
            need,
            key: Identity::of_run(&scenario),
            source,
            settings,
            plans: scenario.files.into_iter().map(|(_, path)| path).collect(),
        })
    }

    /// The same run with further settings, which override earlier ones.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with(&self, settings: Vec<Setting>, memory: &Memory) -> Result<Self, RunError> {
        let settings = self.settings.iter().cloned().chain(settings);
        Self::new(self.source.clone(), settings.collect(), memory)
    }

    /// The files that it is read from.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let own = match &self.source {
            Source::File(path) => Some(path),
            Source::BuiltIn(_) => None,
        };
        own.into_iter().chain(&self.plans).map(PathBuf::as_path)
    }

    /// The scenario with the settings applied, before its agents are placed.
    ///
    /// # Errors
    /// It has become invalid since [`new`](Self::new).
    pub fn draft(&self) -> Result<Draft, ScenarioError> {
        let (text, file) = self.source.text()?;
        Draft::read(&text, &file, &self.settings)
    }

    /// The scenario with the settings applied.
    ///
    /// # Errors
    /// It has become invalid since [`new`](Self::new).
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        self.draft()?.scenario()
    }

    /// The job that computes its [`RunResult`]; messages call it `name`.
    pub fn job(&self, name: String) -> Job<'_> {
        let work = |progress: Progress| self.compute(progress);
        let mut job = Job::new(name, self.key.clone(), self.expected_secs, work);
        job.bytes = self.need.bytes();
        job
    }

    /// Runs it on rayon's current threads.
    fn compute(&self, progress: Progress) -> Result<RunResult, RunError> {
        let scenario = self.scenario()?;
        if Identity::of_run(&scenario) != self.key {
            return Err(RunError::Changed(shown(&scenario.name)));
        }
        let start = Instant::now();
        let mut run = Run::new(scenario)?;
        run.drive(&mut [Box::new(progress)], || false)?;
        let arrivals = &run.simulation.outcome().arrivals;
        Ok(RunResult {
            summary: Summary::of(&run),
            evacuated: arrivals.iter().filter(|arrival| arrival.counted).count(),
            wall_secs: start.elapsed().as_secs_f64(),
        })
    }
}

impl Observer<Fault> for Progress<'_> {
    fn observe(&mut self, run: &Run, _: f64, _: ControlFlow<End>) -> Result<(), Fault> {
        let duration = run.scenario.duration_secs.max(f64::MIN_POSITIVE);
        self(run.simulation.frame().clock.time() / duration);
        Ok(())
    }
}

/// Estimates the time from the number of agents and frames, and from their forces; used to sort jobs.
fn expected_secs(scenario: &Scenario) -> f64 {
    /// Seconds per agent and frame with SPH alone, with social forces, and with RVO.
    const SECONDS: [f64; 3] = [0.8e-6, 3.5e-6, 8e-6];
    let scene = &scenario.scene;
    let frames = scenario.duration_secs / scene.clock.time_step();
    let by_sources = scene.sources.iter().map(|source| {
        let times = (scenario.duration_secs - source.start).max(0.0) / source.every;
        source.grid.len() as f64
            * source
                .times
                .map_or(times, |most| times.min(f64::from(most)))
    });
    let doors = scene.entrances.iter();
    let through = doors.map(|entrance| entrance.arrivals.about(scenario.duration_secs));
    let late = scene.scheduled.len() as f64;
    let entering = by_sources.chain(through).chain([late]);
    // Agents that enter during the run are present for half of it on average.
    let agents = scene.agents.len() as f64 + 0.5 * entering.sum::<f64>();
    let needs = scene.needs();
    let seconds = match (needs.rvo, needs.social) {
        (true, _) => SECONDS[2],
        (false, true) => SECONDS[1],
        (false, false) => SECONDS[0],
    };
    1e-3 + agents * frames * seconds
}

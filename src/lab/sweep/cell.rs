//! One cell of a study: a scenario with its settings and seed.

use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::CellError;
use super::memory::Memory;
use crate::scenario::quote::shown;
use crate::scenario::{Need, SHIPPED, Scenario, ScenarioError, Setting, read_text, shipped_text};

/// The engine's sources, in 16 letters: a result of another engine is not taken for one of this.
const ENGINE: &str = env!("SANDBOX_ENGINE");
/// To be raised with whatever changes what is kept of a cell and is no part of the engine.
const VERSION: u32 = 1;

/// Where a cell's scenario comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Source {
    /// From the program.
    Shipped(&'static str),
    /// From a file.
    File(PathBuf),
}

impl Source {
    /// A scenario of that name that comes with the program.
    pub(super) fn shipped(name: &str) -> Option<Self> {
        let found = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        Some(Self::Shipped(found.name))
    }

    /// The scenario's text, and what messages call its file.
    fn text(&self) -> Result<(String, String), ScenarioError> {
        match self {
            Self::Shipped(name) => Ok((shipped_text(name)?.to_owned(), format!("{name}.json"))),
            Self::File(path) => Ok((read_text(path)?, path.display().to_string())),
        }
    }

    fn scenario(&self, settings: &[Setting]) -> Result<Scenario, ScenarioError> {
        let (text, file) = self.text()?;
        Scenario::parse(&text, &file, settings)
    }
}

/// One run of a study.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Its number in the study, from 1.
    pub number: usize,
    /// What is varied: names and values, without the seeds.
    pub values: Vec<(String, Value)>,
    /// The scenario's seed.
    pub seed: u64,
    /// Roughly how long it takes on one core, seconds.
    pub expected_secs: f64,
    /// How much memory it takes.
    pub need: Need,
    pub(super) source: Source,
    pub(super) settings: Vec<Setting>,
    /// The floor plans that its scenario names.
    plans: Vec<PathBuf>,
    /// What its result is known by.
    key: String,
}

impl Cell {
    /// A cell, checked; its scenario itself is read again when it runs.
    ///
    /// # Errors
    /// Its scenario or a setting makes no sense, or it needs more memory than there is.
    pub(super) fn new(
        number: usize,
        values: Vec<(String, Value)>,
        source: Source,
        settings: Vec<Setting>,
        memory: &Memory,
    ) -> Result<Self, CellError> {
        let (text, file) = source.text()?;
        let check = |need: &Need| need.check(&file, 0, memory.limit().unwrap_or(u64::MAX));
        let need = Need::parse(&text, &file, &settings)?;
        check(&need)?;
        let _lent = memory.lend(need.bytes());
        let scenario = Scenario::parse(&text, &file, &settings)?;
        let need = need.with_lists(&scenario.scene);
        check(&need)?;
        let given = scenario.document.get("seed").and_then(Value::as_u64);
        Ok(Self {
            number,
            values,
            seed: given.unwrap_or(scenario.scene.seed),
            expected_secs: expected_secs(&scenario),
            need,
            key: key(&scenario),
            source,
            settings,
            plans: scenario.files.into_iter().map(|(_, path)| path).collect(),
        })
    }

    /// The files that it is read from, without the study's.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        let own = match &self.source {
            Source::File(path) => Some(path),
            Source::Shipped(_) => None,
        };
        own.into_iter().chain(&self.plans).map(PathBuf::as_path)
    }

    /// The scenario with the settings in it.
    ///
    /// # Errors
    /// As when the study was read.
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        self.source.scenario(&self.settings)
    }

    /// What its result is known by: a hash of the engine and of the whole scenario with its settings.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Is this still the cell's scenario?
    pub(super) fn is_of(&self, scenario: &Scenario) -> bool {
        self.key == key(scenario)
    }
}

/// The number, and what makes it different from others.
impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "cell {}:", self.number)?;
        for (name, value) in &self.values {
            write!(f, " {}={}", shown(name), short(value))?;
        }
        if self.values.iter().all(|(name, _)| name != "seed") {
            write!(f, " seed={}", self.seed)?;
        }
        Ok(())
    }
}

/// A value as in `--set key=value`: text without quotes.
pub(super) fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// The same, as messages repeat it.
pub(super) fn short(value: &Value) -> String {
    shown(&plain(value))
}

fn key(scenario: &Scenario) -> String {
    let identity = format!("{ENGINE} {VERSION} {}", scenario.document);
    let digest = Sha256::digest(identity);
    digest[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// By how many agents there are for how many frames, and what they are asked to do; to put cells in order.
fn expected_secs(scenario: &Scenario) -> f64 {
    /// Seconds for one agent and frame, with SPH alone, social forces, RVO.
    const SECONDS: [f64; 3] = [0.8e-6, 3.5e-6, 8e-6];
    let scene = &scenario.scene;
    let frames = scenario.duration_secs / scene.clock.time_step();
    let entering = scene.sources.iter().map(|source| {
        let times = (scenario.duration_secs - source.start).max(0.0) / source.every;
        source.grid.len() as f64
            * source
                .times
                .map_or(times, |most| times.min(f64::from(most)))
    });
    // Who enters on the way is there half of the time.
    let agents = scene.agents.len() as f64 + 0.5 * entering.sum::<f64>();
    let needs = scene.needs();
    let seconds = match (needs.rvo, needs.social) {
        (true, _) => SECONDS[2],
        (false, true) => SECONDS[1],
        (false, false) => SECONDS[0],
    };
    1e-3 + agents * frames * seconds
}

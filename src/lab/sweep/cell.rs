//! One cell of a study: a scenario with its settings and seed.

use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::CellError;
use super::memory::Memory;
use crate::scenario::quote::shown;
use crate::scenario::{Need, SHIPPED, Scenario, ScenarioError, Setting, read_text, shipped_text};

/// A hash of the engine's sources, 16 letters: results of other engines are not reused.
const ENGINE: &str = env!("SANDBOX_ENGINE");
/// Increase this whenever a change outside the engine affects the stored result of a cell.
const VERSION: u32 = 1;

/// Where a cell's scenario comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Source {
    /// A scenario that ships with the program.
    Shipped(&'static str),
    /// A scenario from a file.
    File(PathBuf),
}

impl Source {
    /// The scenario of this name that ships with the program.
    pub(super) fn shipped(name: &str) -> Option<Self> {
        let found = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        Some(Self::Shipped(found.name))
    }

    /// The scenario's text, and the name of its file for messages.
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
    /// Its number in the study; the first is 1.
    pub number: usize,
    /// The varied settings: names and values, without the seeds.
    pub values: Vec<(String, Value)>,
    /// The scenario's seed.
    pub seed: u64,
    /// Estimated time on one core, seconds.
    pub expected_secs: f64,
    /// The memory that it needs.
    pub need: Need,
    pub(super) source: Source,
    pub(super) settings: Vec<Setting>,
    /// The floor plans that its scenario refers to.
    plans: Vec<PathBuf>,
    /// The key of its result.
    key: String,
}

impl Cell {
    /// A cell, after validation. The scenario is read again when the cell runs.
    ///
    /// # Errors
    /// The scenario or a setting is invalid, or the cell needs more memory than there is.
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

    /// The files that it is read from, other than the study's.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        let own = match &self.source {
            Source::File(path) => Some(path),
            Source::Shipped(_) => None,
        };
        own.into_iter().chain(&self.plans).map(PathBuf::as_path)
    }

    /// The scenario with the settings applied.
    ///
    /// # Errors
    /// As in [`Study::read`](super::Study::read).
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        self.source.scenario(&self.settings)
    }

    /// The key of its result: a hash of the engine and of the whole scenario with its settings.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Does this cell still describe `scenario`?
    pub(super) fn is_of(&self, scenario: &Scenario) -> bool {
        self.key == key(scenario)
    }
}

/// The number, and the settings that distinguish the cell from others.
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

/// The same, shortened for messages.
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

/// Estimates the time from the number of agents and frames, and from their forces; used to sort cells.
fn expected_secs(scenario: &Scenario) -> f64 {
    /// Seconds per agent and frame with SPH alone, with social forces, and with RVO.
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

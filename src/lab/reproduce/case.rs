//! One run: a scenario with settings and a seed, and the data to keep of it.

use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::fmt::{self, Display};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::ReproduceError;
use super::snapshot::{Snapshot, SnapshotAt};
use crate::engine::simulation::Simulation;
use crate::scenario::{Scenario, ScenarioError, Setting};

/// A hash of the engine's sources, 16 letters: results of other engines are not reused.
const ENGINE: &str = env!("SANDBOX_ENGINE");

/// Data to keep of a run, in addition to its metrics.
pub trait Probe: Send + Sync {
    /// The name of the data, with everything that they depend on: probes with the same name keep the same data.
    fn name(&self) -> String;
    /// Begins a run. Densities can be requested here ([`Simulation::request_density_until`]).
    fn begin(&self, simulation: &mut Simulation) -> Box<dyn Observer>;
}

/// A probe during one run.
pub trait Observer {
    /// Observes an evaluated frame; called in every frame.
    fn observe(&mut self, simulation: &Simulation);
    /// The data to keep, after the last frame.
    fn finish(self: Box<Self>) -> Value;
}

/// One run. Cases with the same scenario, settings and seed are the same run, whatever data they keep.
#[derive(Clone)]
pub struct Case {
    source: Source,
    settings: Vec<String>,
    alone: bool,
    expected_secs: f64,
    probes: Vec<Arc<dyn Probe>>,
}

/// Where a case's scenario comes from.
#[derive(Clone)]
enum Source {
    Shipped(&'static str),
    Text { name: String, text: String },
}

impl Case {
    /// A scenario that ships with the program.
    pub fn shipped(name: &'static str) -> Self {
        Self::new(Source::Shipped(name))
    }

    /// A scenario from its JSON text.
    pub fn from_text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(Source::Text {
            name: name.into(),
            text: text.into(),
        })
    }

    fn new(source: Source) -> Self {
        Self {
            source,
            settings: Vec::new(),
            alone: false,
            expected_secs: 5.0,
            probes: Vec::new(),
        }
    }

    /// Changes a setting, as `--set key=value` does.
    #[must_use]
    pub fn set(mut self, key: &str, value: impl Display) -> Self {
        self.settings.push(format!("{key}={value}"));
        self
    }

    /// Sets the seed of all random numbers.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        self.set("seed", seed)
    }

    /// Also keeps the data of `probe`.
    #[must_use]
    pub fn keep(mut self, probe: impl Probe + 'static) -> Self {
        self.probes.push(Arc::new(probe));
        self
    }

    /// Keeps all agents' positions, velocities, densities and radii at a time in seconds.
    #[must_use]
    pub fn snapshot(self, at: f64) -> Self {
        self.keep(SnapshotAt(at))
    }

    /// Sets the estimated computing time on one core, seconds. The longest cases begin first, and the remaining time is
    /// estimated from it.
    #[must_use]
    pub fn taking(mut self, seconds: f64) -> Self {
        self.expected_secs = seconds;
        self
    }

    /// Runs on all threads while no other case runs, to measure its computing time.
    #[must_use]
    pub fn alone(mut self) -> Self {
        self.alone = true;
        self
    }

    /// The scenario's name, then the settings as on the command line; long settings are cut.
    pub fn name(&self) -> String {
        /// Longer settings are cut to this many characters.
        const LONGEST: usize = 40;
        let name = match &self.source {
            Source::Shipped(name) => name,
            Source::Text { name, .. } => name.as_str(),
        };
        let mut text = name.to_owned();
        for setting in &self.settings {
            text.push(' ');
            text.extend(setting.chars().take(LONGEST));
            if setting.chars().count() > LONGEST {
                text.push('…');
            }
        }
        text
    }

    /// The scenario with the settings applied.
    ///
    /// # Errors
    /// A setting or the text is invalid.
    pub fn scenario(&self) -> Result<Scenario, ReproduceError> {
        let invalid = |error| ReproduceError::Scenario {
            case: self.name(),
            error,
        };
        let parsed: Result<Vec<Setting>, _> =
            self.settings.iter().map(|text| text.parse()).collect();
        let settings = parsed.map_err(|error| ReproduceError::Data(format!("{error}")))?;
        let scenario: Result<Scenario, ScenarioError> = match &self.source {
            Source::Shipped(name) => Scenario::shipped(name, &settings),
            Source::Text { name, text } => {
                Scenario::parse(text, &format!("{name}.json"), &settings)
            }
        };
        scenario.map_err(invalid)
    }

    /// The key of the run.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario).
    pub fn key(&self) -> Result<Key, ReproduceError> {
        Ok(Key::new(self, &self.scenario()?))
    }

    /// Estimated time on one core, seconds.
    pub fn expected_secs(&self) -> f64 {
        self.expected_secs
    }

    /// Does it run while no other case runs?
    pub fn is_alone(&self) -> bool {
        self.alone
    }

    /// The probes.
    pub fn probes(&self) -> &[Arc<dyn Probe>] {
        &self.probes
    }

    /// Also keeps the data that `other`, a case of the same run, keeps.
    pub(super) fn keep_also(&mut self, other: &Self) {
        for probe in &other.probes {
            if self.probes.iter().all(|own| own.name() != probe.name()) {
                self.probes.push(Arc::clone(probe));
            }
        }
    }
}

/// The identity of a run: the engine, the whole document, and whether it ran alone.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key {
    /// A readable name and a hash, suitable as a file name.
    stem: String,
    /// The hashed text.
    pub(super) identity: String,
}

impl Key {
    /// The readable name is cut to this many letters.
    const LONGEST: usize = 80;

    fn new(case: &Case, scenario: &Scenario) -> Self {
        let alone = if case.alone { "alone" } else { "beside others" };
        let identity = format!("{ENGINE} {alone} {}", scenario.document);
        let mut hasher = DefaultHasher::new();
        identity.hash(&mut hasher);
        let readable = case.name().replace("->", "-to-").replace('+', "-with-");
        let words: Vec<&str> = readable
            .split(|c: char| !(c.is_ascii_alphanumeric() || c == '.' || c == '_'))
            .filter(|word| !word.is_empty())
            .collect();
        let mut stem = words.join("-");
        stem.truncate(Self::LONGEST);
        Self {
            stem: format!("{stem}-{:016x}", hasher.finish()),
            identity,
        }
    }
}

impl Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.stem)
    }
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    /// The name of the case.
    pub case: String,
    /// Computing time, seconds.
    pub computed_in_secs: f64,
    /// The simulated time at its end, seconds.
    pub ended_at_secs: f64,
    /// The scenario's measurements by name; `None` if the run gave no value.
    pub metrics: BTreeMap<String, Option<f64>>,
    /// The times of counted arrivals, seconds, in order.
    pub arrivals: Vec<f64>,
    /// Number of arrivals that are not counted.
    pub uncounted: usize,
    /// Number of agents at the end.
    pub remaining: usize,
    /// The data of the probes, by name.
    pub kept: BTreeMap<String, Value>,
}

impl CaseResult {
    /// A metric by name.
    ///
    /// # Errors
    /// The metric is not measured. (A metric without a value is `None`.)
    pub fn metric(&self, name: &str) -> Result<Option<f64>, ReproduceError> {
        self.metrics
            .get(name)
            .copied()
            .ok_or_else(|| self.missing(format!("metric `{name}`")))
    }

    /// The data of the probe with this name.
    ///
    /// # Errors
    /// There are no such data, or they have another form.
    pub fn kept<T: DeserializeOwned>(&self, name: &str) -> Result<T, ReproduceError> {
        let value = self.kept.get(name).cloned();
        let value = value.ok_or_else(|| self.missing(format!("`{name}`")))?;
        serde_json::from_value(value)
            .map_err(|error| self.missing(format!("usable `{name}`: {error}")))
    }

    /// The snapshot at a time in seconds.
    ///
    /// # Errors
    /// There is no snapshot of this time, or the run ended before it.
    pub fn snapshot(&self, at: f64) -> Result<Snapshot, ReproduceError> {
        self.kept(&SnapshotAt(at).name())
    }

    fn missing(&self, what: String) -> ReproduceError {
        ReproduceError::Missing {
            case: self.case.clone(),
            what,
        }
    }
}

//! One run: a scenario with settings and a seed, and what to keep of it.

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

/// The engine's sources, in 16 letters: a result of another engine is not taken for one of this.
const ENGINE: &str = env!("SANDBOX_ENGINE");

/// Something to keep of a run beside its metrics.
pub trait Probe: Send + Sync {
    /// Names what is kept, with everything that it depends on: two probes of one name give the same.
    fn name(&self) -> String;
    /// Begins a run; here is the place to ask for densities
    /// ([`Simulation::request_density_until`]).
    fn begin(&self, simulation: &mut Simulation) -> Box<dyn Observer>;
}

/// A probe at work in one run.
pub trait Observer {
    /// Looks at an evaluated frame; called in every one.
    fn observe(&mut self, simulation: &Simulation);
    /// What was seen, after the last frame.
    fn finish(self: Box<Self>) -> Value;
}

/// One run. Cases of the same scenario, settings and seed are the same run, whatever they keep.
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
    /// A scenario that comes with the program.
    pub fn shipped(name: &'static str) -> Self {
        Self::new(Source::Shipped(name))
    }

    /// A scenario from its text, JSON.
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

    /// Keeps what a probe sees.
    #[must_use]
    pub fn keep(mut self, probe: impl Probe + 'static) -> Self {
        self.probes.push(Arc::new(probe));
        self
    }

    /// Keeps everybody's position, velocity, density and radius at a time in seconds.
    #[must_use]
    pub fn snapshot(self, at: f64) -> Self {
        self.keep(SnapshotAt(at))
    }

    /// Roughly how long it takes to compute on one core, seconds; the longest begin first, and the
    /// time left is told from it.
    #[must_use]
    pub fn taking(mut self, seconds: f64) -> Self {
        self.expected_secs = seconds;
        self
    }

    /// Runs when nothing else does, on all threads: for measuring how long it takes.
    #[must_use]
    pub fn alone(mut self) -> Self {
        self.alone = true;
        self
    }

    /// The settings as on the command line, behind the scenario's name; long ones are cut.
    pub fn name(&self) -> String {
        /// More letters of a setting tell nobody anything.
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

    /// The scenario with the settings in it.
    ///
    /// # Errors
    /// A setting or the text makes no sense.
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

    /// What the run is known by.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario).
    pub fn key(&self) -> Result<Key, ReproduceError> {
        Ok(Key::new(self, &self.scenario()?))
    }

    /// Seconds on one core, roughly.
    pub fn expected_secs(&self) -> f64 {
        self.expected_secs
    }

    /// Does it run when nothing else does?
    pub fn is_alone(&self) -> bool {
        self.alone
    }

    /// What is kept.
    pub fn probes(&self) -> &[Arc<dyn Probe>] {
        &self.probes
    }

    /// Keeps what `other`, the same run, keeps as well.
    pub(super) fn keep_also(&mut self, other: &Self) {
        for probe in &other.probes {
            if self.probes.iter().all(|own| own.name() != probe.name()) {
                self.probes.push(Arc::clone(probe));
            }
        }
    }
}

/// What a run is known by: the engine, the whole document, and if it ran alone.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key {
    /// A readable name and a hash, fit for a file.
    stem: String,
    /// What was hashed.
    pub(super) identity: String,
}

impl Key {
    /// A file's name is cut to this many letters before the hash.
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

/// What a run gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    /// The case, readable.
    pub case: String,
    /// How long it took to compute, seconds.
    pub computed_in_secs: f64,
    /// The simulated time at its end, seconds.
    pub ended_at_secs: f64,
    /// The scenario's measurements by name; `None` where the run gave none.
    pub metrics: BTreeMap<String, Option<f64>>,
    /// When each counted arrival was, seconds, in order.
    pub arrivals: Vec<f64>,
    /// How many arrivals did not count.
    pub uncounted: usize,
    /// How many agents were still there at the end.
    pub remaining: usize,
    /// What the probes kept, by their names.
    pub kept: BTreeMap<String, Value>,
}

impl CaseResult {
    /// A metric by name.
    ///
    /// # Errors
    /// It is not measured. (A run that gave no value has `None`.)
    pub fn metric(&self, name: &str) -> Result<Option<f64>, ReproduceError> {
        self.metrics
            .get(name)
            .copied()
            .ok_or_else(|| self.missing(format!("metric `{name}`")))
    }

    /// What the probe of that name kept.
    ///
    /// # Errors
    /// Nothing was kept, or something else.
    pub fn kept<T: DeserializeOwned>(&self, name: &str) -> Result<T, ReproduceError> {
        let value = self.kept.get(name).cloned();
        let value = value.ok_or_else(|| self.missing(format!("`{name}`")))?;
        serde_json::from_value(value)
            .map_err(|error| self.missing(format!("usable `{name}`: {error}")))
    }

    /// The snapshot at a time in seconds.
    ///
    /// # Errors
    /// None was kept, or the run ended before.
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

//! A checked scenario.

use std::io::ErrorKind;
use std::path::Path;

use serde_json::{Value, json};

use crate::error::{Problem, ScenarioError};
use crate::file::{Stop, range};
use crate::floor_plan::{Label, Place};
use crate::input;
use crate::jupedsim;
use crate::measurements::Measurement;
use crate::read::document;
use crate::read::draft::Draft;
use crate::read::parsed::parsed;
use crate::read::plans::PlanFile;
use crate::read::setting::Setting;
use crate::read::shipped::SHIPPED;
use crate::scene::view::View;
use crate::scene::{interventions, routes};
use engine::routes::Routes;
use engine::scene::{Action, Scene};
use engine::simulation::Simulation;

/// A checked scenario: what to simulate, for how long, and what to measure and show.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// Its name.
    pub name: String,
    /// What it shows, in one line; may be empty.
    pub description: String,
    /// What to simulate.
    pub scene: Scene,
    /// The key `seed`: the seed of the population and of behavior, unless they have their own.
    pub seed: u64,
    /// Simulated time, seconds.
    pub duration_secs: f64,
    /// When to stop earlier.
    pub stop: Stop,
    /// What to measure.
    pub measurements: Vec<Measurement>,
    /// What pictures and recordings show.
    pub view: View,
    /// Texts in them.
    pub labels: Vec<Label>,
    /// Ids of the agents whose forces a recording shows. Some of them may never enter.
    pub debug_agents: Vec<u32>,
    /// Upper bound on the agents that enter during the run; all ids are lower.
    pub entering: u64,
    /// The name of the default profile, for agents that name none.
    pub profile_name: String,
    /// The file with the settings applied, its preset expanded and the contents of the files that it names.
    pub document: Value,
    /// The files that it names.
    pub files: Vec<PlanFile>,
    /// The areas, lines and points that its floor plans name.
    pub places: Vec<Place>,
    /// The settings that differ from the file, as typed: `gas_constant=400`, `seed 2`.
    pub changes: Vec<String>,
    /// What was changed to make it run, for readers of its results.
    pub notes: Vec<String>,
    /// Agents find routes through passages of at least this width, meters; `None`: they walk straight.
    pub passage_width: Option<f64>,
}

impl Scenario {
    /// The [`document`](Self::document) as indented JSON, which [`parse`](Self::parse) reads.
    pub fn to_text(&self) -> String {
        document::write(&self.document)
    }

    /// The mass of an average person, kg, if the scenario measures forces on walls.
    pub fn mass_on_walls(&self) -> Option<f64> {
        let mut measured = self.measurements.iter();
        measured.find_map(|one| one.about().mass_on_walls)
    }

    /// The floor without path maps, for goals that agents get during the run; `None` if agents walk straight, or see
    /// everything.
    ///
    /// # Errors
    /// The walls cross, or lie too far away.
    pub fn floor(&self) -> Result<Option<Routes>, ScenarioError> {
        let width = self.passage_width.filter(|_| !self.scene.walls.is_empty());
        let floor = width.map(|width| routes::floor(&self.scene, width));
        floor.transpose().map_err(|problem| ScenarioError::Invalid {
            file: self.name.clone(),
            problem,
        })
    }

    /// The action that an element of the list `interventions` describes, without its time. The same is refused as in a
    /// file, so that [`played`](Self::played) can be read.
    ///
    /// # Errors
    /// A key or a name is unknown, a number is out of range, or there is not exactly one action.
    pub fn action(&self, keys: &Value) -> Result<Action, ScenarioError> {
        let read = || {
            range::check(&json!({"interventions": [keys]})).map_err(|problem| {
                let own = problem.path.strip_prefix("interventions[0]");
                let own = own.map_or(&*problem.path, |own| own.trim_start_matches('.'));
                Problem::new(own, problem.reason)
            })?;
            interventions::action(&parsed(keys)?, &self.scene)
        };
        read().map_err(|problem| ScenarioError::Invalid {
            file: self.name.clone(),
            problem,
        })
    }

    /// The scenario of a run with what was done to it from outside: its document, which ends at the time of the current
    /// frame. A run of it has the same state in its last frame.
    pub fn played(&self, simulation: &Simulation) -> Value {
        let mut document = self.document.clone();
        let done = interventions::written(simulation.interventions(), simulation.scene());
        // In one frame, those from outside act before those of the file.
        let planned = document["interventions"].as_array().cloned();
        let all: Vec<Value> = done
            .into_iter()
            .chain(planned.unwrap_or_default())
            .collect();
        if !all.is_empty() {
            document["interventions"] = all.into();
        }
        document["duration_secs"] = simulation.frame().clock.time().into();
        if let Some(keys) = document.as_object_mut() {
            keys.remove("stop");
        }
        document
    }

    /// Reads a scenario from JSON; see `Draft::read`.
    ///
    /// # Errors
    /// The first problem in the text or the settings, with its place.
    pub fn parse(text: &str, file: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        Draft::read(text, file, settings)?.scenario()
    }

    /// Reads a scenario from a file.
    ///
    /// # Errors
    /// The file cannot be read or is too long, or an error of [`parse`](Self::parse).
    pub fn load(path: &Path, settings: &[Setting]) -> Result<Self, ScenarioError> {
        let text = read_text(path)?;
        Self::parse(&text, &path.display().to_string(), settings)
    }

    /// Reads one of the built-in scenarios.
    ///
    /// # Errors
    /// An unknown name, or an error of [`parse`](Self::parse) caused by the settings.
    pub fn shipped(name: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        Self::parse(shipped_text(name)?, &format!("{name}.json"), settings)
    }
}

/// The text of one of the built-in scenarios.
///
/// # Errors
/// An unknown name.
pub fn shipped_text(name: &str) -> Result<&'static str, ScenarioError> {
    let found = SHIPPED.iter().find(|shipped| shipped.name == name);
    let shipped = found.ok_or_else(|| ScenarioError::UnknownName {
        name: name.to_owned(),
        known: SHIPPED.map(|shipped| shipped.name).join(", "),
    })?;
    Ok(shipped.text)
}

/// Reads the text of a scenario file, or of the standard input for the path `-`. A scenario of JuPedSim's web app can
/// be in a zip archive.
///
/// # Errors
/// The file cannot be read, or is longer than 256 MiB.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    if let Some(text) = jupedsim::text(path, document::read)? {
        return Ok(text);
    }
    let text = match input::is_standard_input(path) {
        true => input::standard_input(),
        false => input::text(path),
    };
    text.map_err(|error| ScenarioError::Unreadable {
        file: path.display().to_string(),
        reason: unreadable_because(&error),
    })
}

/// The system's message about a file, with advice.
fn unreadable_because(error: &std::io::Error) -> String {
    let whole = error.to_string();
    let said = whole.split(" (os error").next().unwrap_or_default();
    match error.kind() {
        ErrorKind::NotFound => {
            format!("{said}; `sandbox list` shows the built-in scenarios")
        }
        ErrorKind::IsADirectory => {
            format!("{said}; a scenario is a file, or a folder with config.json and geometry.wkt")
        }
        ErrorKind::InvalidData => {
            format!("{said}, or continue a checkpoint with `sandbox resume`")
        }
        ErrorKind::FileTooLarge => format!("{said}; a scenario must be shorter"),
        _ => said.to_owned(),
    }
}

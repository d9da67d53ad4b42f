//! Scenario files: the text of a file → a checked [`Scenario`] → a [`Scene`] for the simulation.
//!
//! A file is a JSON object. Every top-level key is optional; an unknown key is an error. The structs in `file.rs`
//! have one field per key, with its description, default and range; [`schema()`], [`settings()`] and the range checks
//! come from them. Presets and [`Setting`]s change the JSON before it is parsed once, by [`Draft::read`].
//!
//! Agents can walk in the `walkable_area` (everywhere if it is missing) except in the `obstacles`. Each of the two
//! is a list of polygons, or the name of a file that [`floor_plan`] reads. `$schema` is ignored; editors use it.
//!
//! An agent is removed within `remove_within` meters of its goal, or never if the key is missing. Its arrival
//! counts as evacuated unless `counted` is false. Top-level `parameters` override those of the profiles. Ids count
//! from 0 in order of entry: the people of `from`, agents, grids, crowds, then the others as they enter.

pub mod quote;

pub mod input;

pub mod floor_plan;

pub mod trajectories;

pub mod calibrated;

pub mod catalog;

pub mod measurements;

mod bodies;
mod check;
mod crowd;
mod crowding;
mod crowds;
mod distribution;
mod document;
mod doors;
mod doubts;
mod draft;
mod effective;
mod entrances;
mod error;
mod file;
mod from;
mod goals;
mod journeys;
mod late;
mod need;
mod numerics;
mod off_floor;
mod openings;
mod origin;
mod overlaps;
mod periodic;
mod places;
mod plan;
mod preset;
mod profiles;
mod range;
mod reach;
mod schema;
mod setting;
mod settings;
mod shapes;
mod shipped;
mod slits;
mod spots;
mod view;
mod waiting;
mod wall_lists;
mod ways;

#[cfg(feature = "program")]
pub(crate) use document::read as read_document;
pub use draft::Draft;
pub use error::{Problem, ScenarioError};
#[cfg(feature = "program")]
pub(crate) use error::{in_plain_words, suggestion};
pub use file::Stop;
pub use need::{Need, in_units};
pub use numerics::automatic_step;
pub use preset::Preset;
pub use schema::schema;
pub use setting::{Setting, SettingError};
pub use settings::{SettingDoc, nested_settings, settings};
pub use shipped::{SHIPPED, Shipped, built_in};
pub use view::View;
pub use ways::WayFinding;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::engine::scene::Scene;
use crate::engine::ways::Ways;
use crate::scenario::floor_plan::Label;
use crate::scenario::measurements::Measurement;

/// The key that names a file, and the file: a floor plan or trajectories.
pub type PlanFile = (&'static str, PathBuf);

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
    /// The settings that differ from the file, as typed: `gas_constant=400`, `seed 2`.
    pub changes: Vec<String>,
    /// What was changed to make it run, for readers of its results.
    pub notes: Vec<String>,
    /// Agents find ways through passages of at least this width, meters; `None`: they walk straight.
    pub passage_width: Option<f64>,
}

impl Scenario {
    /// The [`document`](Self::document) as indented JSON, which [`parse`](Self::parse) reads.
    pub fn to_text(&self) -> String {
        document::write(&self.document)
    }

    /// The mass of an average person, kg, if the scenario measures forces on walls.
    pub fn mass_on_walls(&self) -> Option<f64> {
        self.measurements
            .iter()
            .find_map(Measurement::mass_on_walls)
    }

    /// The floor without path maps, for goals that agents get during the run; `None` if agents walk straight, or see
    /// everything.
    ///
    /// # Errors
    /// The walls cross, or lie too far away.
    pub fn floor(&self) -> Result<Option<Ways>, ScenarioError> {
        let width = self.passage_width.filter(|_| !self.scene.walls.is_empty());
        let floor = width.map(|width| ways::floor(&self.scene, width));
        floor.transpose().map_err(|problem| ScenarioError::Invalid {
            file: self.name.clone(),
            problem,
        })
    }

    /// Reads a scenario from JSON; see [`Draft::read`].
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

/// Reads the text of a scenario file.
///
/// # Errors
/// The file cannot be read, or is longer than 256 MiB.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    input::text(path).map_err(|error| ScenarioError::Unreadable {
        file: path.display().to_string(),
        reason: unreadable_because(&error),
    })
}

/// The system's message about a file, with advice.
fn unreadable_because(error: &std::io::Error) -> String {
    let said = error.to_string();
    let said = said.split(" (os error").next().unwrap_or_default();
    match error.kind() {
        ErrorKind::NotFound => {
            format!("{said}; `sandbox list` shows the built-in scenarios")
        }
        ErrorKind::IsADirectory => format!("{said}; a scenario is a file"),
        ErrorKind::InvalidData => {
            format!("{said}; save it as UTF-8, or continue a checkpoint with `sandbox resume`")
        }
        ErrorKind::FileTooLarge => format!("{said}; a scenario must be shorter"),
        _ => said.to_owned(),
    }
}

//! What a scenario file says → a checked [`Scenario`] → a [`Scene`] for the simulation.
//!
//! A file is a JSON object; every key is optional, and an unknown one is an error. Lengths are in
//! metres, times in seconds, points `[x, y]`, regions `[[x0, y0], [x1, y1]]`. The keys with their
//! units, defaults and ranges are in [`settings`]; the nested ones:
//!
//! | in | keys |
//! |---|---|
//! | `agents` | `position`, and optionally `velocity`, `radius`, `mass`, `goal`, `mean_density` (ρ̂ of the frame before), `profile`, `remove_within`, `counted` |
//! | `grids` | `min`, `max`, `columns`, `rows`, and optionally `name`, `jitter`, `goal` or `goal_offset` (from each agent's start), `profile`, `remove_within`, `counted` |
//! | `sources` | the same, `every_secs`, and optionally `start_secs`, `times` |
//! | `events` | `at_secs`, `for_secs`, `region`, and optionally `name`, `goal_scale`, `ignore_contact`, `ignore_sph` |
//! | `measurements` | one of `density` (`at_secs`, optionally `region`), `flow_of_first` (`arrivals`), `flow_until` (`until_secs`), `evacuated` (nothing) |
//! | `stop` | `when_empty`, `idle_secs` |
//! | `view` | `region`, and optionally `opens_at_secs` |
//! | `profile` | one of `base` (a name), `navigation` (`goal`, `social` or `rvo`; with it `sph`, true or false) and `blend` (a list of `at_density`, `profile`), and optionally `name`, `parameters` |
//!
//! People walk in the `walkable_area`, everywhere without it, but not in the `obstacles`. Either is written
//! out, or is the name of a file that [`floor_plan`](crate::scenario::floor_plan) reads. `$schema` is left alone, for
//! editors.
//!
//! An agent is removed `remove_within` metres of its goal, and never without that key; unless
//! `counted` is false, its arrival counts as evacuated. `parameters` at the top go before those of
//! the profiles. Ids are given from 0 in the order of entry: agents, grids, then sources as they come.

pub mod quote;

pub mod input;

pub mod floor_plan;

pub mod catalog;

pub mod metrics;

mod check;
mod crowd;
mod crowding;
mod document;
mod error;
mod file;
mod key;
mod need;
mod nested;
mod parameters;
mod plan;
mod preset;
mod profiles;
mod range;
mod schema;
mod setting;
mod settings;
mod shipped;
mod wall_lists;

pub(crate) use document::read as read_document;
pub use error::{Problem, ScenarioError};
pub(crate) use error::{in_plain_words, suggestion};
pub use need::{Need, TooLarge, in_units};
pub use nested::NESTED;
pub use preset::Preset;
pub use schema::schema;
pub use setting::{Setting, SettingError};
pub use settings::{SettingDoc, settings};
pub use shipped::{SHIPPED, Shipped};

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::engine::scene::{Region, Scene};
use crate::scenario::metrics::Measurement;

/// A floor plan's file, after the key that names it.
pub type PlanFile = (&'static str, PathBuf);

/// A checked scenario: what to simulate, for how long, and what to look at.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// What it is called.
    pub name: String,
    /// What it shows, in a line; may be empty.
    pub description: String,
    /// What to simulate.
    pub scene: Scene,
    /// For how long, seconds.
    pub duration_secs: f64,
    /// When to stop before.
    pub stop: Stop,
    /// What to measure.
    pub measurements: Vec<Measurement>,
    /// What a recording shows first.
    pub view: View,
    /// Ids of agents that a recording lays open; not all of them need ever enter.
    pub debug_agents: Vec<u32>,
    /// How many enter in the whole run at most; ids are lower than this.
    pub entering: u64,
    /// The name of the profile of agents that name none.
    pub profile_name: String,
    /// The file as given, with the settings, what its preset stands for and what the files that it names say.
    pub document: Value,
    /// The floor plans that it was read from.
    pub files: Vec<PlanFile>,
}

/// When a run stops before its end.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stop {
    /// When nobody is there and nobody will come.
    pub when_empty: bool,
    /// After so many seconds without a counted arrival, from the start or the last one.
    pub idle_secs: Option<f64>,
}

/// What a recording shows first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The part of the plane, metres.
    pub region: Region,
    /// The moment, seconds.
    pub opens_at_secs: f64,
}

impl Scenario {
    /// The file with the settings in it, to be read by people and by [`parse`](Self::parse).
    pub fn to_text(&self) -> String {
        document::write(&self.document)
    }

    /// Reads a scenario from JSON; `file` is what messages call it, and files that it names are in that one's
    /// folder.
    ///
    /// # Errors
    /// Anything wrong with the text or with the settings: the first thing, with its place.
    pub fn parse(text: &str, file: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        checked(text, file, settings, check::scenario)
    }

    /// Reads a scenario from a file.
    ///
    /// # Errors
    /// The file cannot be read or is too long, or as [`parse`](Self::parse).
    pub fn load(path: &Path, settings: &[Setting]) -> Result<Self, ScenarioError> {
        let text = read_text(path)?;
        Self::parse(&text, &path.display().to_string(), settings)
    }

    /// One of the scenarios that come with the program.
    ///
    /// # Errors
    /// No such name, or as [`parse`](Self::parse) because of the settings.
    pub fn shipped(name: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        Self::parse(shipped_text(name)?, &format!("{name}.json"), settings)
    }
}

impl Need {
    /// Of the scenario that [`Scenario::parse`] would read, before anybody is placed.
    ///
    /// # Errors
    /// What is wrong with names, types or the number of agents; the rest is checked by
    /// [`Scenario::parse`].
    pub fn parse(text: &str, file: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        let need = checked(text, file, settings, check::need)?;
        let text = text.len() as u64;
        Ok(Self { text, ..need })
    }
}

/// The text of one of the scenarios that come with the program.
///
/// # Errors
/// No such name.
pub fn shipped_text(name: &str) -> Result<&'static str, ScenarioError> {
    let found = SHIPPED.iter().find(|shipped| shipped.name == name);
    let shipped = found.ok_or_else(|| ScenarioError::UnknownName {
        name: name.to_owned(),
        known: SHIPPED.map(|shipped| shipped.name).join(", "),
    })?;
    Ok(shipped.text)
}

/// The text of a scenario file.
///
/// # Errors
/// The file cannot be read, or is longer than 256 MiB.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    let unreadable = |reason: String| ScenarioError::Unreadable {
        file: path.display().to_string(),
        reason,
    };
    input::text(path).map_err(|error| unreadable(unreadable_because(&error)))
}

/// What the system says about a file, and what may help.
fn unreadable_because(error: &std::io::Error) -> String {
    let said = error.to_string();
    let said = said.split(" (os error").next().unwrap_or_default();
    match error.kind() {
        ErrorKind::NotFound => {
            format!("{said}; `sandbox list` names the scenarios that come with the program")
        }
        ErrorKind::IsADirectory => format!("{said}; a scenario is a file"),
        ErrorKind::InvalidData => format!("{said}; save it as that"),
        ErrorKind::FileTooLarge => format!("{said}; no scenario is"),
        _ => said.to_owned(),
    }
}

/// What `check` makes of a text, which is or came from `file`, with some settings.
fn checked<T>(
    text: &str,
    file: &str,
    settings: &[Setting],
    check: fn(&Value, &Path) -> Result<T, Problem>,
) -> Result<T, ScenarioError> {
    let given = document::read(text, file)?;
    let path = Path::new(file);
    let invalid = |file: String, problem| ScenarioError::Invalid { file, problem };
    if settings.is_empty() || !given.is_object() {
        return check(&given, path).map_err(|p| invalid(file.to_owned(), p));
    }
    let mut changed = given.clone();
    let mut paths = Vec::with_capacity(settings.len());
    for setting in settings {
        let applied = setting.apply(&mut changed);
        paths.push(applied.map_err(|problem| setting.refused(problem))?);
    }
    check(&changed, path).map_err(|problem| {
        for (path, setting) in paths.iter().zip(settings).rev() {
            if let Some(problem) = problem.seen_from(path) {
                return setting.refused(problem);
            }
        }
        let mut source = file.to_owned();
        if check(&given, path).is_ok() {
            source.push_str(" with");
            source.extend(settings.iter().map(|setting| format!(" {setting}")));
        }
        invalid(source, problem)
    })
}

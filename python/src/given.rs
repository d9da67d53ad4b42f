//! A scenario with its settings, as Python gives them.

use std::path::PathBuf;

use pyo3::prelude::*;
use sandbox::lab::machine::main_memory;
use sandbox::runs::case::Source;
use sandbox::scenario::{Draft, Scenario, Setting, in_units};

use crate::error;

/// A scenario with its settings.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    /// The name of a scenario that comes with the program, or its file; what messages call it if there is a text.
    name: String,
    /// The scenario as JSON, if it is in no file.
    text: Option<String>,
    /// Settings: the key, the value as JSON, and what messages call them.
    settings: Vec<(String, String, String)>,
    /// A floor plan that replaces the scenario's.
    geometry: Option<PathBuf>,
}

impl Given {
    /// The checked scenario.
    pub fn scenario(self) -> PyResult<Scenario> {
        let (text, file) = match self.text {
            Some(text) => (text, self.name),
            None => Source::named(&self.name).text().map_err(error)?,
        };
        let mut settings = Vec::new();
        if let Some(path) = &self.geometry {
            let name = format!("geometry={}", path.display());
            settings.extend(Setting::plan_file(path, &name));
        }
        for (key, value, name) in self.settings {
            let value = serde_json::from_str(&value).map_err(error)?;
            let new = Setting::new(&key, value, name.clone());
            let new = new.map_err(|reason| error(format!("{name}: {reason}")))?;
            if let Some(other) = settings.iter().find(|other| other.path() == new.path()) {
                return Err(error(format!(
                    "{new} and {other} set the same key: give only one of them"
                )));
            }
            settings.push(new);
        }
        let draft = Draft::read(&text, &file, &settings).map_err(error)?;
        let (scenario, _) = draft.within(main_memory(), 0).map_err(error)?;
        Ok(scenario)
    }
}

/// Refuses trajectories that do not fit into memory: as many frames and columns, of all agents that enter.
pub fn check_memory(scenario: &Scenario, fps: f64, columns: usize) -> PyResult<()> {
    let frames = (scenario.duration_secs * fps).floor() + 1.0;
    let bytes = 8.0 * frames * columns as f64 * scenario.entering as f64;
    match main_memory() {
        Some(there) if bytes > there as f64 => Err(error(format!(
            "the trajectories of {} agents in {frames} frames would take {} of memory, and this machine has {}: give a \
             lower `fps` or fewer `columns`",
            scenario.entering,
            in_units(bytes as u64),
            in_units(there),
        ))),
        _ => Ok(()),
    }
}

//! A setting, and its place in a study's file.

use std::collections::{BTreeSet, HashSet};

use serde_json::Value;

use super::cell::{MOST_CELLS, short};
use super::entries::Entries;
use super::written::Written;
use runs::case::Source;
use scenario::quote::shown;
use scenario::{Problem, SHIPPED, Setting, suggestion};

/// The key of the scenario, which can be varied like a setting.
pub(super) const SCENARIO: &str = "scenario";

/// A setting, and its place in the file.
#[derive(Debug, Clone)]
pub(super) struct Choice {
    /// The key as written.
    pub(super) key: String,
    /// The value as written.
    pub(super) value: Value,
    /// The place, such as `grid.viscosity[2]`.
    pub(super) place: String,
    /// Its meaning.
    pub(super) meaning: Meaning,
}

/// The meaning of a key.
#[derive(Debug, Clone)]
pub(super) enum Meaning {
    /// Another scenario.
    Scenario(Source),
    /// A change to the scenario.
    Setting(Setting),
}

impl Choice {
    /// The path of the setting; `None` for another scenario.
    pub(super) fn path(&self) -> Option<&[String]> {
        match &self.meaning {
            Meaning::Setting(setting) => Some(setting.path()),
            Meaning::Scenario(_) => None,
        }
    }
}

/// The content of an object, independent of the order of its keys.
pub(super) fn said(choices: &[Choice]) -> BTreeSet<(Option<&[String]>, String)> {
    let said = choices.iter();
    said.map(|choice| (choice.path(), choice.value.to_string()))
        .collect()
}

/// The settings of an object at `place`. Given a root, a scenario may be among them.
pub(super) fn choices(
    entries: &Entries,
    place: &str,
    root: Option<&Written>,
) -> Result<Vec<Choice>, Problem> {
    let mut choices: Vec<Choice> = Vec::new();
    for (key, value) in &entries.0 {
        let choice = choice(key, value, [place, &format!("{place}.{key}")], root)?;
        if let Some(other) = choices.iter().find(|other| other.path() == choice.path()) {
            let reason = format!("is the same as {}", shown(&other.key));
            return Err(Problem::new(choice.place, reason));
        }
        choices.push(choice);
    }
    Ok(choices)
}

/// A key of the grid with its values.
pub(super) fn axis(key: &str, values: &Value, root: &Written) -> Result<Vec<Choice>, Problem> {
    let place = format!("grid.{key}");
    let Some(values) = values.as_array() else {
        return Err(Problem::new(place, "must be a list of values"));
    };
    if values.is_empty() {
        return Err(Problem::new(place, "must not be empty"));
    }
    if values.len() > MOST_CELLS {
        let count = values.len();
        let reason = format!("has {count} values; at most {MOST_CELLS} cells are allowed");
        return Err(Problem::new(place, reason));
    }
    let mut seen = HashSet::new();
    let again = |value: &Value| !seen.insert(value.to_string());
    if let Some(k) = values.iter().position(again) {
        let reason = format!("{} is given twice", short(&values[k]));
        return Err(Problem::new(format!("{place}[{k}]"), reason));
    }
    let value = |(k, value)| choice(key, value, ["grid", &format!("{place}[{k}]")], Some(root));
    values.iter().enumerate().map(value).collect()
}

/// A key with its value. `inside` is the place of the object, `place` that of the key.
fn choice(
    key: &str,
    value: &Value,
    [inside, place]: [&str; 2],
    root: Option<&Written>,
) -> Result<Choice, Problem> {
    let meaning = match (root, value) {
        (Some(root), Value::String(name)) if key == SCENARIO => {
            Meaning::Scenario(source(name, place, root)?)
        }
        (Some(_), _) if key == SCENARIO => {
            return Err(Problem::new(
                place,
                "must be the name of a scenario, or a file",
            ));
        }
        (None, _) if key == SCENARIO => {
            return Err(Problem::new(place, "belongs at the top of the study"));
        }
        _ => {
            let text = format!("{}={}", shown(place), short(value));
            let setting = Setting::new(key, value.clone(), text);
            Meaning::Setting(setting.map_err(|error| Problem::new(inside, error.to_string()))?)
        }
    };
    Ok(Choice {
        key: key.to_owned(),
        value: value.clone(),
        place: place.to_owned(),
        meaning,
    })
}

/// A shipped scenario by its name, or a file.
pub(crate) fn source(name: &str, place: &str, root: &Written) -> Result<Source, Problem> {
    if let Some(shipped) = Source::shipped(name) {
        return Ok(shipped);
    }
    let path = match root.scenario(name) {
        Ok(found) => return Ok(found),
        Err(path) => path,
    };
    let known = SHIPPED.map(|shipped| shipped.name);
    let reason = format!(
        "no scenario is called `{}` (there are {}), and there is no file {}{}",
        shown(name),
        known.join(", "),
        shown(&path.display().to_string()),
        suggestion(name, known),
    );
    Err(Problem::new(place, reason))
}

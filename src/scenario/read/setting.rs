//! `--set key=value`: a change to a scenario's document.

use std::str::FromStr;

use serde_json::{Value, json};

use crate::error::quote::shown;
use crate::error::{Problem, ScenarioError, suggestion};
use crate::file::listed::{is_parameter, is_setting, is_text, may_be_empty, settings};
use crate::read::document::rename_last;

/// A change: `viscosity=5`, `seed=7`, `profile=sf`, `sources.0.rows=50`.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Its name in messages: `--set viscosity=5`.
    text: String,
    path: Vec<String>,
    value: Value,
}

/// Why a text is not a setting.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SettingError {
    /// There is no `=`.
    #[error("a setting has the form key=value")]
    NoValue,
    /// The key is unknown.
    #[error(
        "unknown setting `{}`{suggestion} (`sandbox list --settings` shows them all)",
        shown(key)
    )]
    UnknownKey {
        /// The key as given.
        key: String,
        /// "; did you mean …?", or empty.
        suggestion: String,
    },
}

impl FromStr for Setting {
    type Err = SettingError;

    /// Reads the value as JSON, or as text if it is not JSON.
    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (key, value) = text.split_once('=').ok_or(SettingError::NoValue)?;
        let key = &key.trim().replace('[', ".").replace(']', "");
        let as_json = serde_json::from_str(value).ok().filter(|_| !is_text(key));
        let value = as_json.unwrap_or_else(|| Value::from(value.trim()));
        Self::new(key, value, format!("--set {}", shown(text)))
    }
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl Setting {
    /// Sets a key such as `sources.0.rows` to a value; messages call it `text`.
    ///
    /// # Errors
    /// The top-level key is unknown.
    pub fn new(key: &str, value: Value, text: String) -> Result<Self, SettingError> {
        let mut path: Vec<String> = key.split('.').map(str::to_owned).collect();
        rename_last(&mut path);
        if !is_setting(&path[0]) {
            let known = settings();
            return Err(SettingError::UnknownKey {
                key: path[0].clone(),
                suggestion: suggestion(&path[0], known.iter().map(|doc| doc.key)),
            });
        }
        if is_parameter(&path[0]) {
            path.insert(0, "parameters".to_owned());
        }
        Ok(Self { text, path, value })
    }

    /// The path in the document: `["parameters", "viscosity"]`.
    pub fn path(&self) -> &[String] {
        &self.path
    }

    /// The value that it sets.
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// The value at its path in a document.
    pub fn value_in<'a>(&self, document: &'a Value) -> Option<&'a Value> {
        self.path
            .iter()
            .try_fold(document, |outer, segment| match outer {
                Value::Array(list) => list.get(segment.parse::<usize>().ok()?),
                outer => outer.get(segment),
            })
    }

    /// Its name in titles: `viscosity=5`, `seed 5`.
    pub fn brief(&self) -> String {
        let text = self.text.strip_prefix("--set ").unwrap_or(&self.text);
        text.trim_start_matches("--").to_owned()
    }

    /// The same setting under another name in messages: `--seed 5`.
    #[must_use]
    pub fn typed_as(self, text: String) -> Self {
        Self { text, ..self }
    }

    /// Sets a top-level key; messages call it `text`.
    pub fn of(key: &str, value: Value, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            path: vec![key.to_owned()],
            value,
        }
    }

    /// The error for a problem at or below the changed value.
    pub fn refused(&self, problem: Problem) -> ScenarioError {
        ScenarioError::Setting {
            setting: self.to_string(),
            problem,
        }
    }

    /// Changes `document` and returns the path of the changed value, as in `sources[0].rows`.
    pub fn apply(&self, document: &mut Value) -> Result<String, Problem> {
        let mut place = document;
        let mut path = String::new();
        for (depth, segment) in self.path.iter().enumerate() {
            let begun = match self.path.get(depth + 1) {
                None => Some(Value::Null),
                Some(next) if next == APPEND => Some(json!([])),
                Some(_) => (depth == 0 && may_be_empty(segment)).then(|| json!({})),
            };
            let added = place.as_array().map_or(0, Vec::len);
            place = inner(place, segment, begun, &path)?;
            path = match segment.parse::<usize>() {
                Ok(index) => format!("{path}[{index}]"),
                Err(_) if segment == APPEND => format!("{path}[{added}]"),
                Err(_) if path.is_empty() => segment.clone(),
                Err(_) => format!("{path}.{segment}"),
            };
        }
        *place = self.value.clone();
        Ok(path)
    }
}

/// The segment of a path that adds an element to a list, as in `measurements.+`.
const APPEND: &str = "+";

/// The element `segment` of the value at `path`; an object that lacks it gets `begun` first.
fn inner<'a>(
    outer: &'a mut Value,
    segment: &str,
    begun: Option<Value>,
    path: &str,
) -> Result<&'a mut Value, Problem> {
    let (found, reason) = match outer {
        Value::Object(object) => {
            if let Some(begun) = begun {
                object.entry(segment).or_insert(begun);
            }
            let whole = if path.is_empty() { "the file" } else { path };
            (
                object.get_mut(segment),
                format!("{} has no `{}`", shown(whole), shown(segment)),
            )
        }
        Value::Array(list) => {
            if segment == APPEND {
                list.push(Value::Null);
            }
            let last = list.len().checked_sub(1).filter(|_| segment == APPEND);
            let reason = format!(
                "{} has no element `{}`: there are {}, counted from 0",
                shown(path),
                shown(segment),
                list.len()
            );
            let index = last.or_else(|| segment.parse::<usize>().ok());
            (index.and_then(|index| list.get_mut(index)), reason)
        }
        _ => (
            None,
            format!("{} is neither an object nor a list", shown(path)),
        ),
    };
    found.ok_or_else(|| Problem::new("", reason))
}

//! The fields of a scenario of the web app, with their places.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use serde_json::{Map, Value};

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::keys::limits::FARTHEST;
use engine::geometry::Ring;
use engine::math::Vector;

/// What has no counterpart here, for readers of the results.
#[derive(Debug, Default)]
pub struct Notes {
    notes: Vec<String>,
    /// Unknown keys; ids of elements are `*`.
    unknown: BTreeSet<String>,
}

impl Notes {
    pub fn add(&mut self, note: impl Into<String>) {
        let note = note.into();
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    pub fn into_list(mut self) -> Vec<String> {
        if !self.unknown.is_empty() {
            let keys: Vec<String> = self.unknown.iter().map(|key| shown(key)).collect();
            self.notes
                .push(format!("unknown keys have no effect: {}", keys.join(", ")));
        }
        self.notes
    }
}

/// An object, and where it is.
#[derive(Debug, Clone)]
pub struct Object<'a> {
    map: &'a Map<String, Value>,
    path: String,
    /// The path with `*` in place of ids.
    pattern: String,
}

impl<'a> Object<'a> {
    /// A whole document.
    pub fn root(document: &'a Value) -> Result<Self, Problem> {
        let map = document.as_object();
        Ok(Self {
            map: map.ok_or_else(|| Problem::new("", "must be an object"))?,
            path: String::new(),
            pattern: String::new(),
        })
    }

    /// A problem with the value of a key.
    pub fn problem(&self, key: &str, reason: impl Into<String>) -> Problem {
        Problem::new(joined(&self.path, key), reason)
    }

    /// The value of a key; `None` if it is missing or `null`.
    pub fn get(&self, key: &str) -> Option<&'a Value> {
        self.map.get(key).filter(|value| !value.is_null())
    }

    /// Whether a key has a value that says something.
    pub fn says(&self, key: &str) -> bool {
        match self.get(key) {
            Some(Value::Array(list)) => !list.is_empty(),
            Some(Value::Object(map)) => !map.is_empty(),
            value => value.is_some(),
        }
    }

    /// A number from `least` on.
    pub fn number(&self, key: &str, least: f64) -> Result<Option<f64>, Problem> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let number = value.as_f64().filter(|number| *number >= least);
        let wrong = || {
            let given = shown(&value.to_string());
            self.problem(
                key,
                format!("must be a number of at least {least}, not {given}"),
            )
        };
        number.map(Some).ok_or_else(wrong)
    }

    /// A whole number from 0 on.
    pub fn whole(&self, key: &str) -> Result<Option<u64>, Problem> {
        let number = self.number(key, 0.0)?;
        match number {
            Some(number) if number.fract() != 0.0 || number > 1e15 => {
                Err(self.problem(key, format!("must be a whole number, not {number}")))
            }
            number => Ok(number.map(|number| number as u64)),
        }
    }

    /// A text.
    pub fn word(&self, key: &str) -> Result<Option<&'a str>, Problem> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let wrong = || {
            self.problem(
                key,
                format!("must be a text, not {}", shown(&value.to_string())),
            )
        };
        value.as_str().map(Some).ok_or_else(wrong)
    }

    /// Whether a key is true; the web app writes some as texts.
    pub fn flag(&self, key: &str) -> bool {
        match self.get(key) {
            Some(Value::Bool(flag)) => *flag,
            Some(Value::String(text)) => {
                ["true", "1", "yes", "on"].contains(&text.trim().to_lowercase().as_str())
            }
            Some(Value::Number(number)) => number.as_f64() != Some(0.0),
            _ => false,
        }
    }

    /// The object under a key.
    pub fn object(&self, key: &str) -> Result<Option<Self>, Problem> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let map = value
            .as_object()
            .ok_or_else(|| self.problem(key, "must be an object"))?;
        Ok(Some(Self {
            map,
            path: joined(&self.path, key),
            pattern: joined(&self.pattern, key),
        }))
    }

    /// The object under a key, or one without keys.
    pub fn object_or_empty(&self, key: &str) -> Result<Self, Problem> {
        static EMPTY: OnceLock<Map<String, Value>> = OnceLock::new();
        let found = self.object(key)?;
        Ok(found.unwrap_or_else(|| Self {
            map: EMPTY.get_or_init(Map::new),
            path: joined(&self.path, key),
            pattern: joined(&self.pattern, key),
        }))
    }

    /// The objects in the object under a key, with their ids in the order of their numbers.
    pub fn elements(&self, key: &str) -> Result<Vec<(&'a str, Self)>, Problem> {
        let Some(parent) = self.object(key)? else {
            return Ok(Vec::new());
        };
        let element = |id: &'a String| -> Result<(&'a str, Self), Problem> {
            let mut found = parent
                .object(id)?
                .ok_or_else(|| parent.problem(id, "must be an object"))?;
            found.pattern = joined(&parent.pattern, "*");
            Ok((id.as_str(), found))
        };
        let mut elements = parent
            .map
            .keys()
            .map(element)
            .collect::<Result<Vec<_>, _>>()?;
        elements.sort_by_key(|(id, _)| numbered(id));
        Ok(elements)
    }

    /// The objects in the list under a key.
    pub fn list(&self, key: &str) -> Result<Vec<Self>, Problem> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let list = value
            .as_array()
            .ok_or_else(|| self.problem(key, "must be a list"))?;
        let element = |(k, value): (usize, &'a Value)| -> Result<Self, Problem> {
            let path = joined(&self.path, &format!("{key}[{k}]"));
            let map = value.as_object();
            Ok(Self {
                map: map.ok_or_else(|| Problem::new(&path, "must be an object"))?,
                path,
                pattern: joined(&self.pattern, &format!("{key}[*]")),
            })
        };
        list.iter().enumerate().map(element).collect()
    }

    /// The texts in the list under a key.
    pub fn words(&self, key: &str) -> Result<Vec<&'a str>, Problem> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let words: Option<Option<Vec<&str>>> = value
            .as_array()
            .map(|list| list.iter().map(Value::as_str).collect());
        words
            .flatten()
            .ok_or_else(|| self.problem(key, "must be a list of ids"))
    }

    /// The polygon under `coordinates`. It may repeat points.
    pub fn polygon(&self) -> Result<Ring, Problem> {
        const KEY: &str = "coordinates";
        let wrong = |k: usize| {
            let reason =
                format!("must be a point [x, y] in meters, between -{FARTHEST} and {FARTHEST}");
            self.problem(&format!("{KEY}[{k}]"), reason)
        };
        let list = self
            .get(KEY)
            .and_then(Value::as_array)
            .ok_or_else(|| self.problem(KEY, "needs a list of points [x, y]"))?;
        let mut points: Vec<Vector> = Vec::with_capacity(list.len());
        for (k, value) in list.iter().enumerate() {
            let numbers = [0, 1].map(|axis| value[axis].as_f64());
            let [Some(x), Some(y)] = numbers.map(|x| x.filter(|x| x.abs() <= FARTHEST)) else {
                return Err(wrong(k));
            };
            let point = Vector::new(x, y);
            if points.last() != Some(&point) {
                points.push(point);
            }
        }
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let ring = Ring::new(points).map_err(Problem::from);
        ring.under(&joined(&self.path, KEY))
    }

    /// Notes the keys that are not among `known`. Keys that begin with `_` are comments.
    pub fn note_unknown(&self, known: &[&str], notes: &mut Notes) {
        let others = self.map.keys().filter(|key| !known.contains(&key.as_str()));
        let unknown = others.filter(|key| !key.starts_with('_'));
        notes
            .unknown
            .extend(unknown.map(|key| joined(&self.pattern, key)));
    }
}

fn joined(path: &str, key: &str) -> String {
    match path.is_empty() {
        true => key.to_owned(),
        false => format!("{path}.{key}"),
    }
}

/// An id with the number at its end, by which `id_10` comes after `id_9`.
fn numbered(id: &str) -> (String, u64, String) {
    let digits = id.chars().rev().take_while(char::is_ascii_digit).count();
    let (name, number) = id.split_at(id.len() - digits);
    (name.to_owned(), number.parse().unwrap_or(0), id.to_owned())
}

//! One cell of a study: a case with its place in the study.

use std::fmt;

use serde_json::Value;

use runs::case::Case;
use scenario::quote::shown;

/// One run of a study.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Its number in the study; the first is 1.
    pub number: usize,
    /// The varied settings: names and values, without the seeds. The first is the label, if there is one.
    pub values: Vec<(String, Value)>,
    /// The run.
    pub case: Case,
}

/// Studies with more cells are rejected as mistakes.
pub(super) const MOST_CELLS: usize = 100_000;

/// The key of a list's entry that names it in tables.
pub(super) const LABEL: &str = "label";

impl Cell {
    /// The label of its entry in the study's list.
    pub fn label(&self) -> Option<&str> {
        self.value(LABEL)?.as_str()
    }

    /// The varied settings without the label.
    pub fn settings(&self) -> impl Iterator<Item = &(String, Value)> {
        self.values.iter().filter(|(key, _)| key != LABEL)
    }

    /// The value of a varied setting.
    pub fn value(&self, key: &str) -> Option<&Value> {
        let mut values = self.values.iter();
        values.find(|(name, _)| name == key).map(|(_, value)| value)
    }
}

/// The number, and the settings that distinguish the cell from others.
impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "cell {}:", self.number)?;
        for (name, value) in &self.values {
            match name.as_str() {
                LABEL => write!(f, " {}", short(value))?,
                name => write!(f, " {}={}", shown(name), short(value))?,
            }
        }
        if self.values.iter().all(|(name, _)| name != "seed") {
            write!(f, " seed={}", self.case.seed)?;
        }
        Ok(())
    }
}

/// A value as in `--set key=value`: text without quotes.
pub(crate) fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// The same, shortened for messages.
pub(super) fn short(value: &Value) -> String {
    shown(&plain(value))
}

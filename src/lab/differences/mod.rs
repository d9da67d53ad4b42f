//! The differences between two results: two runs as `--json` reports them, or two trajectory files.

mod reports;
mod tracks;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::error::LabError;
use output::document::{Block, Document, Findings, Names};
use output::table::Table;

pub use reports::{NotAReport, of_reports};
pub use tracks::of_tracks;

/// The name of the files.
const NAME: &str = "comparison";

/// The names of the files with a comparison.
pub fn names() -> Names {
    Names::new(NAME, &[NAME], &[])
}

/// The most differences of a kind that are printed.
const MOST: usize = 40;

/// A value that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// Its name: the path of a setting, a measurement, a quantity with its unit.
    pub name: String,
    /// Its value in the first result; `null` if it is missing there.
    pub a: Value,
    /// Its value in the second result; `null` if it is missing there.
    pub b: Value,
}

/// The differences between two results A and B.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Differences {
    /// Settings; empty for trajectories.
    pub settings: Vec<Difference>,
    /// Measurements and other results.
    pub results: Vec<Difference>,
    /// The number of results that are equal.
    pub equal: usize,
    /// What was not compared; empty for runs.
    pub about: String,
}

impl Difference {
    /// B − A, if both are quantities: numbers that are no seeds and no ids.
    pub fn change(&self) -> Option<f64> {
        /// The ends of the names of seeds and ids.
        const LABELS: [&str; 3] = ["seed", ".agent", ".id"];
        let is_label = LABELS.iter().any(|end| self.name.ends_with(end));
        let [a, b] = [&self.a, &self.b].map(|value| value.as_f64().filter(|_| !is_label));
        Some(b? - a?)
    }

    /// The change in percent of A, if both are quantities and A is not 0.
    pub fn percent(&self) -> Option<f64> {
        let a = self.a.as_f64().filter(|&a| a != 0.0)?;
        Some(100.0 * self.change()? / a.abs())
    }
}

impl Differences {
    /// The differences of two objects, key by key.
    fn add_results(&mut self, a: &Map<String, Value>, b: &Map<String, Value>) {
        let (differ, equal) = different(a, b);
        self.results.extend(differ);
        self.equal += equal;
    }

    /// Everything for readers and programs. The table for programs has all differences.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let mut blocks = Vec::new();
        if !self.settings.is_empty() {
            let table = Table::of(shown(&self.settings))
                .column("setting", |one| one.name.as_str())
                .column("A", |one| brief(&one.a))
                .column("B", |one| brief(&one.b));
            blocks.push(Block::table(table.table()));
            blocks.push(Block::Text(more(&self.settings)));
        }
        if !self.results.is_empty() {
            let table = Table::of(shown(&self.results))
                .column("result", |one| one.name.as_str())
                .column("A", |one| brief(&one.a))
                .column("B", |one| brief(&one.b))
                .column("B − A", |one| one.change().map(rounded))
                .fixed("%", 1, Difference::percent);
            blocks.push(Block::table(table.table()));
            blocks.push(Block::Text(more(&self.results)));
        }
        let (differ, equal) = (self.results.len(), self.equal);
        let counts = format!("{differ} result(s) differ, {equal} are equal");
        blocks.push(Block::Text(format!("{counts}\n{}", self.about)));
        let document = Document::of("Comparison of two results", blocks);
        let all: Vec<&Difference> = self.settings.iter().chain(&self.results).collect();
        let table = Table::of(&all)
            .column("name", |one| one.name.as_str())
            .column("a", |one| whole(&one.a))
            .column("b", |one| whole(&one.b))
            .column("change", |one| one.change())
            .column("percent", |one| one.percent());
        Ok(Findings::new(NAME, document, self.json()).with_table(NAME, &table.table())?)
    }

    /// As one JSON object; its numbers have the change, too.
    fn json(&self) -> Value {
        let entry = |one: &Difference| {
            let mut entry = json!(one);
            entry["change"] = json!(one.change());
            entry["percent"] = json!(one.percent());
            entry
        };
        json!({
            "settings": self.settings,
            "results": self.results.iter().map(entry).collect::<Vec<_>>(),
            "equal_results": self.equal,
            "about": self.about,
        })
    }
}

/// The values that differ between two objects, and the number of values that are equal. Objects and lists inside are
/// compared value by value; entries of lists come last, because there may be many.
fn different(a: &Map<String, Value>, b: &Map<String, Value>) -> (Vec<Difference>, usize) {
    let [a, b] = [a, b].map(|values| {
        let mut all = Map::new();
        for (key, value) in values {
            flatten(key, value, &mut all);
        }
        all
    });
    let missing = b.keys().filter(|key| !a.contains_key(*key));
    let names = a.keys().chain(missing);
    let value = |of: &Map<String, Value>, name: &String| of.get(name).cloned().unwrap_or_default();
    let all = names.map(|name| Difference {
        name: name.clone(),
        a: value(&a, name),
        b: value(&b, name),
    });
    let (equal, mut differ): (Vec<_>, Vec<_>) = all.partition(|one| are_equal(&one.a, &one.b));
    differ.sort_by_key(|one| one.name.contains('['));
    (differ, equal.len())
}

/// Decimal numbers whose relative difference is smaller are equal: it comes from rounding.
const ROUNDING: f64 = 1e-12;

/// Whether two values are equal, up to rounding; 5 and 5.0 are. Whole numbers are compared digit by digit: floats do
/// not hold all seeds.
fn are_equal(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| are_equal(a, b))
        }
        (Value::Number(one), Value::Number(other)) if one.is_f64() || other.is_f64() => {
            let [one, other] = [one, other].map(|number| number.as_f64().unwrap_or(f64::NAN));
            one == other || (one - other).abs() <= ROUNDING * one.abs().max(other.abs())
        }
        _ => a == b,
    }
}

/// Adds the values in `value` by their paths, as in `sources[0].rows`.
fn flatten(path: &str, value: &Value, all: &mut Map<String, Value>) {
    match value {
        Value::Object(object) if !object.is_empty() => {
            for (key, value) in object {
                flatten(&format!("{path}.{key}"), value, all);
            }
        }
        Value::Array(list) if list.iter().any(|item| item.is_object() || item.is_array()) => {
            for (k, value) in list.iter().enumerate() {
                flatten(&format!("{path}[{k}]"), value, all);
            }
        }
        value => {
            all.insert(path.to_owned(), value.clone());
        }
    }
}

fn shown(all: &[Difference]) -> &[Difference] {
    &all[..all.len().min(MOST)]
}

fn more(all: &[Difference]) -> String {
    match all.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!("… and {more} more; --json lists them all"),
    }
}

/// A value for programs.
fn whole(value: &Value) -> Option<String> {
    match value {
        Value::Null => None,
        Value::String(text) => Some(text.clone()),
        other => Some(other.to_string()),
    }
}

/// A value for a terminal: long texts are cut, numbers have six digits.
fn brief(value: &Value) -> String {
    /// The most characters of a value.
    const WIDTH: usize = 32;
    let text = match value {
        Value::Null => return "–".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) if !number.is_i64() && !number.is_u64() => {
            rounded(number.as_f64().unwrap_or(f64::NAN))
        }
        other => other.to_string(),
    };
    match text.chars().count() {
        ..=WIDTH => text,
        _ => text.chars().take(WIDTH - 1).chain(['…']).collect(),
    }
}

/// A number with at most six significant digits.
fn rounded(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    rounded.to_string()
}

//! `sandbox list`: the scenarios and profiles, or the settings that `--set` takes. `sandbox schema`: the JSON Schema.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::failure::Failure;
use super::terminal::{say, tell};
use crate::scenario::catalog::{ABOUT, NAMES};
use crate::scenario::{self, SHIPPED, SettingDoc, Shipped, calibrated, nested_settings, settings};

/// Most characters in a line beside a name.
const WIDTH: usize = 80;

pub fn run(list_settings: bool, as_json: bool) -> Result<(), Failure> {
    match list_settings {
        true => tell(as_json, all_settings, settings_text),
        false => tell(as_json, overview, overview_text),
    }
}

/// A name and what it is.
struct Entry {
    name: &'static str,
    about: String,
}

/// The built-in scenarios.
fn scenarios() -> Vec<Entry> {
    let entry = |scenario: Shipped| Entry {
        name: scenario.name,
        about: scenario.description(),
    };
    SHIPPED.into_iter().map(entry).collect()
}

/// The profiles of the paper, and the calibrated ones.
fn profiles() -> [Vec<Entry>; 2] {
    let entry = |(name, about): (&'static str, &str)| Entry {
        name,
        about: about.to_owned(),
    };
    let calibrated = calibrated::all().iter();
    [
        NAMES.into_iter().zip(ABOUT).map(entry).collect(),
        calibrated
            .map(|profile| entry((profile.name, profile.about)))
            .collect(),
    ]
}

fn overview() -> Value {
    let list = |entries: Vec<Entry>| -> Value {
        let entry = |Entry { name, about }| json!({"name": name, "description": about});
        entries.into_iter().map(entry).collect()
    };
    let [paper, calibrated] = profiles();
    json!({
        "scenarios": list(scenarios()),
        "profiles": { "paper": list(paper), "calibrated": list(calibrated) },
    })
}

fn overview_text() -> String {
    let list = |head: &str, entries: Vec<Entry>| {
        let lines = entries.iter();
        let lines: String = lines
            .map(|Entry { name, about }| entry(name, 0, about))
            .collect();
        format!("{head}\n{lines}")
    };
    let [paper, calibrated] = profiles();
    [
        list("Scenarios (sandbox NAME)", scenarios()),
        list(
            "Profiles of the paper (--profile NAME; quote the arrow, or write sf-sph)",
            paper,
        ),
        list(
            "Profiles fitted to experiments (docs/validation.md)",
            calibrated,
        ),
    ]
    .join("\n")
}

fn all_settings() -> Value {
    let setting = |doc: SettingDoc| {
        json!({
            "key": doc.key, "description": doc.description, "default": doc.default, "range": doc.range,
        })
    };
    json!({
        "settings": settings().into_iter().map(setting).collect::<Vec<_>>(),
        "nested": nested_settings().into_iter().collect::<BTreeMap<_, _>>(),
    })
}

fn settings_text() -> String {
    let mut text = String::new();
    for setting in settings() {
        let default = setting
            .default
            .map(|default| format!("default: {default}; "));
        let values = format!("{}{}", default.unwrap_or_default(), setting.range);
        text += &entry(setting.key, 0, setting.description);
        text += &entry("", 2, &values);
    }
    text += "\nKeys of nested objects (? = optional; `sandbox schema` describes them):\n";
    for (path, keys) in nested_settings() {
        text += &entry(&path, 0, &keys);
    }
    text + "\nA dotted path sets a value inside a list or object: --set sources.0.rows=50\n\
            Parameters set this way apply to all profiles of the scenario.\n"
}

/// `sandbox schema`.
pub fn schema() -> Result<(), Failure> {
    say(format!("{:#}\n", scenario::schema()))
}

/// A name with a text beside it, broken into lines that are indented by `indent` spaces.
fn entry(name: &str, indent: usize, text: &str) -> String {
    let indent = " ".repeat(indent);
    let mut lines = vec![indent.clone()];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < WIDTH => {
                *line += word;
                *line += " ";
            }
            _ => lines.push(format!("{indent}{word} ")),
        }
    }
    let names = std::iter::once(name).chain(std::iter::repeat(""));
    let lines = names.zip(lines.iter().map(|line| line.trim_end()));
    lines
        .map(|(name, line)| format!("{name:<20} {line}\n"))
        .collect()
}

//! `sandbox list`: the scenarios and profiles, or the settings that `--set` takes. `sandbox schema`: the JSON Schema.

use super::{Failure, say};
use crate::scenario::catalog::NAMES;
use crate::scenario::{self, SHIPPED, calibrated, nested_settings, settings};

/// Most characters in a line beside a name.
const WIDTH: usize = 80;

pub fn run(list_settings: bool) -> Result<(), Failure> {
    let mut text = String::new();
    if list_settings {
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
        text += "\nA dotted path sets a value inside a list or object: --set sources.0.rows=50\n\
                 Parameters set this way apply to all profiles of the scenario.\n";
    } else {
        for scenario in SHIPPED {
            text += &format!("{:<12} {}\n", scenario.name, scenario.description());
        }
        text += &format!("\nprofiles of the paper: {}\n", NAMES.join(", "));
        for profile in calibrated::all() {
            text += &entry(profile.name, 0, profile.about);
        }
    }
    say(text)
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

//! `sandbox list`: the scenarios and profiles, or the settings that `--set` takes. `sandbox schema`: the JSON Schema.

use super::{Failure, say};
use crate::scenario::catalog::NAMES;
use crate::scenario::{self, SHIPPED, nested_settings, settings};

/// Most characters in a line of descriptions.
const WIDTH: usize = 100;

pub fn run(list_settings: bool) -> Result<(), Failure> {
    let mut text = String::new();
    if list_settings {
        for setting in settings() {
            let default = setting
                .default
                .map(|default| format!("default: {default}; "));
            let values = format!("  {}{}", default.unwrap_or_default(), setting.range);
            text += &entry(setting.key, &[setting.description, &values]);
        }
        text += "\nKeys of nested objects (? = optional; `sandbox schema` describes them):\n";
        for (path, keys) in nested_settings() {
            text += &entry(&path, &[&keys]);
        }
        text += "\nA dotted path sets a value inside a list or object: --set sources.0.rows=50\n\
                 Parameters set this way apply to all profiles of the scenario.\n";
    } else {
        for scenario in SHIPPED {
            text += &format!("{:<12} {}\n", scenario.name, scenario.description());
        }
        text += &format!("\nprofiles: {}\n", NAMES.join(", "));
    }
    say(text)
}

/// `sandbox schema`.
pub fn schema() -> Result<(), Failure> {
    say(format!("{:#}\n", scenario::schema()))
}

/// A name with paragraphs beside it, broken into lines.
fn entry(name: &str, paragraphs: &[&str]) -> String {
    let mut text = String::new();
    let mut name = name;
    for paragraph in paragraphs {
        let mut line = String::new();
        for word in paragraph.split(' ') {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH - 21 {
                text += &format!("{name:<20} {line}\n");
                name = "";
                line.clear();
            }
            line += if line.is_empty() { "" } else { " " };
            line += word;
        }
        text += &format!("{name:<20} {line}\n");
        name = "";
    }
    text
}

//! `sandbox list`: the scenarios and profiles, or the settings that `--set` takes. `sandbox schema`: the JSON Schema.

use super::{Failure, say};
use crate::scenario::catalog::NAMES;
use crate::scenario::{self, NESTED, SHIPPED, settings};

pub fn run(list_settings: bool) -> Result<(), Failure> {
    let mut text = String::new();
    if list_settings {
        for setting in settings() {
            text += &format!(
                "{:<20} {}{}\n{:20}   default: {}; {}\n",
                setting.key,
                setting.description,
                unit(setting.unit),
                "",
                setting.default,
                setting.range,
            );
        }
        text += "\nKeys of nested objects (meters, seconds; ? = optional):\n";
        for (list, keys) in NESTED {
            text += &format!("{list:<20} {keys}\n");
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

/// A unit in brackets.
fn unit(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" [{unit}]")
    }
}

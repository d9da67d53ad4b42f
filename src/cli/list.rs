//! `sandbox list`: the scenarios, or what `--set` takes.

use super::Failure;
use crate::scenario::{SHIPPED, settings};

pub fn run(list_settings: bool) -> Result<(), Failure> {
    if list_settings {
        for setting in settings() {
            println!(
                "{:<20} {:<8} default {:<12} {:<14} {}",
                setting.key, setting.unit, setting.default, setting.range, setting.description
            );
        }
        println!(
            "\nA dotted path reaches into the scenario's own lists: --set sources.0.rows=50\n\
             Parameters of profiles apply to every profile of the scenario."
        );
    } else {
        for scenario in SHIPPED {
            println!("{:<12} {}", scenario.name, scenario.description());
        }
    }
    Ok(())
}

//! `sandbox accuracy`: run time against error.

use super::arguments::AccuracyOptions;
use super::update::{check, update};
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::accuracy::{KNOBS, Knob, Plan, SCENES, Scene, accuracy};
use crate::reproduce::Store;

/// The scenes with a line about each.
pub fn about() -> String {
    let lines = SCENES.iter();
    lines
        .map(|scene| format!("  {:<18} {}\n", scene.name, scene.about))
        .collect()
}

/// What `--knob` takes.
pub fn knobs() -> Vec<&'static str> {
    KNOBS.iter().map(|(name, _)| *name).collect()
}

/// What can be asked for.
pub fn scenes() -> Vec<&'static str> {
    SCENES.iter().map(|scene| scene.name).collect()
}

pub fn run(options: &AccuracyOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    if let Some(file) = &options.update {
        check(file)?;
    }
    let store = Store::open(&options.out)?;
    let wanted =
        |scene: &&Scene| options.scene.is_empty() || options.scene.iter().any(|s| s == scene.name);
    let turned = |(name, _): &&(&str, Knob)| {
        options.knob.is_empty() || options.knob.iter().any(|k| k == name)
    };
    let plan = Plan {
        scenes: SCENES.iter().filter(wanted).copied().collect(),
        knobs: KNOBS.iter().filter(turned).map(|(_, knob)| *knob).collect(),
        quick: options.quick,
    };
    let watch = Watch::new();
    let report = accuracy(&plan, &store, &watch);
    watch.ends();
    let report = report?;
    if let Some(file) = &options.update {
        let parts = report.parts();
        let texts = parts
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()));
        update(file, texts)?;
    }
    if options.json {
        say(&format!("{}\n", report.json()))
    } else {
        say(&report.text())
    }
}

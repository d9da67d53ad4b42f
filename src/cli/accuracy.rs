//! `sandbox accuracy`: work-precision measurements.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::update::{check, update};
use super::values::threads;
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::lab::accuracy::{Plan, SCENES, Scene, WALLS, accuracy, knobs};
use crate::runs::store::Store;

#[derive(Args)]
pub struct AccuracyOptions {
    /// Scenes to measure [default: all]
    #[arg(value_parser = PossibleValuesParser::new(scenes()))]
    pub scene: Vec<String>,
    /// Numerical choice to vary; may be repeated [default: all that matter in the scene]
    #[arg(long, value_name = "KNOB", value_parser = PossibleValuesParser::new(knobs()))]
    pub knob: Vec<String>,
    /// Few values, seeds and repeats; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    /// Folder for the results; runs finished there are not repeated
    #[arg(long, value_name = "DIR", default_value = "accuracy")]
    pub out: PathBuf,
    /// Also insert the tables into this file, between the lines <!-- NAME --> and <!-- /NAME -->
    #[arg(long, value_name = "FILE.md")]
    pub update: Option<PathBuf>,
    /// Number of runs to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// All scenes, each with a line about it.
pub fn about() -> String {
    let walls = "density and force of five ways to treat walls, compared with the exact integrals";
    let lines = SCENES.iter().map(|scene| (scene.name, scene.about()));
    lines
        .chain([(WALLS, walls)])
        .map(|(name, about)| format!("  {name:<18} {about}\n"))
        .collect()
}

/// The names of all scenes.
pub fn scenes() -> Vec<&'static str> {
    let names = SCENES.iter().map(|scene| scene.name);
    names.chain([WALLS]).collect()
}

pub fn run(options: &AccuracyOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    if let Some(file) = &options.update {
        check(file, &options.out)?;
    }
    let store = Store::open(&options.out)?;
    let wanted = |name: &str| options.scene.is_empty() || options.scene.iter().any(|s| s == name);
    let in_time = |scene: &Scene| !(options.quick && scene.is_long && options.scene.is_empty());
    let scenes = SCENES
        .iter()
        .filter(|scene| wanted(scene.name) && in_time(scene));
    let plan = Plan {
        scenes: scenes.copied().collect(),
        walls: wanted(WALLS),
        knobs: options.knob.clone(),
        quick: options.quick,
    };
    let watch = Watch::new();
    let report = accuracy(&plan, &store, &watch);
    watch.ends();
    let report = report?;
    // Results are printed even if they cannot be saved.
    let updated = options.update.as_ref().map_or(Ok(()), |file| {
        let parts = report.parts();
        let texts = parts
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()));
        update(file, texts)
    });
    if options.json {
        say(format!("{}\n", report.json()))?;
    } else {
        say(report.text())?;
    }
    updated
}

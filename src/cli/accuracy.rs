//! `sandbox accuracy`: work-precision measurements.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::accuracy::{CHOICES, Plan, SCENES, Scene, accuracy, choices, file_names};

#[derive(Args)]
pub struct AccuracyOptions {
    /// Scenes to measure [default: all]
    #[arg(value_parser = PossibleValuesParser::new(scenes()))]
    pub scene: Vec<String>,
    /// Numerical choice to vary; may be repeated [default: all that matter in the scene]
    #[arg(long, alias = "knob", value_name = "CHOICE", value_parser = PossibleValuesParser::new(choices()))]
    pub choice: Vec<String>,
    /// Few values, seeds and repeats; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    #[command(flatten)]
    pub cases: CaseOptions,
}

/// All scenes, each with a line about it.
pub fn about() -> String {
    let lines = SCENES.iter();
    lines
        .map(|scene| format!("  {:<18} {}\n", scene.name, scene.about()))
        .collect()
}

/// The names of all scenes.
pub fn scenes() -> Vec<&'static str> {
    SCENES.iter().map(|scene| scene.name).collect()
}

pub fn run(options: &AccuracyOptions) -> Result<(), Failure> {
    let wanted = |name: &str| options.scene.is_empty() || options.scene.iter().any(|s| s == name);
    let in_time = |scene: &Scene| !(options.quick && scene.is_long && options.scene.is_empty());
    let chosen = SCENES.iter().filter(|one| wanted(one.name) && in_time(one));
    let plan = Plan {
        scenes: chosen.copied().collect(),
        choices: options.choice.clone(),
        quick: options.quick,
    };
    // The table of choices is of all scenes.
    let updated = |name: &str| name != CHOICES || options.scene.is_empty();
    let scenes = plan.scenes.iter().map(|scene| scene.name);
    let updates = scenes.clone().chain([CHOICES]).filter(|name| updated(name));
    let tables: Vec<&str> = updates.collect();
    let store = options.cases.store(&tables, &file_names(scenes))?;
    let report = accuracy(&plan, &store, &Watch::new())?;
    options.cases.give_parts(&report.findings()?, updated)
}

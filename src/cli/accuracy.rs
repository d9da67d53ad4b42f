//! `sandbox accuracy`: work-precision measurements.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::terminal::tell;
use super::update::CaseOptions;
use super::watch::Watch;
use crate::lab::accuracy::{CHOICES, Plan, SCENES, Scene, accuracy, knobs};
use crate::lab::estimate::{Pool, coverage};

#[derive(Args)]
pub struct AccuracyOptions {
    /// Scenes to measure [default: all]
    #[arg(value_parser = PossibleValuesParser::new(scenes().into_iter().chain([COVERAGE])))]
    pub scene: Vec<String>,
    /// Numerical choice to vary; may be repeated [default: all that matter in the scene]
    #[arg(long, value_name = "KNOB", value_parser = PossibleValuesParser::new(knobs()))]
    pub knob: Vec<String>,
    /// Few values, seeds and repeats; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    #[command(flatten)]
    pub cases: CaseOptions,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// All scenes, each with a line about it.
pub fn about() -> String {
    let lines = SCENES.iter();
    lines
        .map(|scene| (scene.name, scene.about()))
        .chain([(
            COVERAGE,
            "how often the intervals of `sandbox estimate` hold the value (some hours)",
        )])
        .map(|(name, about)| format!("  {name:<18} {about}\n"))
        .collect()
}

/// The names of all scenes.
pub fn scenes() -> Vec<&'static str> {
    SCENES.iter().map(|scene| scene.name).collect()
}

/// The name of the study of `sandbox estimate`, and of its table.
const COVERAGE: &str = "coverage";

/// How often the intervals of `sandbox estimate` hold the value.
fn run_coverage(options: &AccuracyOptions) -> Result<(), Failure> {
    if options.scene.len() > 1 || !options.knob.is_empty() {
        let reason = "coverage is a study of its own: name no scene and no knob beside it";
        return Err(Failure::Input(reason.to_owned()));
    }
    let pool = if options.quick {
        Pool::QUICK
    } else {
        Pool::WHOLE
    };
    let store = options.cases.store(&[COVERAGE])?;
    let found = coverage(pool, &store, &Watch::new())?;
    found.write(&store)?;
    tell(options.json, || found.json(), || found.text())?;
    options.cases.document.put([(COVERAGE, found.markdown())])
}

pub fn run(options: &AccuracyOptions) -> Result<(), Failure> {
    if options.scene.iter().any(|name| name == COVERAGE) {
        return run_coverage(options);
    }
    let wanted = |name: &str| options.scene.is_empty() || options.scene.iter().any(|s| s == name);
    let in_time = |scene: &Scene| !(options.quick && scene.is_long && options.scene.is_empty());
    let scenes = SCENES
        .iter()
        .filter(|scene| wanted(scene.name) && in_time(scene));
    let plan = Plan {
        scenes: scenes.copied().collect(),
        knobs: options.knob.clone(),
        quick: options.quick,
    };
    // The table of choices is of all scenes.
    let updated = |name: &str| name != CHOICES || options.scene.is_empty();
    let scenes = plan.scenes.iter().map(|scene| scene.name);
    let tables = scenes.chain([CHOICES]).filter(|name| updated(name));
    let store = options.cases.store(&tables.collect::<Vec<_>>())?;
    let report = accuracy(&plan, &store, &Watch::new())?;
    let said = tell(options.json, || report.json(), || report.text());
    let parts = report.parts().into_iter();
    options
        .cases
        .document
        .put(parts.filter(|(name, _)| updated(name)))?;
    said
}

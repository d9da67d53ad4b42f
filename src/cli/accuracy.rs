//! `sandbox accuracy`: work-precision measurements.

use clap::builder::PossibleValuesParser;
use clap::{Args, value_parser};

use super::failure::Failure;
use super::terminal::tell;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::accuracy::{CHOICES, Plan, SCENES, Scene, accuracy, knobs};
use lab::estimate::{Pool, coverage, knowledge};

#[derive(Args)]
pub struct AccuracyOptions {
    /// Scenes to measure [default: all]
    #[arg(value_parser = PossibleValuesParser::new(scenes().into_iter().chain(OF_ESTIMATES.map(|(name, _)| name))))]
    pub scene: Vec<String>,
    /// Numerical choice to vary; may be repeated [default: all that matter in the scene]
    #[arg(long, value_name = "KNOB", value_parser = PossibleValuesParser::new(knobs()))]
    pub knob: Vec<String>,
    /// Few values, seeds and repeats; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    /// Number of runs at each step in the pools of `coverage` [default: 300]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(2..=1000))]
    pub seeds: Option<u32>,
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
        .chain(OF_ESTIMATES)
        .map(|(name, about)| format!("  {name:<18} {about}\n"))
        .collect()
}

/// The names of all scenes.
pub fn scenes() -> Vec<&'static str> {
    SCENES.iter().map(|scene| scene.name).collect()
}

/// The name of the study of intervals, and of its table.
const COVERAGE: &str = "coverage";
/// The name of the study of what `sandbox estimate` knows before the first run.
const KNOWLEDGE: &str = "knowledge";
/// The studies of `sandbox estimate`, each with a line about it.
const OF_ESTIMATES: [(&str, &str); 2] = [
    (
        COVERAGE,
        "how often the intervals of `sandbox estimate` hold the value (some hours)",
    ),
    (
        KNOWLEDGE,
        "what `sandbox estimate` knows before the first run: writes knowledge.json (an hour)",
    ),
];

/// What `sandbox estimate` knows before the first run.
fn run_knowledge(options: &AccuracyOptions) -> Result<(), Failure> {
    let store = options.cases.store(&[KNOWLEDGE])?;
    let found = knowledge(&store, &Watch::new())?;
    store.write("knowledge.json", found.file().as_bytes())?;
    tell(options.json, || found.json(), || found.text())?;
    options
        .cases
        .document
        .put([(KNOWLEDGE, found.table().markdown())])
}

/// How often the intervals of `sandbox estimate` hold the value.
fn run_coverage(options: &AccuracyOptions) -> Result<(), Failure> {
    let usual = match options.quick {
        true => Pool::QUICK,
        false => Pool::WHOLE,
    };
    let pool = Pool {
        seeds: options.seeds.map_or(usual.seeds, |seeds| seeds as usize),
        ..usual
    };
    let store = options.cases.store(&[COVERAGE])?;
    let found = coverage(pool, &store, &Watch::new())?;
    found.write(&store)?;
    tell(options.json, || found.json(), || found.text())?;
    options.cases.document.put([(COVERAGE, found.markdown())])
}

pub fn run(options: &AccuracyOptions) -> Result<(), Failure> {
    if options.seeds.is_some() && !options.scene.iter().any(|name| name == COVERAGE) {
        let reason = "--seeds is for coverage: sandbox accuracy coverage --seeds 100".to_owned();
        return Err(Failure::Input(reason));
    }
    let mut of_estimates = OF_ESTIMATES.iter().map(|(name, _)| *name);
    let is_asked = |study: &&str| options.scene.iter().any(|name| name == study);
    if let Some(study) = of_estimates.find(is_asked) {
        if options.scene.len() > 1 || !options.knob.is_empty() {
            let reason =
                format!("{study} is a study of its own: name no scene and no knob beside it");
            return Err(Failure::Input(reason));
        }
        return match study {
            KNOWLEDGE => run_knowledge(options),
            _ => run_coverage(options),
        };
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

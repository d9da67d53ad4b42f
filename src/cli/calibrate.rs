//! `sandbox calibrate`: a search for parameters, from one file.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{PrintOptions, ReplaceOptions, use_threads};
use super::documents::{DocumentOptions, add_folder};
use super::failure::Failure;
use super::terminal::tell;
use super::watch::Watch;
use lab::calibrate::{Calibration, MOST_GENERATIONS, Target, names, run as search};
use lab::machine::main_memory;
use lab::sweep::Shard;
use output::table::Table;
use runs::store::Store;

/// An example of a study, and of commands.
pub const EXAMPLE: &str = r#"A study, JSON:
  {
    "settings": { "walking_law": "headway" },
    "parameters": [
      { "name": "headway_time", "bounds": [0.3, 1.2], "start": 0.6 },
      { "name": "radius", "keys": ["crowds.*.radius", "grids.*.radius"], "bounds": [0.15, 0.25] }
    ],
    "fit": [{ "case": "gap-2.4" }, { "case": "speeds", "values": ["speed at 0.75", "speed at 2.75"] }],
    "hold_out": [{ "case": "gap-3.6" }],
    "transfer": [{ "scenario": "door.json",
                   "values": [{ "quantity": "door_flow_per_s", "value": 2.1, "tolerance": 0.06 }] }],
    "seeds": 2, "final_seeds": [11, 12, 13],
    "screening": { "trajectories": 4 },
    "search": { "generations": 30 }
  }

Examples:
  sandbox calibrate study.json --list
  sandbox calibrate study.json --out results
  sandbox calibrate steer --generations 1
  sandbox calibrate headway --shard 2/8 --out /shared/headway"#;

#[derive(Args)]
pub struct CalibrateOptions {
    /// The study: a JSON file with parameters and measured values; or the name of a built-in one, such as headway
    pub file: PathBuf,
    /// Compute part I of N (1 ≤ I ≤ N) of each stage first, then what no other process has begun
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Run nothing; list the measured values, the parameters and the number of runs
    #[arg(long, conflicts_with_all = ["shard", "documents"])]
    pub list: bool,
    /// Generations of the search at most, in place of the study's: 1 tries a study, more go on with a finished search
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_GENERATIONS as u64))]
    pub generations: Option<u64>,
    /// Folder for the results; runs finished there are not run again [default: the study's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of runs to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = super::values::threads)]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub print: PrintOptions,
    #[command(flatten)]
    pub replace: ReplaceOptions,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

pub fn run(options: &CalibrateOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    options.print.apply();
    let mut calibration = Calibration::open(&options.file, main_memory())?;
    if let Some(generations) = options.generations {
        calibration.search.generations = generations as usize;
    }
    if options.list {
        return tell(
            options.json,
            || listed_json(&calibration),
            || listed(&calibration),
        );
    }
    let given = options.out.clone();
    let folder = given.unwrap_or_else(|| PathBuf::from(&calibration.name));
    let mut outputs = options.replace.outputs(&folder);
    if options.file.exists() {
        outputs.reads("the study", &options.file);
    }
    for path in calibration.inputs() {
        outputs.reads("the study's", &path);
    }
    add_folder(&mut outputs, &folder, &names());
    outputs.may_replace(options.replace.force);
    options.files.add_to(&mut outputs, &names());
    outputs.check()?;
    let store = Store::open(&folder)?;
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let found = search(&calibration, shard, &store, &Watch::new())?.findings()?;
    options.files.give(&found, options.json, Some(&folder))
}

/// The measured values, the parameters and the number of runs.
fn listed(calibration: &Calibration) -> String {
    let scene = |target: &Target| calibration.scenes[target.scene].name.clone();
    let targets = Table::of(&calibration.targets)
        .column("set", |target| target.set.name())
        .column("scene", |target| target.of.as_str())
        .column("run", scene)
        .column("quantity", |target| target.quantity.as_str())
        .column("measured", |target| target.measured)
        .column("tolerance", |target| target.tolerance);
    let parameters = Table::of(&calibration.parameters)
        .column("parameter", |parameter| parameter.name.as_str())
        .column("from", |parameter| parameter.bounds[0])
        .column("to", |parameter| parameter.bounds[1])
        .column("start", |parameter| parameter.start)
        .column("", |parameter| if parameter.frozen { "frozen" } else { "" });
    let [runs, secs] = most_runs(calibration);
    format!(
        "{}\n{}\nat most {runs} runs and about {:.1} hours on one core; scenes that empty early take less\n",
        targets.table().text(),
        parameters.table().text(),
        secs / 3600.0,
    )
}

fn listed_json(calibration: &Calibration) -> Value {
    let targets = calibration.targets.iter().map(|target| {
        json!({
            "set": target.set, "scene": target.of, "quantity": target.quantity,
            "run": calibration.scenes[target.scene].name,
            "measured": target.measured, "tolerance": target.tolerance,
        })
    });
    let parameters = calibration.parameters.iter().map(|parameter| {
        let (name, bounds, start) = (&parameter.name, parameter.bounds, parameter.start);
        json!({"name": name, "bounds": bounds, "start": start, "frozen": parameter.frozen})
    });
    let [runs, secs] = most_runs(calibration);
    json!({
        "calibration": calibration.name,
        "values": targets.collect::<Vec<_>>(),
        "parameters": parameters.collect::<Vec<_>>(),
        "most_runs": runs,
        "expected_secs": secs,
    })
}

/// The number of runs if the search does not converge early, and the time that they take on one core, seconds.
fn most_runs(calibration: &Calibration) -> [f64; 2] {
    let search = calibration.screening;
    let screening = search.map_or(0, |of| of.trajectories * (calibration.parameters.len() + 1));
    let dimension = calibration.free().len();
    let generations = calibration.search.generations * calibration.population(dimension);
    let points = (1 + screening + generations + 2 * dimension) * calibration.seeds.len();
    let fitted = calibration.fitted_scenes();
    let last = 2 * calibration.final_seeds.len();
    let scenes = calibration.scenes.iter().enumerate().map(|(k, scene)| {
        let runs = last + if fitted.contains(&k) { points } else { 0 };
        [runs as f64, runs as f64 * scene.expected_secs()]
    });
    scenes.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
}

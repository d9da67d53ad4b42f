//! `sandbox estimate`: results with the errors asked for.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::arguments::{ErrorOptions, PrintOptions, SceneOptions, use_threads};
use super::failure::Failure;
use super::inputs::settings;
use super::terminal::{talk, tell};
use super::watch::Watch;
use crate::lab::estimate::{Answer, Forecast, PILOT, Question, run as make, sheet};
use crate::lab::machine::main_memory;
use crate::output::plot::Print;
use crate::runs::case::Source;
use crate::runs::outputs::{Manner, Outputs};
use crate::runs::store::Store;

pub const EXAMPLES: &str = "\
Examples:
  sandbox estimate evacuation --error flow_per_s=1% --error density_mean_15s=0.5%
  sandbox estimate scenarios/office.json --error t95_secs=3% --profile walk+sph --out results
  sandbox estimate evacuation --profile 'sf->sph' --error flow_per_s=0.05 --confidence 99 --most-minutes 5";

#[derive(Args)]
pub struct EstimateOptions {
    /// The name of a scenario (see `sandbox list`), or a scenario file
    pub scenario: String,
    #[command(flatten)]
    pub error: ErrorOptions,
    /// Run nothing; print how many runs and minutes are expected, from the finished runs of the folder
    #[arg(long)]
    pub plan: bool,
    /// Folder for the results; runs finished there are not made again
    #[arg(long, value_name = "DIR", default_value = "estimate")]
    pub out: PathBuf,
    #[command(flatten)]
    pub print: PrintOptions,
    #[command(flatten)]
    pub scene: SceneOptions,
}

pub fn run(options: &EstimateOptions) -> Result<(), Failure> {
    let program = &options.scene.program;
    use_threads(program.threads)?;
    options.print.apply();
    if options.error.errors.is_empty() {
        let reason =
            "--error is missing: a result with the error that it may have, such as flow_per_s=1%";
        return Err(Failure::Input(reason.to_owned()));
    }
    let source = Source::named(&options.scenario);
    let mut outputs = Outputs::new(program.force || Store::at(&options.out).is_begun());
    let settings = settings(&options.scene, None, &mut outputs)?;
    let question = Question::new(source, settings, options.error.request(), main_memory())?;
    for note in &question.notes {
        talk(&format!("note: {note}"));
    }
    let forecast = Forecast::of(&question, &Store::at(&options.out))?;
    if options.plan {
        return plan(forecast.as_ref(), program.json, &options.out);
    }
    if let Some(forecast) = &forecast {
        talk(&format!("note: {}", forecast.text().trim_end()));
    }
    for path in question.files() {
        outputs.reads("the scenario's", path);
    }
    let name = question.file_name();
    let pictures = Print::of_program().extensions();
    let pictures = pictures.map(|extension| format!(".{extension}"));
    let tables = [".json", ".csv", "-steps.csv", ".md"].map(str::to_owned);
    for end in tables.into_iter().chain(pictures) {
        // Another process may make the same estimate at the same time, so do not create trial files.
        outputs.writes(
            "--out",
            &options.out.join(format!("{name}{end}")),
            Manner::Beside,
        );
    }
    outputs.check()?;
    let store = Store::open(&options.out)?;
    let runs = make(&question, &store, &Watch::new())?;
    let answer = Answer::of(&runs);
    let files = [
        (".json", format!("{:#}\n", answer.json()).into_bytes()),
        (".csv", answer.csv()?),
        ("-steps.csv", answer.steps_csv()?),
        (".md", answer.markdown().into_bytes()),
    ];
    for (end, contents) in files {
        let path = store.write(&format!("{name}{end}"), &contents)?;
        talk(&format!("note: {} written", path.display()));
    }
    sheet(&runs, &answer).save(&store.path(&name))?;
    tell(program.json, || answer.json(), || answer.text())?;
    match &answer.stopped {
        None => Ok(()),
        Some(why) => Err(Failure::Output(format!(
            "not all errors are as small as asked for: {why}; the runs are kept, so that the same command with a \
             higher limit goes on"
        ))),
    }
}

/// Prints what is expected.
fn plan(forecast: Option<&Forecast>, as_json: bool, folder: &Path) -> Result<(), Failure> {
    let folder = folder.display();
    let unknown = || {
        format!(
            "unknown: {folder} has no runs of this profile that say anything; the first {PILOT} runs at each of two \
             time steps will\n"
        )
    };
    tell(
        as_json,
        || json!({ "expected": forecast }),
        || forecast.map_or_else(unknown, Forecast::text),
    )
}

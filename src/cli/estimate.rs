//! `sandbox estimate`: results with the errors asked for.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::arguments::{ErrorOptions, PrintOptions, SceneOptions, use_threads};
use super::documents::{DocumentOptions, add_folder};
use super::failure::Failure;
use super::inputs::settings;
use super::terminal::{talk, tell};
use super::watch::Watch;
use lab::estimate::{Answer, Answers, Forecast, Question, Request, Validated, names, run as make};
use lab::machine::main_memory;
use runs::case::Source;
use runs::outputs::Outputs;
use runs::store::Store;

pub const EXAMPLES: &str = "\
Examples:
  sandbox estimate evacuation --error flow_per_s=1% --error density_mean_15s=0.5%
  sandbox estimate scenarios/office.json --error t95_secs=3% --out results
  sandbox estimate evacuation --profile 'sf->sph' --error flow_per_s=0.05 --confidence 99 --most-minutes 5
  sandbox estimate evacuation --bound time_secs=95%";

#[derive(Args)]
pub struct EstimateOptions {
    /// The name of a scenario (see `sandbox list`), or a scenario file
    pub scenario: String,
    #[command(flatten)]
    pub error: ErrorOptions,
    /// Run nothing; print how many runs and minutes are expected, from the finished runs of the folder
    #[arg(long, conflicts_with = "documents")]
    pub plan: bool,
    /// Folder for the results; runs finished there are not made again
    #[arg(long, value_name = "DIR", default_value = "estimate")]
    pub out: PathBuf,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub print: PrintOptions,
    #[command(flatten)]
    pub scene: SceneOptions,
}

pub fn run(options: &EstimateOptions) -> Result<(), Failure> {
    let program = &options.scene.program;
    use_threads(program.threads)?;
    options.print.apply();
    if !options.error.is_given() {
        let reason = "--error is missing: a result with the error that it may have, such as flow_per_s=1% (or \
                      --bound: a share of runs, such as time_secs=95%)";
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
        return plan(&question.request, forecast.as_ref(), options);
    }
    if let Some(forecast) = &forecast {
        talk(&format!("note: {}", forecast.text().trim_end()));
    }
    for path in question.files() {
        outputs.reads("the scenario's", path);
    }
    let name = question.file_name();
    let names = names(&name);
    add_folder(&mut outputs, &options.out, &names);
    outputs.may_replace(program.force);
    options.files.add_to(&mut outputs, &names);
    outputs.check()?;
    let store = Store::open(&options.out)?;
    let runs = make(&question, &[], &store, &Watch::new())?;
    let answer = Answer {
        validation: Validated::of(&question)?,
        ..Answer::of(&runs)
    };
    let findings = answer.findings(&name, &runs)?;
    options
        .files
        .give(&findings, program.json, Some(&options.out))?;
    match &answer.stopped {
        None if answer.without.is_empty() => Ok(()),
        None => Err(Failure::Output(format!(
            "not everything that was asked for has a value:\n  {}",
            answer.without.join("\n  ")
        ))),
        Some(why) => Err(Failure::Output(format!(
            "not all errors or bounds are as asked for: {why}; the runs are kept, so that the same command with a \
             higher limit goes on"
        ))),
    }
}

/// An error if the errors of some rows are larger than asked for, with the reasons.
pub fn all_reached(answers: &Answers) -> Result<(), Failure> {
    match answers.missed() {
        none if none.is_empty() => Ok(()),
        missed => Err(Failure::Output(format!(
            "not all errors are as small as asked for:\n  {}",
            missed.join("\n  ")
        ))),
    }
}

/// Prints what is expected.
fn plan(
    request: &Request,
    forecast: Option<&Forecast>,
    options: &EstimateOptions,
) -> Result<(), Failure> {
    let folder = options.out.display();
    let unknown = || {
        format!(
            "unknown: {folder} has no runs of this profile that say anything; the first runs will\n"
        )
    };
    let bounds = || {
        request
            .bounds
            .iter()
            .map(|bound| (bound, request.runs_for(bound)))
    };
    let text = || {
        let errors = match request.wanted.is_empty() {
            true => String::new(),
            false => forecast.map_or_else(unknown, Forecast::text),
        };
        let lines = bounds().map(|(bound, runs)| format!("bound on {}: {runs} runs\n", bound.name));
        errors + &lines.collect::<String>()
    };
    let json = || {
        let bounds = bounds().map(|(bound, runs)| json!({ "result": bound.name, "runs": runs }));
        json!({ "expected": forecast, "bounds": bounds.collect::<Vec<_>>() })
    };
    tell(options.scene.program.json, json, text)
}

//! `sandbox estimate`: results with the errors asked for.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::arguments::{ErrorOptions, PrintOptions, SceneOptions, use_threads};
use super::documents::{DocumentOptions, add_folder};
use super::failure::Failure;
use super::inputs::settings;
use super::terminal::{talk, tell};
use super::watch::Watch;
use lab::estimate::{
    Answer, Answers, Bound, Ensemble, Forecast, Question, Questions, Request, names, run as make,
};
use lab::machine::main_memory;
use lab::sweep::Study;
use runs::case::Source;
use runs::outputs::Outputs;
use runs::store::Store;

pub const EXAMPLES: &str = "\
Examples:
  sandbox estimate evacuation --error flow_per_s=1% --error density_mean_15s=0.5%
  sandbox estimate scenarios/office.json --error t95_secs=3% --out results
  sandbox estimate evacuation --profile 'sf->sph' --error flow_per_s=0.05 --confidence 99 --most-minutes 5
  sandbox estimate evacuation --bound time_secs=95%
  sandbox estimate study.json --error flow_per_s=2%";

#[derive(Args)]
pub struct EstimateOptions {
    /// The name of a scenario (see `sandbox list`), or a scenario file; or a study (see `sandbox sweep`), for its rows
    pub scenario: String,
    #[command(flatten)]
    pub error: ErrorOptions,
    /// Also make two runs with each of the parameter sets that meet the experiments as well as those of the profile:
    /// their spread is the error of the parameters
    #[arg(long)]
    pub model: bool,
    /// Run nothing; print how many runs and minutes are expected, from the finished runs of the folder
    #[arg(long, conflicts_with = "documents")]
    pub plan: bool,
    /// Folder for the results; runs finished there are not made again [default: estimate, or the study's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
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
    if let Some(study) = Study::named(&options.scenario, main_memory())? {
        return study_alone(&study, options);
    }
    let source = Source::named(&options.scenario);
    let folder = options.out.clone().unwrap_or_else(|| "estimate".into());
    let known = Store::at(&folder);
    let mut outputs = Outputs::new(program.force || known.is_begun());
    let settings = settings(&options.scene, None, &mut outputs)?;
    let question = Question::new(source, settings, options.error.request(), main_memory())?;
    if options.model
        && let Some(why) = Ensemble::refused(&question)?
    {
        return Err(Failure::Input(format!("--model: {why}")));
    }
    for note in &question.notes {
        talk(&format!("note: {note}"));
    }
    let forecast = Forecast::of(&question, &known)?;
    if options.plan {
        return plan(
            &question.request,
            forecast.as_ref(),
            (&folder, program.json),
        );
    }
    if let Some(forecast) = &forecast {
        talk(&format!("note: {}", forecast.text().trim_end()));
    }
    for path in question.files() {
        outputs.reads("the scenario's", path);
    }
    let name = question.file_name();
    let names = names(&name);
    add_folder(&mut outputs, &folder, &names);
    outputs.may_replace(program.force);
    options.files.add_to(&mut outputs, &names);
    outputs.check()?;
    let store = Store::open(&folder)?;
    let runs = make(&question, &[], &store, &Watch::new())?;
    let sets = match options.model {
        true => Some(Ensemble::of(&runs, &store, &Watch::new())?),
        false => None,
    };
    let answer = Answer::of(&runs).with_model(&runs, sets.as_ref())?;
    let findings = answer.findings(&name, &runs)?;
    options.files.give(&findings, program.json, Some(&folder))?;
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

/// The rows of a study, without options that are for scenarios.
fn study_alone(study: &Study, options: &EstimateOptions) -> Result<(), Failure> {
    let EstimateOptions { scene, files, .. } = options;
    let typed = settings(scene, None, &mut Outputs::new(false))?;
    let typed = typed.first().map(ToString::to_string);
    let of_scenarios = [("--plan", options.plan), ("--model", options.model)];
    let mut given = of_scenarios.iter().filter(|(_, given)| *given);
    if let Some(option) = typed.or(given.next().map(|(option, _)| (*option).to_owned())) {
        return Err(Failure::Input(format!(
            "{option}: is for scenarios; {} is a study, which has its own settings",
            options.scenario
        )));
    }
    of_rows(
        study,
        &Rows {
            file: Path::new(&options.scenario),
            out: options.out.as_deref(),
            error: &options.error,
            files,
            force: scene.program.force,
            json: scene.program.json,
        },
    )
}

/// How the rows of a study are estimated.
pub struct Rows<'a> {
    /// The study's file, as typed.
    pub file: &'a Path,
    /// The folder for the results.
    pub out: Option<&'a Path>,
    /// What is asked for.
    pub error: &'a ErrorOptions,
    /// Files with all results.
    pub files: &'a DocumentOptions,
    /// Whether existing files may be replaced.
    pub force: bool,
    /// Whether to print JSON.
    pub json: bool,
}

/// Makes as many runs for each combination of settings as the errors asked for need.
pub fn of_rows(study: &Study, options: &Rows) -> Result<(), Failure> {
    let questions = Questions::new(study, &options.error.request())?;
    let names = questions.files();
    let folder = options.out.unwrap_or(Path::new(&study.name));
    let mut outputs = Outputs::new(options.force || Store::at(folder).is_begun());
    if options.file.exists() {
        outputs.reads("the study", options.file);
    }
    for path in study.inputs() {
        outputs.reads("the study's", path);
    }
    add_folder(&mut outputs, folder, &names);
    outputs.may_replace(options.force);
    options.files.add_to(&mut outputs, &names);
    outputs.check()?;
    let answers = questions.answer(&Store::open(folder)?, &Watch::new())?;
    let findings = answers.findings()?;
    options.files.give(&findings, options.json, Some(folder))?;
    all_reached(&answers)
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
    (folder, as_json): (&Path, bool),
) -> Result<(), Failure> {
    let bounds = request.bounds.iter();
    let bounds = bounds.map(|bound| (bound, request.runs_for(bound)));
    let text = || {
        let errors = match (request.wanted.is_empty(), forecast) {
            (true, _) => String::new(),
            (false, Some(forecast)) => forecast.text(),
            (false, None) => format!(
                "unknown: {} has no runs of this scenario and profile that say anything; the first runs will\n",
                folder.display()
            ),
        };
        let line =
            |(bound, runs): (&Bound, usize)| format!("bound on {}: {runs} runs\n", bound.name);
        errors + &bounds.clone().map(line).collect::<String>()
    };
    let json = || {
        let entry = |(bound, runs): (&Bound, usize)| json!({ "result": bound.name, "runs": runs });
        json!({ "expected": forecast, "bounds": bounds.clone().map(entry).collect::<Vec<_>>() })
    };
    tell(as_json, json, text)
}

//! `sandbox report`: the document that is handed in with a run or a study.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{SceneOptions, use_threads};
use super::failure::Failure;
use super::inputs::scenario;
use super::moment::{none_left, to_the_end};
use super::terminal::tell;
use super::values::{document, seconds};
use lab::report::{InputFile, Sources, Watched, of_run, of_study};
use lab::sweep::{Gathered, Study};
use output::document::Document;
use runs::case::Source;
use runs::drive::{End, Observer, Run};
use runs::outputs::{Manner, Outputs};
use runs::store::Store;
use scenario::input::is_standard_input;
use scenario::measurements::Measurement;
use scenario::quote::shown;
use scenario::{Scenario, read_text};

pub const EXAMPLES: &str = "\
Examples:
  sandbox report scenarios/office.json -o office.pdf
  sandbox report scenarios/office.json --at 30 --at 60 -o office.html
  sandbox sweep study.json && sandbox report study.json -o study.pdf";

/// Keys that only studies have.
const OF_STUDIES: [&str; 4] = ["scenario", "grid", "list", "seeds"];

#[derive(Args)]
pub struct ReportOptions {
    /// A built-in scenario or a scenario file, which is simulated; or a study whose runs `sandbox sweep` has finished
    #[arg(value_name = "RUN_OR_STUDY")]
    pub run: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// The report (.html or .pdf) [default: the name of the run with .html, in the working directory]
    #[arg(short, long, value_name = "FILE", value_parser = document())]
    pub out: Option<PathBuf>,
    /// Time at which the run ends, seconds [default: the scenario's duration]
    #[arg(long, value_name = "SECS", allow_negative_numbers = true, value_parser = seconds)]
    pub until: Option<f64>,
    /// The time of a picture, seconds; may be repeated [default: the highest density, and when half of the agents had
    /// left]
    #[arg(long, value_name = "SECS", allow_negative_numbers = true, value_parser = seconds)]
    pub at: Vec<f64>,
    /// The folder with the results of a study [default: the study's name]
    #[arg(long, value_name = "DIR")]
    pub results: Option<PathBuf>,
}

pub fn run(options: &ReportOptions) -> Result<(), Failure> {
    let program = &options.scene.program;
    use_threads(program.threads)?;
    let out = options.out.clone().unwrap_or_else(|| {
        let stem = Path::new(&options.run).file_stem().unwrap_or_default();
        Path::new(stem).with_added_extension("html")
    });
    let mut outputs = Outputs::new(program.force);
    outputs.writes("--out", &out, Manner::File);
    let report = match study(options)? {
        Some(study) => of_results(&study, options, outputs)?,
        None => of_scenario(options, outputs)?,
    };
    report.save(&out)?;
    let file = out.display().to_string();
    let (title, blocks) = (&report.title, report.blocks.len());
    tell(
        program.json,
        || json!({"file": file, "title": title, "parts": blocks}),
        || format!("{file}: {}\n", shown(title)),
    )
}

/// The study, if it is one.
fn study(options: &ReportOptions) -> Result<Option<Study>, Failure> {
    let path = Path::new(&options.run);
    let is_study = match path.exists() {
        true => {
            let text: Option<Value> = serde_json::from_str(&read_text(path)?).ok();
            OF_STUDIES
                .iter()
                .any(|key| text.as_ref().is_some_and(|text| text.get(key).is_some()))
        }
        false => {
            let is_scenario = Source::shipped(&options.run).is_some() || is_standard_input(path);
            !is_scenario && path.extension().is_none()
        }
    };
    match is_study {
        true => Ok(Some(Study::open(path, None)?)),
        false => Ok(None),
    }
}

fn of_results(
    study: &Study,
    options: &ReportOptions,
    mut outputs: Outputs,
) -> Result<Document, Failure> {
    if words(options).len() > 1 || !options.at.is_empty() {
        return Err(Failure::Input(format!(
            "{}: a study has its own settings and no pictures; give its file, --results and --out alone",
            options.run
        )));
    }
    for path in study.inputs() {
        outputs.reads("the study's", path);
    }
    outputs.check()?;
    let folder = options.results.clone();
    let folder = folder.unwrap_or_else(|| PathBuf::from(&study.name));
    let store = Store::at(&folder);
    if !store.is_begun() {
        return Err(Failure::Input(format!(
            "{}: contains no results; run `sandbox sweep {}` first, or give its folder with --results",
            folder.display(),
            options.run
        )));
    }
    let gathered = Gathered::of(study, &store);
    let command = format!("sandbox sweep {} --out {}", options.run, folder.display());
    let report = format!(
        "sandbox report {} --results {}",
        options.run,
        folder.display()
    );
    Ok(of_study(&gathered, [&command, &report])?)
}

fn of_scenario(options: &ReportOptions, mut outputs: Outputs) -> Result<Document, Failure> {
    if let Some(results) = &options.results {
        let reason = format!(
            "--results {}: is for studies, not for scenarios",
            results.display()
        );
        return Err(Failure::Input(reason));
    }
    let source = Source::named(&options.run);
    let until = options.until.map(|secs| ("--until", secs));
    let mut whole = scenario(&source, &options.scene, until, 0, &mut outputs)?;
    outputs.check()?;
    let ends = whole.duration_secs;
    if let Some(late) = options.at.iter().find(|&&at| at > ends) {
        return Err(Failure::Input(format!(
            "--at {late}: the run ends at {ends} s; give an earlier time, or a later end with --until"
        )));
    }
    let mut files: Vec<InputFile> = whole.files.iter().map(input).collect();
    if let Source::File(path) = &source {
        files.insert(0, input(&("scenario", path.clone())));
    }
    files.extend(
        options
            .scene
            .geometry
            .iter()
            .map(|path| input(&("--geometry", path.clone()))),
    );
    complete(&mut whole)?;
    let mut watched = Watched::new(&whole, &options.at);
    let mut run = Run::new(whole)?;
    Watched::prepare(&mut run.simulation);
    let watch: Box<dyn Observer<Failure> + Send> = Box::new(Watch(&mut watched));
    to_the_end(&mut run, [watch])?;
    let words = words(options);
    let command = match &source {
        Source::BuiltIn(_) => format!("sandbox {}", words.join(" ")),
        Source::File(_) => format!("sandbox run {}", words.join(" ")),
    };
    let at = options.at.iter().map(|at| format!("--at {at}"));
    let report = words.iter().cloned().chain(at).collect::<Vec<_>>();
    let report = format!("sandbox report {}", report.join(" "));
    let sources = Sources {
        command: &command,
        report: &report,
        files,
    };
    Ok(of_run(&run, &watched, sources)?)
}

/// A file of the run; `key` names it.
fn input((key, path): &(&'static str, PathBuf)) -> InputFile {
    InputFile {
        what: (*key).to_owned(),
        path: path.clone(),
    }
}

/// Lets the report watch the run, and ends it if no agents are left for a picture.
struct Watch<'a>(&'a mut Watched);

impl Observer<Failure> for Watch<'_> {
    fn observe(&mut self, run: &Run, _: f64, then: ControlFlow<End>) -> Result<(), Failure> {
        let simulation = &run.simulation;
        self.0.see(simulation);
        let Some(missing) = self.0.missing() else {
            return Ok(());
        };
        let is_empty = simulation.frame().agents.count_present() == 0;
        let option = format!("--at {missing}");
        match then {
            _ if is_empty && !simulation.expects_agents() => {
                Err(none_left((&option, missing), simulation))
            }
            ControlFlow::Break(end) if end != End::Interrupted => Err(Failure::Input(format!(
                "{option}: the run ends at {:.2} s: {}",
                simulation.frame().clock.time(),
                run.reason()
            ))),
            _ => Ok(()),
        }
    }
}

/// Adds the measurements that every report has. They change no result.
fn complete(scenario: &mut Scenario) -> Result<(), Failure> {
    let has = |is: fn(&Measurement) -> bool| scenario.measurements.iter().any(is);
    let has_journeys = !scenario.scene.journeys.journeys.is_empty();
    let wanted = [
        (
            "egress",
            has_journeys && !has(|one| matches!(one, Measurement::Egress(_))),
        ),
        (
            "exposure",
            !has(|one| matches!(one, Measurement::Exposure(_))),
        ),
        (
            "service_levels",
            !has(|one| matches!(one, Measurement::ServiceLevels(_))),
        ),
    ];
    for (name, _) in wanted.into_iter().filter(|(_, is_wanted)| *is_wanted) {
        let keys = serde_json::from_value(json!({ name: {} }));
        let keys = keys.map_err(|error| Failure::Input(format!("{name}: {error}")))?;
        scenario.measurements.push(keys);
    }
    Ok(())
}

/// The scenario and its settings, as typed into a shell.
fn words(options: &ReportOptions) -> Vec<String> {
    let scene = &options.scene;
    let seed = scene.changes.seed.map(|seed| seed.to_string());
    let until = options.until.map(|until| until.to_string());
    let geometry = scene.geometry.as_ref();
    let geometry = geometry.map(|path| path.display().to_string());
    let given = [
        ("--profile", scene.profile.clone()),
        ("--seed", seed),
        ("--preset", scene.preset.clone()),
        ("--time-step", scene.time_step.clone()),
        ("--geometry", geometry),
        ("--until", until),
    ];
    let given = given
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)));
    let set = scene
        .changes
        .set
        .iter()
        .map(|value| ("--set", value.clone()));
    let words = given
        .chain(set)
        .map(|(name, value)| format!("{name} {}", quoted(&value)));
    [quoted(&options.run)].into_iter().chain(words).collect()
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "+-=_./,:%".contains(c);
    match word.chars().all(is_plain) && !word.is_empty() {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

//! `sandbox report`: the document that is handed in with a run or a study.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{SceneOptions, use_threads};
use super::failure::Failure;
use super::inputs::scenario;
use super::moment::to_the_end;
use super::reported::{Typed, Watch, complete, findings, names, words};
use super::terminal::tell;
use super::values::{document, seconds};
use lab::report::{Watched, of_study};
use lab::sweep::{Gathered, Study};
use output::document::Findings;
use runs::case::Source;
use runs::drive::{Observer, Run};
use runs::outputs::{Manner, Outputs};
use runs::store::Store;
use scenario::input::is_standard_input;
use scenario::quote::shown;
use scenario::read_text;

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
    /// The report (.html, .pdf or .md), its table (.csv) or all values (.json) [default: the name of the run with
    /// .html, in the working directory]
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
        None => of_scenario(options, (outputs, &out))?,
    };
    report.save(&out)?;
    let file = out.display().to_string();
    let document = &report.document;
    let (title, blocks) = (&document.title, document.blocks.len());
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
) -> Result<Findings, Failure> {
    let given = words(&options.run, &options.scene, options.until);
    if given.len() > 1 || !options.at.is_empty() {
        return Err(Failure::Input(format!(
            "{}: a study has its own settings and no pictures; give its file, --results and --out alone",
            options.run
        )));
    }
    for path in study.inputs() {
        outputs.reads("the study's", path);
    }
    outputs.check()?;
    let given = options.results.clone();
    let folder = given.unwrap_or_else(|| PathBuf::from(&study.name));
    let store = Store::at(&folder);
    if !store.is_begun() {
        return Err(Failure::Input(format!(
            "{}: contains no results; run `sandbox sweep {}` first, or give its folder with --results",
            folder.display(),
            options.run
        )));
    }
    let gathered = Gathered::of(study, &store);
    let document = of_study(&gathered, Path::new(&options.run), &folder)?;
    Ok(Findings {
        document,
        ..gathered.findings(None)?
    })
}

fn of_scenario(
    options: &ReportOptions,
    (mut outputs, out): (Outputs, &Path),
) -> Result<Findings, Failure> {
    if let Some(results) = &options.results {
        return Err(Failure::Input(format!(
            "--results {}: is for studies, not for scenarios",
            results.display()
        )));
    }
    let source = Source::named(&options.run);
    let until = options.until.map(|secs| ("--until", secs));
    let mut whole = scenario(&source, &options.scene, until, 0, &mut outputs)?;
    for file in names(&whole).beside(out) {
        outputs.writes("--out", &file, Manner::Beside);
    }
    outputs.check()?;
    let ends = whole.duration_secs;
    if let Some(late) = options.at.iter().find(|&&at| at > ends) {
        return Err(Failure::Input(format!(
            "--at {late}: the run ends at {ends} s; give an earlier time, or a later end with --until"
        )));
    }
    complete(&mut whole)?;
    let mut watched = Watched::new(&whole, &options.at);
    let mut run = Run::new(whole)?;
    Watched::prepare(&mut run.simulation);
    let watch: Box<dyn Observer<Failure> + Send> = Box::new(Watch(&mut watched));
    to_the_end(&mut run, [watch])?;
    let typed = Typed {
        source: &source,
        scene: &options.scene,
        until: options.until,
        at: &options.at,
    };
    findings(&run, &watched, &typed)
}

//! `sandbox compare`: the differences between two results.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::Value;

use super::arguments::ReplaceOptions;
use super::documents::DocumentOptions;
use super::failure::Failure;
use super::inputs::tracks;
use super::terminal::talk;
use super::values::frame_rate;
use lab::differences::{Differences, NotAReport, names as file_names, of_reports, of_tracks};
use lab::estimate::{compared, is_answer};
use output::recording::Recorded;
use runs::outputs::Outputs;
use scenario::input;
use scenario::kinds::is_scenario;
use scenario::quote::shown;
use scenario::trajectories::{ReadOptions, Tracks, Unit};

#[derive(Args)]
pub struct CompareOptions {
    /// A: the result of a run or an estimate as --json printed it, a recording (.rrd), or trajectories (SQLite, text,
    /// CSV)
    pub a: PathBuf,
    /// B: a file of the same kind; a result and a recording can be compared, too
    pub b: PathBuf,
    /// Unit of the coordinates in trajectory files [default: that of the file, else m]
    #[arg(long, value_parser = PossibleValuesParser::new(["m", "cm"]))]
    pub unit: Option<String>,
    /// Frames per second of trajectory files [default: that of the file]
    #[arg(long, value_name = "N", value_parser = frame_rate)]
    pub fps: Option<f64>,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub replace: ReplaceOptions,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// A file to compare.
enum Input {
    Report(Box<Value>),
    Tracks(Box<Tracks>),
}

pub fn run(options: &CompareOptions) -> Result<(), Failure> {
    let read = ReadOptions {
        unit: options.unit.as_deref().and_then(Unit::named),
        fps: options.fps,
    };
    let paths = [&options.a, &options.b];
    let mut outputs = Outputs::new(options.replace.force);
    outputs.reads("A,", paths[0]);
    outputs.reads("B,", paths[1]);
    options.files.add_to(&mut outputs, &file_names());
    outputs.check()?;
    let (a, b) = (open(&options.a, &read)?, open(&options.b, &read)?);
    let names = paths.map(|path| path.display().to_string());
    let [first, second] = names.each_ref().map(String::as_str);
    let differences: Differences = match (&a, &b) {
        (Input::Report(a), Input::Report(b)) if is_answer(a) && is_answer(b) => {
            let compared = compared([(first, a), (second, b)]);
            let compared = compared.map_err(|error| Failure::Input(error.to_string()))?;
            return options
                .files
                .give(&compared.findings()?, options.json, None);
        }
        (Input::Report(a), Input::Report(b)) if is_answer(a) || is_answer(b) => {
            let (is, is_not) = if is_answer(a) {
                (first, second)
            } else {
                (second, first)
            };
            return Err(Failure::Input(format!(
                "{is} is an estimate, {is_not} is not; give two of a kind"
            )));
        }
        (Input::Report(a), Input::Report(b)) => {
            let invalid = |error: NotAReport| {
                let (name, report) = [(first, a), (second, b)][error.which];
                let scenario = if is_scenario(report) {
                    "a scenario, "
                } else {
                    ""
                };
                Failure::Input(format!("{name}: {scenario}{error}"))
            };
            let differences = of_reports(a, b).map_err(invalid)?;
            for (path, report) in paths.into_iter().zip([a, b]) {
                if report.get("settings").is_none() {
                    let file = path.display();
                    talk(&format!(
                        "note: {file} has no settings: an earlier version wrote it; run it again to compare them"
                    ));
                }
            }
            differences
        }
        (Input::Tracks(a), Input::Tracks(b)) => of_tracks(a, b),
        _ => {
            let is_first = matches!(a, Input::Report(_));
            let (result, tracks) = if is_first {
                (first, second)
            } else {
                (second, first)
            };
            return Err(Failure::Input(format!(
                "{result} is the result of a run, {tracks} has trajectories; give two of a kind"
            )));
        }
    };
    options
        .files
        .give(&differences.findings()?, options.json, None)
}

/// Reads a file of any kind.
fn open(path: &Path, options: &ReadOptions) -> Result<Input, Failure> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let refused = |reason: String| Failure::Input(format!("{}: {reason}", path.display()));
    let text = match extension.to_str() {
        Some("json") => {
            input::text(path).map_err(|error| refused(format!("cannot be read: {error}")))?
        }
        Some("rrd") => {
            let reason = "the recording has no results: its run did not end, or an earlier version wrote it; record \
                          the run again";
            let recorded = Recorded::read(path)?;
            let report = recorded.report().map(str::to_owned);
            report.ok_or_else(|| refused(reason.to_owned()))?
        }
        _ => {
            let tracks = tracks(path, options)?;
            return Ok(Input::Tracks(Box::new(tracks)));
        }
    };
    match serde_json::from_str(&text) {
        Ok(report) => Ok(Input::Report(Box::new(report))),
        Err(error) => Err(refused(format!("no JSON: {}", shown(&error.to_string())))),
    }
}

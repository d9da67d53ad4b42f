//! `sandbox compare`: the differences between two results.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

use super::arguments::{ReplaceOptions, TrackOptions};
use super::documents::DocumentOptions;
use super::failure::Failure;
use super::inputs::{FPS, tracks};
use super::terminal::talk;
use super::values::frame_rate;
use lab::differences::{NotAReport, names as file_names, of_reports, of_tracks};
use lab::estimate::{compared, is_answer};
use output::document::Findings;
use output::recording::Recorded;
use runs::outputs::Outputs;
use scenario::input;
use scenario::kinds::is_scenario;
use scenario::quote::shown;
use scenario::trajectories::{ReadOptions, Tracks, endings};

#[derive(Args)]
pub struct CompareOptions {
    #[arg(help = format!(
        "A: the result of a run or an estimate as --json printed it, a recording (.rrd), or trajectories ({})",
        endings()
    ))]
    pub a: PathBuf,
    /// B: a file of the same kind; a result and a recording can be compared, too
    pub b: PathBuf,
    #[command(flatten)]
    pub tracks: TrackOptions,
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
    let read = options.tracks.reading(options.fps);
    let paths = [&options.a, &options.b];
    let mut outputs = Outputs::new(options.replace.force);
    outputs.reads("A,", paths[0]);
    outputs.reads("B,", paths[1]);
    options.files.add_to(&mut outputs, &file_names());
    outputs.check()?;
    let (a, b) = (open(&options.a, &read)?, open(&options.b, &read)?);
    let names = paths.map(|path| path.display().to_string());
    let [first, second] = names.each_ref().map(String::as_str);
    let mixed = |result: &str, tracks: &str| {
        let what = format!("{result} is the result of a run, {tracks} has trajectories");
        Failure::Input(format!("{what}; give two of a kind"))
    };
    let findings = match (&a, &b) {
        (Input::Report(a), Input::Report(b)) => of_results([(first, a), (second, b)])?,
        (Input::Tracks(a), Input::Tracks(b)) => of_tracks(a, b).findings()?,
        (Input::Report(_), Input::Tracks(_)) => return Err(mixed(first, second)),
        (Input::Tracks(_), Input::Report(_)) => return Err(mixed(second, first)),
    };
    options.files.give(&findings, options.json, None)
}

/// The differences between two results of runs or two estimates.
fn of_results(results: [(&str, &Value); 2]) -> Result<Findings, Failure> {
    let [(first, a), (second, b)] = results;
    let mixed = |is: &str, is_not: &str| {
        let what = format!("{is} is an estimate, {is_not} is not");
        Err(Failure::Input(format!("{what}; give two of a kind")))
    };
    match [is_answer(a), is_answer(b)] {
        [true, true] => {
            let compared = compared(results);
            let compared = compared.map_err(|error| Failure::Input(error.to_string()))?;
            return Ok(compared.findings()?);
        }
        [true, false] => return mixed(first, second),
        [false, true] => return mixed(second, first),
        [false, false] => {}
    }
    let invalid = |error: NotAReport| {
        let (name, report) = results[error.which];
        let scenario = match is_scenario(report) {
            true => "a scenario, ",
            false => "",
        };
        Failure::Input(format!("{name}: {scenario}{error}"))
    };
    let differences = of_reports(a, b).map_err(invalid)?;
    for (file, _) in results
        .iter()
        .filter(|(_, report)| report.get("settings").is_none())
    {
        talk(&format!(
            "note: {file} has no settings: an earlier version wrote it; run it again to compare them"
        ));
    }
    Ok(differences.findings()?)
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
            let report = Recorded::read(path)?.report().map(str::to_owned);
            report.ok_or_else(|| refused(reason.to_owned()))?
        }
        _ => {
            let tracks = tracks(path, options, FPS)?;
            return Ok(Input::Tracks(Box::new(tracks)));
        }
    };
    match serde_json::from_str(&text) {
        Ok(report) => Ok(Input::Report(Box::new(report))),
        Err(error) => Err(refused(format!("no JSON: {}", shown(&error.to_string())))),
    }
}

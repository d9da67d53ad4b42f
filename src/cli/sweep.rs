//! `sandbox sweep`: a study, run from one file.

use std::path::{Path, PathBuf};

use clap::{Arg, Args};
use serde_json::{Value, json};

use super::arguments::{ErrorOptions, PrintOptions, ReplaceOptions, use_threads};
use super::documents::{DocumentOptions, add_folder, show};
use super::estimate::{Rows, of_rows};
use super::failure::Failure;
use super::terminal::{talk, tell};
use super::watch::Watch;
use lab::machine::main_memory;
use lab::report::of_study;
use lab::sweep::{Drawing, Gathered, Shard, State, Study, run as run_shard};
use output::document::Findings;
use runs::job::Tally;
use runs::outputs::Outputs;
use runs::store::Store;

/// An example of a study, and of commands.
pub const EXAMPLE: &str = r#"A study, JSON:
  {
    "scenario": "evacuation",
    "settings": { "duration_secs": 60 },
    "grid": { "gas_constant": [200, 400], "profile": ["sf", "sf->sph"] },
    "seeds": 5
  }

Examples:
  sandbox sweep study.json
  sandbox sweep study.json --merge --draw flow_per_s --over gas_constant
  sandbox sweep study.json --list
  sandbox sweep study.json --shard 2/8 --out /shared/study
  sandbox sweep study.json --merge --out /shared/study"#;

/// Hides the options of `sandbox estimate`.
fn hidden(option: Arg) -> Arg {
    const OLD: [&str; 6] = [
        "errors",
        "bounds",
        "runs",
        "confidence",
        "most_runs",
        "most_minutes",
    ];
    let is_old = OLD.contains(&option.get_id().as_str());
    option.hide(is_old)
}

#[derive(Args)]
#[command(mut_args(hidden))]
pub struct SweepOptions {
    /// The study: a JSON file with a scenario, settings, a grid or list of settings, and seeds; or the name of a
    /// built-in one, such as table1
    pub file: PathBuf,
    /// Run only part I of N (1 ≤ I ≤ N): the cells I, I + N, I + 2N, …; combine the parts with --merge
    #[arg(long, value_name = "I/N", conflicts_with = "merge")]
    pub shard: Option<Shard>,
    /// Run nothing; combine the finished cells into tables
    #[arg(long)]
    pub merge: bool,
    /// Run nothing; list the cells and whether they are finished
    #[arg(long, conflicts_with = "merge")]
    pub list: bool,
    /// Folder for the results; cells finished there are not run again [default: the study's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Draw this measurement only; may be repeated [default: all, at most 12]
    #[arg(long, value_name = "MEASUREMENT", conflicts_with_all = ["list", "shard"])]
    pub draw: Vec<String>,
    /// Draw over this varied setting, or over two settings as a map [default: the first one with numbers]
    #[arg(long, value_name = "KEY[,KEY]", value_delimiter = ',', conflicts_with_all = ["list", "shard"])]
    pub over: Vec<String>,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub error: ErrorOptions,
    #[command(flatten)]
    pub print: PrintOptions,
    /// Number of cells to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = super::values::threads)]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub replace: ReplaceOptions,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

pub fn run(options: &SweepOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    options.print.apply();
    // For --list and --merge the cells may have been computed on a larger machine.
    let computes = !options.list && !options.merge;
    let memory = computes.then(main_memory).flatten();
    let study = Study::open(&options.file, memory)?;
    let drawing = Drawing {
        measurements: options.draw.clone(),
        over: options.over.clone(),
    };
    drawing.check(&study)?;
    let folder = options.out.clone();
    let folder = folder.unwrap_or_else(|| PathBuf::from(&study.name));
    let store = Store::at(&folder);
    if options.error.is_given() {
        return estimate(&study, options);
    }
    if (options.list || options.shard.is_some()) && options.files.are_given() {
        let reason = "-o: the results are those of all cells; give it without --list and --shard, or with --merge";
        return Err(Failure::Input(reason.to_owned()));
    }
    if options.list {
        return list(&Gathered::of(&study, &store), options);
    }
    if options.merge && !store.is_begun() {
        let folder = folder.display();
        let reason = format!("{folder}: contains no study; give its folder with --out");
        return Err(Failure::Input(reason));
    }
    check_outputs(&study, &store, options)?;
    if options.merge {
        return merge(&study, &store, &drawing, options);
    }
    let store = Store::open(&folder)?;
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let tally = run_shard(&study, shard, &store, &Watch::new())?;
    if options.shard.is_none() {
        return merge(&study, &store, &drawing, options);
    }
    tell(
        options.json,
        || told_json(&tally, shard),
        || told(&tally, shard),
    )?;
    some_failed(&tally.failed, tally.jobs)
}

/// Estimates the rows of the study.
fn estimate(study: &Study, options: &SweepOptions) -> Result<(), Failure> {
    talk(
        "note: `sandbox sweep STUDY --error …` is `sandbox estimate STUDY --error …` now; the old spelling works in \
         this version only",
    );
    let alone = options.shard.is_none() && !options.merge && !options.list;
    if !alone || !options.draw.is_empty() || !options.over.is_empty() {
        let reason = "--error and --bound: the number of runs depends on their results; give them without --shard, \
                      --merge, --list, --draw and --over";
        return Err(Failure::Input(reason.to_owned()));
    }
    of_rows(
        study,
        &Rows {
            file: &options.file,
            out: options.out.as_deref(),
            error: &options.error,
            files: &options.files,
            force: options.replace.force,
            json: options.json,
        },
    )
}

/// The files that the study reads, before its results in `folder`.
fn inputs(study: &Study, options: &SweepOptions, folder: &Path) -> Outputs {
    let mut outputs = options.replace.outputs(folder);
    if options.file.exists() {
        outputs.reads("the study", &options.file);
    }
    for path in study.inputs() {
        outputs.reads("the study's", path);
    }
    outputs
}

/// Rejects results that cannot be written or would replace an input. In a folder that does not belong to a study,
/// existing files with the results' names are replaced only with --force.
fn check_outputs(study: &Study, store: &Store, options: &SweepOptions) -> Result<(), Failure> {
    let mut outputs = inputs(study, options, store.folder());
    add_folder(&mut outputs, store.folder(), &study.names());
    outputs.may_replace(options.replace.force);
    // The files have the report.
    options
        .files
        .add_to(&mut outputs, &study.names().numbered());
    Ok(outputs.check()?)
}

fn list(gathered: &Gathered, options: &SweepOptions) -> Result<(), Failure> {
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let json = || {
        let mut value = gathered.json();
        if let Some(cells) = value["cells"].as_array_mut() {
            let number = |cell: &Value| cell["cell"].as_u64().unwrap_or_default() as usize;
            cells.retain(|cell| shard.has(number(cell)));
        }
        json!({ "study": value["study"], "cells": value["cells"] })
    };
    tell(options.json, json, || gathered.list(shard))
}

/// Merges the finished cells.
fn merge(
    study: &Study,
    store: &Store,
    drawing: &Drawing,
    options: &SweepOptions,
) -> Result<(), Failure> {
    let gathered = Gathered::of(study, store);
    // The results are written even if the requested picture cannot be drawn.
    let sheet = gathered.sheet(drawing);
    let drawn = sheet.as_ref().ok().and_then(Option::as_ref);
    let findings = gathered.findings(drawn.cloned())?;
    show(&findings, options.json, Some(store.folder()))?;
    if options.files.are_given() {
        let document = of_study(&gathered, &options.file, store.folder())?;
        options.files.save(&Findings {
            document,
            ..findings
        })?;
    }
    sheet?;
    let (mut missing, mut failed) = (Vec::new(), Vec::new());
    for (cell, state) in study.cells.iter().zip(&gathered.states) {
        match state {
            State::Finished(_) => {}
            State::Missing => missing.push(cell.number),
            State::Failed(message) => failed.push((cell.to_string(), message.clone())),
        }
    }
    let (count, of) = (missing.len(), study.cells.len());
    if count > 0 {
        let missing = ranges(&missing);
        talk(&format!(
            "note: {count} of {of} cells are missing: {missing}"
        ));
    }
    some_failed(&failed, of)?;
    match count {
        0 => Ok(()),
        _ => Err(Failure::Output(
            "the study is not finished; the tables have the finished cells (those of another version of the engine \
             do not count)"
                .to_owned(),
        )),
    }
}

/// An error if some cells failed: their names and the reasons.
fn some_failed(failed: &[(String, String)], of: usize) -> Result<(), Failure> {
    /// Most failures to print: more would scroll the first ones off the screen.
    const MOST: usize = 5;
    if failed.is_empty() {
        return Ok(());
    }
    let mut text = format!(
        "{} of {of} cells failed (run the same command to retry them):",
        failed.len()
    );
    for (cell, why) in failed.iter().take(MOST) {
        text += &format!("\n  {cell}: {why}");
    }
    if failed.len() > MOST {
        text += &format!("\n  … and {} more", failed.len() - MOST);
    }
    Err(Failure::Output(text))
}

fn told_json(tally: &Tally, shard: Shard) -> Value {
    let failed = tally.failed.iter();
    let failed = failed.map(|(cell, why)| json!({ "cell": cell, "error": why }));
    json!({
        "shard": shard.to_string(),
        "cells": tally.jobs,
        "kept": tally.kept + tally.by_others,
        "repeated": tally.repeated,
        "finished": tally.finished,
        "failed": failed.collect::<Vec<_>>(),
    })
}

fn told(tally: &Tally, shard: Shard) -> String {
    let (cells, finished, failed) = (tally.jobs, tally.finished, tally.failed.len());
    let kept = tally.kept + tally.by_others;
    let repeated = match tally.repeated {
        0 => String::new(),
        repeated => format!(", {repeated} same as another cell"),
    };
    format!(
        "shard {shard}: {cells} cell(s); {finished} finished now, {kept} before, {failed} failed{repeated}\n"
    )
}

/// Formats ascending numbers as ranges: `1–3, 7`.
fn ranges(numbers: &[usize]) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => runs.push([number, number]),
        }
    }
    let text = runs.iter().map(|[first, last]| match first == last {
        true => first.to_string(),
        false => format!("{first}–{last}"),
    });
    text.collect::<Vec<_>>().join(", ")
}

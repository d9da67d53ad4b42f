//! `sandbox verify` and `sandbox validate`: suites of cases with expected results.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::terminal::{say_text, talk};
use super::update::CaseOptions;
use super::watch::Watch;
use crate::lab::suite::{Chosen, Judged, Status, Suite};
use crate::runs::outputs::write_whole;
use crate::runs::store::Store;
use crate::scenario::catalog;
use crate::scenario::quote::shown;

/// The suites that are built into the program.
pub const VERIFICATION: &str = "verification";
pub const VALIDATION: &str = "validation";

#[derive(Args)]
pub struct VerifyOptions {
    /// Only this case, such as 6, 12a, 12 or iso6; give it several times for several cases
    #[arg(long, value_name = "CASE")]
    pub only: Vec<String>,
    /// A suite of your own: a study with `cases` (docs/validation.md) [default: the cases below]
    #[arg(value_name = "SUITE.json")]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct ValidateOptions {
    /// Only these scenes, such as gap-2.4 or door [default: all]; after SUITE.json those of a suite of your own: a
    /// study with `cases` (docs/validation.md)
    #[arg(value_name = "SUITE.json|SCENE")]
    pub scene: Vec<String>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct SuiteOptions {
    /// Folder with files of trajectories: scenes that begin from such a file are skipped without it
    /// (docs/validation.md)
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// This profile in place of the default ones (verify: sph, sf->sph, rvo->sph; validate: also walk+sph and
    /// steer+sph); give it several times for several profiles
    #[arg(long, value_name = "PROFILE", value_parser = PossibleValuesParser::new(catalog::names()))]
    pub profile: Vec<String>,
    /// Number of seeds per run: 1, 2, …; verify: a case passes if it does with all of them; validate: means over seeds
    /// [default: the suite's; of the cases below 3 of validate and 1 of verify]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: Option<u64>,
    #[command(flatten)]
    pub cases: CaseOptions,
}

pub fn verify(options: &VerifyOptions) -> Result<(), Failure> {
    let suite = match &options.file {
        Some(file) => Suite::read(file)?,
        None => Suite::built_in(VERIFICATION)?,
    };
    let names = ("--only ", options.only.as_slice());
    judge(&suite, Judged::Seeds, names, &options.suite)
}

pub fn validate(options: &ValidateOptions) -> Result<(), Failure> {
    let (suite, names) = match options.scene.split_first() {
        Some((file, names)) if file.ends_with(".json") => (Suite::read(Path::new(file))?, names),
        _ => (Suite::built_in(VALIDATION)?, options.scene.as_slice()),
    };
    judge(&suite, Judged::Means, ("", names), &options.suite)
}

/// All cases of a built-in suite, each with a line about it.
pub fn about(suite: &str) -> String {
    let cases = Suite::built_in(suite).map_or_else(|_| Vec::new(), |suite| suite.cases);
    let widest = cases.iter().map(|case| case.name.len()).max();
    let width = widest.unwrap_or_default();
    let lines = cases
        .iter()
        .map(|case| format!("  {:<width$}  {}\n", case.name, case.title()));
    lines.collect()
}

/// Runs the cases with these names, all without names. `option` begins messages about a name.
fn judge(
    suite: &Suite,
    judged: Judged,
    (option, names): (&str, &[String]),
    options: &SuiteOptions,
) -> Result<(), Failure> {
    let cases = suite.chosen(names).map_err(|name| {
        let known = suite.cases.iter().map(|case| shown(&case.name));
        let (name, known) = (shown(&name), known.collect::<Vec<_>>().join(", "));
        Failure::Input(format!("{option}{name}: no such case; there are {known}"))
    })?;
    let update = options.cases.document.update.as_deref();
    let status = update.and_then(Status::beside);
    let is_whole = options.profile.is_empty();
    if update.is_some() && !(names.is_empty() && (is_whole || status.is_some())) {
        let reason = "--update needs all cases and profiles; name none";
        return Err(Failure::Input(reason.to_owned()));
    }
    let mut given = options.profile.iter().enumerate();
    if let Some((_, twice)) = given.find(|(k, name)| options.profile[..*k].contains(name)) {
        let reason = format!("--profile {twice}: given twice; give it once");
        return Err(Failure::Input(reason));
    }
    // The scenes are not in the current folder.
    let data = options.data.as_deref();
    let data = data.map(|folder| match fs::canonicalize(folder) {
        Ok(path) if path.is_dir() => Ok(path),
        Ok(_) => Err(unusable(folder, "it is not a folder")),
        Err(error) => Err(unusable(folder, error)),
    });
    let data = data.transpose()?;
    options.cases.check(&[&suite.name])?;
    let planned = suite.planned(&Chosen {
        cases,
        profiles: &options.profile,
        seeds: options.seeds,
        data: data.as_deref(),
    })?;
    let store = Store::open(&options.cases.out)?;
    let report = planned.run(judged, &store, &Watch::new())?;
    let text = report.markdown();
    let said = say_text(&format!("{text}\n"));
    if is_whole {
        options.cases.document.put([(&suite.name, &text)])?;
    }
    if let Some(file) = status
        && let Some(status) = Status::updated(&file, &report)
    {
        let written = write_whole(&file, |whole| whole.write_all(status.as_bytes()));
        written.map_err(|error| {
            Failure::Output(format!("cannot write {}: {error}", file.display()))
        })?;
    }
    for line in report.no_longer_missed() {
        talk(&format!("note: {line}"));
    }
    said?;
    match report.failures() {
        none if none.is_empty() => Ok(()),
        failures => Err(Failure::Output(failures.join("\n"))),
    }
}

fn unusable(folder: &Path, why: impl std::fmt::Display) -> Failure {
    let folder = shown(&folder.display().to_string());
    Failure::Input(format!(
        "--data {folder}: {why}; give the folder with the files"
    ))
}

//! `sandbox verify` and `sandbox validate`: suites of cases with expected results.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::terminal::{say, talk};
use super::update::CaseOptions;
use super::watch::Watch;
use crate::lab::suite::{Chosen, Suite};
use crate::lab::validate::VALIDATION;
use crate::lab::verify::VERIFICATION;
use crate::scenario::catalog;
use crate::scenario::quote::shown;

#[derive(Args)]
pub struct VerifyOptions {
    /// Only this case, such as 6, 12a, 12 or iso6; give it several times for several cases
    #[arg(long, value_name = "CASE")]
    pub only: Vec<String>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct ValidateOptions {
    /// Only these scenes, such as gap-2.4 or door [default: all]
    #[arg(value_name = "SCENE")]
    pub scene: Vec<String>,
    /// Folder with files of trajectories: scenes that begin from such a file are skipped without it
    /// (docs/validation.md)
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct SuiteOptions {
    /// This profile in place of the default ones (verify: sph, sf->sph, rvo->sph; validate: also walk+sph); give it
    /// several times for several profiles
    #[arg(long, value_name = "PROFILE", value_parser = PossibleValuesParser::new(catalog::names()))]
    pub profile: Vec<String>,
    /// Number of seeds per run: 1, 2, …; verify: a case passes if it does with all of them; validate: means over seeds
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    #[command(flatten)]
    pub cases: CaseOptions,
}

pub fn verify(options: &VerifyOptions) -> Result<(), Failure> {
    judge(
        &VERIFICATION,
        ("--only ", &options.only),
        (&options.suite, None),
    )
}

pub fn validate(options: &ValidateOptions) -> Result<(), Failure> {
    let data = options.data.as_deref();
    judge(&VALIDATION, ("", &options.scene), (&options.suite, data))
}

/// All cases of a suite, each with a line about it.
pub fn about(suite: &'static Suite) -> String {
    let widest = suite.all().map(|case| case.id.len()).max();
    let width = widest.unwrap_or_default();
    let line = |id: &str, about: &str| format!("  {id:<width$}  {about}\n");
    suite.all().map(|case| line(case.id, case.about)).collect()
}

/// Runs the cases with these names, all without names. `option` begins messages about a name.
fn judge(
    suite: &'static Suite,
    (option, names): (&str, &[String]),
    (options, data): (&SuiteOptions, Option<&Path>),
) -> Result<(), Failure> {
    let cases = suite.chosen(names).map_err(|name| {
        let ids: Vec<&str> = suite.all().map(|case| case.id).collect();
        let (name, ids) = (shown(&name), ids.join(", "));
        Failure::Input(format!("{option}{name}: no such case; there are {ids}"))
    })?;
    if options.cases.document.update.is_some() && !(names.is_empty() && options.profile.is_empty())
    {
        let reason = "--update needs all cases and profiles; name none";
        return Err(Failure::Input(reason.to_owned()));
    }
    let mut given = options.profile.iter().enumerate();
    if let Some((_, twice)) = given.find(|(k, name)| options.profile[..*k].contains(name)) {
        let reason = format!("--profile {twice}: given twice; give it once");
        return Err(Failure::Input(reason));
    }
    // The scenes are not in the current folder.
    let data = data.map(|folder| match fs::canonicalize(folder) {
        Ok(path) if path.is_dir() => Ok(path),
        Ok(_) => Err(unusable(folder, "it is not a folder")),
        Err(error) => Err(unusable(folder, error)),
    });
    let data = data.transpose()?;
    let store = options.cases.store(&[suite.name])?;
    let chosen = Chosen {
        cases,
        profiles: &options.profile,
        seeds: options.seeds,
        data: data.as_deref(),
    };
    let report = suite.run(&chosen, &store, &Watch::new())?;
    let text = report.markdown();
    let said = say(format!("{text}\n"));
    options.cases.document.put([(suite.name, &text)])?;
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

//! `sandbox verify` and `sandbox validate`: suites of cases with expected results.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::ChangeOptions;
use super::failure::Failure;
use super::terminal::talk;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::suite::{Chosen, Judged, Planned, Status, Suite};
use runs::outputs::{Manner, write_whole};
use runs::store::Store;
use scenario::quote::shown;
use scenario::{Setting, catalog};

/// The suites that are built into the program.
pub const VERIFICATION: &str = "verification";
pub const VALIDATION: &str = "validation";

/// What `--seed` and `--set` mean for suites.
pub const FIRST_SEED: &str = "First seed of every run [default: the suite's seeds]";
pub const EVERY_SCENE: &str =
    "Change a setting of every scene (see `sandbox list --settings`); may be repeated";

#[derive(Args)]
pub struct VerifyOptions {
    /// Only these cases, such as 6, 12a, 12 or iso6 [default: all]; after SUITE.json those of a suite of your own: a
    /// study with `cases` (docs/guide/suites.md)
    #[arg(value_name = "SUITE.json|CASE")]
    pub case: Vec<String>,
    /// The same as CASE
    #[arg(long, value_name = "CASE", hide = true)]
    pub only: Vec<String>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct ValidateOptions {
    /// Only these scenes, such as gap-2.4 or door [default: all]; after SUITE.json those of a suite of your own: a
    /// study with `cases` (docs/guide/suites.md)
    #[arg(value_name = "SUITE.json|SCENE")]
    pub scene: Vec<String>,
    /// Judge another simulator: CMD runs once for each scene and seed, with a scene (.json) and the file for its
    /// trajectories as further arguments (docs/guide/suites.md)
    #[arg(long, value_name = "CMD", conflicts_with_all = ["profile", "update"])]
    pub runner: Option<String>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct SuiteOptions {
    /// Folder with files of trajectories: scenes that begin from such a file are skipped without it
    /// (docs/guide/suites.md)
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
    pub changes: ChangeOptions,
    #[command(flatten)]
    pub cases: CaseOptions,
}

pub fn verify(options: &VerifyOptions) -> Result<(), Failure> {
    if !options.only.is_empty() {
        talk("note: `--only CASE` is `CASE` now: the old spelling works in this version only");
    }
    let named = [options.case.as_slice(), &options.only].concat();
    judge_named(
        &named,
        (VERIFICATION, Judged::Seeds),
        (&options.suite, None),
    )
}

pub fn validate(options: &ValidateOptions) -> Result<(), Failure> {
    let runner = options.runner.as_deref();
    judge_named(
        &options.scene,
        (VALIDATION, Judged::Means),
        (&options.suite, runner),
    )
}

/// Runs cases, of the suite in the first name if it is a file, else of the built-in one.
fn judge_named(
    named: &[String],
    (built_in, judged): (&str, Judged),
    (options, runner): (&SuiteOptions, Option<&str>),
) -> Result<(), Failure> {
    let (file, names) = match named.split_first() {
        Some((file, names)) if file.ends_with(".json") => (Some(Path::new(file)), names),
        _ => (None, named),
    };
    let suite = match file {
        Some(file) => Suite::read(file)?,
        None => Suite::built_in(built_in)?,
    };
    let asked = Asked {
        suite: &suite,
        file,
        judged,
        names,
        runner,
    };
    judge(&asked, options)
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

/// What a command asks for.
struct Asked<'a> {
    suite: &'a Suite,
    /// The file of the suite, if it is not built in.
    file: Option<&'a Path>,
    judged: Judged,
    /// The names of cases; all without names.
    names: &'a [String],
    /// The command of another simulator.
    runner: Option<&'a str>,
}

/// Runs the cases that are asked for.
fn judge(asked: &Asked, options: &SuiteOptions) -> Result<(), Failure> {
    let suite = asked.suite;
    let cases = suite.chosen(asked.names).map_err(|name| {
        let known = suite.cases.iter().map(|case| shown(&case.name));
        let (name, known) = (shown(&name), known.collect::<Vec<_>>().join(", "));
        Failure::Input(format!("{name}: no such case; there are {known}"))
    })?;
    let settings = settings(options)?;
    let status = status(asked, options)?;
    let mut given = options.profile.iter().enumerate();
    if let Some((_, twice)) = given.find(|(k, name)| options.profile[..*k].contains(name)) {
        let reason = format!("--profile {twice}: given twice; give it once");
        return Err(Failure::Input(reason));
    }
    // The scenes are not in the current folder.
    let folder = options.data.as_deref();
    let resolved = folder.map(|folder| match fs::canonicalize(folder) {
        Ok(path) if path.is_dir() => Ok(path),
        Ok(_) => Err(unusable(folder, "it is not a folder")),
        Err(error) => Err(unusable(folder, error)),
    });
    let data = resolved.transpose()?;
    options.cases.apply(&[&suite.name])?;
    let planned = suite.planned(&Chosen {
        cases,
        profiles: &options.profile,
        seeds: options.seeds,
        first_seed: options.changes.seed,
        settings: &settings,
        data: data.as_deref(),
        runner: asked.runner,
    })?;
    let store = opened(&planned, asked, options)?;
    let report = planned.run(asked.judged, &store, &Watch::new())?;
    let findings = report.findings()?;
    // Results of other profiles do not belong in the document, only in the status beside it.
    let said = match options.profile.is_empty() {
        true => options.cases.give(&findings),
        false => options.cases.show(&findings),
    };
    if let Some(file) = status
        && let Some(status) = Status::updated(&file, &report)
    {
        write_whole(&file, |whole| whole.write_all(status.as_bytes())).map_err(|error| {
            Failure::Output(format!("cannot write {}: {error}", file.display()))
        })?;
    }
    for line in report.no_longer_missed() {
        talk(&format!("note: {line}"));
    }
    said?;
    // What another simulator misses is its result, not a failure of ours.
    match report.failures() {
        failures if failures.is_empty() || asked.runner.is_some() => Ok(()),
        failures => Err(Failure::Output(failures.join("\n"))),
    }
}

/// The settings of `--set`. Profiles and seeds have options of their own.
fn settings(options: &SuiteOptions) -> Result<Vec<Setting>, Failure> {
    let settings = options.changes.settings()?;
    for (key, option) in [("profile", "--profile NAME"), ("seed", "--seed N")] {
        if let Some(setting) = settings.iter().find(|setting| setting.path()[0] == key) {
            return Err(Failure::Input(format!("{setting}: give {option} instead")));
        }
    }
    Ok(settings)
}

/// The status file beside the document of `--update`, if there is one. Only results of the whole suite as it is belong
/// into a document, and of all profiles unless there is a status.
fn status(asked: &Asked, options: &SuiteOptions) -> Result<Option<PathBuf>, Failure> {
    let Some(document) = options.cases.document.update.as_deref() else {
        return Ok(None);
    };
    let changes = &options.changes;
    if changes.seed.is_some() || !changes.set.is_empty() {
        let reason = "--update needs the suite as it is; give no --seed and no --set";
        return Err(Failure::Input(reason.to_owned()));
    }
    let status = Status::beside(document);
    match asked.names.is_empty() && (options.profile.is_empty() || status.is_some()) {
        true => Ok(status),
        false => Err(Failure::Input(
            "--update needs all cases and profiles; name none".to_owned(),
        )),
    }
}

/// The folder for the results, after a check that they can be written and replace no input.
fn opened(planned: &Planned, asked: &Asked, options: &SuiteOptions) -> Result<Store, Failure> {
    let own = asked.file.map(|file| ("the suite", file));
    let files = planned.study.inputs();
    let inputs = files.into_iter().map(|path| ("the suite's", path));
    let mut outputs = options.cases.outputs(own.into_iter().chain(inputs));
    for picture in planned.pictures() {
        outputs.writes("--out", &options.cases.out.join(picture), Manner::Beside);
    }
    options.cases.open(outputs, &planned.names(asked.judged))
}

fn unusable(folder: &Path, why: impl std::fmt::Display) -> Failure {
    let folder = shown(&folder.display().to_string());
    Failure::Input(format!(
        "--data {folder}: {why}; give the folder with the files"
    ))
}

//! `sandbox verify` and `sandbox validate`: suites of cases with expected results.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::{ChangeOptions, ReplaceOptions};
use super::failure::Failure;
use super::terminal::{say_text, talk};
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
    /// Only this case, such as 6, 12a, 12 or iso6; give it several times for several cases
    #[arg(long, value_name = "CASE")]
    pub only: Vec<String>,
    /// A suite of your own: a study with `cases` (docs/guide/suites.md) [default: the cases below]
    #[arg(value_name = "SUITE.json")]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub suite: SuiteOptions,
}

#[derive(Args)]
pub struct ValidateOptions {
    /// Only these scenes, such as gap-2.4 or door [default: all]; after SUITE.json those of a suite of your own: a
    /// study with `cases` (docs/guide/suites.md)
    #[arg(value_name = "SUITE.json|SCENE")]
    pub scene: Vec<String>,
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
    #[command(flatten)]
    pub replace: ReplaceOptions,
}

pub fn verify(options: &VerifyOptions) -> Result<(), Failure> {
    let suite = match &options.file {
        Some(file) => Suite::read(file)?,
        None => Suite::built_in(VERIFICATION)?,
    };
    let asked = Asked {
        suite: &suite,
        file: options.file.as_deref(),
        judged: Judged::Seeds,
        names: ("--only ", &options.only),
    };
    judge(&asked, &options.suite)
}

pub fn validate(options: &ValidateOptions) -> Result<(), Failure> {
    let (file, names) = match options.scene.split_first() {
        Some((file, names)) if file.ends_with(".json") => (Some(Path::new(file)), names),
        _ => (None, options.scene.as_slice()),
    };
    let suite = match file {
        Some(file) => Suite::read(file)?,
        None => Suite::built_in(VALIDATION)?,
    };
    let asked = Asked {
        suite: &suite,
        file,
        judged: Judged::Means,
        names: ("", names),
    };
    judge(&asked, &options.suite)
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
    /// The names of cases, all without names. The first text begins messages about a name.
    names: (&'a str, &'a [String]),
}

/// Runs the cases that are asked for.
fn judge(asked: &Asked, options: &SuiteOptions) -> Result<(), Failure> {
    let suite = asked.suite;
    let (option, names) = asked.names;
    let cases = suite.chosen(names).map_err(|name| {
        let known = suite.cases.iter().map(|case| shown(&case.name));
        let (name, known) = (shown(&name), known.collect::<Vec<_>>().join(", "));
        Failure::Input(format!("{option}{name}: no such case; there are {known}"))
    })?;
    let settings = settings(options)?;
    let status = status(asked, options)?;
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
        first_seed: options.changes.seed,
        settings: &settings,
        data: data.as_deref(),
    })?;
    check_outputs(&planned, asked, options)?;
    let store = Store::open(&options.cases.out)?;
    let report = planned.run(asked.judged, &store, &Watch::new())?;
    let text = report.markdown();
    let said = say_text(&format!("{text}\n"));
    if options.profile.is_empty() {
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
    let (_, names) = asked.names;
    match names.is_empty() && (options.profile.is_empty() || status.is_some()) {
        true => Ok(status),
        false => {
            let reason = "--update needs all cases and profiles; name none";
            Err(Failure::Input(reason.to_owned()))
        }
    }
}

/// Rejects results that cannot be written or would replace an input. In a folder that does not belong to a study,
/// existing files with the results' names are replaced only with --force.
fn check_outputs(planned: &Planned, asked: &Asked, options: &SuiteOptions) -> Result<(), Failure> {
    let folder = &options.cases.out;
    let mut outputs = options.replace.outputs(folder);
    if let Some(file) = asked.file {
        outputs.reads("the suite", file);
    }
    for path in planned.study.inputs() {
        outputs.reads("the suite's", path);
    }
    for file in planned.files(asked.judged) {
        // Another process may run the same suite at the same time, so do not create trial files.
        outputs.writes("--out", &folder.join(file), Manner::Beside);
    }
    Ok(outputs.check()?)
}

fn unusable(folder: &Path, why: impl std::fmt::Display) -> Failure {
    let folder = shown(&folder.display().to_string());
    Failure::Input(format!(
        "--data {folder}: {why}; give the folder with the files"
    ))
}

//! `sandbox verify`: verification cases.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::update::CaseOptions;
use super::watch::Watch;
use super::{Failure, say, talk};
use crate::lab::verify::{CASES, chosen, verify};
use crate::scenario::catalog::NAMES;
use crate::scenario::quote::shown;

#[derive(Args)]
pub struct VerifyOptions {
    /// Only this case, such as 6, 12a, 12 or iso6; give it several times for several cases
    #[arg(long, value_name = "CASE")]
    pub only: Vec<String>,
    /// Verify this profile in place of sph, sf->sph and rvo->sph; give it several times for several profiles
    #[arg(long, value_name = "PROFILE", value_parser = PossibleValuesParser::new(NAMES))]
    pub profile: Vec<String>,
    /// Number of seeds per run: 1, 2, …; a case passes if it does with all of them
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    #[command(flatten)]
    pub cases: CaseOptions,
}

/// The name of the table in documents.
const TABLE: &str = "verification";

/// All cases, each with a line about it.
pub fn about() -> String {
    let cases = CASES.iter().copied().flatten();
    cases
        .map(|case| format!("  {:<6} {}\n", case.id, case.about))
        .collect()
}

pub fn run(options: &VerifyOptions) -> Result<(), Failure> {
    let cases = chosen(&options.only).map_err(|name| {
        let all = CASES.iter().copied().flatten();
        let ids: Vec<&str> = all.map(|case| case.id).collect();
        let (name, ids) = (shown(&name), ids.join(", "));
        Failure::Input(format!("--only {name}: no such case; there are {ids}"))
    })?;
    if options.cases.update.is_some() && !(options.only.is_empty() && options.profile.is_empty()) {
        let reason = "--update needs all cases and profiles; leave --only and --profile out";
        return Err(Failure::Input(reason.to_owned()));
    }
    let mut given = options.profile.iter().enumerate();
    if let Some((_, twice)) = given.find(|(k, name)| options.profile[..*k].contains(name)) {
        let reason = format!("--profile {twice}: given twice; give it once");
        return Err(Failure::Input(reason));
    }
    let store = options.cases.store(&[TABLE])?;
    let report = verify(
        &cases,
        &options.profile,
        options.seeds,
        &store,
        &Watch::new(),
    )?;
    let text = report.markdown();
    let said = say(format!("{text}\n"));
    options.cases.update([(TABLE, &text)])?;
    for line in report.no_longer_missed() {
        talk(&format!("note: {line}"));
    }
    said?;
    match report.failures() {
        none if none.is_empty() => Ok(()),
        failures => Err(Failure::Output(failures.join("\n"))),
    }
}

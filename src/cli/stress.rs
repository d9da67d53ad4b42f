//! `sandbox stress`: hard cases, stability maps, jitter.

use clap::Args;

use super::failure::Failure;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::stress::{Detail, PARTS, names, stress};

#[derive(Args)]
pub struct StressOptions {
    /// Coarser maps and a shorter soak test; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    #[command(flatten)]
    pub cases: CaseOptions,
}

pub fn run(options: &StressOptions) -> Result<(), Failure> {
    let store = options.cases.store(&PARTS, &names())?;
    let detail = Detail::read(options.quick)?;
    let report = stress(&detail, &store, &Watch::new())?;
    options.cases.give(&report.findings(&detail)?)?;
    match report.failures() {
        none if none.is_empty() => Ok(()),
        failures => Err(Failure::Output(failures.join("\n"))),
    }
}

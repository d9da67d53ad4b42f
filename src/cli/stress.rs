//! `sandbox stress`: hard cases, stability maps, jitter.

use std::path::PathBuf;

use clap::Args;

use super::update::{check, update};
use super::values::threads;
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::lab::stress::{Detail, stress};
use crate::runs::store::Store;

#[derive(Args)]
pub struct StressOptions {
    /// Coarser maps and a shorter soak test; takes less than a minute
    #[arg(long)]
    pub quick: bool,
    /// Folder for the results; cases finished there are not run again
    #[arg(long, value_name = "DIR", default_value = "stress")]
    pub out: PathBuf,
    /// Also insert the tables into this file, between the lines <!-- NAME --> and <!-- /NAME -->
    #[arg(long, value_name = "FILE.md")]
    pub update: Option<PathBuf>,
    /// Number of cases to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
}

pub fn run(options: &StressOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    if let Some(file) = &options.update {
        check(file, &options.out)?;
    }
    let store = Store::open(&options.out)?;
    let detail = Detail::read(options.quick)?;
    let watch = Watch::new();
    let report = stress(&detail, &store, &watch);
    watch.ends();
    let report = report?;
    let parts = report.parts();
    // Results are printed even if they cannot be saved.
    let updated = options.update.as_ref().map_or(Ok(()), |file| {
        let texts = parts.iter().map(|(name, text)| (*name, text.as_str()));
        update(file, texts)
    });
    parts
        .iter()
        .try_for_each(|(_, text)| say(format!("{text}\n")))?;
    updated?;
    let failures = report.failures();
    if failures.is_empty() {
        Ok(())
    } else {
        Err(Failure::Output(failures.join("\n")))
    }
}

//! `sandbox stress`: where the model breaks.

use super::arguments::StressOptions;
use super::update::{check, update};
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::reproduce::Store;
use crate::stress::{Detail, stress};

pub fn run(options: &StressOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    if let Some(file) = &options.update {
        check(file)?;
    }
    let store = Store::open(&options.out)?;
    let detail = Detail {
        quick: options.quick,
    };
    let watch = Watch::new();
    let report = stress(detail, &store, &watch);
    watch.ends();
    let report = report?;
    let parts = report.parts();
    if let Some(file) = &options.update {
        let texts = parts.iter().map(|(name, text)| (*name, text.as_str()));
        update(file, texts)?;
    }
    parts
        .iter()
        .try_for_each(|(_, text)| say(format!("{text}\n")))?;
    let failures = report.failures();
    if failures.is_empty() {
        Ok(())
    } else {
        Err(Failure::Output(failures.join("\n")))
    }
}

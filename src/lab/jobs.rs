//! Jobs for experiments that need every result.

use std::sync::OnceLock;

use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::error::LabError;
use runs::error::StoreError;
use runs::job::{self, Job, Listener};
use runs::parallel::side_by_side;
use runs::store::Store;

/// The results of `work` for 0, 1, … below `count`, computed on several threads, each call on a single one.
///
/// # Errors
/// There are no threads.
pub fn each<T: Send + Sync>(
    count: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, StoreError> {
    let results: Vec<OnceLock<T>> = (0..count).map(|_| OnceLock::new()).collect();
    side_by_side(count, |k| {
        results[k].set(work(k)).ok();
        Ok::<(), StoreError>(())
    })?;
    let results = results.into_iter();
    Ok(results.filter_map(OnceLock::into_inner).collect())
}

/// Computes the jobs that are not in `store`, and returns all results in the order of the jobs.
///
/// # Errors
/// Some jobs failed, or their results cannot be stored or read. Finished jobs stay stored.
pub fn results(
    jobs: &[Job],
    store: &Store,
    listener: &dyn Listener,
) -> Result<Vec<Value>, LabError> {
    finished(&job::run(jobs, store, None, listener)?)?;
    let result = |job: &Job| {
        let result = store.result(&job.key).map_err(LabError::Data)?;
        result.ok_or_else(|| LabError::missing(&job.name, "result"))
    };
    jobs.iter().map(result).collect()
}

/// Whether all jobs finished.
///
/// # Errors
/// Some failed.
pub fn finished(tally: &job::Tally) -> Result<(), LabError> {
    let failed = tally.failed.iter();
    let lines: Vec<String> = failed
        .map(|(job, message)| format!("{job}: {message}"))
        .collect();
    match lines.is_empty() {
        true => Ok(()),
        false => Err(LabError::Failed(lines.join("\n"))),
    }
}

/// Reads the result of a job.
///
/// # Errors
/// The result has another type.
pub fn read<T: DeserializeOwned>(result: &Value) -> Result<T, LabError> {
    T::deserialize(result).map_err(|error| LabError::Data(error.to_string()))
}

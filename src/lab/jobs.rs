//! Jobs for experiments that need every result.

use std::sync::OnceLock;

use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::error::LabError;
use runs::case::RunResult;
use runs::error::StoreError;
use runs::identity::Identity;
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
    Ok(results
        .into_iter()
        .filter_map(OnceLock::into_inner)
        .collect())
}

/// The results of jobs that finished, by what they are results of.
#[derive(Clone, Copy)]
pub struct Results<'a>(pub &'a Store);

/// Computes the jobs that are not in `store`.
///
/// # Errors
/// Some jobs failed, or their results cannot be stored. Finished jobs stay stored.
pub fn results<'a>(
    jobs: &[Job],
    store: &'a Store,
    listener: &dyn Listener,
) -> Result<Results<'a>, LabError> {
    finished(&job::run(jobs, store, None, listener)?)?;
    Ok(Results(store))
}

impl Results<'_> {
    /// The result with this identity; `name` is its job in messages.
    ///
    /// # Errors
    /// It is missing, damaged, or has another type.
    pub fn of<T: DeserializeOwned>(self, name: &str, key: &Identity) -> Result<T, LabError> {
        let result = self.0.result(key).map_err(LabError::Data)?;
        result.ok_or_else(|| LabError::missing(name, "result"))
    }

    /// The result of a run, or why it has none; `None` if it was not made.
    pub fn outcome(self, key: &Identity) -> Option<Result<RunResult, String>> {
        let failure = || Some(Err(self.0.failure(key)?.message));
        self.0.result(key).transpose().or_else(failure)
    }
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

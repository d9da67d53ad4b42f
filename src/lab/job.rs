//! Jobs that run in parallel. Finished results are stored, and not computed again.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::lab::reproduce::{ReproduceError, Store};
use crate::scenario::input::{self, LONGEST_TEXT};

/// A hash of the engine's sources, 16 letters: results of other engines are not reused.
const ENGINE: &str = env!("SANDBOX_ENGINE");
/// Increase this whenever a change outside the engine affects the result of a job.
const VERSION: u32 = 7;

/// Receives progress reports.
pub trait Listener: Sync {
    /// `jobs` jobs begin, which take about `seconds` seconds on one core; the results of `kept` others are in the
    /// store.
    fn begins(&self, jobs: usize, kept: usize, seconds: f64);
    /// A message, one line.
    fn notes(&self, text: &str);
    /// A job that was expected to take `expected` seconds took `seconds`.
    fn finishes(&self, job: &str, expected: f64, seconds: f64);
}

/// Ignores all reports.
impl Listener for () {
    fn begins(&self, _: usize, _: usize, _: f64) {}
    fn notes(&self, _: &str) {}
    fn finishes(&self, _: &str, _: f64, _: f64) {}
}

/// A piece of work with a result.
pub struct Job {
    /// A readable name, unique among all jobs.
    pub name: String,
    /// Further input that the result depends on.
    input: String,
    /// Estimated time on one core, seconds.
    pub expected_secs: f64,
    /// Does the work.
    pub work: Box<dyn Fn() -> Result<Value, ReproduceError> + Send + Sync>,
}

/// The contents of a job's file.
#[derive(Serialize, Deserialize)]
struct Kept {
    identity: String,
    result: Value,
}

impl Job {
    /// A job that does `work`.
    pub fn new<T: Serialize>(
        name: String,
        expected_secs: f64,
        work: impl Fn() -> Result<T, ReproduceError> + Send + Sync + 'static,
    ) -> Self {
        let value = move || {
            serde_json::to_value(work()?).map_err(|error| ReproduceError::Data(error.to_string()))
        };
        Self {
            name,
            input: String::new(),
            expected_secs,
            work: Box::new(value),
        }
    }

    /// The same job with a text that its result depends on.
    #[must_use]
    pub fn depending_on(self, input: impl Into<String>) -> Self {
        Self {
            input: input.into(),
            ..self
        }
    }

    fn identity(&self) -> String {
        format!("{ENGINE} {VERSION} {} {}", self.name, self.input)
    }

    /// The file of its result, relative to the store.
    fn file(&self) -> String {
        let mut hasher = DefaultHasher::new();
        self.identity().hash(&mut hasher);
        let readable = self.name.chars().take(60);
        let stem = readable.map(|c| {
            if c.is_ascii_alphanumeric() || c == '.' {
                c
            } else {
                '-'
            }
        });
        format!(
            "cases/{}-{:016x}.json",
            stem.collect::<String>(),
            hasher.finish()
        )
    }

    fn kept(&self, store: &Store) -> Option<Value> {
        let text = input::bytes(&store.path(&self.file()), LONGEST_TEXT).ok()?;
        let kept: Kept = serde_json::from_slice(&text).ok()?;
        (kept.identity == self.identity()).then_some(kept.result)
    }

    fn finish(&self, store: &Store, listener: &dyn Listener) -> Result<Value, ReproduceError> {
        let start = Instant::now();
        let result = (self.work)()?;
        let kept = Kept {
            identity: self.identity(),
            result: result.clone(),
        };
        let text =
            serde_json::to_vec(&kept).map_err(|error| ReproduceError::Data(error.to_string()))?;
        store.write(&self.file(), &text)?;
        listener.finishes(
            &self.name,
            self.expected_secs,
            start.elapsed().as_secs_f64(),
        );
        Ok(result)
    }
}

/// Does the jobs whose results are not in `store`, on as many threads as rayon has, each job on a single thread.
/// Returns all results in the order of the jobs.
///
/// # Errors
/// The first job that fails or whose result cannot be stored. Jobs that finished before stay stored.
pub fn run(
    store: &Store,
    jobs: &[Job],
    listener: &dyn Listener,
) -> Result<Vec<Value>, ReproduceError> {
    let kept: Vec<Option<Value>> = jobs.iter().map(|job| job.kept(store)).collect();
    let mut missing: Vec<usize> = (0..jobs.len()).filter(|&k| kept[k].is_none()).collect();
    missing.sort_by(|&a, &b| jobs[b].expected_secs.total_cmp(&jobs[a].expected_secs));
    let seconds = missing.iter().map(|&k| jobs[k].expected_secs).sum();
    listener.begins(missing.len(), jobs.len() - missing.len(), seconds);
    let results = Mutex::new(kept);
    side_by_side(missing.len(), |place| {
        let k = missing[place];
        let result = jobs[k].finish(store, listener)?;
        results.lock().unwrap_or_else(|broken| broken.into_inner())[k] = Some(result);
        Ok(())
    })?;
    let results = results
        .into_inner()
        .unwrap_or_else(|broken| broken.into_inner());
    Ok(results.into_iter().flatten().collect())
}

/// Calls `work` with 0, 1, … below `count`, on as many threads as rayon has, each call on a single thread. Calls begin
/// in this order, as threads become free.
///
/// # Errors
/// The first call that fails; no call begins after it.
pub fn side_by_side(
    count: usize,
    work: impl Fn(usize) -> Result<(), ReproduceError> + Sync,
) -> Result<(), ReproduceError> {
    let next = AtomicUsize::new(0);
    let work = || {
        let pool = one_thread()?;
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                return Ok(());
            }
            if let Err(error) = pool.install(|| work(k)) {
                next.store(count, Ordering::Relaxed);
                return Err(error);
            }
        }
    };
    // These are separate threads: a thread of rayon's pool would start a second call while it waits for the first.
    std::thread::scope(|scope| {
        let threads = rayon::current_num_threads().min(count);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| {
            let crashed = |_| ReproduceError::Data("a thread crashed".to_owned());
            worker.join().map_err(crashed)?
        })
    })
}

/// Reads the result of a job.
///
/// # Errors
/// The result has another type.
pub fn read<T: DeserializeOwned>(result: &Value) -> Result<T, ReproduceError> {
    T::deserialize(result).map_err(|error| ReproduceError::Data(error.to_string()))
}

fn one_thread() -> Result<rayon::ThreadPool, ReproduceError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| ReproduceError::Data(format!("no thread can be started: {error}")))
}

//! Jobs: pieces of work with a result. They run in parallel; finished results are stored, and not computed again.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde::Serialize;
use serde_json::Value;

use super::error::StoreError;
use super::identity::Identity;
use super::memory::Memory;
use super::parallel::side_by_side;
use super::store::{Failure, Store};

/// Receives progress reports; times are expected seconds on one core.
pub trait Listener: Sync {
    /// `jobs` jobs begin, which are expected to take `seconds` seconds; the results of `kept` others are in the store.
    fn begins(&self, _jobs: usize, _kept: usize, _seconds: f64) {}
    /// Jobs advanced by another `seconds` of their expected time.
    fn advances(&self, _seconds: f64) {}
    /// A job finished after `seconds` seconds.
    fn finishes(&self, _job: &str, _seconds: f64) {}
    /// A job failed.
    fn fails(&self, _job: &str, _message: &str) {}
    /// A message, one line.
    fn notes(&self, _text: &str) {}
}

/// Ignores all reports.
impl Listener for () {}

/// Receives the finished fraction of a job's work.
pub type Progress<'a> = &'a mut dyn FnMut(f64);

/// A piece of work with a result.
pub struct Job<'a> {
    /// Its name in messages.
    pub name: String,
    /// The identity of everything that its result depends on.
    pub key: Identity,
    /// Estimated time on one core, seconds; the longest jobs begin first.
    pub expected_secs: f64,
    /// Estimated memory, bytes.
    pub bytes: u64,
    /// Whether it runs on all threads while no other job runs, because its time is measured.
    pub alone: bool,
    work: Box<Work<'a>>,
}

type Work<'a> = dyn Fn(Progress) -> Result<Value, String> + Send + Sync + 'a;

/// Counts of the outcomes of some jobs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tally {
    /// Number of jobs.
    pub jobs: usize,
    /// Jobs whose results existed before.
    pub kept: usize,
    /// Jobs with the identity of an earlier job; they share its result.
    pub repeated: usize,
    /// Jobs finished by this call.
    pub finished: usize,
    /// Jobs finished by another process during this call.
    pub by_others: usize,
    /// Failed jobs in order: name and error message.
    pub failed: Vec<(String, String)>,
}

/// The outcome of one job.
enum End {
    Finished,
    ByOthers,
    Failed(String),
}

/// A job to be computed.
struct Todo<'a> {
    /// Its place in the list of jobs.
    place: usize,
    job: &'a Job<'a>,
    /// Number of earlier attempts.
    attempts: u32,
}

impl<'a> Job<'a> {
    /// A job that does `work`; it runs beside others and needs little memory.
    pub fn new<T: Serialize, E: Display>(
        name: String,
        key: Identity,
        expected_secs: f64,
        work: impl Fn(Progress) -> Result<T, E> + Send + Sync + 'a,
    ) -> Self {
        let value = move |progress: Progress| {
            let result = work(progress).map_err(|error| error.to_string())?;
            serde_json::to_value(result).map_err(|error| error.to_string())
        };
        Self {
            name,
            key,
            expected_secs,
            bytes: 0,
            alone: false,
            work: Box::new(value),
        }
    }
}

/// Computes the jobs whose results are not in `store`, the longest first, on as many threads as rayon has, each job on
/// a single thread; then those that run alone. At any time only as many jobs run as fit into `memory`, bytes. Each
/// result is stored as soon as it is finished. At the end, waits for jobs that another process is computing, and
/// computes those for which that process leaves no result.
///
/// # Errors
/// Results cannot be stored. A failed job is not an error: it is in the tally, and the next call tries it again.
pub fn run(
    jobs: &[Job],
    store: &Store,
    memory: Option<u64>,
    listener: &dyn Listener,
) -> Result<Tally, StoreError> {
    let mut tally = Tally {
        jobs: jobs.len(),
        ..Tally::default()
    };
    let todo = missing(jobs, store, listener, &mut tally);
    let seconds = todo.iter().map(|todo| todo.job.expected_secs).sum();
    listener.begins(todo.len(), tally.kept, seconds);
    let (alone, beside): (Vec<Todo>, Vec<Todo>) = todo.into_iter().partition(|t| t.job.alone);
    let context = Context {
        store,
        memory: Memory::new(memory),
        listener,
        ends: Mutex::default(),
    };
    side_by_side(beside.len(), |k| context.run(&beside[k], false))?;
    alone.iter().try_for_each(|todo| context.run(todo, false))?;
    let mut left: Vec<&Todo> = beside.iter().chain(&alone).collect();
    left.retain(|todo| !context.ends().contains_key(&todo.place));
    if !left.is_empty() {
        let count = left.len();
        listener.notes(&format!(
            "waiting for {count} case(s) that another process computes"
        ));
    }
    side_by_side(left.len(), |k| context.run(left[k], true))?;
    for (place, end) in std::mem::take(&mut *context.ends()) {
        match end {
            End::Finished => tally.finished += 1,
            End::ByOthers => tally.by_others += 1,
            End::Failed(message) => tally.failed.push((jobs[place].name.clone(), message)),
        }
    }
    Ok(tally)
}

/// The jobs without a result, the longest first.
fn missing<'a>(
    jobs: &'a [Job],
    store: &Store,
    listener: &dyn Listener,
    tally: &mut Tally,
) -> Vec<Todo<'a>> {
    let (mut todo, mut seen) = (Vec::new(), HashSet::new());
    for (place, job) in jobs.iter().enumerate() {
        if !seen.insert(&job.key) {
            tally.repeated += 1;
            continue;
        }
        let result = store.result::<Value>(&job.key).unwrap_or_else(|reason| {
            listener.notes(&format!("{reason}; it is computed again"));
            None
        });
        if result.is_some() {
            tally.kept += 1;
            continue;
        }
        let attempts = store
            .failure(&job.key)
            .map_or(0, |failure| failure.attempts);
        todo.push(Todo {
            place,
            job,
            attempts,
        });
    }
    todo.sort_by(|a, b| b.job.expected_secs.total_cmp(&a.job.expected_secs));
    todo
}

/// The state that all jobs share while they run.
struct Context<'a> {
    store: &'a Store,
    memory: Memory,
    listener: &'a dyn Listener,
    /// The outcomes of jobs, by their places.
    ends: Mutex<BTreeMap<usize, End>>,
}

impl Context<'_> {
    fn ends(&self) -> MutexGuard<'_, BTreeMap<usize, End>> {
        self.ends.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Computes a job and stores its result, unless another process has stored it. Leaves the job without an outcome if
    /// another process is computing it and `wait` is false.
    fn run(&self, todo: &Todo, wait: bool) -> Result<(), StoreError> {
        let Some(_claim) = self.store.claim(&todo.job.key, wait)? else {
            return Ok(());
        };
        let end = match self.found(todo) {
            Some(end) => {
                self.listener.advances(todo.job.expected_secs);
                end
            }
            None => self.compute(todo)?,
        };
        self.ends().insert(todo.place, end);
        Ok(())
    }

    /// The outcome that another process has stored since this call began.
    fn found(&self, todo: &Todo) -> Option<End> {
        let key = &todo.job.key;
        if let Ok(Some(_)) = self.store.result::<Value>(key) {
            return Some(End::ByOthers);
        }
        let failure = self.store.failure(key)?;
        (failure.attempts > todo.attempts).then_some(End::Failed(failure.message))
    }

    fn compute(&self, todo: &Todo) -> Result<End, StoreError> {
        let job = todo.job;
        let mut reported = 0.0;
        let mut report = |part: f64| {
            let due = job.expected_secs * part;
            if due - reported >= 0.1 || part >= 1.0 {
                self.listener.advances(due - reported);
                reported = due;
            }
        };
        let start = Instant::now();
        let lent = self.memory.lend(job.bytes);
        let computed = caught(|| (job.work)(&mut report));
        drop(lent);
        report(1.0);
        let attempts = todo.attempts + 1;
        let kept = computed.map_err(|message| Failure { message, attempts });
        self.store.keep(&job.key, &job.name, &kept)?;
        match kept {
            Ok(_) => {
                let seconds = start.elapsed().as_secs_f64();
                self.listener.finishes(&job.name, seconds);
                Ok(End::Finished)
            }
            Err(Failure { message, .. }) => {
                self.listener.fails(&job.name, &message);
                Ok(End::Failed(message))
            }
        }
    }
}

/// Turns a panic into an error, so that other jobs continue.
fn caught<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let owned = panic.downcast_ref::<String>().map(String::as_str);
        let text = owned.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("panicked: {}", text.unwrap_or("no message")))
    })
}

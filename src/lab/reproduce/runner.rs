//! Runs cases in parallel.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use super::case::{Case, CaseResult, Key};
use super::error::ReproduceError;
use super::store::{Found, Store};
use crate::engine::simulation::{Fault, Simulation};
use crate::runs::drive::{Then, drive, unless_over};
use crate::scenario::Scenario;
use crate::scenario::metrics::Metrics;

/// Receives progress reports; times are expected seconds on one core.
pub trait Listener: Sync {
    /// `cases` cases begin, which take `seconds` seconds; `kept` others are in the store.
    fn begins(&self, cases: usize, kept: usize, seconds: f64);
    /// Another `seconds` of the expected time are done.
    fn advances(&self, seconds: f64);
    /// A case is finished.
    fn finishes(&self, result: &CaseResult);
    /// A message.
    fn notes(&self, text: &str);
}

/// Ignores all reports.
impl Listener for () {
    fn begins(&self, _: usize, _: usize, _: f64) {}
    fn advances(&self, _: f64) {}
    fn finishes(&self, _: &CaseResult) {}
    fn notes(&self, _: &str) {}
}

/// The results of some cases.
#[derive(Debug, Default)]
pub struct Results(HashMap<Key, CaseResult>);

impl Results {
    /// The result of a case.
    ///
    /// # Errors
    /// It was not run.
    pub fn of(&self, case: &Case) -> Result<&CaseResult, ReproduceError> {
        self.0
            .get(&case.key()?)
            .ok_or_else(|| ReproduceError::Missing {
                case: case.name(),
                what: "result".to_owned(),
            })
    }
}

/// A case to be computed.
struct Job {
    case: Case,
    key: Key,
    scenario: Scenario,
    /// The result from an earlier run, which lacks some of the data to keep.
    before: Option<CaseResult>,
}

/// Computes the cases that are not in `store`, on as many threads as rayon has, each on a single thread; then the cases
/// that run alone. Each result is stored as soon as it is finished.
///
/// # Errors
/// The first case that fails or cannot be stored. Cases that had begun are finished and stored.
pub fn run(
    store: &Store,
    cases: &[Case],
    listener: &dyn Listener,
) -> Result<Results, ReproduceError> {
    let mut results = Results::default();
    let mut jobs = Vec::new();
    for (key, case) in merged(cases)? {
        let before = match store.find(&case, &key) {
            Found::Whole(result) => {
                results.0.insert(key, result);
                continue;
            }
            Found::Part(result) => Some(result),
            Found::Nothing => None,
            Found::Damaged(reason) => {
                let path = store.case_path(&key);
                let path = path.display();
                listener.notes(&format!("{path}: {reason}; it is computed again"));
                None
            }
        };
        let scenario = case.scenario()?;
        jobs.push(Job {
            case,
            key,
            scenario,
            before,
        });
    }
    jobs.sort_by(|a, b| b.case.expected_secs().total_cmp(&a.case.expected_secs()));
    let seconds = jobs.iter().map(|job| job.case.expected_secs()).sum();
    listener.begins(jobs.len(), results.0.len(), seconds);
    let (alone, beside): (Vec<Job>, Vec<Job>) =
        jobs.into_iter().partition(|job| job.case.is_alone());
    for (key, result) in side_by_side(store, &beside, listener)? {
        results.0.insert(key, result);
    }
    for job in &alone {
        let result = job.run(store, listener)?;
        results.0.insert(job.key.clone(), result);
    }
    Ok(results)
}

/// All distinct runs, each with all data to keep of it.
fn merged(cases: &[Case]) -> Result<Vec<(Key, Case)>, ReproduceError> {
    let mut order: Vec<(Key, Case)> = Vec::new();
    let mut places = HashMap::new();
    for case in cases {
        let key = case.key()?;
        match places.entry(key.clone()) {
            Entry::Occupied(place) => {
                let (_, first): &mut (Key, Case) = &mut order[*place.get()];
                first.keep_also(case);
            }
            Entry::Vacant(place) => {
                place.insert(order.len());
                order.push((key, case.clone()));
            }
        }
    }
    Ok(order)
}

/// Runs the jobs in order, as threads become free.
fn side_by_side(
    store: &Store,
    jobs: &[Job],
    listener: &dyn Listener,
) -> Result<Vec<(Key, CaseResult)>, ReproduceError> {
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let finished = Mutex::new(Vec::with_capacity(jobs.len()));
    let work = || {
        while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            if stopped.load(Ordering::Relaxed) {
                break;
            }
            let result = one_thread()?.install(|| job.run(store, listener));
            if result.is_err() {
                stopped.store(true, Ordering::Relaxed);
            }
            let mut finished = finished.lock().unwrap_or_else(|broken| broken.into_inner());
            finished.push((job.key.clone(), result?));
        }
        Ok::<(), ReproduceError>(())
    };
    // These are separate threads: a thread of rayon's pool would start a second case while it waits for the first.
    std::thread::scope(|scope| {
        let threads = rayon::current_num_threads().min(jobs.len());
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| {
            let crashed = |_| ReproduceError::Data("a thread crashed".to_owned());
            worker.join().map_err(crashed)?
        })
    })?;
    Ok(finished
        .into_inner()
        .unwrap_or_else(|broken| broken.into_inner()))
}

fn one_thread() -> Result<rayon::ThreadPool, ReproduceError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| ReproduceError::Data(format!("no thread can be started: {error}")))
}

impl Job {
    /// Runs the case and stores its result.
    fn run(&self, store: &Store, listener: &dyn Listener) -> Result<CaseResult, ReproduceError> {
        let mut told = 0.0;
        let mut tell = |part: f64| {
            let due = self.case.expected_secs() * part;
            if due - told >= 0.1 || part >= 1.0 {
                listener.advances(due - told);
                told = due;
            }
        };
        let computed = compute(&self.case, &self.scenario, &mut tell);
        tell(1.0);
        let mut result = computed.map_err(|fault| ReproduceError::Fault {
            case: self.case.name(),
            fault,
        })?;
        for (name, value) in self.before.iter().flat_map(|before| &before.kept) {
            result
                .kept
                .entry(name.clone())
                .or_insert_with(|| value.clone());
        }
        store.keep(&self.key, &result)?;
        listener.finishes(&result);
        Ok(result)
    }
}

/// Runs one case on rayon's current threads; `tell` receives the finished fraction of the simulated time.
fn compute(
    case: &Case,
    scenario: &Scenario,
    tell: &mut dyn FnMut(f64),
) -> Result<CaseResult, Fault> {
    let start = Instant::now();
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let mut metrics = Metrics::new(scenario.measurements.clone(), &mut simulation);
    let probes = case.probes();
    let mut observers: Vec<_> = probes.iter().map(|p| p.begin(&mut simulation)).collect();
    let duration = scenario.duration_secs;
    drive(&mut simulation, duration, |simulation, _| {
        metrics.observe(simulation);
        for observer in &mut observers {
            observer.observe(simulation);
        }
        tell(simulation.frame().clock.time() / duration.max(f64::MIN_POSITIVE));
        Ok::<Then, Fault>(unless_over(simulation, scenario))
    })?;
    let kept = probes.iter().zip(observers);
    let arrivals = &simulation.outcome().arrivals;
    let counted = arrivals.iter().filter(|arrival| arrival.counted);
    let times: Vec<f64> = counted.map(|arrival| arrival.time).collect();
    Ok(CaseResult {
        case: case.name(),
        computed_in_secs: start.elapsed().as_secs_f64(),
        ended_at_secs: simulation.frame().clock.time(),
        metrics: metrics
            .results(&simulation)
            .into_iter()
            .map(|metric| (metric.name, metric.value))
            .collect(),
        uncounted: arrivals.len() - times.len(),
        arrivals: times,
        remaining: simulation.frame().agents.len(),
        kept: kept
            .map(|(probe, observer)| (probe.name(), observer.finish()))
            .collect(),
    })
}

//! Runs cells in parallel, each on a single thread.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::cell::Cell;
use super::kept::{CellResult, Failure, Shelf};
use super::memory::Memory;
use super::{Shard, Study};
use crate::engine::simulation::{Fault, Simulation};
use crate::lab::job::side_by_side;
use crate::lab::reproduce::ReproduceError;
use crate::runs::drive::{Then, drive, unless_over};
use crate::runs::summary::Summary;
use crate::scenario::Scenario;
use crate::scenario::metrics::Metrics;
use crate::scenario::quote::shown;

/// Receives progress reports; times are expected seconds on one core.
pub trait Listener: Sync {
    /// `cells` cells begin, which take `seconds` seconds; `kept` others are on the shelf.
    fn begins(&self, cells: usize, kept: usize, seconds: f64);
    /// Another `seconds` of the expected time are done.
    fn advances(&self, seconds: f64);
    /// A cell finished after `seconds` seconds.
    fn finishes(&self, cell: &Cell, seconds: f64);
    /// A cell failed.
    fn fails(&self, cell: &Cell, message: &str);
    /// A message.
    fn notes(&self, text: &str);
}

/// Ignores all reports.
impl Listener for () {
    fn begins(&self, _: usize, _: usize, _: f64) {}
    fn advances(&self, _: f64) {}
    fn finishes(&self, _: &Cell, _: f64) {}
    fn fails(&self, _: &Cell, _: &str) {}
    fn notes(&self, _: &str) {}
}

/// Counts of the outcomes of some cells.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tally {
    /// Number of cells.
    pub cells: usize,
    /// Cells whose results existed before.
    pub kept: usize,
    /// Cells with the same scenario, settings and seed as an earlier cell; they share its result.
    pub repeated: usize,
    /// Cells finished by this call.
    pub finished: usize,
    /// Cells finished by another process during this call.
    pub by_others: usize,
    /// Failed cells in order: name and error message.
    pub failed: Vec<(String, String)>,
}

/// The outcome of one cell.
enum End {
    Finished,
    ByOthers,
    Failed(String),
}

/// A cell to be computed.
struct Todo<'a> {
    cell: &'a Cell,
    memory: &'a Memory,
    /// Number of earlier attempts.
    attempts: u32,
}

/// Computes the cells of a shard that are not on the `shelf`, the longest first, on as many threads as rayon has, each
/// cell on a single thread. At any time only as many cells run as fit into the study's memory. Each result is stored as
/// soon as it is finished. At the end, waits for cells that another process is computing, and computes those for which
/// that process leaves no result.
///
/// # Errors
/// Results cannot be stored. A failed cell is not an error: it is in the tally, and the next call tries it again.
pub fn run(
    study: &Study,
    shard: Shard,
    shelf: &Shelf,
    listener: &dyn Listener,
) -> Result<Tally, ReproduceError> {
    let memory = Memory::new(study.memory);
    let mut tally = Tally::default();
    let mut todo = Vec::new();
    let mut seen = HashSet::new();
    for cell in study.cells.iter().filter(|cell| shard.has(cell.number)) {
        tally.cells += 1;
        let result = shelf.result(cell).unwrap_or_else(|reason| {
            listener.notes(&format!("{reason}; it is computed again"));
            None
        });
        if !seen.insert(cell.key()) {
            tally.repeated += 1;
            continue;
        }
        if result.is_some() {
            tally.kept += 1;
            continue;
        }
        let attempts = shelf.failure(cell).map_or(0, |failure| failure.attempts);
        todo.push(Todo {
            cell,
            memory: &memory,
            attempts,
        });
    }
    todo.sort_by(|a, b| b.cell.expected_secs.total_cmp(&a.cell.expected_secs));
    let seconds = todo.iter().map(|todo| todo.cell.expected_secs).sum();
    listener.begins(todo.len(), tally.kept, seconds);
    let ends = Mutex::new(Vec::with_capacity(todo.len()));
    let ended = |cell: usize, end| {
        let mut ends = ends.lock().unwrap_or_else(PoisonError::into_inner);
        ends.push((cell, end));
    };
    let taken = Mutex::new(Vec::new());
    side_by_side(todo.len(), |k| {
        match todo[k].run(shelf, listener, false)? {
            Some(end) => ended(todo[k].cell.number, end),
            None => taken.lock().unwrap_or_else(PoisonError::into_inner).push(k),
        }
        Ok(())
    })?;
    let taken = taken.into_inner().unwrap_or_else(PoisonError::into_inner);
    if !taken.is_empty() {
        let count = taken.len();
        listener.notes(&format!(
            "waiting for {count} cell(s) that another process computes"
        ));
    }
    side_by_side(taken.len(), |k| {
        let todo = &todo[taken[k]];
        if let Some(end) = todo.run(shelf, listener, true)? {
            ended(todo.cell.number, end);
        }
        Ok(())
    })?;
    let mut ends = ends.into_inner().unwrap_or_else(PoisonError::into_inner);
    ends.sort_by_key(|(cell, _)| *cell);
    for (number, end) in ends {
        match end {
            End::Finished => tally.finished += 1,
            End::ByOthers => tally.by_others += 1,
            End::Failed(message) => {
                let cell = study.cells[number - 1].to_string();
                tally.failed.push((cell, message));
            }
        }
    }
    Ok(tally)
}

impl Todo<'_> {
    /// Computes the cell and stores its result, unless another process has. `None` if another process is computing it
    /// and `wait` is false.
    fn run(
        &self,
        shelf: &Shelf,
        listener: &dyn Listener,
        wait: bool,
    ) -> Result<Option<End>, ReproduceError> {
        let Some(_claim) = shelf.claim(self.cell, wait)? else {
            return Ok(None);
        };
        if let Ok(Some(_)) = shelf.result(self.cell) {
            listener.advances(self.cell.expected_secs);
            return Ok(Some(End::ByOthers));
        }
        let failure = shelf.failure(self.cell);
        if let Some(failure) = failure.filter(|failure| failure.attempts > self.attempts) {
            listener.advances(self.cell.expected_secs);
            return Ok(Some(End::Failed(failure.message)));
        }
        let mut told = 0.0;
        let mut tell = |part: f64| {
            let due = self.cell.expected_secs * part;
            if due - told >= 0.1 || part >= 1.0 {
                listener.advances(due - told);
                told = due;
            }
        };
        let lent = self.memory.lend(self.cell.need.bytes());
        let computed = caught(|| compute(self.cell, &mut tell));
        drop(lent);
        tell(1.0);
        match computed {
            Ok(result) => {
                shelf.keep(self.cell, &result)?;
                listener.finishes(self.cell, result.wall_secs);
                Ok(Some(End::Finished))
            }
            Err(message) => {
                let failure = Failure {
                    message: message.clone(),
                    attempts: self.attempts + 1,
                };
                shelf.keep_failure(self.cell, &failure)?;
                listener.fails(self.cell, &message);
                Ok(Some(End::Failed(message)))
            }
        }
    }
}

/// Runs a cell on rayon's current threads; `tell` receives the finished fraction of the simulated time.
fn compute(cell: &Cell, tell: &mut dyn FnMut(f64)) -> Result<CellResult, String> {
    let scenario = cell.scenario().map_err(|error| error.to_string())?;
    if !cell.is_of(&scenario) {
        return Err(format!(
            "{} has changed since the study was read",
            shown(&scenario.name)
        ));
    }
    simulated(&scenario, tell).map_err(|fault| fault.to_string())
}

fn simulated(scenario: &Scenario, tell: &mut dyn FnMut(f64)) -> Result<CellResult, Fault> {
    let start = Instant::now();
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let mut metrics = Metrics::new(scenario.measurements.clone(), &mut simulation);
    let duration = scenario.duration_secs;
    drive(&mut simulation, duration, |simulation, _| {
        metrics.observe(simulation);
        tell(simulation.frame().clock.time() / duration.max(f64::MIN_POSITIVE));
        Ok::<Then, Fault>(unless_over(simulation, scenario))
    })?;
    let arrivals = &simulation.outcome().arrivals;
    Ok(CellResult {
        summary: Summary::of(scenario, &simulation, &metrics),
        evacuated: arrivals.iter().filter(|arrival| arrival.counted).count(),
        remaining: simulation.frame().agents.len(),
        wall_secs: start.elapsed().as_secs_f64(),
    })
}

/// Turns a panic into an error, so that other cells continue.
fn caught<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("panicked: {}", text.unwrap_or("no message")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_failure_with_its_message() {
        assert_eq!(caught(|| Ok(1)), Ok(1));
        let number = 7;
        let said = caught::<()>(|| panic!("cell {number}"));
        assert_eq!(said, Err("panicked: cell 7".to_owned()));
    }
}

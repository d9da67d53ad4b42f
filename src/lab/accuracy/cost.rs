//! The cost of settings: milliseconds per simulated second on one thread. The settings take turns.

use serde_json::Value;

use super::scenes::simulation;
use crate::engine::simulation::Simulation;
use crate::analysis::statistics::Range;
use crate::lab::bench::{BenchError, Contender, alternate, pool};
use crate::lab::error::LabError;

/// Simulated time of one measurement, seconds.
const SECONDS: f64 = 0.96;

/// A crowd that repeats the same frames from the same start in every turn.
struct Again<'a> {
    start: Simulation,
    pool: &'a rayon::ThreadPool,
}

impl Contender for Again<'_> {
    fn ms_per_step(&mut self, steps: u64) -> Result<f64, BenchError> {
        let Self { start, pool } = self;
        let mut simulation = start.clone();
        let time = simulation.frame().clock.time_step();
        let frames = ((SECONDS * steps as f64) / time).round() as u64;
        let ms = pool.install(|| crate::lab::bench::ms_per_frame(&mut simulation, frames))?;
        Ok(ms / time)
    }
}

/// Milliseconds per simulated second of a document under each of several settings.
///
/// # Errors
/// A setting is invalid, or a run fails.
pub fn measure(
    document: &Value,
    settings: &[Vec<String>],
    repeats: usize,
) -> Result<Vec<Range>, LabError> {
    let failed = |error: BenchError| LabError::Data(error.to_string());
    let pool = pool(1).map_err(failed)?;
    let mut contenders: Vec<Box<dyn Contender>> = Vec::with_capacity(settings.len());
    for settings in settings {
        contenders.push(Box::new(Again {
            start: simulation(document, settings)?,
            pool: &pool,
        }));
    }
    let times = alternate(&mut contenders, repeats, 1).map_err(failed)?;
    Ok(times.iter().map(|times| Range::of(times)).collect())
}

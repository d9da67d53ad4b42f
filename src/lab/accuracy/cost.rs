//! The cost of settings: milliseconds per simulated second on one thread. The settings take turns.

use serde_json::Value;

use super::scenes::{run_until, simulation};
use crate::bench::timing::{Contender, alternate, ms_per_frame, pool};
use crate::error::LabError;
use analysis::statistics::Range;
use scenario::Setting;

/// Simulated time of one measurement, seconds.
const SECONDS: f64 = 1.2;

/// Milliseconds per simulated second of a document under each of several settings, from `from_secs` on; an error if a
/// setting is invalid or a run fails.
pub fn measure<'a>(
    document: &Value,
    from_secs: f64,
    settings: impl Iterator<Item = &'a [Setting]>,
    repeats: usize,
) -> Result<Vec<Range>, LabError> {
    let pool = pool(1)?;
    let mut contenders: Vec<Contender> = Vec::new();
    for settings in settings {
        let mut start = simulation(document, settings)?;
        run_until(&mut start, from_secs)?;
        let pool = &pool;
        // Every turn repeats the same frames from the same start.
        contenders.push(Box::new(move |turns| {
            let mut simulation = start.clone();
            let time = simulation.frame().clock.time_step();
            let frames = ((SECONDS * turns as f64) / time).round() as u64;
            let ms = pool.install(|| ms_per_frame(&mut simulation, frames))?;
            Ok(ms / time)
        }));
    }
    let times = alternate(&mut contenders, repeats, 1)?;
    Ok(times.iter().map(|times| Range::of(times)).collect())
}

//! Timing of simulation steps.

use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::error::BenchError;
use crate::engine::simulation::{Fault, Simulation, Stage, StageTimes};

/// Warm-up frames, which bring a copied crowd into the caches.
const WARMING: u64 = 5;

/// A simulation whose steps are timed.
pub trait Contender {
    /// Takes `steps` steps, and returns milliseconds per step.
    ///
    /// # Errors
    /// The simulation fails.
    fn ms_per_step(&mut self, steps: u64) -> Result<f64, BenchError>;
}

/// Lets all contenders take `steps` steps in turn, `repeats` times. Returns milliseconds per step for each contender
/// and turn.
///
/// # Errors
/// A contender fails.
pub fn alternate(
    contenders: &mut [Box<dyn Contender + '_>],
    repeats: usize,
    steps: u64,
) -> Result<Vec<Vec<f64>>, BenchError> {
    let mut times = vec![Vec::with_capacity(repeats); contenders.len()];
    for _ in 0..repeats {
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            times.push(contender.ms_per_step(steps)?);
        }
    }
    Ok(times)
}

/// Milliseconds per frame of the next `frames` frames.
pub fn ms_per_frame(simulation: &mut Simulation, frames: u64) -> Result<f64, Fault> {
    let start = Instant::now();
    for _ in 0..frames {
        simulation.step()?;
    }
    Ok(1e3 * start.elapsed().as_secs_f64() / frames as f64)
}

/// A crowd that continues from one turn to the next.
pub struct GoingOn {
    pub simulation: Simulation,
    pub pool: ThreadPool,
}

impl Contender for GoingOn {
    fn ms_per_step(&mut self, steps: u64) -> Result<f64, BenchError> {
        let Self { simulation, pool } = self;
        Ok(pool.install(|| ms_per_frame(simulation, steps))?)
    }
}

/// The stage times of the `frames` frames after a warm-up from `start`: the same frames in every call.
pub fn replay(start: &Simulation, frames: u64) -> Result<StageTimes, Fault> {
    let mut simulation = warmed(start.clone())?;
    simulation.reset_stages();
    for _ in 0..frames {
        simulation.step()?;
    }
    Ok(simulation.stages().clone())
}

/// The simulation after the warm-up.
pub fn warmed(mut simulation: Simulation) -> Result<Simulation, Fault> {
    for _ in 0..WARMING {
        simulation.step()?;
    }
    Ok(simulation)
}

/// Milliseconds per frame of one stage; 0 if it never ran.
pub fn ms_of(times: &StageTimes, wanted: Stage) -> f64 {
    let mut stages = times.ms_per_frame();
    stages
        .find(|(stage, _)| *stage == wanted)
        .map_or(0.0, |(_, ms)| ms)
}

/// A pool of `threads` threads.
pub fn pool(threads: usize) -> Result<ThreadPool, BenchError> {
    let built = ThreadPoolBuilder::new().num_threads(threads).build();
    built.map_err(|error| BenchError::Threads {
        threads,
        reason: error.to_string(),
    })
}

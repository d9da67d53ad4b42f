//! Timing of simulation steps.

use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::LabError;
use engine::simulation::{Fault, Simulation, Stage, StageTimes};
use runs::error::StoreError;

/// Warm-up frames, which bring a copied crowd into the caches.
const WARMING: u64 = 5;

/// A simulation whose steps are timed: takes a number of steps, and returns milliseconds per step.
pub type Contender<'a> = Box<dyn FnMut(u64) -> Result<f64, LabError> + 'a>;

/// Lets all contenders take `steps` steps in turn, `repeats` times. Returns milliseconds per step for each contender
/// and turn.
///
/// # Errors
/// A contender fails.
pub fn alternate(
    contenders: &mut [Contender],
    repeats: usize,
    steps: u64,
) -> Result<Vec<Vec<f64>>, LabError> {
    let mut times = vec![Vec::with_capacity(repeats); contenders.len()];
    for _ in 0..repeats {
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            times.push(contender(steps)?);
        }
    }
    Ok(times)
}

/// The error of a timed simulation.
pub fn failed(fault: Fault) -> LabError {
    LabError::of("timed run", fault)
}

/// Milliseconds per frame of the next `frames` frames.
pub fn ms_per_frame(simulation: &mut Simulation, frames: u64) -> Result<f64, LabError> {
    // On a thread of the pool: frames do not begin with a handover.
    rayon::scope(|_| {
        let start = Instant::now();
        for _ in 0..frames {
            simulation.step().map_err(failed)?;
        }
        Ok(1e3 * start.elapsed().as_secs_f64() / frames as f64)
    })
}

/// A crowd that continues from one turn to the next, on `threads` threads.
pub fn going_on(mut crowd: Simulation, threads: usize) -> Result<Contender<'static>, LabError> {
    let pool = pool(threads)?;
    Ok(Box::new(move |steps| {
        pool.install(|| ms_per_frame(&mut crowd, steps))
    }))
}

/// A copy of a simulation after the warm-up, with its stage times set to 0.
pub fn warmed(start: &Simulation) -> Result<Simulation, LabError> {
    let mut simulation = start.clone();
    ms_per_frame(&mut simulation, WARMING)?;
    simulation.reset_stages();
    Ok(simulation)
}

/// Milliseconds per frame of one stage; 0 if it never ran.
pub fn ms_of(times: &StageTimes, wanted: Stage) -> f64 {
    let found = times.ms_per_frame().find(|(stage, _)| *stage == wanted);
    found.map_or(0.0, |(_, ms)| ms)
}

/// A pool of `threads` threads.
pub fn pool(threads: usize) -> Result<ThreadPool, LabError> {
    let built = ThreadPoolBuilder::new().num_threads(threads).build();
    built.map_err(|error| StoreError::Threads(format!("{threads}: {error}")).into())
}

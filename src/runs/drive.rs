//! The drive loop: a scenario from its first frame to its end.

use std::time::Instant;

use crate::engine::simulation::{Fault, Simulation};
use crate::scenario::Scenario;

/// Whether a run continues after a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Then {
    /// Compute the next frame.
    GoOn,
    /// This frame is the last.
    Stop,
}

/// Runs until `duration` seconds, or until `observe` returns [`Then::Stop`]. `observe` gets every evaluated frame and
/// the milliseconds that the previous frame took.
///
/// # Errors
/// The simulation fails, or `observe` does.
pub fn drive<E: From<Fault>>(
    simulation: &mut Simulation,
    duration: f64,
    mut observe: impl FnMut(&Simulation, f64) -> Result<Then, E>,
) -> Result<(), E> {
    let last_frame = simulation.frame().clock.frame_at(duration);
    let mut ms = 0.0;
    loop {
        let start = Instant::now();
        simulation.evaluate()?;
        let evaluated = start.elapsed();
        let then = observe(simulation, ms)?;
        if simulation.frame().clock.frame() >= last_frame || then == Then::Stop {
            return Ok(());
        }
        let start = Instant::now();
        simulation.integrate()?;
        ms = 1e3 * (evaluated + start.elapsed()).as_secs_f64();
    }
}

/// Stops when one of the scenario's [`stop`](Scenario::stop) conditions holds.
pub fn unless_over(simulation: &Simulation, scenario: &Scenario) -> Then {
    let frame = simulation.frame();
    let empty = frame.agents.is_empty() && !simulation.expects_agents();
    let arrivals = simulation.outcome().arrivals.iter().rev();
    let last_arrival = arrivals
        .filter(|arrival| arrival.counted)
        .map(|arrival| arrival.time)
        .next()
        .unwrap_or(0.0);
    let idle = frame.clock.time() - last_arrival;
    let is_idle = scenario.stop.idle_secs.is_some_and(|most| idle > most);
    if (scenario.stop.when_empty && empty) || is_idle {
        Then::Stop
    } else {
        Then::GoOn
    }
}

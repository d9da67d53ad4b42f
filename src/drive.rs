//! The drive loop: a scenario from its first frame to its end.

use std::time::Instant;

use crate::scenario::Scenario;
use crate::simulation::{Fault, Simulation};

/// Runs to `duration` seconds or the scenario's own end; `observe` sees every evaluated frame with
/// the milliseconds that the frame before took.
///
/// # Errors
/// The simulation cannot go on, or `observe` does not want to.
pub fn drive<E: From<Fault>>(
    simulation: &mut Simulation,
    scenario: &Scenario,
    duration: f64,
    mut observe: impl FnMut(&Simulation, f64) -> Result<(), E>,
) -> Result<(), E> {
    let last_frame = simulation.frame().clock.frame_at(duration);
    let mut ms = 0.0;
    loop {
        let start = Instant::now();
        simulation.evaluate()?;
        let evaluated = start.elapsed();
        observe(simulation, ms)?;
        if simulation.frame().clock.frame() >= last_frame || is_over(simulation, scenario) {
            return Ok(());
        }
        let start = Instant::now();
        simulation.integrate()?;
        ms = 1e3 * (evaluated + start.elapsed()).as_secs_f64();
    }
}

/// Has the scenario come to its own end?
fn is_over(simulation: &Simulation, scenario: &Scenario) -> bool {
    let frame = simulation.frame();
    let empty = frame.agents.is_empty() && !simulation.expects_agents();
    let arrivals = simulation.outcome().arrivals.iter().rev();
    let last_arrival = arrivals
        .filter(|arrival| arrival.counted)
        .map(|arrival| arrival.time)
        .next()
        .unwrap_or(0.0);
    let idle = frame.clock.time() - last_arrival;
    (scenario.stop.when_empty && empty) || scenario.stop.idle_secs.is_some_and(|most| idle > most)
}

//! A scenario at one moment or at its end, for commands that look at it.

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::inputs::scenario as read;
use super::interrupt::Interrupt;
use super::watch::Progress;
use crate::engine::simulation::Simulation;
use crate::runs::case::Source;
use crate::runs::drive::{Observer, Run};
use crate::runs::outputs::Outputs;
use crate::scenario::Scenario;

/// Reads a built-in scenario or a scenario file; if the time `at`, seconds, lies beyond its end, sources continue until
/// then. Writing output takes `writing` bytes of memory per agent.
pub fn scenario(
    name: &str,
    (scene, at): (&SceneOptions, f64),
    writing: u64,
    outputs: &mut Outputs,
) -> Result<Scenario, Failure> {
    let source = Source::named(name);
    let scenario = read(&source, scene, None, writing, outputs)?;
    match at <= scenario.duration_secs {
        true => Ok(scenario),
        false => read(&source, scene, Some(("--at", at)), writing, outputs),
    }
}

/// Drives a run to its end, which `more` observes, too.
///
/// # Errors
/// The simulation fails, an observer does, or a signal arrives.
pub fn to_the_end<'a>(
    run: &mut Run,
    more: impl IntoIterator<Item = Box<dyn Observer<Failure> + Send + 'a>>,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(|error| Failure::Output(error.to_string()))?;
    let interrupted = || interrupt.exit_code().is_some();
    let progress = Progress::new(run.scenario.duration_secs);
    let mut observers: Vec<Box<dyn Observer<Failure> + Send + 'a>> = vec![Box::new(progress)];
    observers.extend(more);
    let driven = rayon::scope(|_| run.drive(&mut observers, interrupted));
    driven.map_err(|failure| failure.with_forces(&mut run.simulation))?;
    match interrupt.exit_code() {
        Some(exit_code) => {
            let time = run.simulation.frame().clock.time();
            Err(Failure::Stopped { time, exit_code })
        }
        None => Ok(()),
    }
}

/// Advances to a time, seconds, even beyond the scenario's end; fails if no agents are left before. `option` asks for
/// the time.
pub fn advance(
    simulation: &mut Simulation,
    to: f64,
    (option, progress): (&str, &Progress),
) -> Result<(), Failure> {
    let last = simulation.frame().clock.frame_at(to);
    while simulation.frame().clock.frame() < last {
        progress.show(simulation);
        simulation.step()?;
        if simulation.frame().agents.count_present() == 0 && !simulation.expects_agents() {
            return Err(none_left(option, simulation));
        }
    }
    Ok(())
}

/// `option` asks for a time at which no agents are left.
pub fn none_left(option: &str, simulation: &Simulation) -> Failure {
    let time = simulation.frame().clock.time();
    Failure::Input(format!(
        "{option}: no agents are left at that time: the last one leaves at {time:.2} s"
    ))
}

//! A scenario at one moment or at its end, for commands that look at it.

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::inputs::scenario as read;
use super::interrupt::Interrupt;
use super::watch::Progress;
use engine::simulation::Simulation;
use runs::case::Source;
use runs::drive::{Observer, Run};
use runs::outputs::Outputs;
use scenario::Scenario;

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

/// Advances to the frame nearest to a time, seconds, even beyond the scenario's end; fails if no agents are left then.
/// `option` asks for the time.
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
            return Err(none_left((option, to), simulation));
        }
    }
    Ok(())
}

/// `option` asks for a time, seconds, at which no agents are left: the last one has just left.
pub fn none_left((option, asked): (&str, f64), simulation: &Simulation) -> Failure {
    /// Times that differ by less are equal, seconds.
    const ROUNDING: f64 = 1e-9;
    let clock = simulation.frame().clock;
    let time = clock.time();
    Failure::Input(match asked < time - ROUNDING {
        true => format!(
            "{option}: no agents are left in the nearest frame, that of {time:.2} s; give at most {:.2}",
            clock.time_at(clock.frame().saturating_sub(1))
        ),
        false => {
            format!("{option}: no agents are left at that time: the last one leaves at {time:.2} s")
        }
    })
}

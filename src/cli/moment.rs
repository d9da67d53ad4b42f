//! A scenario at one moment, for commands that look at it.

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::inputs::scenario as read;
use super::watch::Progress;
use crate::engine::simulation::Simulation;
use crate::runs::case::Source;
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
            let time = simulation.frame().clock.time();
            return Err(Failure::Input(format!(
                "{option}: no agents are left at that time: the last one leaves at {time:.2} s"
            )));
        }
    }
    Ok(())
}

//! A scenario at one moment, for commands that look at it.

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::inputs::scenario as read;
use super::watch::Progress;
use crate::engine::pairs::Precision;
use crate::engine::simulation::Simulation;
use crate::runs::case::Source;
use crate::runs::outputs::Outputs;
use crate::scenario::Scenario;

/// A moment, as typed.
pub struct Moment<'a> {
    /// A built-in scenario or a scenario file.
    pub scenario: &'a str,
    pub scene: &'a SceneOptions,
    /// Seconds.
    pub at: f64,
}

/// Reads the scenario; if the moment lies beyond its end, sources continue until then. Writing output takes `writing`
/// bytes of memory per agent.
pub fn scenario(moment: &Moment, writing: u64, outputs: &mut Outputs) -> Result<Scenario, Failure> {
    let source = Source::named(moment.scenario);
    let scenario = read(&source, moment.scene, None, writing, outputs)?;
    if moment.at <= scenario.duration_secs {
        return Ok(scenario);
    }
    let at = Some(("--at", moment.at));
    read(&source, moment.scene, at, writing, outputs)
}

/// Advances to the time `at` in seconds, even beyond the scenario's end; fails if no agents are left before. The state
/// is that of a normal run; only the last frame is evaluated in double precision throughout.
pub fn go_to(at: f64, simulation: &mut Simulation) -> Result<(), Failure> {
    let progress = Progress::new(at);
    let last = simulation.frame().clock.frame_at(at);
    while simulation.frame().clock.frame() < last {
        progress.show(simulation);
        simulation.step()?;
        if simulation.frame().agents.count_present() == 0 && !simulation.expects_agents() {
            let time = simulation.frame().clock.time();
            return Err(Failure::Input(format!(
                "--at {at}: no agents are left at that time: the last one leaves at {time:.2} s"
            )));
        }
    }
    simulation.set_precision(Precision::Double);
    simulation.evaluate()?;
    Ok(())
}

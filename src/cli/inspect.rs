//! `sandbox inspect`: single agents, term by term.

use serde_json::json;

use super::arguments::{InspectOptions, Source};
use super::drive::Progress;
use super::output;
use super::{Failure, say, scenario as read, use_threads};
use crate::breakdown::Breakdown;
use crate::outputs::{Manner, Outputs};
use crate::pairs::Precision;
use crate::simulation::Simulation;

pub fn run(options: &InspectOptions) -> Result<(), Failure> {
    use_threads(options.scene.program.threads)?;
    if options.save.is_some() {
        output::check_enabled()?;
    }
    let source = Source::named(&options.scenario);
    let mut outputs = Outputs::new(options.scene.program.force);
    let mut scenario = read(&source, &options.scene, None, 0, &mut outputs)?;
    if options.at > scenario.duration_secs {
        // Sources go on until then.
        let at = Some(("--at", options.at));
        scenario = read(&source, &options.scene, at, 0, &mut outputs)?;
    }
    if let Some(path) = &options.save {
        outputs.writes("--save", path, Manner::InPlace);
    }
    outputs.check()?;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    // The rest density follows the density's history, so every frame needs it.
    simulation.request_density_until(u64::MAX);
    let progress = Progress::new(options.at);
    let went = rayon::scope(|_| go_to(options.at, &mut simulation, &progress));
    progress.finish();
    went.map_err(|failure| failure.laid_open(&mut simulation))?;
    let breakdowns = breakdowns(&simulation, options)?;
    if let Some(path) = &options.save {
        let ids = breakdowns.iter().map(|breakdown| breakdown.id).collect();
        output::save_moment(path, &scenario, &simulation, ids)?;
    }
    let clock = simulation.frame().clock;
    let (time, frame) = (clock.time(), clock.frame());
    if options.scene.program.json {
        let object = json!({"time_secs": time, "frame": frame, "agents": breakdowns});
        return say(format!("{object}\n"));
    }
    let tables: String = breakdowns
        .iter()
        .map(|agent| format!("\n{agent}"))
        .collect();
    say(format!("t = {time:.2} s, frame {frame}\n{tables}"))
}

/// Advances to a moment in seconds, even beyond the scenario's own end; stops early when no agent is left.
/// The state is that of a run; only the last frame is computed in double precision throughout.
fn go_to(at: f64, simulation: &mut Simulation, progress: &Progress) -> Result<(), Failure> {
    let last = simulation.frame().clock.frame_at(at);
    while simulation.frame().clock.frame() < last {
        progress.show(simulation);
        simulation.step()?;
        if simulation.frame().agents.is_empty() && !simulation.expects_agents() {
            let time = simulation.frame().clock.time();
            return Err(Failure::Input(format!(
                "--at {at}: no agent is left then: the last one leaves at {time:.2} s"
            )));
        }
    }
    simulation.set_precision(Precision::Double);
    Ok(simulation.evaluate()?)
}

fn breakdowns(
    simulation: &Simulation,
    options: &InspectOptions,
) -> Result<Vec<Breakdown>, Failure> {
    let agents = simulation.frame().agents;
    let mut ids = if options.all {
        agents.id.clone()
    } else {
        options.agent.clone()
    };
    if options.all {
        ids.sort_unstable();
    }
    ids.into_iter()
        .map(|id| {
            let i = agents.index_of(id).ok_or_else(|| absent(simulation, id))?;
            Breakdown::of(simulation, i).ok_or_else(|| absent(simulation, id))
        })
        .collect()
}

fn absent(simulation: &Simulation, id: u32) -> Failure {
    let frame = simulation.frame();
    let time = frame.clock.time();
    let entered = frame.agents.entered();
    let reason = if id >= entered {
        format!("only {entered} agents have entered, with ids from 0")
    } else {
        "it has left".to_owned()
    };
    Failure::Input(format!("--agent {id}: not there at {time:.2} s: {reason}"))
}

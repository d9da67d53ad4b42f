//! `sandbox inspect`: the forces on single agents, term by term.

use serde_json::json;

use super::arguments::InspectOptions;
use super::moment::Moment;
use super::{Failure, memory, moment, output, say, use_threads};
use crate::engine::breakdown::Breakdown;
use crate::engine::simulation::{Absent, Simulation};
use crate::output::recording::check_enabled;
use crate::runs::outputs::{Manner, Outputs};

impl InspectOptions {
    fn moment(&self) -> Moment<'_> {
        Moment {
            scenario: &self.scenario,
            scene: &self.scene,
            at: self.at,
        }
    }
}

pub fn run(options: &InspectOptions) -> Result<(), Failure> {
    use_threads(options.scene.program.threads)?;
    if options.save.is_some() {
        check_enabled()?;
    }
    let writing = memory::of_inspecting(options.save.is_some(), options.all);
    let mut outputs = Outputs::new(options.scene.program.force);
    let scenario = moment::scenario(&options.moment(), writing, &mut outputs)?;
    if let Some(path) = &options.save {
        outputs.writes("--save", path, Manner::InPlace);
    }
    outputs.check()?;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    // The rest density depends on the density's history, so every frame needs the density.
    simulation.request_density_until(u64::MAX);
    let went = rayon::scope(|_| moment::go_to(options.at, &mut simulation));
    went.map_err(|failure| failure.laid_open(&mut simulation))?;
    let inspected = inspected(&simulation, options)?;
    if let Some(path) = &options.save {
        let ids = inspected.iter().map(|&(id, _)| id).collect();
        output::save_moment(path, &scenario, &simulation, ids)?;
    }
    let clock = simulation.frame().clock;
    let (time, frame) = (clock.time(), clock.frame());
    let as_json = options.scene.program.json;
    // Print agent by agent: breakdowns of a whole crowd would take far more memory than the run.
    say(match as_json {
        true => "{\"agents\":[".to_owned(),
        false => format!("t = {time:.2} s, frame {frame}\n"),
    })?;
    for (k, &(id, i)) in inspected.iter().enumerate() {
        let breakdown = Breakdown::of(&simulation, i).ok_or_else(|| {
            let reason = format!("--agent {id}: the frame has no densities");
            Failure::Output(reason)
        })?;
        say(match as_json {
            true => format!("{}{}", if k > 0 { "," } else { "" }, json!(breakdown)),
            false => format!("\n{breakdown}"),
        })?;
    }
    match as_json {
        true => say(format!(
            "],\"frame\":{frame},\"time_secs\":{}}}\n",
            json!(time)
        )),
        false => Ok(()),
    }
}

/// Ids and indices of the requested agents.
fn inspected(
    simulation: &Simulation,
    options: &InspectOptions,
) -> Result<Vec<(u32, usize)>, Failure> {
    let agents = simulation.frame().agents;
    if options.all {
        let mut all: Vec<_> = agents.present().map(|i| (agents.id[i], i)).collect();
        all.sort_unstable();
        return Ok(all);
    }
    let index = |&id: &u32| {
        let i = simulation.present(id).map_err(|why| absent(id, why))?;
        Ok((id, i))
    };
    options.agent.iter().map(index).collect()
}

fn absent(id: u32, why: Absent) -> Failure {
    Failure::Input(format!("--agent {id}: {why}"))
}

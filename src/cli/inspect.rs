//! `sandbox inspect`: single agents, term by term.

use serde_json::json;

use super::arguments::{InspectOptions, Source};
use super::drive::Progress;
use super::output;
use super::{Failure, say, scenario, use_threads};
use crate::breakdown::Breakdown;
use crate::pairs::Precision;
use crate::simulation::Simulation;

pub fn run(options: &InspectOptions) -> Result<(), Failure> {
    let scenario = scenario(&Source::named(&options.scenario), &options.scene, None)?;
    use_threads(options.scene.threads)?;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    // The rest density follows the density's history, so every frame needs it.
    simulation.request_density_until(u64::MAX);
    let progress = Progress::new(options.at);
    let went = rayon::scope(|_| go_to(options.at, &mut simulation, &progress));
    progress.finish();
    went?;
    let breakdowns = breakdowns(&simulation, options)?;
    if let Some(path) = &options.save {
        let ids = breakdowns.iter().map(|breakdown| breakdown.id).collect();
        output::save_moment(path, options.scene.force, &scenario, &simulation, ids)?;
    }
    let clock = simulation.frame().clock;
    let (time, frame) = (clock.time(), clock.frame());
    if options.scene.json {
        let object = json!({"time_secs": time, "frame": frame, "agents": breakdowns});
        return say(&format!("{object}\n"));
    }
    let tables: String = breakdowns.iter().map(table).collect();
    say(&format!("t = {time:.2} s, frame {frame}\n{tables}"))
}

/// On to a moment in seconds, though the scenario may have come to its own end before. The state is
/// that of a run; only the last frame is computed in double precision throughout.
fn go_to(at: f64, simulation: &mut Simulation, progress: &Progress) -> Result<(), Failure> {
    let last = simulation.frame().clock.frame_at(at);
    while simulation.frame().clock.frame() < last {
        progress.show(simulation);
        simulation.step()?;
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

/// A breakdown to be read by people.
fn table(agent: &Breakdown) -> String {
    let vector = |[x, y]: [f64; 2]| format!("({x:>10.4}, {y:>10.4})");
    let mut text = format!(
        "\nagent {}: position {} m, velocity {} m/s, radius {:.4} m, mass {:.4}\n",
        agent.id,
        vector(agent.position),
        vector(agent.velocity),
        agent.radius,
        agent.mass
    );
    text += &format!(
        "  density {:.4} P/m² ({:.4} agents + {:.4} walls), mean {:.4}, rest {:.4}, pressure {:.4}\n",
        agent.density,
        agent.density_from_agents,
        agent.density_from_walls,
        agent.mean_density,
        agent.rest_density,
        agent.pressure
    );
    for share in &agent.profiles {
        text += &format!(
            "  {} × {:.4}: accelerations, m/s²\n",
            share.name, share.weight
        );
        for (name, term) in share.accelerations.named() {
            if let Some(term) = term {
                text += &format!("    {name:<18} {}\n", vector(term.into()));
            }
        }
    }
    text += &format!(
        "    {:<18} {}\n",
        "total (weighted)",
        vector(agent.acceleration)
    );
    for wall in &agent.walls {
        text += &format!(
            "  wall {}: nearest point {} m, hidden area {:.5} m², density {:.5} P/m²\n",
            wall.wall,
            vector(wall.nearest_point),
            wall.hidden_area,
            wall.density
        );
    }
    let near: Vec<String> = agent
        .neighbors
        .iter()
        .map(|neighbor| format!("{} ({:.3} m)", neighbor.id, neighbor.distance))
        .collect();
    text + &format!("  {} neighbours: {}\n", near.len(), near.join(", "))
}

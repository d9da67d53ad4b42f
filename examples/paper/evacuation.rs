//! §6.1, the evacuation of a room, and the row of Table 1 that it gives.

use std::error::Error;

use serde_json::{Value, json};

use super::{Agent, Behavior, Crowd, TIME_STEP, Vector, Wall, behavior, evaluate, integrate};

/// The room, [0, 20]² with walls 1 m thick and a doorway of 0.8 m. Reading: the thickness.
const ROOM: [[f64; 2]; 12] = [
    [-1.0, -1.0],
    [21.0, -1.0],
    [21.0, 9.6],
    [20.0, 9.6],
    [20.0, 0.0],
    [0.0, 0.0],
    [0.0, 20.0],
    [20.0, 20.0],
    [20.0, 10.4],
    [21.0, 10.4],
    [21.0, 21.0],
    [-1.0, 21.0],
];
/// 1 m beyond the door. Reading: beyond its outer end.
const GOAL: Vector = Vector { x: 22.0, y: 10.0 };
/// Agents leave within this distance of the goal, meters.
const REMOVAL_RADIUS: f64 = 0.5;
/// The frame at 15 s, in which the density is measured.
const DENSITY_FRAME: u64 = 750;
/// The flow is that of the first agents, up to this number.
const FLOW_OF: usize = 350;
/// Reading: a run ends when the room is empty, after this time without an arrival, or at `LONGEST`, seconds.
const IDLE: f64 = 60.0;
const LONGEST: f64 = 900.0;

/// 400 agents at rest on a grid of 1 m.
pub fn crowd(behavior: Behavior, seed: u64) -> Crowd {
    let cells = (0..400).map(|id| Vector {
        x: f64::from(id % 20) + 0.5,
        y: f64::from(id / 20) + 0.5,
    });
    Crowd {
        agents: (0..)
            .zip(cells)
            .map(|(id, cell)| Agent::new(id, cell, GOAL, seed))
            .collect(),
        walls: Wall::around(&ROOM),
        behavior,
        seed,
        frame: 0,
    }
}

/// Removes the agents that have reached the goal, and returns their number.
pub fn remove_arrived(crowd: &mut Crowd) -> usize {
    let before = crowd.agents.len();
    let stays = |i: &Agent| (GOAL - i.position).norm() > REMOVAL_RADIUS;
    crowd.agents.retain(stays);
    before - crowd.agents.len()
}

/// The results of Table 1 for a profile and its `setting` there: ρ⁰max with SPH, K^ag without.
pub fn results(profile: &str, setting: Option<f64>) -> Result<Value, Box<dyn Error>> {
    let mut behavior = behavior(profile)?;
    match (setting, &mut behavior.profiles[..]) {
        (Some(k_ag), [(profile, _)]) if !profile.sph => profile.agent_stiffness = k_ag,
        (Some(rest_density_max), _) => behavior.rest_density_max = rest_density_max,
        (None, _) => {}
    }
    let mut crowd = crowd(behavior, 1);
    let (mut densities, mut arrivals) = (Vec::new(), Vec::new());
    loop {
        let accelerations = evaluate(&mut crowd);
        if crowd.frame == DENSITY_FRAME {
            densities = crowd.agents.iter().map(|i| i.density).collect();
        }
        let time = crowd.frame as f64 * TIME_STEP;
        let idle = time - arrivals.last().unwrap_or(&0.0);
        if crowd.agents.is_empty() || idle > IDLE || time >= LONGEST {
            break;
        }
        integrate(&mut crowd, &accelerations);
        let arrived = remove_arrived(&mut crowd);
        let time = crowd.frame as f64 * TIME_STEP;
        arrivals.extend((0..arrived).map(|_| time));
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let density = mean(&densities);
    let square = |rho_i: &f64| (rho_i - density).powi(2);
    let squares: Vec<f64> = densities.iter().map(square).collect();
    let last = arrivals.get(FLOW_OF - 1);
    Ok(json!({
        "evacuated": arrivals.len(),
        "density": density,
        "density_std": mean(&squares).sqrt(),
        "flow": last.map(|last| (FLOW_OF - 1) as f64 / (last - arrivals[0])),
    }))
}

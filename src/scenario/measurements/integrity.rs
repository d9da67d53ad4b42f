//! Integrity: agents that pass walls, numbers that are not finite, and the highest speed.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::fence::Fence;
use super::{Measure, Observed, Quantity};
use analysis::evaluated::Evaluated;
use engine::math::{Vector, are_finite};
use engine::simulation::Simulation;

/// The number of agents that were inside an obstacle or moved through a wall, checked without the engine's own
/// geometry; the number of frames in which a position, velocity, acceleration or density was not finite; the highest
/// speed of an agent in any frame and the root mean square speed in the last frame, m/s.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Integrity {}

impl Integrity {
    /// The name of its data: the ids of the first agents that were inside an obstacle or moved through a wall.
    pub const NAME: &str = "ids_through_walls";
}

/// The most ids to name.
const MOST_IDS: usize = 10;

/// What an independent observer has seen of a run.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Watched {
    /// Built from the scene in the first frame.
    #[serde(skip)]
    fence: Option<Fence>,
    /// The last known position of each agent, by id; `None` before the agent's first frame.
    last: Vec<Option<Vector>>,
    /// Number of arrivals that were processed.
    arrivals: usize,
    through_walls: BTreeSet<u32>,
    non_finite_frames: u64,
    /// m/s.
    highest_speed: f64,
}

impl Measure for Integrity {
    type Seen = Watched;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        vec![
            Quantity::new(
                "agents_through_walls",
                "agents",
                "agents that were inside an obstacle or moved through a wall",
            ),
            Quantity::new(
                "non_finite_frames",
                "frames",
                "frames with numbers that are not finite",
            ),
            Quantity::new(
                "highest_speed_m_per_s",
                "m/s",
                "highest speed of an agent in any frame",
            ),
            Quantity::new(
                "speed_at_end_m_per_s",
                "m/s",
                "root mean square of the speeds at the end",
            ),
        ]
    }

    fn observe(&self, seen: &mut Watched, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        seen.observe(simulation);
    }

    fn values(&self, seen: &Watched, simulation: &Simulation) -> Vec<Option<f64>> {
        let agents = simulation.frame().agents;
        let present = agents.present();
        let squares: f64 = present.map(|i| agents.velocity[i].norm_squared()).sum();
        let count = agents.count_present();
        let mean = squares / count as f64;
        vec![
            Some(seen.agents_through_walls(simulation) as f64),
            Some(seen.non_finite_frames as f64),
            Some(seen.highest_speed),
            (count > 0).then(|| mean.sqrt()),
        ]
    }

    fn data(&self, seen: &Watched) -> Option<(String, Value)> {
        let ids: Vec<u32> = seen.through_walls.iter().copied().take(MOST_IDS).collect();
        (!ids.is_empty()).then(|| (Self::NAME.to_owned(), json!(ids)))
    }
}

impl Watched {
    /// Observes an evaluated frame; call it in every frame.
    pub fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let agents = frame.agents;
        let new = || Fence::new(&simulation.scene().walls);
        let fence = self.fence.get_or_insert_with(new);
        let scene = simulation.scene();
        let has_images = scene.period.is_some() || scene.levels.is_some();
        self.last.resize(agents.entered() as usize, None);
        for (&id, &position) in agents.id.iter().zip(&agents.position) {
            let last = self.last[id as usize].replace(position);
            // Across the ends of a period or a join, the last position is the image next to this one.
            let last = last.map(|last| match has_images {
                true => position - scene.walked(last, position),
                false => last,
            });
            let passed = match last {
                None => fence.encloses(position),
                Some(before) => before != position && fence.is_crossed(before, position),
            };
            self.through_walls.extend(passed.then_some(id));
        }
        // Agents that have left made one more move, to their goal.
        for arrival in simulation.outcome().arrivals.iter().skip(self.arrivals) {
            let before = self.last[arrival.id as usize];
            let passed = before.is_some_and(|before| fence.is_crossed(before, arrival.position));
            self.through_walls.extend(passed.then_some(arrival.id));
        }
        self.arrivals = simulation.outcome().arrivals.len();
        let fields = frame.fields;
        let vectors = [&agents.position, &agents.velocity, &fields.acceleration];
        let finite = vectors.into_iter().all(|v| are_finite(v));
        self.non_finite_frames += u64::from(!finite || !are_finite(&fields.density));
        let squares = agents.velocity.iter().map(Vector::norm_squared);
        self.highest_speed = squares.fold(0.0, f64::max).sqrt().max(self.highest_speed);
    }

    /// The number of agents that were inside an obstacle or moved through a wall so far, or are inside an obstacle
    /// now.
    pub fn agents_through_walls(&self, simulation: &Simulation) -> usize {
        let agents = simulation.frame().agents;
        let positions = agents.id.iter().zip(&agents.position);
        let built;
        let fence = match &self.fence {
            Some(fence) => fence,
            None => {
                built = Fence::new(&simulation.scene().walls);
                &built
            }
        };
        let inside = positions.filter(|(id, position)| {
            !self.through_walls.contains(id) && fence.encloses(**position)
        });
        self.through_walls.len() + inside.count()
    }
}

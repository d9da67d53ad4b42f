//! What each agent walks: when it starts, how far and how long; density, speed and flow from these.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::window::walkable_area;
use super::{Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, wide_region};
use analysis::evaluated::Evaluated;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "walks";
/// An agent that keeps this part of its preferred speed has started.
const STARTED: f64 = 0.25;
/// For so long, seconds: a shove by others is shorter.
const KEPT: f64 = 1.0;

/// How far and how long each agent walks in a region, between two times. From the sums over all agents: density (with a
/// region), speed and flow as Edie (1963) defines them. Per agent, in the data: start, distance and time.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Walks {
    /// The beginning of the names of its values. Default: `walks`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// The region: lower left and upper right corner, meters; everywhere if missing.
    pub(super) region: Option<Corners>,
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    from_secs: f64,
    /// The end, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: Option<f64>,
}

/// What one agent has walked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    /// The agent's id.
    pub agent: u32,
    /// The name of its group.
    pub group: String,
    /// s_pref, m/s.
    pub preferred_speed: f64,
    /// When it may start: its entry and its pre-movement time, seconds.
    pub due_secs: f64,
    /// From when on it had a quarter of its preferred speed or more, for a second at least, seconds; `None` before.
    pub started_secs: Option<f64>,
    /// Time in the region, seconds.
    pub secs: f64,
    /// Distance walked in the region, meters.
    pub meters: f64,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// The walk and the last position of each agent, by id.
    walks: Vec<Option<(Walk, Vector)>>,
    /// The time observed, seconds.
    secs: f64,
}

impl Walks {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }

    /// Square meters.
    fn area(&self, scene: &Scene) -> Option<f64> {
        Some(walkable_area(self.region?.into(), scene))
    }
}

impl Measure for Walks {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("walks.region", self.region)
    }

    fn check(&self) -> Result<(), Problem> {
        if let Some(until) = self.until_secs.filter(|until| *until <= self.from_secs) {
            let reason = format!("must be above `from_secs`, {}, not {until}", self.from_secs);
            return Err(Problem::new("walks.until_secs", reason));
        }
        self.region.map_or(Ok(()), |corners| {
            wide_region("walks.region", corners).map(|_| ())
        })
    }

    fn quantities(&self) -> Vec<Quantity> {
        let values = [
            ("agents", "agents", "agents that were there"),
            (
                "density_per_m2",
                "P/m²",
                "person-seconds there / (walkable area · time)",
            ),
            (
                "speed_m_per_s",
                "m/s",
                "meters walked there / person-seconds there",
            ),
            (
                "flow_per_m_per_s",
                "P/(m s)",
                "meters walked there, in all directions / (walkable area · time)",
            ),
            (
                "start_delay_secs",
                "s",
                "whole run: longest time from entry and pre-movement time until an agent walks at a quarter of its \
                 preferred speed for a second",
            ),
        ];
        Quantity::all(self.name(), &values)
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let (scene, frame) = (simulation.scene(), simulation.frame());
        let (clock, agents) = (frame.clock, frame.agents);
        let (now, step) = (clock.time(), clock.time_step());
        let first = clock.frame_at(self.from_secs);
        let last = self.until_secs.map(|until| clock.frame_at(until));
        let is_due = clock.frame() > first && last.is_none_or(|last| clock.frame() <= last);
        seen.secs += if is_due { step } else { 0.0 };
        let region = self.region.map(Region::from);
        seen.walks.resize(agents.entered() as usize, None);
        for i in agents.present() {
            let (id, position) = (agents.id[i], agents.position[i]);
            let (walk, before) = seen.walks[id as usize].get_or_insert_with(|| {
                let own = agents.preferred_speed.get(i).copied();
                let walk = Walk {
                    agent: id,
                    group: scene.groups[usize::from(agents.group[i])].name.clone(),
                    preferred_speed: own.unwrap_or(scene.preferred_speed),
                    due_secs: agents.walks_from.get(i).map_or(now, |from| from.max(now)),
                    started_secs: None,
                    secs: 0.0,
                    meters: 0.0,
                };
                (walk, position)
            });
            let since = walk.started_secs;
            if since.is_none_or(|since| now - since < KEPT) {
                let is_walking = agents.velocity[i].norm() >= STARTED * walk.preferred_speed;
                walk.started_secs = is_walking.then(|| since.unwrap_or(now));
            }
            if is_due && region.is_none_or(|region| region.contains(position)) {
                walk.secs += step;
                walk.meters += scene.walked(*before, position).norm();
            }
            *before = position;
        }
    }

    fn values(&self, seen: &Seen, simulation: &Simulation) -> Vec<Option<f64>> {
        let walks = || seen.walks.iter().flatten().map(|(walk, _)| walk);
        let sum = |of: fn(&Walk) -> f64| walks().map(of).sum::<f64>();
        let (secs, meters) = (sum(|walk| walk.secs), sum(|walk| walk.meters));
        let product = self.area(simulation.scene()).map(|area| area * seen.secs);
        let per_area = |sum: f64| product.filter(|of| *of > 0.0).map(|of| sum / of);
        let delays = walks().filter_map(|walk| Some(walk.started_secs? - walk.due_secs));
        vec![
            Some(walks().filter(|walk| walk.secs > 0.0).count() as f64),
            per_area(secs),
            (secs > 0.0).then(|| meters / secs),
            per_area(meters),
            delays.reduce(f64::max),
        ]
    }

    fn data(&self, seen: &Seen) -> Option<(String, Value)> {
        let walks: Vec<&Walk> = seen.walks.iter().flatten().map(|(walk, _)| walk).collect();
        Some((self.name().to_owned(), json!(walks)))
    }
}

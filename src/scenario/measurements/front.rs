//! The front of a start or a push that runs through a crowd: how fast, and how far.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, Point, wide_region};
use analysis::evaluated::Evaluated;
use analysis::front;
use analysis::statistics::Estimate;
use engine::math::{Vector, direction};
use engine::scene::Region;
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "front";

/// The front at which people begin to move: for each agent, the first time at which it has a part of its preferred
/// speed, over the place where it stood at the start. The speed is that of a robust straight line.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Front {
    /// The beginning of the names of its values. Default: `front`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// Only agents that are here at the start: lower left and upper right corner, meters; all agents if missing.
    pub(super) region: Option<Corners>,
    /// The direction along which places are measured, and in which the front runs. Default: along x.
    #[serde(default = "along_x")]
    direction: Point,
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(default)]
    from_secs: f64,
    /// The end, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: Option<f64>,
    /// An agent moves from this part of its preferred speed on.
    #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
    #[serde(default = "quarter")]
    part: f64,
}

fn along_x() -> Point {
    Point([1.0, 0.0])
}

fn quarter() -> f64 {
    0.25
}

/// An agent, and when the front reached it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reached {
    /// The agent's id.
    pub agent: u32,
    /// Its place along the direction at the start, meters.
    pub place: f64,
    /// When it began to move, seconds; `None` if it did not.
    pub secs: Option<f64>,
    /// Its place at that time, meters.
    pub moved_at: Option<f64>,
    /// The speed from which on it moves, m/s.
    threshold: f64,
}

/// The data of a [`Front`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrontData {
    /// All agents, by id.
    pub people: Vec<Reached>,
    /// dt/dx of the line, s/m.
    pub slowness: Option<f64>,
    /// When the line passes place 0, seconds.
    pub passes_zero: Option<f64>,
}

impl Front {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }

    fn way(&self) -> Vector {
        direction(Vector::from(self.direction))
    }

    /// The front over places at the start, or over the places where agents began to move.
    fn front(
        people: &[Reached],
        time_step: f64,
        place: fn(&Reached) -> Option<f64>,
    ) -> Option<front::Front> {
        let points = people.iter().filter_map(|of| Some([place(of)?, of.secs?]));
        front::Front::through(&points.collect::<Vec<_>>(), time_step)
    }
}

impl Measure for Front {
    /// The agents that were there at the start, by id; `None` before it.
    type Seen = Option<Vec<Reached>>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("front.region", self.region)
    }

    fn check(&self) -> Result<(), Problem> {
        if self.way() == Vector::zeros() {
            return Err(Problem::new("front.direction", "must not be [0, 0]"));
        }
        if let Some(until) = self.until_secs.filter(|until| *until <= self.from_secs) {
            let reason = format!("must be above `from_secs`, {}, not {until}", self.from_secs);
            return Err(Problem::new("front.until_secs", reason));
        }
        self.region.map_or(Ok(()), |corners| {
            wide_region("front.region", corners).map(|_| ())
        })
    }

    fn quantities(&self) -> Vec<Quantity> {
        let values = [
            ("agents", "agents", "people that the front reached"),
            (
                "reach_m",
                "m",
                "distance from the first person to the farthest one reached",
            ),
            (
                "speed_m_per_s",
                "m/s",
                "speed of the front: the median slope of its times over places (Theil 1950)",
            ),
            (
                "speed_error_m_per_s",
                "m/s",
                "standard error of the speed (jackknife)",
            ),
            ("slowness_s_per_m", "s/m", "time per meter, 1 / speed"),
            (
                "slowness_error_s_per_m",
                "s/m",
                "standard error of the slowness",
            ),
            (
                "speed_in_space_m_per_s",
                "m/s",
                "speed over the places where people began to move",
            ),
        ];
        Quantity::all(self.name(), &values)
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let (scene, frame) = (simulation.scene(), simulation.frame());
        let (clock, agents) = (frame.clock, frame.agents);
        let last = self.until_secs.map(|until| clock.frame_at(until));
        if clock.frame() < clock.frame_at(self.from_secs)
            || last.is_some_and(|last| clock.frame() > last)
        {
            return;
        }
        let way = self.way();
        let people = seen.get_or_insert_with(|| {
            let region = self.region.map(Region::from);
            let is_there = |p: Vector| region.is_none_or(|region| region.contains(p));
            let there = agents.present().filter(|&i| is_there(agents.position[i]));
            let mut people: Vec<Reached> = there
                .map(|i| {
                    let own = agents.preferred_speed.get(i).copied();
                    Reached {
                        agent: agents.id[i],
                        place: agents.position[i].dot(&way),
                        secs: None,
                        moved_at: None,
                        threshold: self.part * own.unwrap_or(scene.preferred_speed),
                    }
                })
                .collect();
            people.sort_unstable_by_key(|of| of.agent);
            people
        });
        for i in agents.present() {
            let Ok(k) = people.binary_search_by_key(&agents.id[i], |of| of.agent) else {
                continue;
            };
            let of = &mut people[k];
            if of.secs.is_none() && agents.velocity[i].norm() >= of.threshold {
                of.secs = Some(clock.time());
                of.moved_at = Some(agents.position[i].dot(&way));
            }
        }
    }

    fn values(&self, seen: &Self::Seen, simulation: &Simulation) -> Vec<Option<f64>> {
        let Some(people) = seen else {
            return vec![None; self.quantities().len()];
        };
        let reached = || people.iter().filter(|of| of.secs.is_some());
        let first = people.iter().map(|of| of.place).reduce(f64::min);
        let farthest = reached().map(|of| of.place).reduce(f64::max);
        let time_step = simulation.frame().clock.time_step();
        let front = Self::front(people, time_step, |of| Some(of.place));
        let in_space = Self::front(people, time_step, |of| of.moved_at);
        let speed = |front: Option<front::Front>| front.and_then(|front| front.speed);
        let slowness = front.map(|front| front.slowness);
        let [value, error]: [fn(Estimate) -> f64; 2] = [|of| of.value, |of| of.error];
        vec![
            Some(reached().count() as f64),
            farthest
                .zip(first)
                .map(|(farthest, first)| farthest - first),
            speed(front).map(value),
            speed(front).map(error),
            slowness.map(value),
            slowness.map(error),
            speed(in_space).map(value),
        ]
    }

    fn data(&self, seen: &Self::Seen) -> Option<(String, Value)> {
        let data = seen.as_ref().map(|people| {
            let front = Self::front(people, 0.0, |of| Some(of.place));
            FrontData {
                people: people.clone(),
                slowness: front.map(|front| front.slowness.value),
                passes_zero: front.map(|front| front.starts),
            }
        });
        Some((self.name().to_owned(), json!(data)))
    }
}

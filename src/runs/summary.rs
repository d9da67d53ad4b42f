//! The reproducible results of a run, without run times.

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::drive::{End, Run};
use engine::journeys::{Kind, Place};
use engine::levels::Levels;
use engine::math::Vector;
use engine::scene::Scene;
use engine::simulation::{self, PlaceState, Simulation};
use scenario::in_building;
use scenario::measurements::{
    HighestDensity, Left, LongestQueue, Metric, StuckGroup, times_to_leave,
};

/// The results that every run prints first, but for those of single places.
const FIRST: [&str; 8] = [
    "arrived",
    "remaining",
    "stuck",
    "t50_secs",
    "t95_secs",
    "t100_secs",
    "highest_density",
    "longest_queue",
];
/// `left_by.EXIT`: the number of agents that left by an exit.
const LEFT_BY: &str = "left_by";
/// `queue.PLACE`: the longest queue before a place.
const QUEUE: &str = "queue";
/// The kind of exits.
const EXIT: &str = "exit";

/// The results of a run, part of what `--json` reports.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// The name of the scenario.
    pub scenario: String,
    /// The default profile.
    pub profile: String,
    /// The scenario's `seed`.
    pub seed: u64,
    /// Seed of the population: bodies and start positions. 0 in files of versions that did not write it.
    #[serde(default)]
    pub population_seed: u64,
    /// Seed of the behavior: RVO's candidate velocities.
    #[serde(alias = "behaviour_seed")]
    pub behavior_seed: u64,
    /// SHA-256 of the final state.
    pub state_sha256: String,
    /// Frames computed.
    pub frames: u64,
    /// Simulated time at the end, seconds.
    pub time_secs: f64,
    /// Number of agents that entered.
    pub agents: u32,
    /// Number of agents that reached their goal and left.
    #[serde(default)]
    pub arrived: usize,
    /// Number of agents at the end.
    #[serde(default)]
    pub remaining: usize,
    /// Number of agents that were taken out from outside; not written if there were none.
    #[serde(default, skip_serializing_if = "is_none")]
    pub removed: usize,
    /// When the first of them left, seconds.
    #[serde(default)]
    pub first_secs: Option<f64>,
    /// When half of the agents that entered, and were not removed, had left, seconds.
    #[serde(default)]
    pub t50_secs: Option<f64>,
    /// When 95 % of them had left, seconds.
    #[serde(default)]
    pub t95_secs: Option<f64>,
    /// When all of them had left, seconds.
    #[serde(default)]
    pub t100_secs: Option<f64>,
    /// The highest SPH density at an agent; `None` if no force needs densities.
    #[serde(default)]
    pub highest_density: Option<HighestDensity>,
    /// The longest queue before each place, goal, door and opening, the longest one first.
    #[serde(default)]
    pub longest_queues: Vec<LongestQueue>,
    /// Why the run ended; `None` if it has not.
    pub end: Option<End>,
    /// Number of agents at the end that had made less than 1 m of headway in 20 s of walking.
    #[serde(default)]
    pub stuck: usize,
    /// These agents by the likely cause.
    #[serde(default)]
    pub stuck_because: Vec<StuckGroup>,
    /// The measurements by name; counts are integers, missing values are `null`.
    pub metrics: BTreeMap<String, Value>,
    /// Data of measurements that have more than values, such as snapshots, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub data: BTreeMap<String, Value>,
    /// The journeys that agents have begun.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub journeys: Vec<JourneyResult>,
    /// The places of these journeys: exits, waypoints, waiting areas and queues.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<PlaceResult>,
    /// Moves that were stopped at a wall that they would have crossed.
    pub contained_moves: u64,
    /// The number of times a speed was clamped to `max_speed`.
    pub clamped_speeds: u64,
    /// The agents that waited for room, entrance by entrance.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub backlogs: Vec<Backlog>,
    /// Agents that would have entered inside an obstacle and were moved.
    pub displaced_agents: usize,
}

/// The agents that waited for room at an entrance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Backlog {
    /// The name of the entrance.
    pub entrance: String,
    /// The most agents that waited at once.
    pub largest: u32,
    /// The first time with this number, seconds.
    pub largest_at_secs: f64,
    /// Agents that still wait at the end.
    pub at_end: u32,
}

/// Whether a number need not be written.
fn is_none(number: &usize) -> bool {
    *number == 0
}

impl Summary {
    /// The summary of a finished run.
    pub fn of(run: &Run) -> Self {
        let (scenario, simulation) = (&run.scenario, &run.simulation);
        let (frame, outcome) = (simulation.frame(), simulation.outcome());
        let backlog = |of: simulation::Backlog| Backlog {
            entrance: of.name.to_owned(),
            largest: of.largest,
            largest_at_secs: frame.clock.time_at(of.largest_frame),
            at_end: of.waiting,
        };
        let measured = run.metrics.results(simulation).into_iter();
        let stuck_because = run.metrics.stuck(simulation);
        let times: Vec<f64> = outcome.arrivals.iter().map(|one| one.time).collect();
        let removed = outcome.removed.len();
        let staying = frame.agents.entered() - removed as u32;
        let [t50_secs, t95_secs, t100_secs] = times_to_leave(&times, staying);
        let mut summary = Self {
            scenario: scenario.name.clone(),
            profile: scenario.profile_name.clone(),
            seed: scenario.seed,
            population_seed: simulation.scene().seed,
            behavior_seed: frame.seed,
            state_sha256: simulation.digest(),
            frames: frame.clock.frame(),
            time_secs: frame.clock.time(),
            agents: frame.agents.entered(),
            arrived: outcome.arrivals.len(),
            remaining: frame.agents.count_present(),
            removed,
            first_secs: times.first().copied(),
            t50_secs,
            t95_secs,
            t100_secs,
            highest_density: run.metrics.highest_density(),
            longest_queues: run.metrics.longest_queues(simulation),
            end: run.end,
            stuck: stuck_because.iter().map(|group| group.agents).sum(),
            stuck_because,
            metrics: measured.map(|m| (m.name.clone(), value(&m))).collect(),
            data: run.metrics.data().collect(),
            journeys: JourneyResult::all(simulation),
            places: PlaceResult::all(simulation),
            contained_moves: outcome.contained.count,
            clamped_speeds: outcome.clamped.count,
            backlogs: simulation.backlogs().map(backlog).collect(),
            displaced_agents: outcome.displaced.len(),
        };
        if let Some(levels) = &simulation.scene().levels {
            summary.name_levels(levels);
        }
        summary
    }

    /// Turns places of the plane, in which levels lie side by side, into those of the building.
    fn name_levels(&mut self, levels: &Levels) {
        let of_highest = self.highest_density.iter_mut();
        let of_highest = of_highest.map(|highest| (&mut highest.at, &mut highest.level));
        let of_stuck = self.stuck_because.iter_mut();
        let of_stuck = of_stuck.map(|group| {
            group.cause = in_building(Some(levels), &group.cause);
            (&mut group.at, &mut group.level)
        });
        let of_queues = self.longest_queues.iter_mut().map(|queue| {
            queue.before = in_building(Some(levels), &queue.before);
            (&mut queue.at, &mut queue.level)
        });
        for (at, level) in of_highest.chain(of_stuck).chain(of_queues) {
            let place = Vector::from(*at);
            *level = Some(levels.all()[levels.level(place)].name.clone());
            *at = levels.in_building(place).into();
        }
    }

    /// A metric by name; `None` if it is not measured or has no value.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.get(name)?.as_f64()
    }

    /// A result that runs print first, by its name in studies and estimates ([`Self::first_names`]); `None` if the run
    /// has no such result, or it has no value.
    pub fn first(&self, name: &str) -> Option<f64> {
        let left_by = |exit: &str| {
            let place = self.places.iter().find(|place| place.name == exit)?;
            (place.kind == EXIT).then(|| f64::from(place.passed))
        };
        let queue = |before: &str| {
            let mut queues = self.longest_queues.iter();
            let queue = queues.find(|queue| queue.before == before);
            queue.map_or(0.0, |queue| f64::from(queue.agents))
        };
        match (name, name.split_once('.')) {
            ("arrived", _) => Some(self.arrived as f64),
            ("remaining", _) => Some(self.remaining as f64),
            ("stuck", _) => Some(self.stuck as f64),
            ("t50_secs", _) => self.t50_secs,
            ("t95_secs", _) => self.t95_secs,
            ("t100_secs", _) => self.t100_secs,
            ("highest_density", _) => Some(self.highest_density.as_ref()?.density_per_m2),
            ("longest_queue", _) => Some(
                self.longest_queues
                    .iter()
                    .map(|queue| f64::from(queue.agents))
                    .fold(0.0, f64::max),
            ),
            (_, Some((LEFT_BY, exit))) => left_by(exit),
            (_, Some((QUEUE, before))) => Some(queue(before)),
            _ => None,
        }
    }

    /// The names of the results that runs of a scene print first: `left_by.EXIT` and `queue.PLACE` among them.
    pub fn first_names(scene: &Scene) -> Vec<String> {
        let mut names = FIRST.map(str::to_owned).to_vec();
        for place in &scene.journeys.places {
            if place.is_exit() {
                names.push(format!("{LEFT_BY}.{}", place.name));
            }
            names.push(format!("{QUEUE}.{}", place.name));
        }
        names
    }

    /// Data by name; `None` if they are not measured, have another form, or the run ended before them.
    pub fn data<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        T::deserialize(self.data.get(name)?).ok()
    }
}

/// The results of a journey.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JourneyResult {
    /// The name of the journey.
    pub name: String,
    /// The departures of its agents.
    #[serde(flatten)]
    pub left: Left,
}

impl JourneyResult {
    /// The results of all journeys that agents have begun.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let journeys = simulation.scene().journeys.journeys.iter().enumerate();
        let results = journeys.map(|(k, journey)| Self {
            name: journey.name.clone(),
            left: Left::of(simulation, Some(k as u16)),
        });
        results.filter(|result| result.left.started > 0).collect()
    }
}

/// The results of a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceResult {
    /// The name of the place.
    pub name: String,
    /// `exit`, `waypoint`, `waiting area` or `queue`.
    pub kind: String,
    /// The number of agents that have passed it, each counted once.
    pub passed: u32,
    /// For an exit: its share of all agents that have left, at exits and goals.
    pub share: Option<f64>,
    /// The time of the first and the last agent that left here, seconds; `None` if it is no exit.
    pub from_to_secs: Option<[f64; 2]>,
    /// For waiting areas and queues: the mean time that agents waited at a visit, seconds.
    pub waited_secs: Option<f64>,
}

impl PlaceResult {
    /// The results of all places; empty if no agent has begun a journey.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let progress = simulation.progress();
        if progress.begun.iter().all(|&count| count == 0) {
            return Vec::new();
        }
        let places = &simulation.scene().journeys.places;
        let arrivals = &simulation.outcome().arrivals;
        let states = places.iter().zip(&progress.places).enumerate();
        let result = |(k, (place, state)): (usize, (&Place, &PlaceState))| {
            let all = arrivals.len();
            let trips = arrivals.iter().filter_map(|a| Some((a.time, a.trip?.exit)));
            let here = trips.filter(|&(_, exit)| usize::from(exit) == k);
            let times: Vec<f64> = here.map(|(time, _)| time).collect();
            let passed = f64::from(state.passed);
            let waits = matches!(place.kind, Kind::Waiting(_) | Kind::Queue(_));
            Self {
                name: place.name.clone(),
                kind: place.kind.name().to_owned(),
                passed: state.people.len() as u32,
                share: (place.is_exit() && all > 0).then(|| times.len() as f64 / all as f64),
                from_to_secs: times.first().zip(times.last()).map(|(&a, &b)| [a, b]),
                waited_secs: (waits && state.passed > 0).then(|| state.waited / passed),
            }
        };
        states.map(result).collect()
    }
}

/// A metric's value as JSON; counts of agents are integers.
pub fn value(metric: &Metric) -> Value {
    match metric.value {
        Some(count) if metric.unit == "agents" => json!(count as u64),
        value => json!(value),
    }
}

//! How long people take to leave: the times by which parts of them have left, and their delays.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, Measure, Observed, Quantity};
use analysis::evaluated::Evaluated;
use engine::clock::Clock;
use engine::journeys::{Kind, Status};
use engine::math::Vector;
use engine::routes::{Destination, Goal, PathMap};
use engine::simulation::Simulation;

/// Of the people on one journey, or on all journeys: how many have left at an exit, the mean time from entry to exit,
/// the times by which 50 %, 95 % and all have left, the mean wait in queues and waiting areas, that in waiting areas
/// alone, and the mean and the largest delay against free walking, without the time in waiting areas.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Egress {
    /// The name of the journey. Default: all journeys.
    pub(super) journey: Option<String>,
}

/// How people on a journey have left.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// The number of people who have begun the journey.
    pub started: u32,
    /// The number of people who have left at an exit.
    pub finished: u32,
    /// The mean time from entry to exit, seconds.
    pub mean_secs: Option<f64>,
    /// When half of those who have started had left, seconds.
    pub t50_secs: Option<f64>,
    /// When 95 % of them had left, seconds.
    pub t95_secs: Option<f64>,
    /// When all of them had left, seconds.
    pub t100_secs: Option<f64>,
    /// The mean time spent in waiting areas and queues by those who have left, seconds.
    pub waited_secs: Option<f64>,
}

impl Left {
    /// Those on the journey with this number; `None`: on all journeys.
    pub fn of(simulation: &Simulation, journey: Option<u16>) -> Self {
        let begun = simulation.progress().begun.iter().enumerate();
        let asked = |number: usize| journey.is_none_or(|journey| usize::from(journey) == number);
        let counts = begun.filter(|(k, _)| asked(*k)).map(|(_, count)| count);
        let started: u32 = counts.sum();
        let arrivals = simulation.outcome().arrivals.iter();
        let times = arrivals.filter_map(|arrival| {
            let trip = arrival
                .trip
                .filter(|trip| asked(usize::from(trip.journey)))?;
            Some((arrival.time, arrival.time - trip.entered, trip.waited))
        });
        let left: Vec<(f64, f64, f64)> = times.collect(); // by time, as arrivals are
        let mean = |value: fn(&(f64, f64, f64)) -> f64| {
            let sum: f64 = left.iter().map(value).sum();
            (!left.is_empty()).then(|| sum / left.len() as f64)
        };
        let times: Vec<f64> = left.iter().map(|&(time, ..)| time).collect();
        let [t50_secs, t95_secs, t100_secs] = times_to_leave(&times, started);
        Self {
            started,
            finished: left.len() as u32,
            mean_secs: mean(|&(_, lasting, _)| lasting),
            t50_secs,
            t95_secs,
            t100_secs,
            waited_secs: mean(|&(.., waited)| waited),
        }
    }
}

/// When 50 %, 95 % and all of `started` people had left, who leave at ascending times, seconds.
pub fn times_to_leave(times: &[f64], started: u32) -> [Option<f64>; 3] {
    [0.5, 0.95, 1.0].map(|part| {
        let count = (part * f64::from(started)).ceil() as usize;
        count.checked_sub(1).and_then(|k| times.get(k).copied())
    })
}

/// An agent on its way.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Walker {
    /// When it may start: its entry and its pre-movement time, seconds.
    due: f64,
    /// s_pref, m/s.
    speed: f64,
    /// The stage of its journey, from 0, and the place that it has chosen for it.
    stage: u16,
    place: u16,
    /// Where the stage began, meters.
    from: Vector,
    /// The length of the shortest routes of the stages before, meters.
    length: f64,
    /// The frame since which it waits in a waiting area.
    waits_since: Option<u64>,
    /// How long it has waited in waiting areas before, seconds.
    rested: f64,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// By id; `None` for agents that have left or are on no journey that counts.
    walkers: Vec<Option<Walker>>,
    /// The number of arrivals that were processed.
    arrivals: usize,
    /// The delays of the agents that have left, seconds.
    delays: Vec<f64>,
    /// The times in waiting areas of the agents that have left, seconds.
    rests: Vec<f64>,
    /// They follow from the scene.
    #[serde(skip)]
    fronts: Fronts,
}

/// The path maps to the fronts of queues, by the number of the place.
#[derive(Debug, Default)]
struct Fronts(BTreeMap<u16, Option<PathMap>>);

impl Walker {
    /// Follows its waits in waiting areas, which begin and end in coarse frames.
    fn follow_wait(&mut self, status: Status, clock: &Clock) {
        let since = match status {
            Status::Waiting { since, .. } => Some(since),
            _ => None,
        };
        if let Some(before) = self.waits_since.filter(|_| self.waits_since != since) {
            self.rested += clock.time() - clock.time_at(before);
        }
        self.waits_since = since;
    }
}

impl Egress {
    /// The number of the journey; `None`: all journeys. `Err` if there is no such journey.
    fn number(&self, simulation: &Simulation) -> Result<Option<u16>, ()> {
        let Some(name) = &self.journey else {
            return Ok(None);
        };
        let mut journeys = simulation.scene().journeys.journeys.iter();
        let found = journeys.position(|journey| journey.name == *name);
        found.map(|k| Some(k as u16)).ok_or(())
    }
}

impl Fronts {
    /// The length of the shortest way from `from` to a place at which an agent at `end` ends a stage, meters; 0 if
    /// there is none. Of a queue, that place is the front, up to which agents are served, and the rest of the way there
    /// does not count.
    fn length(&mut self, simulation: &Simulation, number: u16, [from, end]: [Vector; 2]) -> f64 {
        let scene = simulation.scene();
        let Some(routes) = &scene.routes else {
            return 0.0;
        };
        let (way, rest) = match &scene.journeys.places[usize::from(number)].kind {
            Kind::Queue(queue) => {
                let front = queue.path[0];
                let new = || PathMap::for_few(&routes.floor, &[Goal::Point(front)], 0.0).ok();
                let map = self.0.entry(number).or_insert_with(new);
                let way = map
                    .as_ref()
                    .and_then(|map| map.way_from(&routes.floor, from));
                (way, (front - end).norm())
            }
            _ => (routes.way(from, Destination::Place(number)), 0.0),
        };
        way.map_or(0.0, |way| (way.length - rest).max(0.0))
    }
}

impl Measure for Egress {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn about(&self) -> About {
        let journey = self.journey.clone();
        About {
            journey: journey.map(|name| ("egress.journey", name)),
            ..About::default()
        }
    }

    fn quantities(&self) -> Vec<Quantity> {
        let of = self.journey.as_ref();
        let of = of.map_or(String::new(), |journey| format!("_{journey}"));
        let values = [
            (
                "finished",
                "agents",
                "people on journeys that have left at an exit",
            ),
            ("mean_secs", "s", "mean time from entry to exit"),
            ("t50_secs", "s", "when 50 % of those who started had left"),
            ("t95_secs", "s", "when 95 % of those who started had left"),
            ("t100_secs", "s", "when all who started had left"),
            ("waited_secs", "s", "mean time in queues and waiting areas"),
            (
                "wished_secs",
                "s",
                "mean time in waiting areas, where people wait because their journey says so",
            ),
            (
                "delay_secs",
                "s",
                "mean of time to leave − pre-movement time − time in waiting areas − length of the shortest routes / \
                 preferred speed",
            ),
            ("longest_delay_secs", "s", "the largest of these delays"),
        ];
        let quantity = |(name, unit, meaning): (&str, _, _)| {
            Quantity::new(format!("{name}{of}"), unit, meaning)
        };
        values.into_iter().map(quantity).collect()
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let (scene, frame) = (simulation.scene(), simulation.frame());
        let (clock, agents) = (frame.clock, frame.agents);
        for arrival in &simulation.outcome().arrivals[seen.arrivals..] {
            let walker = seen.walkers.get_mut(arrival.id as usize);
            if let (Some(trip), Some(walker)) = (arrival.trip, walker.and_then(Option::take)) {
                let last = seen.fronts.length(simulation, trip.exit, [walker.from; 2]);
                let free = (walker.length + last) / walker.speed;
                // People whose preferred speed is 0 do not walk freely.
                let delay = Some(arrival.time - walker.due - walker.rested - free);
                seen.delays.extend(delay.filter(|secs| secs.is_finite()));
                seen.rests.push(walker.rested);
            }
        }
        seen.arrivals = simulation.outcome().arrivals.len();
        let Ok(number) = self.number(simulation) else {
            return;
        };
        // Stages change in coarse frames only.
        if !clock.is_coarse() {
            return;
        }
        seen.walkers.resize(agents.entered() as usize, None);
        for (i, trip) in agents.trip.iter().enumerate() {
            let trip = trip.filter(|trip| number.is_none_or(|own| own == trip.journey));
            let Some(trip) = trip.filter(|trip| !trip.is_outside()) else {
                continue;
            };
            let position = agents.position[i];
            let slot = agents.id[i] as usize;
            let walker = seen.walkers[slot].get_or_insert_with(|| Walker {
                due: (agents.walks_from.get(i)).map_or(trip.entered, |from| from.max(trip.entered)),
                speed: (agents.preferred_speed.get(i).copied()).unwrap_or(scene.preferred_speed),
                stage: trip.stage,
                place: trip.place,
                from: position,
                length: 0.0,
                waits_since: None,
                rested: 0.0,
            });
            walker.follow_wait(trip.status, clock);
            if walker.stage != trip.stage {
                let ends = [walker.from, position];
                walker.length += seen.fronts.length(simulation, walker.place, ends);
                (walker.stage, walker.from) = (trip.stage, position);
            }
            walker.place = trip.place;
        }
    }

    fn values(&self, seen: &Seen, simulation: &Simulation) -> Vec<Option<f64>> {
        let Ok(number) = self.number(simulation) else {
            return vec![None; self.quantities().len()];
        };
        let left = Left::of(simulation, number);
        let mean =
            |secs: &[f64]| (!secs.is_empty()).then(|| secs.iter().sum::<f64>() / secs.len() as f64);
        vec![
            Some(f64::from(left.finished)),
            left.mean_secs,
            left.t50_secs,
            left.t95_secs,
            left.t100_secs,
            left.waited_secs,
            mean(&seen.rests),
            mean(&seen.delays),
            seen.delays.iter().copied().reduce(f64::max),
        ]
    }
}

//! People who wait for a passage.
//!
//! A passage is an exit, a waypoint or waiting area that people walk to, a declared door, or an opening of the floor.
//! In the queue before it are the people whose routes lead through it and who are slow, in the order of their distances
//! along their routes, from the passage up to the first gap.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::aim::Aim;
use super::passages::{Crossing, Known, Openings};
use super::queue_lines::{Lines, Outside};
use super::standing::{is_slow, length};
use super::stuck::{Headway, SOME};
use crate::error::quote::{shown, to_centimeters};
use analysis::service;
use analysis::statistics::Range;
use engine::journeys::{Change, ChangeKind, Journeys, Kind, Place};
use engine::math::Vector;
use engine::scene::Scene;
use engine::simulation::Simulation;

/// The fewest agents in a queue.
const FEWEST: u32 = 2;
/// The fewest agents whose density is that of a queue.
const CROWD: usize = 5;

/// The longest queue before a passage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LongestQueue {
    /// The name of the place or door, `the opening at (x, y)`, or the position of the goal.
    pub before: String,
    /// The middle of the passage, meters.
    #[serde(default)]
    pub at: [f64; 2],
    /// In a building: the name of the level there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// The largest number of agents at one time; of a queue with a line, of those who have joined it.
    pub agents: u32,
    /// The first time with this number, seconds.
    pub at_secs: f64,
    /// The highest median of the SPH densities at its agents, over all times with five or more of them, P/m²; of a
    /// queue with a line, at those who stood outside of it. `None` without densities.
    #[serde(default)]
    pub density_per_m2: Option<f64>,
    /// Whether people are held there: it is closed for a time, passes a limited number per second, or serves people.
    #[serde(default)]
    pub holds: bool,
    /// Of a queue with a line: those who stood outside of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<Outside>,
}

impl LongestQueue {
    /// What to know of people who are held here so densely that bodies touch (Fruin's level F for queues).
    pub fn packed(&self) -> Option<String> {
        let touching = service::densities(&service::QUEUE)[4];
        let density = self.density_per_m2.filter(|&density| density > touching)?;
        self.holds.then(|| {
            format!(
                "people who wait before {} stand at up to {density:.1} P/m²: their bodies touch (Fruin's level F for \
                 queues, above {touching:.1} P/m²). No profile keeps people apart who stand and wait, and calm people \
                 stand farther apart where they have room. Take such densities as upper bounds, or give people \
                 `waiting_areas` or the line of a `queues` entry with room for all",
                shown(&self.before)
            )
        })
    }
}

/// What people wait for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum Passage {
    Opening(u32),
    Aim(Aim),
}

impl Passage {
    /// The number of the place or door that it is.
    fn place(self, openings: &Openings) -> Option<u16> {
        match self {
            Self::Opening(k) => openings.door(k),
            Self::Aim(Aim::Place(number)) => Some(number),
            Self::Aim(_) => None,
        }
    }
}

/// The longest queue so far before a passage.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Queue {
    passage: Passage,
    agents: u32,
    at_secs: f64,
    /// The highest median density so far, P/m².
    density: Option<f64>,
}

/// The longest queues so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Queues {
    queues: Vec<Queue>,
    /// The agents in each queue before a place when they were last observed.
    #[serde(skip)]
    latest: BTreeMap<u16, u32>,
    lines: Lines,
    /// They follow from the scene.
    #[serde(skip)]
    openings: Option<Openings>,
}

/// A slow agent.
struct Slow {
    agent: usize,
    aim: Aim,
    /// The openings on its way.
    ahead: Vec<Crossing>,
    /// The length of its way, meters.
    length: f64,
}

/// The slow agents on routes through a passage, each with its distance, meters.
struct Waiting {
    passage: Passage,
    agents: Vec<(f64, usize)>,
    /// Those up to the first gap.
    queue: usize,
}

impl Queues {
    /// Observes the queues of a frame with the headways of its agents, by id: once every
    /// [`EVERY`](super::standing::EVERY) seconds.
    pub(super) fn observe(&mut self, headways: &[Option<Headway>], simulation: &Simulation) {
        let known = self.openings.take();
        let openings = known.unwrap_or_else(|| Openings::of(simulation.scene()));
        let now = simulation.frame().clock.time();
        let slow = slow(headways, simulation, &openings);
        let mut waiting = waiting(&slow, simulation);
        for one in &mut waiting {
            one.close_up(simulation, &slow);
        }
        for one in &waiting {
            if !one.is_part_of_another(&waiting, &slow, &openings) {
                let density = one.density(simulation, &slow);
                self.notice(one.passage, (one.queue as u32, now), density);
            }
        }
        let lengths = waiting.iter().filter_map(|one| {
            let number = one.passage.place(&openings)?;
            Some((number, one.queue as u32))
        });
        self.latest = lengths.collect();
        self.openings = Some(openings);
        let places = simulation.scene().journeys.places.iter();
        let states = simulation.progress().places.iter().zip(places).zip(0..);
        for ((state, place), number) in states {
            if let Kind::Queue(line) = &place.kind {
                let outside = self.lines.observe(simulation, number, line);
                let density = median_density(simulation, outside);
                self.notice(
                    Passage::Aim(Aim::Place(number)),
                    (state.longest, now),
                    density,
                );
            }
        }
    }

    /// The agents in the queue before each place, by its number, when they were last observed; places without a queue
    /// are left out.
    pub(super) fn latest(&self) -> &BTreeMap<u16, u32> {
        &self.latest
    }

    /// The longest queue before each passage, the longest one first.
    pub(super) fn longest(&self, simulation: &Simulation) -> Vec<LongestQueue> {
        let openings = self.openings.clone();
        let openings = openings.unwrap_or_else(|| Openings::of(simulation.scene()));
        let places = &simulation.scene().journeys.places;
        let mut queues: Vec<&Queue> = self.queues.iter().collect();
        queues.sort_by_key(|queue| std::cmp::Reverse(queue.agents)); // stable
        let longest = queues.into_iter().map(|queue| {
            let number = queue.passage.place(&openings);
            let outside = number.and_then(|number| self.lines.outside(number));
            let place = number.map(|number| &places[usize::from(number)]);
            let at = match (place, queue.passage) {
                (Some(place), _) => middle(place),
                (None, Passage::Opening(k)) => openings.middle(k),
                (None, Passage::Aim(Aim::Goal(goal) | Aim::Direction(goal))) => goal,
                (None, Passage::Aim(Aim::Place(_))) => Vector::zeros(),
            };
            let [x, y] = [at.x, at.y].map(to_centimeters);
            LongestQueue {
                before: match (place, queue.passage) {
                    (Some(place), _) => place.name.clone(),
                    (None, Passage::Opening(_)) => format!("the opening at ({x}, {y})"),
                    (None, _) => format!("({}, {})", at.x, at.y),
                },
                at: at.into(),
                level: None,
                agents: queue.agents,
                at_secs: queue.at_secs,
                density_per_m2: queue.density,
                holds: number.is_some_and(|number| holds(simulation.scene(), number)),
                outside,
            }
        });
        longest.collect()
    }

    fn notice(&mut self, passage: Passage, (agents, at_secs): (u32, f64), density: Option<f64>) {
        if agents < FEWEST {
            return;
        }
        let mut queues = self.queues.iter_mut();
        match queues.find(|queue| queue.passage == passage) {
            Some(longest) => {
                if longest.agents < agents {
                    (longest.agents, longest.at_secs) = (agents, at_secs);
                }
                // `None` is less than any density.
                if longest.density < density {
                    longest.density = density;
                }
            }
            None => self.queues.push(Queue {
                passage,
                agents,
                at_secs,
                density,
            }),
        }
    }
}

/// The slow agents that have walked for some time.
fn slow(headways: &[Option<Headway>], simulation: &Simulation, openings: &Openings) -> Vec<Slow> {
    let agents = simulation.frame().agents;
    let slow = (0..agents.len()).into_par_iter().with_min_len(SOME);
    let slow = slow.filter_map(|agent| {
        let headway = headways.get(agents.id[agent] as usize)?.as_ref()?;
        let (aim, length) = headway.way()?;
        let is_queuing = agents.is_present(agent) && is_slow(simulation, agent);
        is_queuing.then(|| (agent, aim, length, openings.way(simulation, (agent, aim))))
    });
    let slow: Vec<_> = slow.collect();
    let mut known = Known::new();
    let all = slow.into_iter().map(|(agent, aim, length, way)| Slow {
        agent,
        aim,
        length: way.as_ref().map_or(length, |way| way.length),
        ahead: way.map_or(Vec::new(), |way| openings.ahead(way, &mut known)),
    });
    all.collect()
}

/// The slow agents before each passage, the nearest ones first. Queues with a line are passages of their own.
fn waiting(slow: &[Slow], simulation: &Simulation) -> Vec<Waiting> {
    let places = &simulation.scene().journeys.places;
    let has_line = |aim: Aim| match aim {
        Aim::Place(number) => matches!(places[usize::from(number)].kind, Kind::Queue(_)),
        _ => false,
    };
    let mut openings: BTreeMap<u32, Vec<(f64, usize)>> = BTreeMap::new();
    let mut aims: Vec<(Aim, f64, usize)> = Vec::new();
    for (k, one) in slow.iter().enumerate() {
        for &(opening, distance) in &one.ahead {
            openings.entry(opening).or_default().push((distance, k));
        }
        aims.extend((!has_line(one.aim)).then_some((one.aim, one.length, k)));
    }
    aims.sort_by(|(aim, ..), (other, ..)| aim.order(other)); // stable
    let pairs = openings.into_iter();
    let openings = pairs.map(|(opening, agents)| (Passage::Opening(opening), agents));
    let aims = aims
        .chunk_by(|(aim, ..), (other, ..)| aim == other)
        .map(|agents| {
            let all = agents.iter().map(|&(_, length, k)| (length, k));
            (Passage::Aim(agents[0].0), all.collect())
        });
    let all = openings.chain(aims).map(|(passage, agents)| Waiting {
        passage,
        agents,
        queue: 0,
    });
    all.collect()
}

impl Waiting {
    /// Finds the queue: the agents up to the first gap.
    fn close_up(&mut self, simulation: &Simulation, slow: &[Slow]) {
        self.agents.sort_by(|(a, _), (b, _)| a.total_cmp(b)); // stable
        let Some(&(first, front)) = self.agents.first() else {
            return;
        };
        let (agents, scene) = (simulation.frame().agents, simulation.scene());
        let group = usize::from(agents.group[slow[front].agent]);
        let start = match (self.passage, &scene.routes) {
            // Without a floor, no openings before the goal are known.
            (Passage::Aim(Aim::Goal(_)), None) => first,
            (Passage::Aim(Aim::Goal(_)), Some(_)) => {
                scene.groups[group].removal_radius.unwrap_or_default()
            }
            _ => 0.0,
        };
        let distances = self.agents.iter().map(|&(distance, _)| distance);
        self.queue = length(distances, start) as usize;
    }

    /// Whether it is an opening whose queue stands before another passage, too: a place, a door or a narrower opening.
    /// Then people wait for that one. Declared doors have queues of their own.
    fn is_part_of_another(&self, all: &[Self], slow: &[Slow], openings: &Openings) -> bool {
        let Passage::Opening(opening) = self.passage else {
            return false;
        };
        let Some(&(_, front)) = self.agents.first() else {
            return true;
        };
        if openings.door(opening).is_some() {
            return false;
        }
        let front = &slow[front];
        // Doors come first, then the narrower ones.
        let others = front.ahead.iter().filter(|&&(other, _)| other < opening);
        let before = others.map(|&(other, away)| (Passage::Opening(other), away));
        let mut passages = before.chain([(Passage::Aim(front.aim), front.length)]);
        passages.any(|(passage, away)| {
            let mut all = all.iter();
            all.find(|one| one.passage == passage)
                .is_some_and(|one| one.reach().is_some_and(|reach| away <= reach))
        })
    }

    /// The median density at those in the queue, P/m².
    fn density(&self, simulation: &Simulation, slow: &[Slow]) -> Option<f64> {
        let queue = self.agents[..self.queue].iter();
        median_density(simulation, queue.map(|&(_, k)| slow[k].agent))
    }

    /// How far behind the passage the last one stands, meters; `None` without a queue.
    fn reach(&self) -> Option<f64> {
        let last = self.queue.checked_sub(1)?;
        Some(self.agents[last].0)
    }
}

/// The median of the SPH densities at agents, P/m²; `None` at fewer than [`CROWD`], or without densities.
fn median_density(simulation: &Simulation, agents: impl IntoIterator<Item = usize>) -> Option<f64> {
    if !simulation.needs().density {
        return None;
    }
    let all = &simulation.frame().fields.density;
    let in_front = agents.into_iter().filter_map(|i| all.get(i).copied());
    let densities: Vec<f64> = in_front.collect();
    (densities.len() >= CROWD).then(|| Range::of(&densities).median)
}

/// Whether people are held at a place: see [`LongestQueue::holds`].
fn holds(scene: &Scene, number: u16) -> bool {
    let Journeys {
        places, changes, ..
    } = &scene.journeys;
    let closes = |change: &Change| change.place == number && change.kind == ChangeKind::Close;
    match &places[usize::from(number)].kind {
        Kind::Queue(_) => true,
        Kind::Exit(exit) if exit.most_per_sec.is_some() => true,
        _ => changes.iter().any(closes),
    }
}

/// Where a place is, meters.
fn middle(place: &Place) -> Vector {
    match (&place.kind, place.line()) {
        (_, Some([a, b])) => 0.5 * (a + b),
        (Kind::Disk { at, .. }, _) => *at,
        (Kind::Queue(line), _) => line.path[0],
        (Kind::Waiting(waiting), _) => {
            let corners = waiting.area.points();
            corners.iter().sum::<Vector>() / corners.len() as f64
        }
        _ => Vector::zeros(),
    }
}

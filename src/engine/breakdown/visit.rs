//! The activity of an agent on a journey, its place, and the reason for that place.

use serde::Serialize;

use crate::journeys::{Status, Trip};
use crate::simulation::{Closed, Decision, Expected, Prospect, Reason, Simulation};

/// The place that an agent on a journey visits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Visit {
    /// The name of its journey.
    pub journey: String,
    /// The current stage, from 1.
    pub stage: usize,
    /// The number of stages.
    pub stages: usize,
    /// The name of the place.
    pub place: String,
    /// The agent's activity.
    #[serde(flatten)]
    pub doing: Doing,
    /// The time that it has waited in waiting areas and queues before, seconds.
    pub waited_secs: f64,
    /// The reason why it walks to this place; `None` unless it walks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<Why>,
}

/// The activity of an agent on a journey.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
pub enum Doing {
    /// It walks to its place.
    Walking,
    /// It waits in a waiting area.
    Waiting {
        /// Since when, seconds.
        since_secs: f64,
        /// The latest time until which it waits, seconds; `None`: until it is released.
        until_secs: Option<f64>,
        /// The lift for which it waits.
        #[serde(skip_serializing_if = "Option::is_none")]
        lift: Option<String>,
    },
    /// It stands in a queue.
    Queued {
        /// Since when, seconds.
        since_secs: f64,
        /// The number of agents ahead of it.
        ahead: usize,
    },
    /// It is at the front of a queue and is being served.
    Served {
        /// Since when it has been in the queue, seconds.
        since_secs: f64,
        /// The time at which it goes on, seconds.
        until_secs: f64,
    },
    /// It has ended its journey and stays.
    Finished,
}

/// The reason why an agent walks to its place: the decision that it would make now.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Why {
    /// The place that it would choose now.
    pub choice: String,
    /// The reason, in words.
    pub reason: &'static str,
    /// The time at which it chooses again, seconds; `None`: never.
    pub looks_again_secs: Option<f64>,
    /// All places of the stage.
    pub alternatives: Vec<Alternative>,
}

/// A place that the agent could choose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alternative {
    /// The name of the place.
    pub place: String,
    /// Whether it is open: only exits can be closed.
    pub open: bool,
    /// The length of the way there, meters; `None` if there is none.
    pub length: Option<f64>,
    /// The number of agents that are bound for it.
    pub bound: u32,
    /// Its weight, for a stage with shares.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weight: Option<f64>,
    /// The expected times, for `quickest`; `None` if the way there is closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected: Option<Expected>,
    /// Until when doors close the way there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub route_closed: Option<Closed>,
}

impl Visit {
    /// The visit of agent `i`; `None` if it has no journey or has not begun it.
    pub(super) fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let trip = simulation.frame().agents.trip.get(i)?.as_ref()?;
        let journeys = &simulation.scene().journeys;
        let journey = journeys.journeys.get(usize::from(trip.journey))?;
        let decision = simulation.decision(i);
        Some(Self {
            journey: journey.name.clone(),
            stage: usize::from(trip.stage) + 1,
            stages: journey.stages.len(),
            place: name(simulation, trip.place),
            doing: doing(simulation, trip),
            waited_secs: trip.waited,
            why: decision.map(|decision| Why::of(simulation, i, (trip, &decision))),
        })
    }
}

fn name(simulation: &Simulation, place: u16) -> String {
    let places = &simulation.scene().journeys.places;
    let place = places.get(usize::from(place));
    place.map_or(String::new(), |place| place.name.clone())
}

fn doing(simulation: &Simulation, trip: &Trip) -> Doing {
    let frame = simulation.frame();
    let secs = |frame_number: u64| frame.clock.time_at(frame_number);
    match trip.status {
        Status::Walking => Doing::Walking,
        Status::Waiting { since, until, .. } => Doing::Waiting {
            since_secs: secs(since),
            until_secs: (until < u64::MAX).then(|| secs(until)),
            lift: lift(simulation, trip),
        },
        Status::Queued {
            since,
            until: Some(until),
            ..
        } => Doing::Served {
            since_secs: secs(since),
            until_secs: secs(until),
        },
        Status::Queued { ticket, since, .. } => {
            let others = frame.agents.trip.iter().flatten();
            let is_ahead = |other: &&Trip| match other.status {
                Status::Queued { ticket: first, .. } => other.place == trip.place && first < ticket,
                _ => false,
            };
            Doing::Queued {
                since_secs: secs(since),
                ahead: others.filter(is_ahead).count(),
            }
        }
        Status::Finished | Status::Outside { .. } => Doing::Finished,
    }
}

/// The lift for which an agent in a waiting area waits.
fn lift(simulation: &Simulation, trip: &Trip) -> Option<String> {
    let journeys = &simulation.scene().journeys;
    let journey = journeys.journeys.get(usize::from(trip.journey))?;
    let ride = journey.stage(trip.stage).to_level;
    let stop = ride.and_then(|_| journeys.lift_at(trip.place));
    stop.map(|(lift, _)| lift.name.clone())
}

impl Why {
    fn of(simulation: &Simulation, i: usize, (trip, decision): (&Trip, &Decision)) -> Self {
        let clock = simulation.frame().clock;
        let again = Some(trip.chooses_at).filter(|&frame| frame < u64::MAX);
        let journey = &simulation.scene().journeys.journeys[usize::from(trip.journey)];
        let choice = &journey.stage(trip.stage).choice;
        let prospects = decision.prospects.iter().enumerate();
        Self {
            choice: name(simulation, decision.place),
            reason: in_words(decision.reason),
            looks_again_secs: again.map(|frame| clock.time_at(frame)),
            alternatives: prospects
                .map(|(k, prospect)| Alternative::of(simulation, i, prospect, choice.weight(k)))
                .collect(),
        }
    }
}

fn in_words(reason: Reason) -> &'static str {
    match reason {
        Reason::Only => "no other place is open and can be reached",
        Reason::Nearest => "the shortest way",
        Reason::Quickest => "the least expected time",
        Reason::NotClearlyNearer => "kept: no way is shorter by 0.5 m",
        Reason::NotClearlyQuicker => "kept: no place saves at least 1 s and 10 % of its time",
        Reason::Drawn => "drawn at random",
        Reason::Fewest => "the fewest agents were bound for it",
    }
}

impl Alternative {
    fn of(simulation: &Simulation, i: usize, prospect: &Prospect, weight: Option<f64>) -> Self {
        let state = &simulation.progress().places[usize::from(prospect.place)];
        let route_closed = simulation.closed_way(i, prospect.place, None);
        Self {
            place: name(simulation, prospect.place),
            open: prospect.open,
            length: Some(prospect.length).filter(|length| length.is_finite()),
            bound: state.bound,
            weight,
            expected: prospect.expected.filter(|_| route_closed.is_none()),
            route_closed,
        }
    }
}

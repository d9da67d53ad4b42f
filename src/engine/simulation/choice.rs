//! How agents choose between places.

use rand::Rng;
use serde::Serialize;

use super::plans::is_clearly_quicker;
use super::sight::Seen;
use super::{Crowd, PlaceState, Simulation, bound};
use crate::journeys::{Choice, Journey, JourneyStage, Kind, Place, Status, Trip};
use crate::math::Vector;
use crate::random::{self, Purpose};
use crate::scene::Scene;
use crate::ways::{Destination, SLACK};

/// Agents that choose the nearest place choose again after this time, seconds.
const NEAREST_EVERY: f64 = 1.0;
/// Agents that choose the quickest place choose again after a random time in this range, seconds.
const QUICKEST_EVERY: [f64; 2] = [2.0, 5.0];

impl Simulation {
    /// The decision that agent `i` would make now about the place of its stage; `None` if it does not walk to a place.
    pub fn decision(&self, i: usize) -> Option<Decision> {
        let trip = self.crowd.agents.trip.get(i)?.as_ref()?;
        let chooser = Chooser {
            scene: &self.fixed.scene,
            crowd: &self.crowd,
            agent: i,
            is_asked: true,
            seen: None,
        };
        (trip.status == Status::Walking).then(|| chooser.decide(trip, Some(trip.place)))
    }
}

/// An agent that chooses.
pub(super) struct Chooser<'a> {
    pub(super) scene: &'a Scene,
    pub(super) crowd: &'a Crowd,
    /// Its index.
    pub(super) agent: usize,
    /// Whether all its expectations are asked for, or only its decision.
    pub(super) is_asked: bool,
    /// What it sees, if that is known.
    pub(super) seen: Option<&'a Seen>,
}

/// A place of an agent's stage, as the agent sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prospect {
    /// The number of the place.
    pub place: u16,
    /// Whether it is not a closed exit.
    pub open: bool,
    /// The length of the way there, meters; infinite if the agent cannot get there.
    pub length: f64,
    /// The number of agents that are bound for it.
    pub bound: u32,
    /// Its weight, for a stage with shares.
    pub weight: Option<f64>,
    /// The expected times, for a stage where agents choose the quickest place, if the agent can get there.
    pub expected: Option<Expected>,
}

/// The times that an agent expects for passing a place and walking to its next stage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Expected {
    /// Walking to the place, seconds.
    pub walking_secs: f64,
    /// Agents bound for the place that are nearer to it.
    pub ahead: u32,
    /// The flow through the place, P/s; `None` if it is unlimited.
    pub flow_per_sec: Option<f64>,
    /// Waiting until these agents have passed, seconds.
    pub waiting_secs: f64,
    /// Walking from the place to the next stage, seconds.
    pub onward_secs: f64,
    /// The total time, seconds: the crowd ahead passes while the agent walks.
    pub total_secs: f64,
}

/// The decision of an agent about the place of its stage.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The place.
    pub place: u16,
    /// The reason for it.
    pub reason: Reason,
    /// All places of the stage, in its order.
    pub prospects: Vec<Prospect>,
}

/// Why an agent chooses a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// The stage has no other place that is open and can be reached.
    Only,
    /// The shortest way.
    Nearest,
    /// The least expected time.
    Quickest,
    /// It already walks there, and no other way is shorter by the slack.
    NotClearlyNearer,
    /// It already walks there, and no other place is expected to be clearly quicker.
    NotClearlyQuicker,
    /// It was drawn at random.
    Drawn,
    /// The fewest agents were bound for it when the agent chose.
    Fewest,
}

impl Chooser<'_> {
    /// Chooses the place for the current stage of `trip`. Also returns the frame in which the agent chooses again.
    /// `before` is the place that it walks to now.
    pub(super) fn choose(&self, trip: &Trip, before: Option<u16>) -> (u16, u64) {
        let decision = self.decide(trip, before);
        let clock = &self.crowd.clock;
        let again = |secs: f64| clock.coarse_frame_at(clock.time() + secs);
        let is_kept =
            before.is_some_and(|before| candidates(&decision.prospects).contains(&before));
        let chooses_at = match self.stage(trip).choice {
            Choice::Nearest if self.stage(trip).places.len() == 1 => u64::MAX,
            Choice::Nearest if is_kept => again(NEAREST_EVERY),
            // The first time is random, so that not all agents choose in the same frame.
            Choice::Nearest => again(self.random(trip).random_range(0.0..NEAREST_EVERY) + 1e-9),
            Choice::Quickest => {
                let [least, most] = QUICKEST_EVERY;
                again(self.random(trip).random_range(least..most))
            }
            Choice::Shares(_) | Choice::Fewest => u64::MAX,
        };
        (decision.place, chooses_at)
    }

    /// Decides between the places of the current stage of `trip`. `before` is the place that the agent walks to now.
    pub(super) fn decide(&self, trip: &Trip, before: Option<u16>) -> Decision {
        let stage = self.stage(trip);
        let mut prospects = self.prospects(trip);
        let open = candidates(&prospects);
        let before = before.filter(|place| open.contains(place));
        if self.scene.by_time() {
            self.expect_waits(&mut prospects, before);
        }
        let of = |place: u16| prospects.iter().find(|prospect| prospect.place == place);
        let (place, reason) = match &stage.choice {
            Choice::Nearest => {
                let length = |place| of(place).map_or(f64::INFINITY, |prospect| prospect.length);
                let is_shorter = |new, old| new < old - SLACK;
                match best(&open, before, length, is_shorter) {
                    (place, true) => (place, Reason::NotClearlyNearer),
                    (place, false) => (place, Reason::Nearest),
                }
            }
            Choice::Quickest => {
                let expected = |place| of(place).and_then(|prospect| prospect.expected);
                let time = |place| expected(place).map_or(f64::INFINITY, |e| e.total_secs);
                match best(&open, before, time, is_clearly_quicker) {
                    (place, true) => (place, Reason::NotClearlyQuicker),
                    (place, false) => (place, Reason::Quickest),
                }
            }
            Choice::Shares(weights) => {
                let drawn = || self.draw(trip, &open, weights);
                (before.unwrap_or_else(drawn), Reason::Drawn)
            }
            Choice::Fewest => {
                let bound = |place: u16| self.crowd.progress.places[usize::from(place)].bound;
                let fewest = open.iter().copied().min_by_key(|&place| bound(place));
                let place = before.or(fewest).unwrap_or(stage.places[0]);
                (place, Reason::Fewest)
            }
        };
        let reason = if open.len() == 1 {
            Reason::Only
        } else {
            reason
        };
        Decision {
            place,
            reason,
            prospects,
        }
    }

    fn journey(&self, trip: &Trip) -> &Journey {
        &self.scene.journeys.journeys[usize::from(trip.journey)]
    }

    pub(super) fn stage(&self, trip: &Trip) -> &JourneyStage {
        self.journey(trip).stage(trip.stage)
    }

    fn is_open(&self, place: u16) -> bool {
        let is_exit = self.scene.journeys.places[usize::from(place)].is_exit();
        !is_exit || self.crowd.progress.places[usize::from(place)].open
    }

    /// The random numbers of this choice.
    fn random(&self, trip: &Trip) -> impl Rng + use<> {
        let id = self.crowd.agents.id[self.agent];
        random::stream(
            self.scene.seed,
            Purpose::Choice,
            id,
            u64::from(trip.choices),
        )
    }

    /// A place of `open` at random.
    fn draw(&self, trip: &Trip, open: &[u16], weights: &[f64]) -> u16 {
        let stage = self.stage(trip);
        let places = stage.places.iter().zip(weights);
        let open: Vec<_> = places.filter(|(place, _)| open.contains(place)).collect();
        let total: f64 = open.iter().map(|(_, weight)| **weight).sum();
        let mut left = self.random(trip).random_range(0.0..1.0) * total;
        let chosen = open.iter().find(|(_, weight)| {
            left -= **weight;
            left < 0.0
        });
        let chosen = chosen.or(open.last()).map(|(place, _)| **place);
        chosen.unwrap_or(stage.places[0])
    }

    /// The places of the current stage of `trip`, as the agent sees them.
    fn prospects(&self, trip: &Trip) -> Vec<Prospect> {
        let places = &self.stage(trip).places;
        let position = self.crowd.agents.position[self.agent];
        let lengths = self.seen.map(|seen| seen.lengths.clone());
        let lengths = lengths.unwrap_or_else(|| self.lengths(position, places));
        let seen = places.iter().zip(lengths).enumerate();
        seen.map(|(k, (&place, length))| self.see(trip, k, (place, length)))
            .collect()
    }

    /// Place k of the current stage of `trip`, to which the way has this length, meters.
    fn see(&self, trip: &Trip, k: usize, (place, length): (u16, f64)) -> Prospect {
        let stage = self.stage(trip);
        let onward = self.journey(trip).stages.get(usize::from(trip.stage) + 1);
        Prospect {
            place,
            open: self.is_open(place),
            length,
            bound: self.crowd.progress.places[usize::from(place)].bound,
            weight: match &stage.choice {
                Choice::Shares(weights) => weights.get(k).copied(),
                _ => None,
            },
            expected: match stage.choice {
                Choice::Quickest if length.is_finite() => Some(self.expect(place, length, onward)),
                _ => None,
            },
        }
    }

    /// Adds the waits on the ways to the expected times. A place that is not clearly quicker than place `before`
    /// without them is not quicker with them: its time stays too short unless it is asked for.
    fn expect_waits(&self, prospects: &mut [Prospect], before: Option<u16>) {
        let mut known = self.seen.and_then(|seen| seen.leaving.clone());
        let mut wait = |prospect: &mut Prospect| {
            let to = (self.agent, prospect.place, prospect.length);
            let expected = prospect.expected.as_mut()?;
            if let Some(walking) = self.crowd.time_to(self.scene, to, &mut known) {
                expected.walking_secs = walking;
                expected.total_secs = walking.max(expected.waiting_secs) + expected.onward_secs;
            }
            Some(expected.total_secs)
        };
        let is_kept = |prospect: &&mut Prospect| Some(prospect.place) == before;
        let kept = prospects.iter_mut().find(is_kept).and_then(&mut wait);
        for prospect in prospects {
            let least = prospect.expected.map_or(f64::INFINITY, |e| e.total_secs);
            let can_win = kept.is_none_or(|kept| is_clearly_quicker(least, kept));
            if Some(prospect.place) != before && (can_win || self.is_asked) {
                wait(prospect);
            }
        }
    }

    /// The lengths of the ways from `p` to some places, meters; infinite where there is none.
    pub(super) fn lengths(&self, p: Vector, places: &[u16]) -> Vec<f64> {
        match &self.scene.ways {
            Some(ways) => ways.lengths(p, places),
            None => vec![f64::INFINITY; places.len()],
        }
    }

    /// The length of the way to a place, meters; infinite if there is none.
    pub(super) fn length(&self, place: u16) -> f64 {
        let position = self.crowd.agents.position[self.agent];
        let ways = self.scene.ways.as_ref();
        let way = ways.and_then(|ways| ways.way(position, Destination::Place(place)));
        way.map_or(f64::INFINITY, |way| way.length)
    }

    /// The times that the agent expects for a place at the end of a way of this length, meters, without waits on it,
    /// and for the way to the next stage.
    fn expect(&self, place: u16, length: f64, onward: Option<&JourneyStage>) -> Expected {
        let own = self.crowd.agents.preferred_speed.get(self.agent);
        let speed = own.copied().unwrap_or(self.scene.preferred_speed);
        let speed = speed.max(f64::MIN_POSITIVE);
        let state = &self.crowd.progress.places[usize::from(place)];
        let definition = &self.scene.journeys.places[usize::from(place)];
        let ahead = state.stream.nearer_than(length);
        let flow = self.flow(definition, state);
        let onward = onward.map_or(0.0, |stage| {
            let from = definition.nearest_point(self.crowd.agents.position[self.agent]);
            let lengths = self.lengths(from, &stage.places).into_iter();
            let shortest = lengths.filter(|length| length.is_finite()).reduce(f64::min);
            shortest.unwrap_or(0.0)
        });
        let walking = length / speed;
        let of_others = speed.max(self.scene.preferred_speed);
        let waiting = state.stream.clear_after(length, of_others, flow);
        let onward = onward / speed;
        Expected {
            walking_secs: walking,
            ahead,
            flow_per_sec: Some(flow).filter(|flow| flow.is_finite()),
            waiting_secs: waiting,
            onward_secs: onward,
            total_secs: walking.max(waiting) + onward,
        }
    }

    /// The flow that an agent expects through a place, P/s.
    fn flow(&self, place: &Place, state: &PlaceState) -> f64 {
        let most = match &place.kind {
            Kind::Exit(exit) => exit.most_per_sec.unwrap_or(f64::INFINITY),
            Kind::Line(_) | Kind::Door(_) => f64::INFINITY,
            Kind::Queue(queue) => return f64::from(queue.servers) / queue.mean_service,
            Kind::Disk { .. } | Kind::Waiting(_) => return f64::INFINITY,
        };
        let per_meter = self
            .crowd
            .flow_per_meter()
            .max(bound::FLOW_PER_METER_OF_EXITS);
        let expected = per_meter * bound::width(place).unwrap_or(0.0);
        state.stream.flow(expected.min(most)).min(most)
    }
}

/// The places that the agent can reach and that are not closed; if all reachable places are closed, all reachable
/// places.
fn candidates(prospects: &[Prospect]) -> Vec<u16> {
    let can_reach_any = prospects.iter().any(|prospect| prospect.length.is_finite());
    let reached = prospects.iter();
    let reached = reached.filter(|prospect| !can_reach_any || prospect.length.is_finite());
    let is_any_open = reached.clone().any(|prospect| prospect.open);
    let chosen = reached.filter(|prospect| prospect.open || !is_any_open);
    chosen.map(|prospect| prospect.place).collect()
}

/// The place with the least value, but `before` unless that place is `better`. Also returns whether `before` is kept
/// although another place has the least value.
fn best(
    places: &[u16],
    before: Option<u16>,
    value: impl Fn(u16) -> f64,
    better: impl Fn(f64, f64) -> bool,
) -> (u16, bool) {
    let values = places.iter().map(|&place| (place, value(place)));
    let least = values.min_by(|a, b| a.1.total_cmp(&b.1));
    let (place, least) = least.unwrap_or((places[0], f64::INFINITY));
    match before {
        Some(before) if !better(least, value(before)) => (before, before != place),
        _ => (place, false),
    }
}

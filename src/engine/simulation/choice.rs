//! How agents choose between places.

use rand::Rng;
use rayon::prelude::*;

use super::bound::{FLOW_PER_METER_OF_EXITS, width};
use super::expected::{Expected, Line, is_clearly_quicker, least_or_kept};
use super::{Crowd, PlaceState, Simulation};
use crate::journeys::{Choice, Journey, JourneyStage, Kind, Place, Status, Trip};
use crate::math::Vector;
use crate::neighbors::BLOCK;
use crate::random::{self, Purpose};
use crate::routes::{Destination, RoutesOut, SLACK};
use crate::scene::Scene;

/// Agents that choose the nearest place choose again after this time, seconds.
const NEAREST_EVERY: f64 = 1.0;
/// Agents that choose the quickest place choose again after a random time in this range, seconds.
const QUICKEST_EVERY: [f64; 2] = [2.0, 5.0];

impl Simulation {
    /// The decision that agent `i` would make now about the place of its stage; `None` if it does not walk to a place.
    pub fn decision(&self, i: usize) -> Option<Decision> {
        let trip = self.crowd.agents.trip.get(i)?.as_ref()?;
        let chooser = Chooser {
            is_asked: true,
            ..Chooser::of(&self.fixed.scene, &self.crowd, i)
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

/// What an agent that is due to choose sees, whatever others choose before.
pub(super) struct Seen {
    /// The number of the stage in its journey.
    pub(super) stage: u16,
    /// The lengths of the routes to its places, meters.
    pub(super) lengths: Vec<f64>,
    /// The routes out of its room that lead to its place, if it compares times.
    pub(super) routes_out: Option<RoutesOut>,
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
    /// The expected times, for a stage where agents choose the quickest place, if the agent can get there.
    pub expected: Option<Expected>,
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

impl Prospect {
    /// The expected time, seconds; infinite without one.
    fn total_secs(&self) -> f64 {
        self.expected
            .map_or(f64::INFINITY, |expected| expected.total_secs)
    }
}

impl<'a> Chooser<'a> {
    /// An agent that has seen nothing yet and only decides.
    pub(super) fn of(scene: &'a Scene, crowd: &'a Crowd, agent: usize) -> Self {
        Self {
            scene,
            crowd,
            agent,
            is_asked: false,
            seen: None,
        }
    }

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
        let all = prospects.iter();
        let possible = all.filter(|prospect| open.contains(&prospect.place));
        let (place, reason) = match &stage.choice {
            _ if open.len() == 1 => (open[0], Reason::Only),
            Choice::Nearest => {
                let lengths = possible.map(|prospect| (prospect.place, prospect.length));
                match least_or_kept(lengths, before, |new, old| new < old - SLACK) {
                    Some((place, true)) => (place, Reason::NotClearlyNearer),
                    least => (least.map_or(open[0], |least| least.0), Reason::Nearest),
                }
            }
            Choice::Quickest => {
                let times = possible.map(|prospect| (prospect.place, prospect.total_secs()));
                match least_or_kept(times, before, is_clearly_quicker) {
                    Some((place, true)) => (place, Reason::NotClearlyQuicker),
                    least => (least.map_or(open[0], |least| least.0), Reason::Quickest),
                }
            }
            Choice::Shares(weights) => {
                let drawn = || self.draw(trip, &open, weights);
                (before.unwrap_or_else(drawn), Reason::Drawn)
            }
            Choice::Fewest => {
                let bound = |place: u16| self.crowd.progress.places[usize::from(place)].bound;
                let fewest = open.iter().copied().min_by_key(|&place| bound(place));
                (before.or(fewest).unwrap_or(open[0]), Reason::Fewest)
            }
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
        let (id, choice) = (self.crowd.agents.id[self.agent], u64::from(trip.choices));
        random::stream(self.scene.seed, Purpose::Choice, id, choice)
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
        let onward = self.journey(trip).stages.get(usize::from(trip.stage) + 1);
        let is_timed = self.stage(trip).choice == Choice::Quickest;
        let see = |(&place, length): (&u16, f64)| {
            let expects = is_timed && length.is_finite();
            Prospect {
                place,
                open: self.is_open(place),
                length,
                expected: expects.then(|| self.expect(place, length, onward)),
            }
        };
        places.iter().zip(lengths).map(see).collect()
    }

    /// Adds the waits on the routes to the expected times. Waits only lengthen times, so a place that is not clearly
    /// quicker than place `before` without them is skipped unless it is asked for: its time is then a lower bound.
    fn expect_waits(&self, prospects: &mut [Prospect], before: Option<u16>) {
        let mut known = self.seen.and_then(|seen| seen.routes_out.clone());
        let mut wait = |prospect: &mut Prospect| {
            let to = (self.agent, prospect.place, prospect.length);
            let expected = prospect.expected.as_mut()?;
            if let Some(walking) = self.crowd.time_to(self.scene, to, &mut known) {
                *expected = expected.walking(walking);
            }
            Some(expected.total_secs)
        };
        let is_kept = |prospect: &&mut Prospect| Some(prospect.place) == before;
        let kept = prospects.iter_mut().find(is_kept).and_then(&mut wait);
        for prospect in prospects {
            let least = prospect.total_secs();
            let can_win = kept.is_none_or(|kept| is_clearly_quicker(least, kept));
            if Some(prospect.place) != before && (can_win || self.is_asked) {
                wait(prospect);
            }
        }
    }

    /// The lengths of the routes from `p` to some places, meters; infinite where there is none.
    pub(super) fn lengths(&self, p: Vector, places: &[u16]) -> Vec<f64> {
        match &self.scene.routes {
            Some(routes) => routes.lengths(p, places),
            None => vec![f64::INFINITY; places.len()],
        }
    }

    /// The length of the way to a place, meters; infinite if there is none.
    pub(super) fn length(&self, place: u16) -> f64 {
        let position = self.crowd.agents.position[self.agent];
        let routes = self.scene.routes.as_ref();
        let length = routes.map(|routes| routes.length(position, Destination::Place(place)));
        length.unwrap_or(f64::INFINITY)
    }

    /// The times that the agent expects for a place at the end of a way of this length, meters, without waits on it,
    /// and for the way to the next stage.
    fn expect(&self, place: u16, length: f64, onward: Option<&JourneyStage>) -> Expected {
        let own = self.crowd.agents.preferred_speed.get(self.agent);
        let speed = own.copied().unwrap_or(self.scene.preferred_speed);
        let speed = speed.max(f64::MIN_POSITIVE);
        let state = &self.crowd.progress.places[usize::from(place)];
        let definition = &self.scene.journeys.places[usize::from(place)];
        let line = Line {
            length,
            stream: Some(&state.stream),
            oncoming: 0,
            flow: self.flow(definition, state),
        };
        let onward = onward.map_or(0.0, |stage| {
            let from = definition.nearest_point(self.crowd.agents.position[self.agent]);
            let lengths = self.lengths(from, &stage.places).into_iter();
            let shortest = lengths.filter(|length| length.is_finite()).reduce(f64::min);
            shortest.unwrap_or(0.0)
        });
        let waiting = line.waiting(speed.max(self.scene.preferred_speed));
        line.expected(length / speed, waiting, &[onward / speed])
    }

    /// The flow that an agent expects through a place, P/s.
    fn flow(&self, place: &Place, state: &PlaceState) -> f64 {
        let most = match &place.kind {
            Kind::Exit(exit) => exit.most_per_sec.unwrap_or(f64::INFINITY),
            Kind::Line(_) | Kind::Door(_) => f64::INFINITY,
            Kind::Queue(queue) => return f64::from(queue.servers) / queue.mean_service,
            Kind::Disk { .. } | Kind::Waiting(_) => return f64::INFINITY,
        };
        let per_meter = self.crowd.flow_per_meter().max(FLOW_PER_METER_OF_EXITS);
        let expected = per_meter * width(place).unwrap_or(0.0);
        state.stream.flow(expected.min(most)).min(most)
    }
}

impl Crowd {
    /// What agents see that are due to choose, before the first of them chooses.
    pub(super) fn seen_by(&self, scene: &Scene, due: &[usize]) -> Vec<Option<Seen>> {
        let seen = due.par_iter().with_min_len(BLOCK).map(|&agent| {
            let trip = self.agents.trip[agent].as_ref();
            let chooses = |trip: &&Trip| trip.chooses_at <= self.clock.frame();
            let trip = trip
                .filter(|trip| trip.status == Status::Walking)
                .filter(chooses)?;
            let chooser = Chooser::of(scene, self, agent);
            let stage = chooser.stage(trip);
            let lengths = chooser.lengths(self.agents.position[agent], &stage.places);
            let compares = matches!(stage.choice, Choice::Quickest);
            let mut known = stage.places.iter().zip(&lengths).filter(|_| compares);
            let known = known.find(|(place, length)| **place == trip.place && length.is_finite());
            let routes_out = known.and_then(|(&place, &length)| {
                self.routes_out_to(scene, (agent, place, length), None)
            });
            Some(Seen {
                stage: trip.stage,
                lengths,
                routes_out,
            })
        });
        seen.collect()
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

//! How agents choose between places.

use rand::Rng;

use super::{Crowd, PlaceState};
use crate::engine::journeys::{Choice, JourneyStage, Kind, Place, Status, Trip};
use crate::engine::random::{self, Purpose};
use crate::engine::scene::Scene;
use crate::engine::ways::{Destination, SLACK};

/// Agents that choose the nearest place look again after this, seconds.
const NEAREST_EVERY: f64 = 1.0;
/// Agents that choose the quickest place look again after a time in this range, seconds.
const QUICKEST_EVERY: [f64; 2] = [2.0, 5.0];
/// An agent changes to a place that it expects to pass in less than this part of the time.
const CLEARLY_QUICKER: f64 = 0.8;
/// The flow through a place is observed over this time, seconds.
const OBSERVED: f64 = 10.0;
/// The least flow that agents expect through an exit, P/(m s): about what Weidmann (1993) gives.
const FLOW_PER_METER: f64 = 1.3;
/// Within this distance, meters, this many agents make a crowd before an exit; then its flow is what it lets through.
const CROWD: (f64, u32) = (2.0, 4);
/// So many passes after the first one make a flow.
const FEWEST_OBSERVED: usize = 5;
/// The least flow that agents expect from observation, P/s.
const LEAST_FLOW: f64 = 0.1;
/// The width of the classes of distances in which agents are counted, meters.
const BIN: f64 = 0.5;
/// Farther agents are counted as this far, meters.
const FARTHEST_BIN: f64 = 500.0;

/// An agent that chooses.
pub(super) struct Chooser<'a> {
    pub(super) scene: &'a Scene,
    pub(super) crowd: &'a Crowd,
    /// Its index.
    pub(super) agent: usize,
}

impl Chooser<'_> {
    /// The place for the current stage of `trip`, and the frame in which the agent chooses again. `before` is the place
    /// that it walks to.
    pub(super) fn choose(&self, trip: &Trip, before: Option<u16>) -> (u16, u64) {
        let journey = &self.scene.journeys.journeys[usize::from(trip.journey)];
        let stage = journey.stage(trip.stage);
        let state = |place: u16| &self.crowd.progress.places[usize::from(place)];
        let is_open = |&place: &u16| {
            let is_exit = self.scene.journeys.places[usize::from(place)].is_exit();
            !is_exit || state(place).open
        };
        let mut open: Vec<u16> = stage.places.iter().copied().filter(is_open).collect();
        if open.is_empty() {
            open.clone_from(&stage.places);
        }
        let before = before.filter(|place| open.contains(place));
        let clock = &self.crowd.clock;
        let id = self.crowd.agents.id[self.agent];
        let seed = self.scene.seed;
        let mut random = random::stream(seed, Purpose::Choice, id, u64::from(trip.choices));
        let again = |secs: f64| clock.coarse_frame_at(clock.time() + secs);
        match &stage.choice {
            Choice::Nearest => {
                let place = best(
                    &open,
                    before,
                    |p| self.length(p),
                    |new, old| new < old - SLACK,
                );
                // The first time at random, so that not all agents look in the same frame.
                let wait = match before {
                    None => random.random_range(0.0..NEAREST_EVERY) + 1e-9,
                    Some(_) => NEAREST_EVERY,
                };
                (
                    place,
                    if stage.places.len() > 1 {
                        again(wait)
                    } else {
                        u64::MAX
                    },
                )
            }
            Choice::Quickest => {
                let onward = journey.stages.get(usize::from(trip.stage) + 1);
                let time = |place| self.time(place, onward);
                let place = best(&open, before, time, |new, old| new < CLEARLY_QUICKER * old);
                let [least, most] = QUICKEST_EVERY;
                (place, again(random.random_range(least..most)))
            }
            Choice::Shares(weights) => {
                let places = stage.places.iter().zip(weights);
                let open: Vec<_> = places.filter(|(place, _)| open.contains(place)).collect();
                let total: f64 = open.iter().map(|(_, weight)| **weight).sum();
                let mut left = random.random_range(0.0..1.0) * total;
                let chosen = open.iter().find(|(_, weight)| {
                    left -= **weight;
                    left < 0.0
                });
                let chosen = chosen.or(open.last()).map(|(place, _)| **place);
                (before.or(chosen).unwrap_or(stage.places[0]), u64::MAX)
            }
            Choice::Fewest => {
                let fewest = open.iter().copied().min_by_key(|&place| state(place).bound);
                (before.or(fewest).unwrap_or(stage.places[0]), u64::MAX)
            }
        }
    }

    /// The length of the way to a place, meters; infinite if there is none.
    pub(super) fn length(&self, place: u16) -> f64 {
        let position = self.crowd.agents.position[self.agent];
        let ways = self.scene.ways.as_ref();
        let way = ways.and_then(|ways| ways.way(position, Destination::Place(place)));
        way.map_or(f64::INFINITY, |way| way.length)
    }

    /// The expected time to pass a place and to walk to the next stage from there, seconds.
    fn time(&self, place: u16, onward: Option<&JourneyStage>) -> f64 {
        let length = self.length(place);
        let speed = self.scene.preferred_speed.max(f64::MIN_POSITIVE);
        let state = &self.crowd.progress.places[usize::from(place)];
        let definition = &self.scene.journeys.places[usize::from(place)];
        let ahead = state.nearer_than(length);
        let passing = f64::from(ahead) / self.flow(definition, state);
        let onward = onward.map_or(0.0, |stage| {
            let from = definition.nearest_point(self.crowd.agents.position[self.agent]);
            let ways = self.scene.ways.as_ref();
            let way = |next: &u16| ways?.way(from, Destination::Place(*next));
            let lengths = stage.places.iter().filter_map(way).map(|way| way.length);
            lengths.reduce(f64::min).unwrap_or(0.0)
        });
        (length / speed).max(passing) + onward / speed
    }

    /// The flow that an agent expects through a place, P/s. Through an exit with a crowd before it, that is the flow
    /// observed there. An exit without a crowd could let more through than it does: there it is the flow per meter
    /// observed at the best exit.
    fn flow(&self, place: &Place, state: &PlaceState) -> f64 {
        let most = match &place.kind {
            Kind::Exit(exit) => exit.most_per_sec.unwrap_or(f64::INFINITY),
            Kind::Line(_) => f64::INFINITY,
            Kind::Queue(queue) => return f64::from(queue.servers) / queue.mean_service,
            Kind::Disk { .. } | Kind::Waiting(_) => return f64::INFINITY,
        };
        let (near, crowd) = CROWD;
        if state.nearer_than(near) >= crowd
            && let Some(flow) = self.observed(state)
        {
            return flow.max(LEAST_FLOW);
        }
        let places = self.scene.journeys.places.iter();
        let states = places.zip(&self.crowd.progress.places);
        let flows = states.filter_map(|(place, state)| Some(self.observed(state)? / width(place)?));
        let per_meter = flows.fold(FLOW_PER_METER, f64::max);
        width(place).map_or(most, |width| (per_meter * width).min(most))
    }

    /// The flow through a place since the first of the agents that passed it during the last seconds, P/s; `None` if
    /// these were too few.
    fn observed(&self, state: &PlaceState) -> Option<f64> {
        let clock = &self.crowd.clock;
        let others = state.recent.len().checked_sub(1)?;
        let since = clock.time() - clock.time_at(state.recent[0]);
        (others >= FEWEST_OBSERVED && since > 0.0).then(|| others as f64 / since)
    }
}

/// The length of the line of a place, meters.
fn width(place: &Place) -> Option<f64> {
    place.line().map(|[a, b]| (b - a).norm())
}

/// The place with the least value; `before` unless another one is `better` than it.
fn best(
    places: &[u16],
    before: Option<u16>,
    value: impl Fn(u16) -> f64,
    better: impl Fn(f64, f64) -> bool,
) -> u16 {
    let values = places.iter().map(|&place| (place, value(place)));
    let least = values.min_by(|a, b| a.1.total_cmp(&b.1));
    let (place, least) = least.unwrap_or((places[0], f64::INFINITY));
    match before {
        Some(before) if !better(least, value(before)) => before,
        _ => place,
    }
}

impl PlaceState {
    /// Counts an agent that has come to be bound for this place from `length` meters away, or no longer is.
    pub(super) fn count(&mut self, length: f64, comes: bool) {
        let bin = (length.min(FARTHEST_BIN) / BIN) as usize;
        let last = self.nearer.last().copied().unwrap_or(0);
        self.nearer.resize(self.nearer.len().max(bin + 2), last);
        for count in &mut self.nearer[bin + 1..] {
            *count = if comes {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
        }
    }

    /// The number of agents bound for this place that are nearer to it than `length` meters.
    fn nearer_than(&self, length: f64) -> u32 {
        let last = self.nearer.last().copied().unwrap_or(0);
        let bin = (length.min(FARTHEST_BIN) / BIN) as usize;
        self.nearer.get(bin).copied().unwrap_or(last)
    }
}

/// Once per second: counts the agents bound for each place by distance, and forgets old passes.
pub(super) fn count(crowd: &mut Crowd, scene: &Scene) {
    let clock = &crowd.clock;
    let before = clock
        .frame()
        .saturating_sub(u64::from(clock.coarse_every()));
    let is_due = clock.frame() == 0 || clock.time().floor() > clock.time_at(before).floor();
    if !is_due || !scene.journeys.has_quickest() {
        return;
    }
    let oldest = clock.time() - OBSERVED;
    for state in &mut crowd.progress.places {
        state.recent.retain(|&frame| clock.time_at(frame) > oldest);
        state.nearer.clear();
    }
    let agents = &crowd.agents;
    for (trip, route) in agents.trip.iter().zip(&agents.route) {
        let (Some(trip), Some(route)) = (trip, route) else {
            continue;
        };
        if matches!(trip.status, Status::Waiting { .. } | Status::Finished) {
            continue;
        }
        let bin = (route.length().min(FARTHEST_BIN) / BIN) as usize;
        let nearer = &mut crowd.progress.places[usize::from(trip.place)].nearer;
        nearer.resize(nearer.len().max(bin + 2), 0);
        nearer[bin + 1] += 1;
    }
    for state in &mut crowd.progress.places {
        let mut sum = 0;
        for count in &mut state.nearer {
            sum += *count;
            *count = sum;
        }
    }
}

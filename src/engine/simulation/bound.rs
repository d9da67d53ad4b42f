//! Streams of agents toward places and openings: the number that is bound for each, by distance, and the flow.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Crowd;
use crate::clock::Clock;
use crate::journeys::{Kind, Place, Status};
use crate::scene::Scene;
use crate::ways::{Destination, Step};

/// The flow through an opening is averaged over this time, seconds.
const OBSERVED: f64 = 15.0;
/// The flow that follows from the width counts as much as this time of observation, seconds.
const EXPECTED: f64 = 5.0;
/// The least flow that agents expect, P/(m s): about what Weidmann (1993) gives.
pub(super) const FLOW_PER_METER: f64 = 1.3;
/// That through exits before which no crowd has stood: about what `walk+sph` passes. With less, people would take the
/// far exit although the near one is free.
pub(super) const FLOW_PER_METER_OF_EXITS: f64 = 2.3;
/// That through openings: about what Seyfried et al. (2009) measured at bottlenecks.
pub(super) const FLOW_PER_METER_OF_OPENINGS: f64 = 1.9;
/// If this many times as many agents stand within [`BEFORE`] meters of a place or of an opening as walk there at
/// [`FLOW_PER_METER`], and one more, a crowd stands before it, and its flow is its capacity.
const CROWD: f64 = 2.0;
const CROWD_AT_OPENING: f64 = 1.0;
/// The area before a line ends at this distance, meters.
pub(super) const BEFORE: f64 = 2.0;
/// The least flow that agents expect from observation, P/s.
const LEAST_FLOW: f64 = 0.05;
/// The width of the bins of distances in which agents are counted, meters.
const BIN: f64 = 0.1;
/// Larger distances are clamped to this, meters.
const FARTHEST_BIN: f64 = 500.0;

/// The bin of a distance, meters.
fn bin_of(length: f64) -> usize {
    (length.min(FARTHEST_BIN) / BIN) as usize
}

/// The agents bound for a line, and those that have passed it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Stream {
    /// `nearer[k]` is the number of agents bound for it that are nearer than k bins.
    nearer: Vec<u32>,
    /// The number of agents that have passed it since the last second.
    passes: u32,
    /// The number that passed while a crowd stood before it, and how long one did, seconds. Both decay.
    passed: f64,
    crowded: f64,
}

impl Stream {
    /// Counts an agent `length` meters away that is now bound for the line (`comes`), or no longer bound for it.
    pub(super) fn count(&mut self, length: f64, comes: bool) {
        let bin = bin_of(length);
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

    /// The number of agents bound for the line that are nearer to it than `length` meters.
    pub fn nearer_than(&self, length: f64) -> u32 {
        let last = self.nearer.last().copied().unwrap_or(0);
        self.nearer.get(bin_of(length)).copied().unwrap_or(last)
    }

    /// The time until all agents bound for the line that are nearer than `length` meters have passed it, seconds: they
    /// walk there at `speed`, and pass one after the other at a flow. An agent at that distance that walks no faster
    /// waits only in a queue.
    pub fn clear_after(&self, length: f64, speed: f64, flow: f64) -> f64 {
        let bins = self.nearer.windows(2).take(bin_of(length)).enumerate();
        let coming = bins.filter(|(_, counts)| counts[1] > counts[0]);
        coming.fold(0.0, |clear: f64, (bin, counts)| {
            let arrives = bin as f64 * BIN / speed;
            clear.max(arrives) + f64::from(counts[1] - counts[0]) / flow
        })
    }

    /// The number of agents bound for the line.
    pub fn bound(&self) -> u32 {
        self.nearer_than(FARTHEST_BIN)
    }

    /// Records that an agent passes the line.
    pub(super) fn pass(&mut self) {
        self.passes += 1;
    }

    /// The flow that agents expect, P/s: that which follows from the width, `expected`, and more and more the one
    /// observed while a crowd stands before the line.
    pub fn flow(&self, expected: f64) -> f64 {
        let flow = (EXPECTED * expected + self.passed) / (EXPECTED + self.crowded);
        flow.max(LEAST_FLOW)
    }

    /// Once per second: counts the agents bound for the line at these distances again, meters.
    fn recount(&mut self, lengths: &[f64]) {
        self.nearer.clear();
        for bin in lengths.iter().map(|&length| bin_of(length)) {
            self.nearer.resize(self.nearer.len().max(bin + 2), 0);
            self.nearer[bin + 1] += 1;
        }
        let mut sum = 0;
        for count in &mut self.nearer {
            sum += *count;
            *count = sum;
        }
    }

    /// Once per second: takes over the agents that have passed. With less than `crowd` agents before the line, they
    /// say nothing about its flow.
    fn observe(&mut self, crowd: f64) {
        let keep = 1.0 - 1.0 / OBSERVED;
        self.passed *= keep;
        self.crowded *= keep;
        let passes = std::mem::take(&mut self.passes);
        if f64::from(self.nearer_than(BEFORE)) >= crowd {
            self.passed += f64::from(passes);
            self.crowded += 1.0;
        }
    }
}

/// Whether a second has begun since the last coarse frame.
pub(super) fn is_due(clock: &Clock) -> bool {
    let before = clock
        .frame()
        .saturating_sub(u64::from(clock.coarse_every()));
    clock.frame() == 0 || clock.time().floor() > clock.time_at(before).floor()
}

/// The width of a place that agents pass, meters; `None` for places that are no lines.
pub(super) fn width(place: &Place) -> Option<f64> {
    place.line().map(|[a, b]| (b - a).norm())
}

/// Once per second: counts the agents bound for each place and opening by distance, and learns the flows.
pub(super) fn count(crowd: &mut Crowd, scene: &Scene) {
    if !is_due(&crowd.clock) {
        return;
    }
    if scene.journeys.has_quickest() {
        crowd.count_places(scene);
    }
    crowd.count_steps(scene);
    let per_meter = crowd.largest_flow(scene);
    crowd.progress.per_meter = per_meter;
    let speed = scene.preferred_speed.max(f64::MIN_POSITIVE);
    let crowd_before =
        |width: f64, before: f64, crowd: f64| 1.0 + crowd * FLOW_PER_METER * width * before / speed;
    let places = scene.journeys.places.iter();
    for (place, state) in places.zip(&mut crowd.progress.places) {
        let width = width(place).unwrap_or(0.0);
        state.stream.observe(crowd_before(width, BEFORE, CROWD));
    }
    if let Some(rooms) = scene.rooms() {
        for (step, stream) in (0..).zip(&mut crowd.progress.steps) {
            let before = rooms.depth(step).min(BEFORE);
            let width = rooms.opening(step).width();
            stream.observe(crowd_before(width, before, CROWD_AT_OPENING));
        }
    }
}

/// The lengths of the ways of agents to each of `count` lines, meters, from the line of each agent and its length.
fn lengths_of(agents: Vec<Option<(usize, f64)>>, count: usize) -> Vec<Vec<f64>> {
    let mut lengths = vec![Vec::new(); count];
    for (line, length) in agents.into_iter().flatten() {
        lengths[line].push(length);
    }
    lengths
}

impl Crowd {
    /// The flow per meter of lines before which no crowd stands, P/(m s).
    pub(super) fn flow_per_meter(&self) -> f64 {
        self.progress.per_meter.max(FLOW_PER_METER)
    }

    /// The largest flow per meter of all lines, P/(m s).
    fn largest_flow(&self, scene: &Scene) -> f64 {
        let places = scene.journeys.places.iter().zip(&self.progress.places);
        let places = places.filter(|(place, _)| match &place.kind {
            Kind::Exit(exit) => exit.most_per_sec.is_none(),
            _ => true,
        });
        let places = places.filter_map(|(place, state)| Some((width(place)?, &state.stream)));
        let steps = (0..)
            .zip(&self.progress.steps)
            .filter_map(|(step, stream)| {
                Some((scene.rooms()?.opening(step as Step).width(), stream))
            });
        let flows = places
            .chain(steps)
            .map(|(width, stream)| stream.flow(FLOW_PER_METER * width) / width);
        flows.fold(FLOW_PER_METER, f64::max)
    }

    fn count_places(&mut self, scene: &Scene) {
        let agents = &self.agents;
        let trips = agents.trip.par_iter().zip(&agents.route).enumerate();
        let bound = trips.map(|(i, (trip, route))| {
            let (trip, route) = (trip.as_ref()?, route.as_ref()?);
            if !matches!(trip.status, Status::Walking | Status::Queued { .. }) {
                return None;
            }
            let detours = agents.plan.get(i).copied().flatten();
            let length = match detours.is_some_and(|plan| plan.detours) {
                false => route.length(),
                true => scene.ways.as_ref().map_or(f64::INFINITY, |ways| {
                    let way = ways.way(agents.position[i], Destination::Place(trip.place));
                    way.map_or(f64::INFINITY, |way| way.length)
                }),
            };
            Some((usize::from(trip.place), length))
        });
        let lengths = lengths_of(bound.collect(), self.progress.places.len());
        for (state, lengths) in self.progress.places.iter_mut().zip(&lengths) {
            state.stream.recount(lengths);
        }
    }

    fn count_steps(&mut self, scene: &Scene) {
        let Some(rooms) = scene.rooms().filter(|_| scene.by_time()) else {
            return;
        };
        let agents = &self.agents;
        let plans = agents.plan.par_iter().zip(&agents.position);
        let toward = plans.map(|(plan, &p)| {
            let plan = plan.as_ref()?;
            let step = plan.toward?;
            // It may have left its triangle since it was located.
            let here = rooms.floor.locate_or_nearest(Some(plan.triangle), p)?;
            let length = rooms.length_to(p, here, step);
            Some((step as usize, length.unwrap_or(0.0)))
        });
        let lengths = lengths_of(toward.collect(), rooms.steps() as usize);
        self.progress
            .steps
            .resize_with(lengths.len(), Stream::default);
        for (stream, lengths) in self.progress.steps.iter_mut().zip(&lengths) {
            stream.recount(lengths);
        }
    }
}

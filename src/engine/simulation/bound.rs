//! Which agents are bound for each place and opening, and the flows there.

use rayon::prelude::*;

use super::stream::{BEFORE, Stream};
use super::{Crowd, Simulation, Stage};
use crate::clock::Clock;
use crate::journeys::{Kind, Place, Status};
use crate::routes::Destination;
use crate::scene::Scene;

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

/// Whether a second has begun since the last coarse frame.
pub(super) fn is_due(clock: &Clock) -> bool {
    let frame = clock.frame();
    let before = frame.saturating_sub(u64::from(clock.coarse_every()));
    frame == 0 || clock.time().floor() > clock.time_at(before).floor()
}

/// The width of a place that agents pass, meters; `None` for places that are no lines.
pub(super) fn width(place: &Place) -> Option<f64> {
    place.line().map(|[a, b]| (b - a).norm())
}

impl Simulation {
    /// Once per second: counts the agents bound for each place and opening by distance, and learns the flows.
    pub(super) fn count_streams(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        let has_trips = scene.journeys.has_trips();
        if !crowd.decides() || !(has_trips || scene.rooms().is_some()) {
            return;
        }
        if has_trips {
            crowd.progress.extend_to(&scene.journeys);
        }
        if is_due(&crowd.clock) {
            let stage = if has_trips {
                Stage::Journeys
            } else {
                Stage::Routes
            };
            self.stages.time(stage, || crowd.count_streams(scene));
        }
    }
}

/// The lengths of the routes of agents to each of `count` lines, meters, from the line of each agent and its length.
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
        let sides = scene.rooms().into_iter().flat_map(|rooms| {
            let sides = rooms.sides().zip(&self.progress.sides);
            sides.map(|(side, stream)| (rooms.opening(side).width(), stream))
        });
        let flows = places
            .chain(sides)
            .map(|(width, stream)| stream.flow(FLOW_PER_METER * width) / width);
        flows.fold(FLOW_PER_METER, f64::max)
    }

    fn count_streams(&mut self, scene: &Scene) {
        if scene.journeys.has_quickest() {
            self.count_places(scene);
        }
        self.count_sides(scene);
        self.progress.per_meter = self.largest_flow(scene);
        let speed = scene.preferred_speed.max(f64::MIN_POSITIVE);
        let crowd_before = |width: f64, before: f64, crowd: f64| {
            1.0 + crowd * FLOW_PER_METER * width * before / speed
        };
        let places = scene.journeys.places.iter();
        for (place, state) in places.zip(&mut self.progress.places) {
            let width = width(place).unwrap_or(0.0);
            state.stream.observe(crowd_before(width, BEFORE, CROWD));
        }
        if let Some(rooms) = scene.rooms() {
            for (side, stream) in rooms.sides().zip(&mut self.progress.sides) {
                let before = rooms.depth(side).min(BEFORE);
                let width = rooms.opening(side).width();
                stream.observe(crowd_before(width, before, CROWD_AT_OPENING));
            }
        }
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
                true => scene.routes.as_ref().map_or(f64::INFINITY, |routes| {
                    routes.length(agents.position[i], Destination::Place(trip.place))
                }),
            };
            Some((usize::from(trip.place), length))
        });
        let lengths = lengths_of(bound.collect(), self.progress.places.len());
        for (state, lengths) in self.progress.places.iter_mut().zip(&lengths) {
            state.stream.recount(lengths);
        }
    }

    fn count_sides(&mut self, scene: &Scene) {
        let Some(rooms) = scene.rooms().filter(|_| scene.by_time()) else {
            return;
        };
        let agents = &self.agents;
        let plans = agents.plan.par_iter().zip(&agents.position);
        let toward = plans.map(|(plan, &p)| {
            let plan = plan.as_ref()?;
            let side = plan.toward?;
            let here = plan.located.triangle_at(rooms, p)?;
            let length = rooms.length_to(rooms.floor.in_building(p), here, side);
            Some((side.index(), length.unwrap_or(0.0)))
        });
        let lengths = lengths_of(toward.collect(), rooms.sides().len());
        let sides = &mut self.progress.sides;
        sides.resize_with(lengths.len(), Stream::default);
        for (stream, lengths) in sides.iter_mut().zip(&lengths) {
            stream.recount(lengths);
        }
    }
}

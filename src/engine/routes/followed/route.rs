//! The routes that agents follow.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::routes::{Destination, MapKey, Routes};
use crate::math::Vector;
use crate::random::{self, Purpose};
use crate::routes::floor::Floor;
use crate::routes::paths::{End, Next, PathMap, SLACK, Source, Way};
use crate::routes::paths::{around, between_borders, points};

/// Agents keep this distance from corners in addition to their radius, drawn for each agent, meters.
const CLEARANCE: [f64; 2] = [0.05, 0.6];

/// Agents keep their aim until they have moved this fraction of the distance to the next point. Until then, their
/// headings are off by a few degrees at most.
const SHARE: f64 = 0.15;
/// They find a new aim after this distance at the latest, meters.
const LONGEST: f64 = 0.8;

/// The aim of an agent that walks to a corner is at least this far away, meters.
const NEAREST: f64 = 1.0;

/// The way that an agent follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// Where the agent was when its aim was last found, meters.
    found: Vector,
    /// The aim is found again when the agent is this far from `found`, meters.
    reach: f64,
    /// The triangle in which the way was found.
    triangle: u32,
    /// The number of the map's entry for it.
    entry: u32,
    /// At `found`, the length of the way exceeded that of the shortest by at most this, meters.
    excess: f64,
    /// Its path map; `None`: straight to its goal.
    map: Option<MapKey>,
    /// What comes next.
    next: Next,
    /// The length of the way, meters; infinite without a path map.
    length: f64,
    /// The distance that the agent keeps from corners, meters.
    clearance: f64,
    /// Whether the agent sees the end and still turns around the last corner.
    rounds: bool,
}

/// An agent that looks for its way.
#[derive(Debug, Clone, Copy)]
pub struct Walker {
    /// Its number.
    pub id: u32,
    /// Its position, meters.
    pub position: Vector,
    /// Where it wants to go.
    pub to: Destination,
    /// Its radius, meters.
    pub radius: f64,
    /// The path map that it follows, if not that of the shortest way.
    pub detour: Option<MapKey>,
}

impl Routes {
    /// Updates the route of an agent and returns the point that it walks toward, meters. `seed` is that of the
    /// population.
    pub fn aim(&self, walker: &Walker, route: &mut Option<Route>, seed: u64) -> Vector {
        let p = walker.position;
        let route = route.get_or_insert_with(|| self.first_route(walker, seed));
        let Some(way) = self.go_on(route, p) else {
            let end = match walker.to {
                Destination::Goal(goal) if self.floor.is_one_level(p, goal) => goal,
                // Without a way, the agent stays.
                _ => p,
            };
            (route.next, route.reach) = (Next::Goal(end), 0.0);
            return end;
        };
        let rounded = route.rounds || route.next.bend().is_some();
        (route.next, route.rounds) = (way.next, false);
        let floor = self.floor_of(route);
        let heading = match way.next {
            Next::Corner(bend) => way.borders.map(|borders| {
                let (at, corner) = ((floor.in_building(p), way.distance), (bend, borders));
                around(floor, at, corner, route.clearance)
            }),
            Next::Goal(_) => self.turn_to_end(walker, route, &way, rounded),
            Next::Out(_) => None,
        };
        let ahead = way.distance.max(NEAREST);
        heading.map_or_else(
            || floor.seen_from(p, way.next.place(floor)),
            |heading| p + heading * ahead,
        )
    }

    /// The route of an agent that has not looked for its way yet.
    fn first_route(&self, walker: &Walker, seed: u64) -> Route {
        let [low, high] = CLEARANCE;
        let mut random = random::stream(seed, Purpose::Clearance, walker.id, 0);
        let shortest = || self.map_to(walker.to).map(MapKey::Floor);
        Route {
            found: walker.position,
            reach: 0.0,
            triangle: 0,
            entry: u32::MAX,
            excess: 0.0,
            map: walker.detour.or_else(shortest),
            next: Next::Goal(walker.position),
            length: f64::INFINITY,
            clearance: walker.radius + random.random_range(low..=high),
            rounds: false,
        }
    }

    /// The heading of an agent that sees the end of its way, and may have `rounded` a corner before; `None` if it walks
    /// straight.
    fn turn_to_end(
        &self,
        walker: &Walker,
        route: &mut Route,
        way: &Way,
        rounded: bool,
    ) -> Option<Vector> {
        let (floor, map) = self.map_of(route)?;
        let source = map.source(way.entry);
        // Agents that see a goal point from their start, or have a goal line in front of them, walk straight if their
        // bodies fit. They pass the end of a line like the jamb of a door.
        let rounds = match source {
            Some(Source::Line { .. }) => false,
            Some(source) if source.ends().is_some() => true,
            _ => rounded,
        };
        let least = walker.radius + CLEARANCE[0];
        let gap = if rounds { route.clearance } else { least };
        let end = End {
            point: way.next.place(floor),
            distance: way.distance,
            line: source.and_then(Source::ends),
        };
        let here = floor.in_building(walker.position);
        let (heading, nearest) = between_borders(here, &end, way.borders?, gap)?;
        route.rounds = rounds;
        route.reach = route.reach.min(SHARE * nearest);
        Some(heading)
    }

    /// The way from `p` for an agent on `route`. The agent keeps its entry as long as the entry holds at `p` and its
    /// way is certainly at most [`SLACK`] longer than the shortest.
    fn go_on(&self, route: &mut Route, p: Vector) -> Option<Way> {
        let (floor, map) = self.map_of(route)?;
        let at = floor.in_building(p);
        if let Some(way) = map.way_over(floor, at, route.entry as usize) {
            // Moving shortened the shortest way by at most the distance moved.
            let excess = route.excess + way.length - route.length + (p - route.found).norm();
            route.set(floor, p, &way, excess);
            if route.reach > 0.0 && excess < SLACK {
                return Some(way);
            }
        }
        let here = floor.locate_or_nearest(Some(route.triangle), p)?;
        let way = map.way(floor, at, here, route.next.bend())?;
        route.triangle = here;
        route.entry = u32::try_from(way.entry).unwrap_or(u32::MAX);
        route.set(floor, p, &way, 0.0);
        Some(way)
    }

    /// Whether the corner, the triangle and the map of `route` exist.
    pub fn knows(&self, route: &Route) -> bool {
        let floor = self.floor_of(route);
        let bend = route.next.bend();
        bend.is_none_or(|bend| (bend.corner as usize) < floor.corners.len())
            && (route.triangle as usize) < floor.mesh.triangles().len()
            && route.map.is_none_or(|key| self.map(key).is_some())
    }

    /// The points of the rest of a route, as in [`course`](Self::course); of a detour, those up to its opening.
    pub fn course_of(&self, route: &Route) -> Vec<Vector> {
        match self.map_of(route) {
            Some((floor, map)) => points(floor, map, route.next)
                .map(|point| floor.seen_from(route.found, point))
                .collect(),
            None => vec![self.next(route)],
        }
    }

    /// The point that an agent on `route` walks to next, meters: a corner or its goal.
    pub fn next(&self, route: &Route) -> Vector {
        let floor = self.floor_of(route);
        floor.seen_from(route.found, route.next.place(floor))
    }

    /// The path map of a route, and the floor on which it lies.
    fn map_of(&self, route: &Route) -> Option<(&Floor, &PathMap)> {
        self.map(route.map?)
    }

    /// The floor of a route.
    fn floor_of(&self, route: &Route) -> &Floor {
        self.map_of(route).map_or(&self.floor, |(floor, _)| floor)
    }
}

impl Route {
    /// Takes a way from `p` that is at most `excess` meters longer than the shortest.
    fn set(&mut self, floor: &Floor, p: Vector, way: &Way, excess: f64) {
        let place = floor.seen_from(p, way.next.place(floor));
        (self.found, self.length, self.excess) = (p, way.length, excess);
        let most = (SHARE * way.distance).min(LONGEST).min(way.sight);
        self.reach = floor.plane().room_before(self.triangle, p, place, most);
    }

    /// Whether an agent at `position` still follows the route.
    #[inline]
    pub fn holds(&self, position: Vector) -> bool {
        self.reach > 0.0 && (position - self.found).norm_squared() < self.reach * self.reach
    }

    /// The length of the way when it was last found, meters; infinite without a path map.
    pub fn length(&self) -> f64 {
        self.length
    }
}

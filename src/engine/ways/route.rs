//! The ways of a scene's agents: path maps to its goals, and what each agent follows.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::WayError;
use super::floor::Floor;
use super::goal::Goal;
use super::map::{Next, PathMap, Way};
use super::mesh::side;
use super::steer::heading;
use crate::engine::math::{Vector, direction};
use crate::engine::random::{self, Purpose};

/// Agents keep this distance from corners in addition to their radius, drawn for each agent, meters.
const CLEARANCE: [f64; 2] = [0.05, 0.6];

/// Lines are shortened by this at both ends, so that bodies fit between the ends, meters.
const LINE_MARGIN: f64 = 0.25;

/// Path maps to the places and goals of a scene.
#[derive(Debug, Clone)]
pub struct Ways {
    /// The floor on which all of them lie.
    pub floor: Floor,
    /// The number of places; their maps come first.
    places: usize,
    goals: Vec<Vector>,
    maps: Vec<PathMap>,
}

/// What an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Destination {
    /// A point, meters.
    Goal(Vector),
    /// The place with this number.
    Place(u16),
}

/// The way that an agent follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// The number of its path map; `None`: straight to its goal.
    map: Option<u16>,
    /// What comes next.
    next: Next,
    /// The length of the way, meters; infinite without a path map.
    length: f64,
    /// The distance that the agent keeps from corners, meters.
    clearance: f64,
}

/// What the route of an agent depends on.
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
}

impl Ways {
    /// Path maps to `places`, each of which may have several lines and points, and to `goals`, points on the floor.
    ///
    /// # Errors
    /// A goal, or all of a place, is not on the floor.
    pub fn new(floor: Floor, places: &[Vec<Goal>], goals: Vec<Vector>) -> Result<Self, WayError> {
        let points: Vec<[Goal; 1]> = goals.iter().map(|&goal| [Goal::Point(goal)]).collect();
        let all = places.iter().map(Vec::as_slice);
        let all = all.chain(points.iter().map(|goal| &goal[..]));
        let maps = all.map(|goals| PathMap::new(&floor, goals, LINE_MARGIN));
        let maps = maps.collect::<Result<_, _>>()?;
        Ok(Self {
            floor,
            places: places.len(),
            goals,
            maps,
        })
    }

    /// The way from `p` to a destination; `None` if there is none, or no map of it.
    pub fn way(&self, p: Vector, to: Destination) -> Option<Way> {
        let map = self.map_to(to)?;
        self.from(usize::from(map), p, None)
    }

    /// Does a way lead from `p` to a destination that is nowhere narrower than the floor's least width?
    pub fn is_open(&self, p: Vector, to: Destination) -> bool {
        let floor = &self.floor;
        let Some(way) = self.way(p, to) else {
            return false;
        };
        let next = match way.next {
            Next::Goal(point) => point,
            Next::Corner { bend, .. } => floor.place(bend),
            Next::Out(_) => return false,
        };
        let Some(here) = floor.locate(p).or_else(|| floor.nearest(p)) else {
            return false;
        };
        let crosses = |[a, b]: [Vector; 2]| {
            side(a, b, p) * side(a, b, next) < 0.0 && side(p, next, a) * side(p, next, b) < 0.0
        };
        !floor.mesh.gaps(here, floor.least_width).any(crosses)
    }

    /// Can `route` come from here?
    pub fn knows(&self, route: &Route) -> bool {
        let maps = self.maps.len();
        let corners = self.floor.corners.len();
        route.map.is_none_or(|map| usize::from(map) < maps)
            && route
                .next
                .bend()
                .is_none_or(|bend| (bend.corner as usize) < corners)
    }

    fn map_to(&self, to: Destination) -> Option<u16> {
        let map = match to {
            Destination::Place(place) => {
                return (usize::from(place) < self.places).then_some(place);
            }
            Destination::Goal(goal) => self.goals.iter().position(|&other| other == goal),
        };
        map.map(|map| (self.places + map) as u16)
    }

    fn from(&self, map: usize, p: Vector, held: Option<&Next>) -> Option<Way> {
        let floor = &self.floor;
        let here = floor.locate(p).or_else(|| floor.nearest(p))?;
        self.maps[map].way(floor, p, here, held.and_then(Next::bend))
    }

    /// The route of an agent from where it is, after `before`. `seed` is that of the population.
    pub fn route(&self, walker: &Walker, before: Option<&Route>, seed: u64) -> Route {
        let mut route = before.copied().unwrap_or_else(|| {
            let [low, high] = CLEARANCE;
            let mut random = random::stream(seed, Purpose::Clearance, walker.id, 0);
            Route {
                map: self.map_to(walker.to),
                next: Next::Goal(walker.position),
                length: f64::INFINITY,
                clearance: walker.radius + random.random_range(low..=high),
            }
        });
        let way = route
            .map
            .and_then(|map| self.from(usize::from(map), walker.position, Some(&route.next)));
        match (way, walker.to) {
            (Some(way), _) => (route.next, route.length) = (way.next, way.length),
            (None, Destination::Goal(goal)) => route.next = Next::Goal(goal),
            // Without a way, the agent stays.
            (None, Destination::Place(_)) => route.next = Next::Goal(walker.position),
        }
        route
    }

    /// The direction in which an agent on `route` walks; straight toward its goal if nothing stands between.
    pub fn direction(&self, route: &Route, position: Vector) -> Vector {
        match route.next {
            Next::Goal(goal) => direction(goal - position),
            next => heading(&self.floor, position, &next, route.clearance),
        }
    }
}

/// The most points of a course: far more than any way has corners.
const MOST_POINTS: usize = 10_000;

impl Ways {
    /// Is there a path map to this destination?
    pub fn leads_to(&self, to: Destination) -> bool {
        self.map_to(to).is_some()
    }

    /// The goals that have a path map, meters.
    pub fn goals(&self) -> &[Vector] {
        &self.goals
    }

    /// The points that the shortest way from `p` leads over, meters: its corners in order, then its end. Empty if
    /// there is no way.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let first = self.map_to(to).zip(self.way(p, to));
        first.map_or(Vec::new(), |(map, way)| self.points(map, way.next))
    }

    /// The points that the rest of a route leads over, as in [`course`](Self::course).
    pub fn course_of(&self, route: &Route) -> Vec<Vector> {
        match route.map {
            Some(map) => self.points(map, route.next),
            None => vec![self.next(route)],
        }
    }

    fn points(&self, map: u16, first: Next) -> Vec<Vector> {
        let (number, map) = (usize::from(map), &self.maps[usize::from(map)]);
        let (mut points, mut next) = (Vec::new(), Some(first));
        while let Some(now) = next.take_if(|_| points.len() < MOST_POINTS) {
            match now {
                Next::Goal(point) => points.push(point),
                Next::Corner { bend, .. } => {
                    let bends = std::iter::successors(Some(bend), |bend| map.after(*bend));
                    let bends: Vec<_> = bends.take(MOST_POINTS).collect();
                    points.extend(bends.iter().map(|&bend| self.floor.place(bend)));
                    let last = bends.last();
                    points.extend(last.and_then(|&bend| map.end_after(&self.floor, bend)));
                }
                Next::Out(point) => {
                    points.push(point);
                    next = self.from(number, point, None).map(|way| way.next);
                }
            }
        }
        points
    }

    /// The point that an agent on `route` walks to next, meters: a corner or its goal.
    pub fn next(&self, route: &Route) -> Vector {
        match route.next {
            Next::Goal(point) | Next::Out(point) => point,
            Next::Corner { bend, .. } => self.floor.place(bend),
        }
    }

    /// The memory of the floor and the maps, and of building the largest, bytes.
    pub fn bytes(&self) -> usize {
        let maps = self.maps.iter().map(PathMap::bytes);
        let building = self.maps.iter().map(PathMap::building_bytes).max();
        self.floor.bytes() + maps.sum::<usize>() + building.unwrap_or_default()
    }
}

impl Route {
    /// What comes next.
    pub fn next(&self) -> Next {
        self.next
    }

    /// The length of the way when it was last found, meters; infinite without a path map.
    pub fn length(&self) -> f64 {
        self.length
    }
}

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

/// Path maps to the goals of a scene.
#[derive(Debug, Clone)]
pub struct Ways {
    /// The floor on which all of them lie.
    pub floor: Floor,
    goals: Vec<Vector>,
    maps: Vec<PathMap>,
}

/// The way that an agent follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// The number of its path map; `None`: straight to its goal.
    map: Option<u16>,
    /// What comes next.
    next: Next,
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
    /// Its goal, meters.
    pub goal: Vector,
    /// Its radius, meters.
    pub radius: f64,
}

impl Ways {
    /// Path maps to `goals`, points on the floor.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn new(floor: Floor, goals: Vec<Vector>) -> Result<Self, WayError> {
        let map = |&goal: &Vector| PathMap::new(&floor, &[Goal::Point(goal)], 0.0);
        let maps = goals.iter().map(map).collect::<Result<_, _>>()?;
        Ok(Self { floor, goals, maps })
    }

    /// The way from `p` to `goal`; `None` if there is none, or no map of this goal.
    pub fn way(&self, p: Vector, goal: Vector) -> Option<Way> {
        let map = self.map_to(goal)?;
        self.from(usize::from(map), p, None)
    }

    /// Does a way lead from `p` to `goal` that is nowhere narrower than the floor's least width?
    pub fn is_open(&self, p: Vector, goal: Vector) -> bool {
        let floor = &self.floor;
        let Some(way) = self.way(p, goal) else {
            return false;
        };
        let to = match way.next {
            Next::Goal(point) => point,
            Next::Corner { bend, .. } => floor.place(bend),
            Next::Out(_) => return false,
        };
        let Some(here) = floor.locate(p).or_else(|| floor.nearest(p)) else {
            return false;
        };
        let crosses = |[a, b]: [Vector; 2]| {
            side(a, b, p) * side(a, b, to) < 0.0 && side(p, to, a) * side(p, to, b) < 0.0
        };
        !floor.mesh.gaps(here, floor.least_width).any(crosses)
    }

    fn map_to(&self, goal: Vector) -> Option<u16> {
        let map = self.goals.iter().position(|&other| other == goal);
        map.map(|map| map as u16)
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
                map: self.map_to(walker.goal),
                next: Next::Goal(walker.goal),
                clearance: walker.radius + random.random_range(low..=high),
            }
        });
        if let Some(map) = route.map {
            let way = self.from(usize::from(map), walker.position, Some(&route.next));
            route.next = way.map_or(Next::Goal(walker.goal), |way| way.next);
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

impl Ways {
    /// The point that an agent on `route` walks to next, meters: a corner or its goal.
    pub fn next(&self, route: &Route) -> Vector {
        match route.next {
            Next::Goal(point) | Next::Out(point) => point,
            Next::Corner { bend, .. } => self.floor.place(bend),
        }
    }

    /// The memory of the floor and the maps, bytes.
    pub fn bytes(&self) -> usize {
        let maps = self.maps.iter().map(PathMap::bytes);
        self.floor.bytes() + maps.sum::<usize>()
    }
}

impl Route {
    /// What comes next.
    pub fn next(&self) -> Next {
        self.next
    }
}

//! The ways of a scene's agents: path maps to its goals, and what each agent follows.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::corner::Bend;
use super::floor::Floor;
use super::goal::Goal;
use super::map::{Next, PathMap, SLACK, Way};
use super::opening::Step;
use super::plan::Detour;
use super::rooms::Rooms;
use super::steer::{End, around, between_borders};
use super::targets::Source;
use super::{MOST_GOALS, WayError};
use crate::math::Vector;
use crate::random::{self, Purpose};

/// Agents keep this distance from corners in addition to their radius, drawn for each agent, meters.
const CLEARANCE: [f64; 2] = [0.05, 0.6];

/// Agents keep their aim until they have moved this fraction of the distance to the next point. Until then, their
/// headings are off by a few degrees at most.
const SHARE: f64 = 0.15;
/// They find a new aim after this distance at the latest, meters.
const LONGEST: f64 = 0.8;

/// Lines are shortened by this at both ends, so that no end lies on a wall, meters.
const LINE_MARGIN: f64 = 0.01;

/// Path maps to the places and goals of a scene.
#[derive(Debug, Clone)]
pub struct Ways {
    /// The floor on which all of them lie.
    pub floor: Floor,
    /// The number of places; their maps come first.
    places: usize,
    goals: Vec<Vector>,
    /// The number of goals given at the start; the others were added later.
    first_goals: usize,
    pub(super) maps: Vec<PathMap>,
    /// The rooms of the floor, for ways by time and through doors.
    pub(super) rooms: Option<Rooms>,
    /// For each triangle of the rooms, the triangle of the floor at its middle.
    pub(super) beneath: Vec<Option<u32>>,
}

/// The path map that a route follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Chart {
    /// That of the goal with this number on the whole floor.
    Floor(u16),
    /// That of the opening of this step.
    Opening(Step),
    /// That of the goal with this number inside of its room.
    Room(u16),
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
    chart: Option<Chart>,
    /// What comes first.
    first: First,
    /// The length of the way, meters; infinite without a path map.
    length: f64,
    /// The distance that the agent keeps from corners, meters.
    clearance: f64,
    /// Whether the agent sees the end and still turns around the last corner.
    rounds: bool,
}

/// What comes first on the way of an agent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum First {
    /// A corner.
    Corner(Bend),
    /// The end of the way, meters.
    End(Vector),
    /// A point in a place wide enough for ways, meters.
    Out(Vector),
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
    /// The way there, if it is not the shortest.
    pub detour: Option<Detour>,
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
            first_goals: goals.len(),
            goals,
            maps,
            rooms: None,
            beneath: Vec::new(),
        })
    }

    /// Adds a path map to a goal, in place of an added one that is no longer used.
    ///
    /// # Errors
    /// The goal is not on the floor, or there are too many.
    pub fn add_goal(
        &mut self,
        goal: Vector,
        is_used: impl Fn(Vector) -> bool,
    ) -> Result<(), WayError> {
        let map = PathMap::new(&self.floor, &[Goal::Point(goal)], LINE_MARGIN)?;
        let mut added = self.first_goals..self.goals.len();
        let is_full = added.len() >= MOST_GOALS;
        let unused = added.find(|&k| !is_used(self.goals[k]));
        if let Some(rooms) = self.rooms.as_mut().filter(|_| unused.is_some() || !is_full) {
            rooms.add_goal(&[Goal::Point(goal)], unused.map(|k| self.places + k))?;
        }
        match unused {
            Some(k) => {
                self.goals[k] = goal;
                self.maps[self.places + k] = map;
            }
            None if is_full => return Err(WayError::TooMany),
            None => {
                self.goals.push(goal);
                self.maps.push(map);
            }
        }
        Ok(())
    }

    /// The way from `p` to a destination; `None` if there is none, or no map of it.
    pub fn way(&self, p: Vector, to: Destination) -> Option<Way> {
        let map = self.map_to(to)?;
        self.from(map, p)
    }

    /// Whether the corner, the triangle and the map of `route` exist.
    pub fn knows(&self, route: &Route) -> bool {
        let floor = self.floor_of(route);
        let is_known = match route.first {
            First::Corner(bend) => (bend.corner as usize) < floor.corners.len(),
            First::End(_) | First::Out(_) => true,
        };
        let is_known = is_known && (route.triangle as usize) < floor.mesh.triangles().len();
        is_known && route.chart.is_none_or(|chart| self.on(chart).is_some())
    }

    /// The path map of a route, and the floor on which it lies.
    pub(super) fn map_of(&self, route: &Route) -> Option<(&Floor, &PathMap)> {
        self.on(route.chart?)
    }

    /// The path map of a chart, and the floor on which it lies.
    fn on(&self, chart: Chart) -> Option<(&Floor, &PathMap)> {
        let rooms = self.rooms.as_ref();
        match chart {
            Chart::Floor(map) => Some((&self.floor, self.maps.get(usize::from(map))?)),
            Chart::Opening(step) => rooms
                .filter(|rooms| step < rooms.steps())
                .map(|rooms| (&rooms.floor, rooms.map(step))),
            Chart::Room(goal) => {
                rooms.and_then(|rooms| Some((&rooms.floor, rooms.goal(usize::from(goal))?)))
            }
        }
    }

    /// The chart of a walker.
    fn chart(&self, walker: &Walker) -> Option<Chart> {
        let map = self.map_to(walker.to)?;
        Some(match walker.detour {
            None => Chart::Floor(map),
            Some(Detour::Opening(step)) => Chart::Opening(step),
            Some(Detour::Room) => Chart::Room(map),
        })
    }

    /// The floor of a route.
    pub(super) fn floor_of(&self, route: &Route) -> &Floor {
        let on = route.chart.and_then(|chart| self.on(chart));
        on.map_or(&self.floor, |(floor, _)| floor)
    }

    /// Whether some way bends, because a wall or a closed passage hides its goal.
    pub fn bend(&self) -> bool {
        self.maps.iter().any(PathMap::bends)
    }

    /// The number of the path map to a destination.
    pub fn map_to(&self, to: Destination) -> Option<u16> {
        let map = match to {
            Destination::Place(place) => {
                return (usize::from(place) < self.places).then_some(place);
            }
            Destination::Goal(goal) => self.goals.iter().position(|&other| other == goal),
        };
        map.map(|map| (self.places + map) as u16)
    }

    pub(super) fn from(&self, map: u16, p: Vector) -> Option<Way> {
        self.maps[usize::from(map)].way_from(&self.floor, p)
    }

    /// Updates the route of an agent and returns the point that it walks toward, meters. `seed` is that of the
    /// population.
    pub fn aim(&self, walker: &Walker, route: &mut Option<Route>, seed: u64) -> Vector {
        let p = walker.position;
        let route = route.get_or_insert_with(|| {
            let [low, high] = CLEARANCE;
            let mut random = random::stream(seed, Purpose::Clearance, walker.id, 0);
            Route {
                found: p,
                reach: 0.0,
                triangle: 0,
                entry: u32::MAX,
                excess: 0.0,
                chart: self.chart(walker),
                first: First::End(p),
                length: f64::INFINITY,
                clearance: walker.radius + random.random_range(low..=high),
                rounds: false,
            }
        });
        let Some(way) = self.go_on(route, p) else {
            let end = match walker.to {
                Destination::Goal(goal) => goal,
                // Without a way, the agent stays.
                Destination::Place(_) => p,
            };
            (route.first, route.reach) = (First::End(end), 0.0);
            return end;
        };
        let rounds = route.rounds || matches!(route.first, First::Corner(_));
        route.rounds = false;
        route.first = match way.next {
            Next::Corner { bend, .. } => First::Corner(bend),
            Next::Goal(point) => First::End(point),
            Next::Out(point) => First::Out(point),
        };
        let floor = self.floor_of(route);
        let place = way.next.place(floor);
        let way_around = match way.next {
            Next::Corner { bend, borders } => {
                let (at, corner) = ((p, way.distance), (bend, borders));
                Some(around(floor, at, corner, route.clearance))
            }
            Next::Goal(end) => {
                let map = route
                    .chart
                    .and_then(|chart| self.on(chart))
                    .map(|(_, map)| map);
                let source = map.and_then(|map| map.source(way.entry));
                // Agents that see a goal point from their start, or have a goal line in front of them, walk straight if
                // their bodies fit. They pass the end of a line like the jamb of a door.
                let rounds = match source {
                    Some(Source::Line { .. }) => false,
                    Some(source) if source.ends().is_some() => true,
                    _ => rounds,
                };
                let least = walker.radius + CLEARANCE[0];
                let gap = if rounds { route.clearance } else { least };
                let borders = map.and_then(|map| map.borders(floor, way.entry));
                let end = End {
                    point: end,
                    distance: way.distance,
                    line: source.and_then(Source::ends),
                };
                let way_around = borders.and_then(|borders| between_borders(p, &end, borders, gap));
                route.rounds = rounds && way_around.is_some();
                way_around.map(|(heading, nearest)| {
                    route.reach = route.reach.min(SHARE * nearest);
                    heading
                })
            }
            Next::Out(_) => None,
        };
        let ahead = way.distance.max(NEAREST);
        way_around.map_or(place, |heading| p + heading * ahead)
    }

    /// The way from `p` for an agent on `route`. The agent keeps its entry as long as the entry holds at `p` and its
    /// way is certainly at most [`SLACK`] longer than the shortest.
    fn go_on(&self, route: &mut Route, p: Vector) -> Option<Way> {
        let (floor, map) = self.on(route.chart?)?;
        if let Some(way) = map.way_over(floor, p, route.entry as usize) {
            // Moving shortened the shortest way by at most the distance moved.
            let excess = route.excess + way.length - route.length + (p - route.found).norm();
            route.set(floor, p, &way, excess);
            if route.reach > 0.0 && excess < SLACK {
                return Some(way);
            }
        }
        let held = route.first(floor).bend();
        let here = floor.locate_or_nearest(Some(route.triangle), p)?;
        let way = map.way(floor, p, here, held)?;
        route.triangle = here;
        route.entry = u32::try_from(way.entry).unwrap_or(u32::MAX);
        route.set(floor, p, &way, 0.0);
        Some(way)
    }
}

impl Route {
    /// Takes a way from `p` that is at most `excess` meters longer than the shortest.
    fn set(&mut self, floor: &Floor, p: Vector, way: &Way, excess: f64) {
        let place = way.next.place(floor);
        (self.found, self.length, self.excess) = (p, way.length, excess);
        let most = (SHARE * way.distance).min(LONGEST).min(way.sight);
        self.reach = floor.mesh.room_before(self.triangle, p, place, most);
    }
}

/// The aim of an agent that walks to a corner is at least this far away, meters.
const NEAREST: f64 = 1.0;

impl Ways {
    /// Whether there is a path map to this destination.
    pub fn leads_to(&self, to: Destination) -> bool {
        self.map_to(to).is_some()
    }

    /// The goals that have a path map, meters.
    pub fn goals(&self) -> &[Vector] {
        &self.goals
    }

    /// The memory of the floor and the maps, and of building the largest, bytes.
    pub fn bytes(&self) -> usize {
        let maps = self.maps.iter().map(PathMap::bytes);
        let building = self.maps.iter().map(PathMap::building_bytes).max();
        let rooms = self.rooms.as_ref().map_or(0, Rooms::bytes);
        let rooms = rooms + size_of_val(&self.beneath[..]);
        self.floor.bytes() + maps.sum::<usize>() + building.unwrap_or_default() + rooms
    }
}

impl Route {
    /// What comes first on the route over this floor.
    pub(super) fn first(&self, floor: &Floor) -> Next {
        match self.first {
            First::Corner(bend) => Next::Corner {
                bend,
                borders: [floor.place(bend); 2],
            },
            First::End(point) => Next::Goal(point),
            First::Out(point) => Next::Out(point),
        }
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

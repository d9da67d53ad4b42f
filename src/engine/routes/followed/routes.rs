//! The path maps of a scene.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::math::Vector;
use crate::routes::floor::Floor;
use crate::routes::paths::{Goal, PathMap, Way, points};
use crate::routes::rooms::{Rooms, Side};
use crate::routes::{MOST_GOALS, WayError};

/// Lines are shortened by this at both ends, so that no end lies on a wall, meters.
const LINE_MARGIN: f64 = 0.01;

/// Path maps to the places and goals of a scene.
#[derive(Debug, Clone)]
pub struct Routes {
    /// The floor on which all of them lie.
    pub floor: Floor,
    /// The number of places; their maps come first.
    places: usize,
    goals: Vec<Vector>,
    /// The number of goals given at the start; the others were added later.
    first_goals: usize,
    pub(super) maps: Vec<PathMap>,
    /// The rooms of the floor, for quickest routes and through doors.
    pub(super) rooms: Option<Rooms>,
    /// For each triangle of the rooms, the triangle of the floor at its middle.
    pub(super) beneath: Vec<Option<u32>>,
}

/// What an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Destination {
    /// A point, meters.
    Goal(Vector),
    /// The place with this number.
    Place(u16),
}

/// Which path map an agent follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapKey {
    /// That of the goal with this number on the whole floor.
    Floor(u16),
    /// That of an opening, from this side.
    Opening(Side),
    /// That of the goal with this number inside of its room.
    Room(u16),
}

impl Routes {
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

    /// The first of some starts from which no way leads to a goal.
    ///
    /// # Errors
    /// The goal is not on the floor.
    pub fn without_way(
        &self,
        mut starts: impl Iterator<Item = Vector>,
        goal: Vector,
    ) -> Result<Option<usize>, WayError> {
        let made;
        let map = match self.map_to(Destination::Goal(goal)) {
            Some(map) => &self.maps[usize::from(map)],
            None => {
                made = PathMap::new(&self.floor, &[Goal::Point(goal)], LINE_MARGIN)?;
                &made
            }
        };
        Ok(starts.position(|start| map.way_from(&self.floor, start).is_none()))
    }

    /// Whether path maps to `more` goals cannot be added.
    pub fn lacks_room_for(&self, more: usize, is_used: impl Fn(Vector) -> bool) -> bool {
        let added = self.added_goals().iter();
        more > 0 && added.filter(|&&goal| is_used(goal)).count() + more > MOST_GOALS
    }

    /// The goals whose path maps were added later, in the order of their maps, meters.
    pub fn added_goals(&self) -> &[Vector] {
        &self.goals[self.first_goals..]
    }

    /// The way from `p` to a destination; `None` if there is none, or no map of it.
    pub fn way(&self, p: Vector, to: Destination) -> Option<Way> {
        self.maps[usize::from(self.map_to(to)?)].way_from(&self.floor, p)
    }

    /// The length of the way from `p` to a destination, meters; infinite if there is none.
    pub fn length(&self, p: Vector, to: Destination) -> f64 {
        self.way(p, to).map_or(f64::INFINITY, |way| way.length)
    }

    /// The points of the shortest way from `p`, meters: its corners in order, then its end. Empty if there is no way.
    /// On several levels it goes on beyond joins as if it stayed on that of `p`.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let first = self.map_to(to).zip(self.way(p, to));
        first.map_or(Vec::new(), |(map, way)| {
            let points = points(&self.floor, &self.maps[usize::from(map)], way.next);
            points.map(|point| self.floor.seen_from(p, point)).collect()
        })
    }

    /// Divides the floor into rooms.
    pub fn divide(&mut self, rooms: Rooms) {
        let mesh = rooms.floor.plane();
        let triangles = (0..mesh.triangles().len() as u32).into_par_iter();
        let beneath = triangles.map(|t| self.floor.locate_or_nearest(None, mesh.middle(t)));
        self.beneath = beneath.collect();
        self.rooms = Some(rooms);
    }

    /// The rooms of the floor, if it is divided.
    pub fn rooms(&self) -> Option<&Rooms> {
        self.rooms.as_ref()
    }

    /// A path map, and the floor on which it lies; `None` if it does not exist.
    pub(super) fn map(&self, key: MapKey) -> Option<(&Floor, &PathMap)> {
        let rooms = self.rooms.as_ref();
        match key {
            MapKey::Floor(goal) => Some((&self.floor, self.maps.get(usize::from(goal))?)),
            MapKey::Opening(side) => rooms
                .filter(|rooms| side.index() < rooms.sides().len())
                .map(|rooms| (&rooms.floor, rooms.map(side))),
            MapKey::Room(goal) => {
                rooms.and_then(|rooms| Some((&rooms.floor, rooms.goal(usize::from(goal))?)))
            }
        }
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

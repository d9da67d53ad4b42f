//! Lifts: cabins that take agents from one level to another.

use crate::geometry::Ring;
use crate::math::Vector;

/// A lift. Its cabin is a part of the floor of each level at which it stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Lift {
    /// Name in reports.
    pub name: String,
    /// The cabin, corners in the building, meters.
    pub cabin: Ring,
    /// Where people stand in it, one spot for each that it takes, in the building, meters.
    pub spots: Vec<Vector>,
    /// Its stops.
    pub stops: Vec<Stop>,
    /// Its speed, m/s.
    pub speed: f64,
    /// The time in which its doors open, and that in which they close, seconds.
    pub door_secs: f64,
}

/// A stop of a lift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The number of the place where people wait: a waiting area.
    pub place: u16,
    /// The number of its level.
    pub level: u16,
    /// The height of this level, meters.
    pub height: f64,
    /// Where people enter the cabin, in the building, meters.
    pub entry: Vector,
}

impl Lift {
    /// The time from when the doors begin to close at one stop until they are open at another, seconds.
    pub fn travel_secs(&self, [from, to]: [usize; 2]) -> f64 {
        let climb = (self.stops[to].height - self.stops[from].height).abs();
        2.0 * self.door_secs + climb / self.speed
    }

    /// The number of its stop on a level.
    pub fn stop_on(&self, level: u16) -> Option<usize> {
        self.stops.iter().position(|stop| stop.level == level)
    }

    /// The number of its stop at which agents wait at a place.
    pub fn stop_at(&self, place: u16) -> Option<usize> {
        self.stops.iter().position(|stop| stop.place == place)
    }
}

//! Where agents were located.

use serde::{Deserialize, Serialize};

use super::Rooms;
use crate::math::Vector;

/// Where an agent was located last. Until it has moved by the free distance, it is in the same room; its triangle must
/// be [found](Self::triangle_at) from here on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Located {
    triangle: u32,
    at: Vector,
    /// The distance from there to the nearest opening or closed passage at which the room ends, at most a meter.
    free_distance: f64,
}

impl Located {
    /// Locates an agent at `p`, near the place where it was located `before`; `None` if the floor has no triangles.
    pub fn new(rooms: &Rooms, before: Option<Self>, p: Vector) -> Option<Self> {
        let before = before.map(|before| before.triangle);
        let triangle = rooms.floor.locate_or_nearest(before, p)?;
        Some(Self {
            triangle,
            at: p,
            free_distance: rooms.free_distance(triangle, rooms.floor.in_building(p)),
        })
    }

    /// The triangle of the rooms' floor where it was.
    pub fn triangle(&self) -> u32 {
        self.triangle
    }

    /// The triangle where it is now, at `p`.
    pub fn triangle_at(&self, rooms: &Rooms, p: Vector) -> Option<u32> {
        rooms.floor.locate_or_nearest(Some(self.triangle), p)
    }

    /// Whether the agent, now at `p`, is still in the room where it was located, if this was so in every coarse frame
    /// since.
    ///
    /// No opening or closed passage reaches into the circle of the free distance, so an agent that moves straight
    /// inside the circle does not leave the room. Between two coarse frames it can leave the circle, walk around the
    /// end of a thin wall and come back into the circle behind the wall, but only if it passes this end nearer than
    /// half of the way that it walks in this time, 7 cm at 1.4 m/s. Contact keeps bodies farther away. Without contact,
    /// its step through the opening counts when it leaves the circle again or is due.
    pub fn stays_at(&self, p: Vector) -> bool {
        (p - self.at).norm_squared() < self.free_distance * self.free_distance
    }
}

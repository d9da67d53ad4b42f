//! What an agent plans that chooses between ways by time, or around closed doors.

use serde::{Deserialize, Serialize};

use super::opening::Step;
use super::route::{Destination, Ways};
use crate::math::Vector;

/// Another way than the shortest one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Detour {
    /// Through the opening of this step, which leads out of the room.
    Opening(Step),
    /// To the goal without leaving the room.
    Room,
}

/// The plan of an agent: how it leaves its room.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The triangle of the rooms' floor where the agent was when it was last located.
    pub triangle: u32,
    /// Where that was, meters.
    pub located: Vector,
    /// The distance from there to the nearest opening or closed passage at which its room ends, at most a meter.
    pub free_distance: f64,
    /// The number of the path map to its goal.
    pub goal: u16,
    /// The step by which it wants to leave the room; `None`: its goal is in the room.
    pub toward: Option<Step>,
    /// The last step that it has taken.
    pub crossed: Option<Step>,
    /// Whether it walks to the opening, or to the goal in the room, not by the shortest way: that leads elsewhere, or a
    /// crowd stands before the opening.
    pub detours: bool,
    /// The frame in which it is due again: it compares its ways, or only draws the next such frame if it has no choice.
    pub decides_at: u64,
    /// The number of draws of that frame so far.
    pub turns: u32,
    /// The number of changes of its mind so far.
    pub changes: u32,
}

impl Plan {
    /// Whether an agent at `p` is still in the room where it was last located, if this was so in every coarse frame
    /// since.
    ///
    /// No opening or closed passage reaches into the circle of the free distance, so an agent that moves straight
    /// inside the circle does not leave the room. Between two coarse frames it can leave the circle, walk around the
    /// end of a thin wall and come back into the circle behind the wall, but only if it passes this end nearer than
    /// half of the way that it walks in this time, 7 cm at 1.4 m/s. Contact keeps bodies farther away. Without contact,
    /// its step through the opening counts when it leaves the circle again or is due.
    pub fn stays_at(&self, p: Vector) -> bool {
        (p - self.located).norm_squared() < self.free_distance * self.free_distance
    }

    /// The way to a destination, if the plan leads there and not by the shortest way.
    pub fn detour(&self, ways: &Ways, to: Destination) -> Option<Detour> {
        let is_known = self.detours && ways.map_to(to) == Some(self.goal);
        is_known.then_some(self.toward.map_or(Detour::Room, Detour::Opening))
    }

    /// Whether everything that the plan names exists.
    pub fn fits(&self, ways: &Ways) -> bool {
        ways.rooms.as_ref().is_some_and(|rooms| {
            let steps = [self.toward, self.crossed].into_iter().flatten();
            rooms.goal(usize::from(self.goal)).is_some()
                && (self.triangle as usize) < rooms.floor.mesh.triangles().len()
                && steps.into_iter().all(|step| step < rooms.steps())
        })
    }
}

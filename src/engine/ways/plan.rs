//! What an agent plans that chooses between ways by time, or around closed doors.

use serde::{Deserialize, Serialize};

use super::opening::Step;
use super::route::{Destination, Ways};
use crate::engine::math::Vector;

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
    /// The distance from there within which it is still in the same room, meters.
    pub clear: f64,
    /// The number of the path map to its goal.
    pub goal: u16,
    /// The step by which it wants to leave the room; `None`: its goal is in the room.
    pub toward: Option<Step>,
    /// The last step that it has taken.
    pub crossed: Option<Step>,
    /// Whether it walks to the opening, or to the goal in the room, not by the shortest way: that leads elsewhere, or a
    /// crowd stands before the opening.
    pub detours: bool,
    /// The frame in which it compares ways again.
    pub decides_at: u64,
    /// The number of its comparisons so far.
    pub turns: u32,
    /// The number of changes of its mind so far.
    pub changes: u32,
}

impl Plan {
    /// Whether an agent at `p` is still in the room where it was last located.
    pub fn stays_at(&self, p: Vector) -> bool {
        (p - self.located).norm_squared() < self.clear * self.clear
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

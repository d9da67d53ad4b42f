//! What an agent plans that chooses between quickest routes, or around closed doors.

use serde::{Deserialize, Serialize};

use super::routes::{Destination, MapKey, Routes};
use crate::routes::rooms::{Located, Side};

/// The plan of an agent: how it leaves its room.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Where the agent was located last.
    pub located: Located,
    /// The number of the path map to its goal.
    pub goal: u16,
    /// The side of the opening by which it wants to leave the room; `None`: its goal is in the room.
    pub toward: Option<Side>,
    /// The side from which it has passed an opening last.
    pub crossed: Option<Side>,
    /// Whether it walks to the opening, or to the goal in the room, not by the shortest way: that leads elsewhere, or a
    /// crowd stands before the opening.
    pub detours: bool,
    /// The frame in which it is due again: it compares its routes, or only draws the next such frame if it has no
    /// choice.
    pub decides_at: u64,
    /// The number of draws of that frame so far.
    pub turns: u32,
    /// The number of changes of its mind so far.
    pub changes: u32,
}

impl Plan {
    /// The path map to a destination, if the plan leads there and not by the shortest way.
    pub fn detour(&self, routes: &Routes, to: Destination) -> Option<MapKey> {
        let is_known = self.detours && routes.map_to(to) == Some(self.goal);
        is_known.then(|| self.toward.map_or(MapKey::Room(self.goal), MapKey::Opening))
    }

    /// Whether everything that the plan names exists.
    pub fn fits(&self, routes: &Routes) -> bool {
        routes.rooms().is_some_and(|rooms| {
            let mut sides = [self.toward, self.crossed].into_iter().flatten();
            rooms.goal(usize::from(self.goal)).is_some()
                && (self.located.triangle() as usize) < rooms.floor.mesh.triangles().len()
                && sides.all(|side| side.index() < rooms.sides().len())
        })
    }
}

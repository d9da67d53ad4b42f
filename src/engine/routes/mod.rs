//! Routes around walls: for each goal, a map with the next point to walk to from any position.
//!
//! A `Floor` is a constrained Delaunay triangulation of the areas that people walk in, with the corners that shortest
//! routes bend around and the routes between corners. A `PathMap` has the way to one goal from any position: the
//! `Next` point or corner, and the length. It is exact for polygons with holes, shared by all agents with that goal,
//! and needs no search per agent; an agent that is pushed off its way looks it up again. `around` keeps clear of the
//! corners on the way.
//!
//! Four folders, each of which uses only those before it: `floor` knows no goals, `paths` no agents; `rooms` divides
//! floors; `routes` has what agents follow and plan.

mod floor;
mod followed;
mod paths;
mod rooms;

pub use followed::{Destination, Plan, Route, Routes};
pub use rooms::Rooms;

#[doc(hidden)]
pub use floor::{Bend, Corner, Floor, Mesh, Triangle, Turn, nearest_on, side};
#[doc(hidden)]
pub use floor::{Narrowing, Narrowings, Passage, Passages};
#[doc(hidden)]
pub use followed::{MapKey, Regions, RoutesOut, Shortest, Walker};
#[doc(hidden)]
pub use paths::{Goal, Next, PathMap, SLACK, Way, around};
#[doc(hidden)]
pub use rooms::{Door, Located, Opening, Side, WIDEST};

use crate::math::Vector;

/// The most goals that can be added after the start.
const MOST_GOALS: usize = 1000;

/// Why routes cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WayError {
    /// Two walls cross here.
    #[error("walls cross near ({}, {})", .0.x, .0.y)]
    Crossing(Vector),
    /// A coordinate is too large or too small.
    #[error("the floor plan has a coordinate that cannot be used: {0}")]
    Coordinates(String),
    /// This point of a goal lies in a wall or outside of the floor.
    #[error("({}, {}) is not on the floor", .0.x, .0.y)]
    NotOnFloor(Vector),
    /// The floors of the two levels differ along the join that begins here.
    #[error("the floors of two levels differ along the join at ({}, {})", .0.x, .0.y)]
    Join(Vector),
    /// There are too many goals.
    #[error("agents walk to {MOST_GOALS} different goals already; give them common ones")]
    TooMany,
}

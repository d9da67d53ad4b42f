//! Path maps: for each goal, the way from any position.

mod entries;
mod goal;
mod list;
mod map;
mod parts;
mod points;
mod region;
mod steer;
mod targets;

pub use goal::Goal;
pub use map::{Next, PathMap, SLACK, Way};
pub use points::{end, points};
pub use steer::{End, around, between_borders};
pub use targets::Source;

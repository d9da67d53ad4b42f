//! Routes: the path maps of a scene, and the ways that agents follow and plan.

mod plan;
mod reach;
mod route;
mod ways;
mod ways_out;

pub use plan::Plan;
pub use reach::Regions;
pub use route::{Route, Walker};
pub use ways::{Destination, MapKey, Ways};
pub use ways_out::{Shortest, WaysOut};

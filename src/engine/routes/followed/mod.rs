//! Routes: the path maps of a scene, and the routes that agents follow and plan.

mod plan;
mod reach;
mod route;
mod routes;
mod routes_out;

pub use plan::Plan;
pub use reach::Regions;
pub use route::{Route, Walker};
pub use routes::{Destination, MapKey, Routes};
pub use routes_out::{RoutesOut, Shortest};

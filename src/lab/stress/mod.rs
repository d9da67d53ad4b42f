//! The limits of the model: hard cases in which no agent may pass through a wall, checked independently of the engine;
//! maps of the largest time step at which a crowd comes to rest; and the motion of crowds at rest.

mod cell;
mod condition;
mod fit;
mod map;
mod pictures;
mod report;
mod rest;
mod suite;

pub use cell::{Cell, Limit};
pub use condition::Condition;
pub use fit::fit;
pub use map::Detail;
pub use report::{Finished, PARTS, Report, names};
pub use rest::{Law, Remains, Rest};
pub use suite::stress;

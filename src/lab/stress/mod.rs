//! The limits of the model: hard cases in which no agent may pass through a wall, checked independently of the engine;
//! maps of the largest time step at which a crowd comes to rest; and the motion that remains then.

mod cell;
mod condition;
mod fence;
mod fit;
mod hard;
mod jitter;
mod map;
mod pictures;
mod report;
mod rest;
mod suite;
mod watch;

pub use cell::{Cell, Limit};
pub use condition::Condition;
pub use fence::Fence;
pub use fit::fit;
pub use hard::{HARD, Hard, Survival};
pub use jitter::{Jitter, VARIANTS, Variant};
pub use map::Detail;
pub use report::Report;
pub use rest::{Remains, Rest, Surroundings};
pub use suite::stress;
pub use watch::{Found, Watch};

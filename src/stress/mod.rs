//! Where the model breaks: hard cases that nobody may get through a wall in, under a bystander's eyes.

mod fence;
mod hard;
mod watch;

pub use fence::Fence;
pub use hard::{HARD, Hard, Survival};
pub use watch::{Found, Watch};

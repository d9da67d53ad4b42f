//! Waves in a crowd (§6.3): the mean speed over place and time along the wave's axis, and from it the speed and
//! amplitude of the wave and its reflection from an obstacle.
//!
//! All measurements use the velocity along the axis minus its mean before the push, so that a slowly advancing crowd
//! is not taken for a wave. A rigid front reverses velocities, so we search for the returning wave with the opposite
//! sign.

mod ridge;
mod space_time;

pub use ridge::{Ridge, RidgePoint, Run, Wave, measure};
pub use space_time::{SpaceTime, Strip};

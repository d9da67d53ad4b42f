//! Waves in a crowd (§6.3): the mean speed over place and time along the wave's axis, and from it the
//! wave's speed, its amplitude and what comes back from an obstacle.
//!
//! Everything is measured on the velocity along the axis, less its mean before the push, so that a
//! crowd that creeps forward is no wave. A rigid front turns velocities round: the returning wave is
//! looked for with the opposite sign.

mod fit;
mod ridge;
mod space_time;

pub use fit::{Estimate, Line};
pub use ridge::{Ridge, RidgePoint, Run, Wave, measure};
pub use space_time::{SpaceTime, Strip};

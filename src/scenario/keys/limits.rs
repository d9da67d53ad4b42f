//! Limits and defaults that several keys share.

pub use engine::limits::{HIGHEST_DENSITY, STRONGEST};

/// Default duration, seconds.
pub const DEFAULT_DURATION: f64 = 60.0;
/// Default profile.
pub const DEFAULT_PROFILE: &str = "sph";
/// The longest time, seconds.
pub const LONGEST_TIME: f64 = 1e7;
/// The largest coordinate, meters. Beyond this, walls and contacts lose precision.
pub const FARTHEST: f64 = 1e6;

/// Most groups or pushes: their numbers have 16 bits.
pub const MOST_NUMBERED: usize = u16::MAX as usize;

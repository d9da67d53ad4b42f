//! The people in a frame.

use super::person::Person;
use super::regions::RegionState;

/// A frame with at least one person.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// The frame number.
    pub frame: i64,
    /// Seconds.
    pub time: f64,
    /// All people in the frame, by id.
    pub people: Vec<Person>,
    /// One per region.
    pub regions: Vec<RegionState>,
}

//! How many cases and values a profile passes.

use serde::{Deserialize, Serialize};

/// What a profile passes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Passed {
    /// The number of cases.
    pub cases: usize,
    /// The number of cases that it passes.
    pub passed: usize,
    /// The cases that it misses.
    pub missed: Vec<String>,
    /// The number of values that are compared with measured ones, those within the tolerance first.
    pub values: [usize; 2],
    /// Those of these values to which the profile was fitted.
    #[serde(default, skip_serializing_if = "none")]
    pub fitted: [usize; 2],
}

/// Whether nothing is counted.
fn none([_, all]: &[usize; 2]) -> bool {
    *all == 0
}

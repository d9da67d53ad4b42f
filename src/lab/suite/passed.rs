//! How many cases and values a profile passes.

use std::collections::BTreeMap;

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
    /// For each case and each of its measured values, by name: the value of the profile over the measured one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub ratios: BTreeMap<String, BTreeMap<String, f64>>,
}

/// Whether nothing is counted.
fn none([_, all]: &[usize; 2]) -> bool {
    *all == 0
}

//! The key `periodic`.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::keys::limits::FARTHEST;
use crate::keys::names::word;
use engine::period::{Axis, Period};

/// The scene repeats itself along an axis without end. Agents that leave at one end of the period come in at the other,
/// and everything acts across the ends.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// `x` or `y`.
    #[schemars(schema_with = "word::<Axis>")]
    pub axis: Axis,
    /// The length of the period, meters: at least twice as far as agents act on each other.
    #[schemars(range(max = FARTHEST), extend("exclusiveMinimum" = 0))]
    pub length: f64,
    /// The coordinate at which the period begins, meters.
    #[serde(default)]
    #[schemars(range(min = -FARTHEST, max = FARTHEST))]
    pub from: f64,
}

impl From<Periodic> for Period {
    fn from(given: Periodic) -> Self {
        Self {
            axis: given.axis,
            from: given.from,
            length: given.length,
        }
    }
}

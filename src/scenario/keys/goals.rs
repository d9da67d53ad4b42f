//! The keys of goals, and of how agents find their routes.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_untagged::UntaggedEnumVisitor;

use crate::keys::shapes::Point;

/// A goal: a point, or a direction
#[derive(Debug, Clone, Copy, JsonSchema)]
#[schemars(untagged)]
pub enum Aim {
    Point(Point),
    Heading(Heading),
}

/// Not derived: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for Aim {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("a point [x, y] in meters, or {\"direction\": [x, y]}")
            .seq(|point| Ok(Self::Point(point.deserialize()?)))
            .map(|keys| Ok(Self::Heading(keys.deserialize()?)))
            .deserialize(deserializer)
    }
}

/// Instead of a point: agents walk in a direction, without end.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heading {
    /// The direction [x, y]; only the ratio of the two matters.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub direction: [f64; 2],
}

/// How agents find their routes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WayFinding {
    /// Around walls.
    #[default]
    Paths,
    /// Straight toward the goal, as in the paper.
    Straight,
}

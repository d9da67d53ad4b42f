//! What an agent walks to.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use engine::math::Vector;
use engine::routes::Destination;

/// What an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) enum Aim {
    /// Its goal, meters.
    Goal(Vector),
    /// The place with this number.
    Place(u16),
    /// A direction.
    Direction(Vector),
}

impl Aim {
    /// Where routes lead to it; `None` if it is a direction.
    pub(super) fn destination(self) -> Option<Destination> {
        match self {
            Self::Goal(goal) => Some(Destination::Goal(goal)),
            Self::Place(place) => Some(Destination::Place(place)),
            Self::Direction(_) => None,
        }
    }

    /// An order of aims, in which equal ones are neighbors.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let key = |aim: &Self| match *aim {
            Self::Place(place) => (0, f64::from(place), 0.0),
            Self::Goal(p) => (1, p.x, p.y),
            Self::Direction(p) => (2, p.x, p.y),
        };
        let ((a, x, y), (b, u, v)) = (key(self), key(other));
        a.cmp(&b).then(x.total_cmp(&u)).then(y.total_cmp(&v))
    }
}

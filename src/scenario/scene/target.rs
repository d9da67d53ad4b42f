//! Where agents walk.

use engine::math::Vector;
use engine::scene::Goal;

/// Where agents walk.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Their goals; where they start, if they have a journey or a direction.
    pub goal: Goal,
    /// The direction in which they walk instead, of length 1.
    pub direction: Option<Vector>,
    /// The number of their journey.
    pub journey: Option<u16>,
}

impl Target {
    /// To where they start.
    pub const START: Self = Self::to(Goal::Offset(Vector::new(0.0, 0.0)));

    /// To this goal.
    pub const fn to(goal: Goal) -> Self {
        Self {
            goal,
            direction: None,
            journey: None,
        }
    }

    /// Along a direction, of length 1.
    pub fn along(direction: Vector) -> Self {
        Self {
            direction: Some(direction),
            ..Self::START
        }
    }

    /// The goal of an agent that starts at `place`, meters.
    pub fn goal_from(&self, place: Vector) -> Vector {
        match self.goal {
            Goal::Point(goal) => goal,
            Goal::Offset(offset) => place + offset,
        }
    }
}

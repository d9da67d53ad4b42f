//! Where agents without a journey walk: to a point, or in a direction.

use schemars::JsonSchema;
use serde::Deserialize;

use super::crowd::Crowd;
use super::error::{Problem, Under};
use super::shapes::Point;
use crate::engine::math::{Vector, direction};
use crate::engine::scene::Goal;

/// A goal: a point, or a direction
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Aim {
    Point(Point),
    Heading(Heading),
}

/// Instead of a point: agents walk in a direction, without end.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Heading {
    /// The direction [x, y]; only the ratio of the two matters.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    direction: [f64; 2],
}

/// Where agents walk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    /// Their goals; where they start, if they have a journey or a direction.
    pub goal: Goal,
    /// The direction in which they walk instead, of length 1.
    pub direction: Option<Vector>,
}

impl Target {
    /// To where they start.
    const START: Self = Self::to(Goal::Offset(Vector::new(0.0, 0.0)));

    pub(super) const fn to(goal: Goal) -> Self {
        Self {
            goal,
            direction: None,
        }
    }

    fn along(direction: Vector) -> Self {
        Self {
            direction: Some(direction),
            ..Self::START
        }
    }

    /// The goal of an agent that starts at `place`, meters.
    pub(super) fn goal_from(&self, place: Vector) -> Vector {
        match self.goal {
            Goal::Point(goal) => goal,
            Goal::Offset(offset) => place + offset,
        }
    }
}

impl Crowd<'_> {
    /// The target of agents with the goal `given`, or with a journey, or with the scenario's goal. In a periodic scene
    /// without goal they walk along the axis.
    pub(super) fn target(
        &self,
        given: Option<Aim>,
        journey: Option<u16>,
        remove_within: Option<f64>,
    ) -> Result<Target, Problem> {
        let target = match (given, journey) {
            (Some(aim), _) => self.aimed(aim).under("goal")?,
            // Each place of a journey becomes the goal in its turn.
            (None, Some(_)) => Target::START,
            (None, None) => self.default_target()?,
        };
        if target.direction.is_some() && remove_within.is_some() {
            let reason = "agents that walk in a direction reach no goal and never leave; remove it";
            return Err(Problem::new("remove_within", reason));
        }
        Ok(target)
    }

    fn aimed(&self, aim: Aim) -> Result<Target, Problem> {
        match aim {
            Aim::Point(_) if self.scene.period.is_some() => {
                let reason = "in a periodic scene agents walk in a direction, not to a point; give one, such as \
                              {\"direction\": [1, 0]}, or nothing to walk along the axis";
                Err(Problem::new("", reason))
            }
            Aim::Point(point) => Ok(Target::to(Goal::Point(point.into()))),
            Aim::Heading(heading) => {
                let way = direction(heading.direction.into());
                match way == Vector::zeros() {
                    true => Err(Problem::new("direction", "must not be [0, 0]")),
                    false => Ok(Target::along(way)),
                }
            }
        }
    }

    fn default_target(&self) -> Result<Target, Problem> {
        if let Some(aim) = self.file.goal {
            return self.aimed(aim).under("goal");
        }
        if let Some(period) = &self.scene.period {
            return Ok(Target::along(direction(period.way(1))));
        }
        let reason =
            "no goal: set `goal` or `journey` here, `goal` at the top of the file, or add `exits`";
        Err(Problem::new("", reason))
    }
}

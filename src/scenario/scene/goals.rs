//! Where agents without a journey walk: to a point, or in a direction.

use crate::error::{Problem, Under};
use crate::keys::goals::Aim;
use crate::keys::people::Behavior;
use crate::keys::places::journey_named;
use crate::keys::shapes::Point;
use crate::scene::journeys::TO_EXIT;
use crate::scene::people::Population;
use crate::scene::target::Target;
use engine::math::{Vector, direction};
use engine::scene::Goal;

impl Population<'_> {
    /// The target of agents with a goal, or `offset` from where they start, or with a journey, or with the scenario's
    /// goal. In a periodic scene without goal they walk along the axis.
    pub fn target(&self, given: &Behavior, offset: Option<Point>) -> Result<Target, Problem> {
        let has_goal = given.goal.is_some() || offset.is_some();
        let journey = self.journey(given.journey.as_deref(), has_goal)?;
        let target = match (given.goal, offset, journey) {
            (_, Some(_), _) if self.scene.period.is_some() => {
                let reason =
                    "in a periodic scene agents walk in a direction, not to a point; remove it";
                return Err(Problem::new("goal_offset", reason));
            }
            (Some(_), Some(_), _) => {
                let reason = "either `goal` or `goal_offset`, not both";
                return Err(Problem::new("goal_offset", reason));
            }
            (None, Some(offset), _) => Target::to(Goal::Offset(offset.into())),
            (Some(aim), None, _) => self.aimed(aim).under("goal")?,
            // Each place of a journey becomes the goal in its turn.
            (None, None, Some(_)) => Target::START,
            (None, None, None) => self.default_target()?,
        };
        if target.direction.is_some() && given.remove_within.is_some() {
            let reason = "agents that walk in a direction reach no goal and never leave; remove it";
            return Err(Problem::new("remove_within", reason));
        }
        Ok(Target { journey, ..target })
    }

    /// The journey of agents that name `given`; `None` if they walk to a goal.
    fn journey(&self, given: Option<&str>, has_goal: bool) -> Result<Option<u16>, Problem> {
        let journeys = &self.scene.journeys.journeys;
        match given {
            Some(_) if has_goal => {
                let reason = "either a goal or a `journey`, not both";
                Err(Problem::new("journey", reason))
            }
            Some(name) => journey_named(journeys, name).under("journey").map(Some),
            None if has_goal || self.file.goal.is_some() => Ok(None),
            None => Ok(TO_EXIT
                .iter()
                .find_map(|name| journey_named(journeys, name).ok())),
        }
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

//! Agents, grids and sources of a file → groups, agents and sources of a scene.

use std::collections::{BTreeMap, BTreeSet};

use super::error::{Problem, Under};
use super::file::{self, Behavior, File, Object, ProfileChoice};
use super::parameters::DENSITY;
use super::profiles;
use super::range::{self, COORDINATE, Range, point};
use crate::engine::agents::NewAgent;
use crate::engine::placement::Grid;
use crate::engine::profile::Blend;
use crate::engine::scene::{Goal, Group, Region, Scene, Source};

/// Most groups or pushes: their numbers have 16 bits.
pub(super) const MOST_NUMBERED: usize = u16::MAX as usize;

/// Most different profiles defined in full: each takes its own sum over all agents.
const MOST_CUSTOM: usize = 1_000;

/// D_i, meters.
pub(super) const RADIUS: Range = Range::at_least(0.01, 10.0);
/// m_i.
pub(super) const MASS: Range = Range::at_least(1e-6, 1e6);
/// Removal radius, meters.
pub(super) const DISTANCE: Range = Range::above(0.0, 1e6);
/// Jitter, meters.
pub(super) const JITTER: Range = Range::at_least(0.0, 1e6);
/// Time between entries, seconds.
pub(super) const EVERY: Range = Range::above(0.0, 1e7);
/// Initial speeds, m/s.
pub(super) const VELOCITY: Range = Range::at_least(-100.0, 100.0);

/// Relative rounding error that a speed clamped to `max_speed` may have.
const ROUNDING: f64 = 1e-9;

/// Adds the agents to a scene.
pub(super) struct Crowd<'a> {
    file: &'a File,
    default: &'a Blend,
    scene: &'a mut Scene,
    /// Groups of single agents, by behavior.
    shared: BTreeMap<String, u16>,
    /// The different profiles defined in full.
    custom: BTreeSet<String>,
}

impl<'a> Crowd<'a> {
    /// `default` is the blend of agents that name no profile.
    pub(super) fn new(file: &'a File, default: &'a Blend, scene: &'a mut Scene) -> Self {
        Self {
            file,
            default,
            scene,
            shared: BTreeMap::new(),
            custom: BTreeSet::new(),
        }
    }

    /// Adds single agents, then grids, then sources. Their number has been checked.
    pub(super) fn enter(mut self) -> Result<(), Problem> {
        for (k, Object(agent)) in self.file.agents.iter().enumerate() {
            self.agent(agent).under(&format!("agents[{k}]"))?;
        }
        for (k, Object(grid)) in self.file.grids.iter().enumerate() {
            let name = format!("grids[{k}]");
            self.grid(grid, &name).under(&name)?;
        }
        for (k, Object(source)) in self.file.sources.iter().enumerate() {
            let name = format!("sources[{k}]");
            self.source(source, &name).under(&name)?;
        }
        Ok(())
    }

    fn agent(&mut self, agent: &file::Agent) -> Result<(), Problem> {
        let [x, y] = agent.velocity.unwrap_or_default();
        VELOCITY.check("velocity[0]", x)?;
        VELOCITY.check("velocity[1]", y)?;
        let (speed, most) = (x.hypot(y), self.scene.max_speed);
        if speed > most * (1.0 + ROUNDING) {
            let reason = format!(
                "the speed {speed} m/s is above max_speed {most}; lower it, or raise max_speed"
            );
            return Err(Problem::new("velocity", reason));
        }
        let position = point("position", agent.position)?;
        let goal = match agent.goal {
            Some(goal) => point("goal", goal)?,
            None => self.default_goal()?,
        };
        let group = self.shared_group(&agent.behavior())?;
        self.scene.agents.push(NewAgent {
            velocity: [x, y].into(),
            radius: RADIUS.check_given("radius", agent.radius)?,
            mass: MASS.check_given("mass", agent.mass)?,
            mean_density: DENSITY.check_given("mean_density", agent.mean_density)?,
            ..NewAgent::at(position, goal, group)
        });
        Ok(())
    }

    fn grid(&mut self, given: &file::Grid, place: &str) -> Result<(), Problem> {
        let (grid, goal) = self.placed(given)?;
        let name = given.name.as_deref().unwrap_or(place);
        let group = self.group(name, &given.behavior())?;
        let first_id = self.scene.agents.len() as u32;
        let agents = grid.positions(self.scene.seed, first_id).map(|position| {
            let goal = match goal {
                Goal::Point(goal) => goal,
                Goal::Offset(offset) => position + offset,
            };
            NewAgent::at(position, goal, group)
        });
        self.scene.agents.extend(agents);
        Ok(())
    }

    fn source(&mut self, given: &file::Source, place: &str) -> Result<(), Problem> {
        let (grid, goal) = self.placed(&given.grid())?;
        let name = given.name.as_deref().unwrap_or(place);
        let source = Source {
            name: name.to_owned(),
            grid,
            group: self.group(name, &given.grid().behavior())?,
            goal,
            start: given.start_secs,
            every: given.every_secs,
            times: given.times,
        };
        self.scene.sources.push(source);
        Ok(())
    }

    /// Checks what grids and sources share: the grid and the goal.
    fn placed(&self, given: &file::Grid) -> Result<(Grid, Goal), Problem> {
        let grid = Grid {
            min: point("min", given.min)?,
            max: point("max", given.max)?,
            columns: given.columns,
            rows: given.rows,
            jitter: JITTER.check("jitter", given.jitter)?,
        };
        let (min, max) = (grid.min, grid.max);
        range::ordered(&Region { min, max }).map_err(|reason| Problem::new("min", reason))?;
        for (key, cells, extent) in [
            ("columns", grid.columns, max.x - min.x),
            ("rows", grid.rows, max.y - min.y),
        ] {
            if cells == 0 {
                return Err(Problem::new(key, "must be at least 1"));
            }
            if cells > 1 && extent == 0.0 && grid.jitter == 0.0 {
                let reason = format!(
                    "{cells} agents would stand at one point: `min` and `max` are 0 m apart; move one, or set `jitter`"
                );
                return Err(Problem::new(key, reason));
            }
        }
        Ok((grid, self.goal(given)?))
    }

    fn goal(&self, given: &file::Grid) -> Result<Goal, Problem> {
        match (given.goal, given.goal_offset) {
            (Some(_), Some(_)) => Err(Problem::new(
                "goal_offset",
                "either `goal` or `goal_offset`, not both",
            )),
            (Some(goal), None) => Ok(Goal::Point(point("goal", goal)?)),
            (None, Some(offset)) => Ok(Goal::Offset(point("goal_offset", offset)?)),
            (None, None) => Ok(Goal::Point(self.default_goal()?)),
        }
    }

    fn default_goal(&self) -> Result<crate::engine::math::Vector, Problem> {
        let [x, y] = self.file.goal.ok_or_else(|| {
            let reason = "no goal: set `goal` here or at the top of the file";
            Problem::new("", reason)
        })?;
        debug_assert!(
            COORDINATE.check("goal", x).is_ok(),
            "the default goal is checked first"
        );
        Ok([x, y].into())
    }

    /// The group of single agents with this behavior; creates it if needed.
    fn shared_group(&mut self, behavior: &Behavior) -> Result<u16, Problem> {
        let key = serde_json::json!([behavior.profile, behavior.remove_within, behavior.counted,])
            .to_string();
        if let Some(&group) = self.shared.get(&key) {
            return Ok(group);
        }
        let group = self.group("agents", behavior)?;
        self.shared.insert(key, group);
        Ok(group)
    }

    fn group(&mut self, name: &str, behavior: &Behavior) -> Result<u16, Problem> {
        if name.is_empty() {
            return Err(Problem::new("name", "must not be empty"));
        }
        if self.scene.groups.len() >= MOST_NUMBERED {
            let reason = format!(
                "more than {MOST_NUMBERED} groups of agents; put several into one grid or source, or give \
                 single agents the same profile, `remove_within` and `counted`"
            );
            return Err(Problem::new("", reason));
        }
        let choice: Option<&ProfileChoice> = behavior.profile.as_ref();
        if let Some(ProfileChoice::Custom(_)) = choice {
            self.custom.insert(serde_json::json!(choice).to_string());
            if self.custom.len() > MOST_CUSTOM {
                let reason = format!(
                    "more than {MOST_CUSTOM} different profiles defined in full; let agents share profiles"
                );
                return Err(Problem::new("profile", reason));
            }
        }
        let blend = match choice {
            None => self.default.clone(),
            Some(choice) => profiles::blend(choice, &self.file.parameters.0).under("profile")?,
        };
        let removal_radius = DISTANCE.check_given("remove_within", behavior.remove_within)?;
        Ok(self.scene.add_group(Group {
            name: name.to_owned(),
            blend,
            removal_radius,
            counted: behavior.counted.unwrap_or(true),
        }))
    }
}

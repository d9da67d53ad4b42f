//! Entrances: lines through which agents come in.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::crowd::{Behavior, Crowd as Building};
use super::distribution::{self, Draw, traits};
use super::error::Problem;
use super::file::LONGEST_TIME;
use super::goals::Aim;
use super::profiles::ProfileChoice;
use super::schema::word;
use super::shapes::Point;
use crate::engine::agents::RADIUS_RANGE;
use crate::engine::entrance::{Arrivals, Entrance as Line, Flow};
use crate::engine::math::Vector;

/// The part of all agents for which an entrance must be wide enough.
pub(super) const NEARLY_ALL: f64 = 0.9999;

/// How agents arrive at an entrance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Arriving {
    /// At equal intervals.
    #[default]
    Constant,
    /// At random.
    Poisson,
}

/// A line through which agents come in, each where there is room; without room it waits. `per_sec` or `at_secs` says
/// when they arrive.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Entrance {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The ends of the line. Agents enter with their centers on it, clear of walls. On the edge of the walkable area,
    /// the line opens the wall.
    pub line: Ends,
    /// How many agents arrive per second.
    #[schemars(range(max = 1e4), extend("exclusiveMinimum" = 0))]
    pub per_sec: Option<f64>,
    /// With `per_sec`: agents arrive at equal intervals (`constant`) or independently of each other (`poisson`).
    #[serde(default)]
    #[schemars(schema_with = "word::<Arriving>")]
    pub arrivals: Arriving,
    /// Instead of `per_sec`: the time of each arrival, seconds.
    #[schemars(inner(range(min = 0, max = LONGEST_TIME)))]
    pub at_secs: Option<Vec<f64>>,
    /// With `per_sec`: when agents begin to arrive, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME), extend("default" = 0))]
    pub from_secs: Option<f64>,
    /// With `per_sec`: no agent arrives at this time or later, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
    /// With `per_sec`: the most agents that arrive. Default: unlimited.
    #[schemars(range(min = 1))]
    pub number: Option<u32>,
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// Agents leave within this distance of their goal, meters. Default: they stay.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// Whether arrivals at the goal count as evacuated.
    #[schemars(extend("default" = true))]
    pub counted: Option<bool>,
    /// s_pref, m/s: a number, or a distribution to draw from for each agent. Default: the scenario's `preferred_speed`.
    #[serde(default)]
    #[schemars(schema_with = "distribution::speed")]
    pub preferred_speed: Option<Draw>,
    /// D_i, meters: a number, or a distribution. Default: uniform from 0.215 to 0.265 (§5.6).
    #[serde(default)]
    #[schemars(schema_with = "distribution::radius")]
    pub radius: Option<Draw>,
    /// m_i, 1 for an average person: a number, or a distribution. Lighter agents need shorter time steps. Default:
    /// (D_i / 0.24)².
    #[serde(default)]
    #[schemars(schema_with = "distribution::mass")]
    pub mass: Option<Draw>,
    /// The time from its entry until an agent walks, seconds: a number, or a distribution. Default: 0.
    #[serde(default)]
    #[schemars(schema_with = "distribution::wait")]
    pub premovement_secs: Option<Draw>,
}

/// The two ends of a line
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub(super) struct Ends(pub [Point; 2]);

impl Entrance {
    /// An upper bound on the agents that arrive until `last` seconds.
    pub(super) fn most(&self, last: f64) -> u64 {
        if let Some(times) = &self.at_secs {
            return times.iter().filter(|&&time| time <= last).count() as u64;
        }
        let (from, until) = (self.from_secs.unwrap_or(0.0), self.until_secs);
        let mean =
            (until.map_or(last, |until| until.min(last)) - from) * self.per_sec.unwrap_or(0.0);
        let spread = match self.arrivals {
            Arriving::Constant => 0.0,
            // Fewer than one in 10¹² runs has more.
            Arriving::Poisson => 8.0 * mean.max(0.0).sqrt() + 30.0,
        };
        // The cast saturates: a negative number becomes 0.
        let most = (mean + spread + 1.0).floor() as u64;
        match mean < 0.0 {
            true => 0,
            false => self.number.map_or(most, |number| most.min(number.into())),
        }
    }

    fn arrivals(&self) -> Result<Arrivals, Problem> {
        let flow = match (self.per_sec, &self.at_secs) {
            (Some(per_sec), None) => Flow {
                per_sec,
                from: self.from_secs.unwrap_or(0.0),
                until: self.until_secs.unwrap_or(f64::INFINITY),
                number: self.number,
            },
            (None, Some(times)) => {
                for (key, is_given) in [
                    ("arrivals", self.arrivals == Arriving::Poisson),
                    ("from_secs", self.from_secs.is_some()),
                    ("until_secs", self.until_secs.is_some()),
                    ("number", self.number.is_some()),
                ] {
                    if is_given {
                        let reason = "is for `per_sec`; `at_secs` has the time of each arrival";
                        return Err(Problem::new(key, reason));
                    }
                }
                let mut times = times.clone();
                times.sort_by(f64::total_cmp);
                return Ok(Arrivals::At(times));
            }
            _ => {
                return Err(Problem::new(
                    "",
                    "needs `per_sec` or `at_secs`, and not both",
                ));
            }
        };
        if flow.until <= flow.from {
            let reason = format!(
                "{} is not after from_secs {}; raise it, or lower from_secs",
                flow.until, flow.from
            );
            return Err(Problem::new("until_secs", reason));
        }
        Ok(match self.arrivals {
            Arriving::Constant => Arrivals::Constant(flow),
            Arriving::Poisson => Arrivals::Poisson(flow),
        })
    }
}

impl Building<'_> {
    /// Adds an entrance.
    pub(super) fn entrance(&mut self, given: &Entrance, place: &str) -> Result<(), Problem> {
        let draws = [
            &given.preferred_speed,
            &given.radius,
            &given.mass,
            &given.premovement_secs,
        ];
        let traits = traits(draws)?;
        let widest = match &traits.radius {
            Some(radius) => radius.quantile(NEARLY_ALL),
            None => RADIUS_RANGE[1],
        };
        let name = given.name.as_deref().unwrap_or(place).to_owned();
        let journey = self.journey(given.journey.as_deref(), given.goal.is_some())?;
        let target = self.target(given.goal, journey, given.remove_within)?;
        let behavior = Behavior {
            journey,
            direction: target.direction,
            profile: given.profile.as_ref(),
            remove_within: given.remove_within,
            counted: given.counted,
        };
        let Ends(ends) = given.line;
        let line: [Vector; 2] = ends.map(Into::into);
        if line[0] == line[1] {
            let reason = "its ends are the same point; move one";
            return Err(Problem::new("line", reason));
        }
        let entrance = Line {
            line,
            goal: target.goal_from((line[0] + line[1]) * 0.5),
            arrivals: given.arrivals()?,
            group: self.group(&name, behavior, traits)?,
            name,
        };
        let nobody = std::iter::empty();
        if entrance.free(widest, &self.scene.walls, nobody).is_empty() {
            let reason = format!(
                "no agent with a radius of {widest:.3} m can stand on it: obstacles are too near, or it lies outside of \
                 the walkable area; move or lengthen it"
            );
            return Err(Problem::new("line", reason));
        }
        self.scene.entrances.push(entrance);
        Ok(())
    }
}

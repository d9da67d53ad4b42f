//! The keys of agents: single ones, grids, crowds and entrances.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::keys::distribution;
use crate::keys::distribution::Draw;
use crate::keys::goals::Aim;
use crate::keys::limits::{HIGHEST_DENSITY, LONGEST_TIME};
use crate::keys::names::word;
use crate::keys::profiles::ProfileChoice;
use crate::keys::shapes::{Outline, Point, Ring};
use engine::math::Vector;

/// The keys of behavior, which single agents and groups have in common.
///
/// serde cannot refuse unknown keys in structs that flatten it or [`People`]: `file::range::check_names` does, where
/// they have `#[schemars(deny_unknown_fields)]`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Behavior {
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// In buildings: whether they may use stairs and escalators. Those who may not take ramps and lifts to an exit.
    #[schemars(extend("default" = true))]
    pub uses_stairs: Option<bool>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// Agents leave within this distance of their goal, meters. Default: they stay.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// How much they hurry, from 0 (calm) to 1 (told to hurry): with the walking law `headings` they then keep shorter
    /// gaps. Default: the scenario's `motivation`.
    #[schemars(range(min = 0, max = 1))]
    pub motivation: Option<f64>,
    /// Whether arrivals count as evacuated.
    #[schemars(extend("default" = true))]
    pub counted: Option<bool>,
}

/// A single agent.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Agent {
    /// The start position.
    pub position: Point,
    /// The initial velocity, m/s, at most `max_speed`. Default: at rest.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub velocity: Option<[f64; 2]>,
    /// D_i, meters. Default: random, from 0.215 to 0.265 (§5.6).
    #[schemars(range(min = 0.01, max = 10))]
    pub radius: Option<f64>,
    /// m_i, 1 for an average person. Lighter agents need shorter time steps. Default: (D_i / 0.24)².
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub mass: Option<f64>,
    /// s_pref, m/s. Default: the scenario's `preferred_speed`.
    #[schemars(range(min = 0, max = 100))]
    pub preferred_speed: Option<f64>,
    /// The time until the agent walks, seconds. Default: 0.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub premovement_secs: Option<f64>,
    /// ρ̂ (Eq. 8) of the previous frame, P/m². Default: the density from agents alone in its first frame.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub mean_density: Option<f64>,
    #[serde(flatten)]
    pub behavior: Behavior,
}

/// The keys that grids, crowds, sources, entrances and `from` have in common.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct People {
    #[serde(flatten)]
    pub behavior: Behavior,
    /// s_pref, m/s: a number, or a distribution to draw from for each agent. Default: the scenario's `preferred_speed`.
    #[schemars(schema_with = "distribution::speed")]
    pub preferred_speed: Option<Draw>,
    /// D_i, meters: a number, or a distribution. Default: uniform from 0.215 to 0.265 (§5.6).
    #[schemars(schema_with = "distribution::radius")]
    pub radius: Option<Draw>,
    /// m_i, 1 for an average person: a number, or a distribution. Lighter agents need shorter time steps. Default:
    /// (D_i / 0.24)².
    #[schemars(schema_with = "distribution::mass")]
    pub mass: Option<Draw>,
    /// The time from its entry until an agent walks, seconds: a number, or a distribution. Default: 0.
    #[schemars(schema_with = "distribution::wait")]
    pub premovement_secs: Option<Draw>,
}

/// Agents on a grid, one at the center of each cell.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Grid {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The lower left corner.
    pub min: Point,
    /// The upper right corner.
    pub max: Point,
    /// The number of cells along x.
    #[schemars(range(min = 1))]
    pub columns: u32,
    /// The number of cells along y.
    #[schemars(range(min = 1))]
    pub rows: u32,
    /// Each coordinate is shifted at random by up to ± this, meters.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1e6))]
    pub jitter: f64,
    /// Instead of `goal`: the goal relative to each agent's start.
    pub goal_offset: Option<Point>,
    /// The time of the first entry, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME), extend("default" = 0))]
    pub start_secs: Option<f64>,
    /// The time between entries, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    pub every_secs: Option<f64>,
    /// The number of entries. Default: unlimited.
    pub times: Option<u32>,
    #[serde(flatten)]
    pub people: People,
}

impl Grid {
    /// The time of the first entry and the time between entries, seconds; agents of `grids` enter once.
    pub fn schedule(&self) -> [f64; 2] {
        let start = self.start_secs.unwrap_or(0.0);
        [start, self.every_secs.unwrap_or(f64::INFINITY)]
    }
}

/// How the agents of a crowd are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Spacing {
    /// At random, as far from each other as their number allows.
    #[default]
    Random,
    /// On a triangular lattice.
    Grid,
}

/// Agents that stand in an area at the start: `number` or `density` says how many.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Crowd {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// Where they stand, corners in meters: one ring, or a list of rings (the outline, then the holes). Walls and
    /// obstacles in it are left out.
    pub area: Outline,
    /// The number of agents.
    #[schemars(range(min = 1))]
    pub number: Option<u32>,
    /// Instead of `number`: agents per square meter of the free part of the area.
    #[schemars(range(max = HIGHEST_DENSITY), extend("exclusiveMinimum" = 0))]
    pub density: Option<f64>,
    /// `random` places, as far from each other as the number allows, or a triangular `grid`, which packs agents more
    /// densely. Bodies never overlap.
    #[serde(default)]
    #[schemars(schema_with = "word::<Spacing>")]
    pub spacing: Spacing,
    #[serde(flatten)]
    pub people: People,
}

impl Crowd {
    /// An upper bound on its number of agents: the area may have holes and contain obstacles.
    pub fn most(&self) -> u64 {
        let outline = self.area.rings().first();
        let corners: Vec<Vector> = outline.map_or(Vec::new(), |Ring(corners)| {
            corners.iter().map(|&corner| corner.into()).collect()
        });
        let ends = corners.iter().cycle().skip(1);
        let twice: f64 = corners.iter().zip(ends).map(|(a, b)| a.perp(b)).sum();
        let dense = self.density.unwrap_or(0.0) * 0.5 * twice.abs();
        // The cast saturates.
        self.number.map_or(dense.ceil() as u64, u64::from)
    }
}

/// How agents arrive at an entrance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Arriving {
    /// At equal intervals.
    #[default]
    Constant,
    /// At random.
    Poisson,
}

/// A line through which agents come in, each where there is room; without room it waits. `per_sec` or `at_secs` says
/// when they arrive.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Entrance {
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
    #[serde(flatten)]
    pub people: People,
}

/// The two ends of a line
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Ends(pub [Point; 2]);

impl Entrance {
    /// An upper bound on the agents that arrive until `last` seconds.
    pub fn most(&self, last: f64) -> u64 {
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
}

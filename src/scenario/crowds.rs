//! Crowds: agents that stand anywhere in an area at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::catalog::HIGHEST_DENSITY;
use super::crowd::{Behavior, Crowd as Building};
use super::distribution::{self, Draw, traits};
use super::error::{Problem, Under};
use super::floor_plan::{free, outlines, rings};
use super::goals::Aim;
use super::off_floor::OFF;
use super::plan;
use super::profiles::ProfileChoice;
use super::schema::word;
use super::shapes::{Outline, Ring};
use crate::engine::agents::{NewAgent, RADIUS_RANGE};
use crate::engine::geometry::Area;
use crate::engine::math::{Vector, bounds};
use crate::engine::packing::{self, Body, Space};
use crate::engine::random::{self, Purpose};
use crate::engine::scene::Region;

/// The most parts of an area whose agents a note counts.
const MOST_COUNTS: usize = 4;
/// Crowds are noted if less than this part of their area is free floor.
const MOSTLY_OFF: f64 = 0.25;
/// The share of radii that may be smaller than assumed.
const RARE: f64 = 1e-6;

/// How the agents of a crowd are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Spacing {
    /// At random, as far from each other as their number allows.
    #[default]
    Random,
    /// On a triangular lattice.
    Grid,
}

/// Agents that stand in an area at the start: `number` or `density` says how many.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Crowd {
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
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// Agents leave within this distance of their goal, meters. Default: they stay.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// Whether arrivals count as evacuated.
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

impl Crowd {
    /// An upper bound on its number of agents: the area may have holes and contain obstacles.
    pub(super) fn most(&self) -> u64 {
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

/// A note if walls divide the free area of the crowd `name`, whose agents stand at `places`.
fn divided(areas: &[Area], places: &[Vector], name: &str) -> Option<String> {
    if areas.len() < 2 {
        return None;
    }
    let there = |area: &Area| places.iter().filter(|&&p| area.contains(p)).count();
    let mut counts: Vec<usize> = areas.iter().map(there).filter(|&one| one > 0).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    (counts.len() > 1).then(|| {
        let parts = counts.len();
        let counts = counts.iter().take(MOST_COUNTS).map(usize::to_string);
        let mut counts: Vec<String> = counts.collect();
        counts.extend((parts > MOST_COUNTS).then(|| "…".to_owned()));
        let counts = counts.join(", ");
        format!(
            "{name}.area: walls divide it into {parts} parts, with {counts} agents; draw it within one room if they \
             should stand in one"
        )
    })
}

impl Building<'_> {
    /// Adds the agents of crowd `index`.
    pub(super) fn crowd(&mut self, given: &Crowd, index: u32, place: &str) -> Result<(), Problem> {
        let areas = self.free_area(&given.area).under("area")?;
        let size: f64 = areas.iter().map(Area::area).sum();
        let number = match (given.number, given.density) {
            (Some(number), None) => number as usize,
            (None, Some(density)) => (density * size).round() as usize,
            _ => {
                return Err(Problem::new(
                    "",
                    "needs `number` or `density`, and not both",
                ));
            }
        };
        let draws = [
            &given.preferred_speed,
            &given.radius,
            &given.mass,
            &given.premovement_secs,
        ];
        let traits = traits(draws)?;
        let journey = self.journey(given.journey.as_deref(), given.goal.is_some())?;
        let target = self.target(given.goal, journey, given.remove_within)?;
        let (seed, first) = (self.scene.seed, self.scene.agents.len() as u32);
        self.note_bodies();
        let space = Space::new(&areas, &self.scene.walls, self.scene.period);
        let least = traits.radius.as_ref();
        let least = least.map_or(RADIUS_RANGE[0], |radius| radius.quantile(RARE));
        // A few of too many agents are enough to find out how many fit.
        let tried = number.min(space.capacity(least));
        let radii = (first..).take(tried).map(|id| traits.radius_of(seed, id));
        let radii: Vec<f64> = radii.collect();
        let places = match given.spacing {
            Spacing::Random => {
                let mut random = random::stream(seed, Purpose::Crowd, index, 0);
                packing::scattered(&space, &self.bodies, &radii, &mut random)
            }
            Spacing::Grid => packing::lattice(&space, &self.bodies, &radii),
        };
        let all = |places: Vec<Vector>| match tried < number {
            true => Err(tried),
            false => Ok(places),
        };
        let places = places.and_then(all).map_err(|fitting| {
            let (at, advice) = match given.spacing {
                Spacing::Random => ("at random places ", ", or set `spacing` to `grid`"),
                Spacing::Grid => ("", ""),
            };
            let reason = format!(
                "{number} agents do not fit: about {fitting} stand {at}side by side in the free {size:.1} m² of the \
                 area; use fewer, a larger area or a smaller `radius`{advice}"
            );
            Problem::new("", reason)
        })?;
        self.notes.extend(divided(&areas, &places, place));
        let drawn = plan::area(given.area.rings()).under("area")?.area();
        if size < MOSTLY_OFF * drawn {
            self.notes.push(format!(
                "{place}.area: {size:.1} m² of its {drawn:.1} m² are free floor, and all its agents start there; check that \
                 it is where it should be"
            ));
        }
        let behavior = Behavior {
            journey,
            direction: target.direction,
            profile: given.profile.as_ref(),
            remove_within: given.remove_within,
            counted: given.counted,
        };
        let group = self.group(given.name.as_deref().unwrap_or(place), behavior, traits)?;
        let agents = places.into_iter().zip(radii);
        self.scene
            .agents
            .extend(agents.map(|(place, radius)| NewAgent {
                radius: Some(radius),
                ..NewAgent::at(place, target.goal_from(place), group)
            }));
        Ok(())
    }

    /// The part of an area outside of all obstacles and inside of the walkable area as it is given, without the floors
    /// behind exits, and inside of the period.
    fn free_area(&self, given: &Outline) -> Result<Vec<Area>, Problem> {
        let area = plan::area(given.rings())?;
        let own = rings(&[area]);
        let (mut floors, mut bodies) = outlines(self.scene.walls.obstacles());
        bodies.extend(self.behind.iter().cloned());
        if let Some(period) = &self.scene.period {
            let corners = bounds(own.iter().flatten().copied()).unwrap_or_default();
            let [min, max] = period.clipped(corners);
            floors.push(vec![Region { min, max }.corners().to_vec()]);
        }
        floors.insert(0, own);
        let areas = free(&floors, &bodies).map_err(|error| Problem::new("", error.to_string()))?;
        match areas.is_empty() {
            false => Ok(areas),
            true => Err(Problem::new("", OFF)),
        }
    }

    /// Notes the bodies of the agents that have been added since.
    pub(super) fn note_bodies(&mut self) {
        let scene = &self.scene;
        let new = scene.agents.iter().enumerate().skip(self.bodies.len());
        self.bodies.extend(new.map(|(id, agent)| {
            let traits = &scene.groups[usize::from(agent.group)].traits;
            Body {
                place: scene
                    .period
                    .map_or(agent.position, |period| period.wrapped(agent.position).0),
                radius: agent
                    .radius
                    .unwrap_or_else(|| traits.radius_of(scene.seed, id as u32)),
            }
        }));
    }
}

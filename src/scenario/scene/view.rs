//! What pictures and recordings show: the part of the plane, the first moment, the ranges of their colors.

use crate::error::Problem;
use crate::file;
use crate::keys::shapes::region;
use analysis::round::end;
use engine::math::{Vector, bounds};
use engine::scene::{Group, Region, Scene};

/// Margin of the default region around walls, agents, goals and sources, meters.
const MARGIN: f64 = 1.0;
/// The density with the last color, as a part of the largest rest density in the scene.
const DENSITY: f64 = 1.2;
/// The largest default density with the last color, P/m².
const MOST_DENSITY: f64 = 10.0;
/// The least height of a picture as a part of its width.
const NARROWEST: f64 = 0.4;
/// The part of the people whose preferred speeds are within the default range of speeds.
const PART: f64 = 0.99;

/// What pictures and recordings show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The visible part of the plane, meters.
    pub region: Region,
    /// The time at which a recording opens, seconds; `None`: at the moment of the highest density.
    pub opens_at_secs: Option<f64>,
    /// The densities with the first and the last color, P/m².
    pub density_range: [f64; 2],
    /// The speeds with the first and the last color, m/s.
    pub speed_range: [f64; 2],
}

/// The view that a scenario asks for, completed from its scene.
pub fn of(given: Option<&file::View>, scene: &Scene) -> Result<View, Problem> {
    let given = given.cloned().unwrap_or_default();
    let region = match given.region {
        Some(corners) => region("region", corners)?,
        None => surroundings(scene),
    };
    if region.min.x == region.max.x || region.min.y == region.max.y {
        let reason = "encloses no area: its corners must differ in x and in y";
        return Err(Problem::new("region", reason));
    }
    let range = |key: &str, range: Option<[f64; 2]>, default: f64| match range {
        Some([first, last]) if first >= last => {
            let reason = "the first value must be less than the second";
            Err(Problem::new(key, reason))
        }
        range => Ok(range.unwrap_or([0.0, default])),
    };
    Ok(View {
        region,
        opens_at_secs: given.opens_at_secs,
        density_range: range("density_range", given.density_range, most_density(scene))?,
        speed_range: range("speed_range", given.speed_range, most_speed(scene))?,
    })
}

/// A note on the first text so far outside of the scene that pictures do not show it, unless the file says what they
/// show.
pub fn unseen(keys: &file::File, region: &Region) -> Option<String> {
    if keys.view.as_ref().is_some_and(|view| view.region.is_some()) {
        return None;
    }
    // Pictures of narrow scenes show more on both sides.
    let half = (region.max - region.min) * 0.5;
    let half = half.map(|side| side.max(NARROWEST * half.max()));
    let middle = (region.min + region.max) * 0.5;
    let is_out = |at: &Vector| (at - middle).abs() != (at - middle).abs().inf(&half);
    let labels = keys.labels.iter().map(|label| Vector::from(label.at));
    let (k, at) = labels.enumerate().find(|(_, at)| is_out(at))?;
    Some(format!(
        "labels[{k}].at: ({}, {}) lies outside of the scene, and pictures do not show this text; move it, or set \
         `view.region`",
        at.x, at.y
    ))
}

/// 1.2 times the largest rest density of any profile, at most 10 P/m²; up to a round number.
fn most_density(scene: &Scene) -> f64 {
    let densities = scene.groups.iter();
    let largest = densities.map(|group| group.blend.sph.rest_density_max);
    end((DENSITY * largest.fold(0.0, f64::max)).clamp(1.0, MOST_DENSITY))
}

/// The 99th percentile of the preferred speeds of the group with the fastest people, m/s; up to a round number.
fn most_speed(scene: &Scene) -> f64 {
    let of_group = |group: &Group| match &group.traits.preferred_speed {
        Some(speeds) => speeds.quantile(PART),
        None => scene.preferred_speed,
    };
    let groups = scene.groups.iter().map(of_group);
    let agents = scene.agents.iter();
    let own = agents.filter_map(|agent| agent.preferred_speed);
    let fastest = groups.chain(own).fold(0.0, f64::max);
    end(if fastest > 0.0 {
        fastest
    } else {
        scene.max_speed
    })
}

/// The bounding box of walls, agents, goals, sources, entrances and scheduled agents, with a margin.
fn surroundings(scene: &Scene) -> Region {
    let corners = scene.walls.iter().map(|wall| wall.start);
    let late = scene.scheduled.iter().map(|late| &late.agent);
    let people = scene.agents.iter().chain(late);
    let agents = people.flat_map(|agent| [agent.position, agent.goal]);
    let grids = scene.sources.iter();
    let sources = grids.flat_map(|source| [source.grid.min, source.grid.max]);
    let entrances = scene.entrances.iter();
    let lines = entrances.flat_map(|entrance| [entrance.line[0], entrance.line[1], entrance.goal]);
    let margin = Vector::new(MARGIN, MARGIN);
    let [low, high] = bounds(corners.chain(agents).chain(sources).chain(lines)).unwrap_or_default();
    let period = scene.period;
    let [low, high] = period.map_or([low, high], |period| period.clipped([low, high]));
    Region {
        min: low - margin,
        max: high + margin,
    }
}

//! Periodic scenes: the key, the bodies of the neighboring periods, and what such a scene cannot have.

use crate::error::Problem;
use crate::file::File;
use crate::floor_plan::FloorPlan;
use engine::agents::Agents;
use engine::geometry::{Area, Polygon};
use engine::math::{Vector, bounds};
use engine::period::{Axis, Period};
use engine::scene::{Region, Scene};

/// The place of the key in messages.
const LENGTH: &str = "periodic.length";
/// Corners as near as this to the end of the period lie on it, meters.
const ON_END: f64 = 1e-6;

/// Rings of points in meters: the outline, then the holes.
pub type Rings = Vec<Vec<[f64; 2]>>;

/// Refuses the keys that a periodic scene cannot have.
pub fn check_keys(keys: &File) -> Result<(), Problem> {
    if keys.periodic.is_none() {
        return Ok(());
    }
    for (key, is_given) in [
        ("exits", !keys.exits.is_empty()),
        ("waypoints", !keys.waypoints.is_empty()),
        ("waiting_areas", !keys.waiting_areas.is_empty()),
        ("queues", !keys.queues.is_empty()),
        ("journeys", !keys.journeys.is_empty()),
        ("sources", !keys.sources.is_empty()),
        ("entrances", !keys.entrances.is_empty()),
    ] {
        if is_given {
            let reason = "in a periodic scene agents walk in a direction, and none come in or leave: remove this, or \
                          `periodic`";
            return Err(Problem::new(key, reason));
        }
    }
    Ok(())
}

/// Most copies of one polygon.
const MOST_COPIES: f64 = 1000.0;

/// The copies of a polygon in all periods that agents can see, the given one among them. An error if there are too
/// many.
pub fn copies(rings: &Rings, period: Option<&Period>) -> Result<Vec<Rings>, Problem> {
    let Some(period) = period else {
        return Ok(vec![rings.clone()]);
    };
    let points = rings.iter().flatten().map(|&p| Vector::from(p));
    let [low, high] = bounds(points).unwrap_or_default().map(|p| period.along(p));
    let [from, to] = period.ends();
    // One period more on both sides than agents are in.
    let first = ((from - period.length - high) / period.length).ceil();
    let last = ((to + period.length - low) / period.length).floor();
    let count = last - first + 1.0;
    if count.is_nan() || count > MOST_COPIES {
        let reason = format!(
            "reaches over more than {MOST_COPIES} periods; lengthen `{LENGTH}`, or shorten this polygon"
        );
        return Err(Problem::new("", reason));
    }
    let moved = |laps: i32| {
        let way = period.way(laps);
        let ring =
            |ring: &Vec<[f64; 2]>| ring.iter().map(|p| [p[0] + way.x, p[1] + way.y]).collect();
        rings.iter().map(ring).collect()
    };
    Ok((first as i32..=last as i32).map(moved).collect())
}

/// An obstacle, from its outline and holes, in all periods that agents can see. Copies that touch become one body, so
/// that no corner shows where they meet.
pub fn bodies(rings: &Rings, period: &Period) -> Result<Vec<Polygon>, Problem> {
    let copies = copies(rings, Some(period))?;
    let points = rings.iter().flatten().map(|&p| Vector::from(p));
    let [low, high] = bounds(points).unwrap_or_default();
    let touch = period.along(high - low) >= period.length - ON_END;
    let obstacle = |rings: &Rings| FloorPlan::obstacle(rings);
    let areas: Vec<Area> = match touch {
        true => FloorPlan::walkable(&copies)?.walkable,
        false => copies.iter().map(obstacle).collect::<Result<_, _>>()?,
    };
    let polygons = areas.into_iter().map(Polygon::filling);
    Ok(polygons.collect::<Result<_, _>>()?)
}

/// Checks that the floor goes on across the end of the period: `solids` surround the walkable area and its copies.
pub fn check_ends(solids: &[Polygon], period: &Period) -> Result<(), Problem> {
    let [_, to] = period.ends();
    let name = match period.axis {
        Axis::X => "x",
        Axis::Y => "y",
    };
    let edges = || solids.iter().flat_map(Polygon::edges);
    let is_on = |p: Vector| (period.along(p) - to).abs() < ON_END;
    if let Some((a, b)) = edges().find(|&(a, b)| is_on(a) && is_on(b)) {
        let reason = format!(
            "the two ends of the period do not fit together: at {name} = {to} a wall remains from ({}, {}) to ({}, \
             {}); give both ends the same outline, or move them with `periodic.from`",
            a.x, a.y, b.x, b.y
        );
        return Err(Problem::new("", reason));
    }
    let crosses = |&(a, b): &(Vector, Vector)| {
        let [a, b] = [a, b].map(|p| period.along(p) - to);
        a.min(b) <= ON_END && a.max(b) >= -ON_END
    };
    if edges().any(|edge| crosses(&edge)) {
        return Ok(());
    }
    let reason = format!(
        "there is no floor at {name} = {to}, where the period ends; it must reach from {name} = {} to {name} = {to}, \
         or beyond",
        period.from
    );
    Err(Problem::new("", reason))
}

/// Checks that the period is long enough, for a scene that is otherwise complete, and that regions lie in it.
pub fn check(keys: &File, scene: &Scene) -> Result<(), Problem> {
    let Some(period) = &scene.period else {
        return Ok(());
    };
    let ranges = scene.ranges(&scene.needs(), &Agents::default());
    let agents = scene.agents.iter().zip(0..).map(|(agent, id)| {
        let traits = &scene.groups[usize::from(agent.group)].traits;
        let drawn = || traits.radius_of(scene.seed, id);
        agent.radius.unwrap_or_else(drawn)
    });
    let widest = agents.fold(0.0, f64::max);
    let range = ranges.interaction(widest);
    let least = (2.0 * range).max(ranges.longest_step + 2.0 * ranges.drift);
    if period.length < least {
        let reason = format!(
            "must be at least {least} m, not {}: agents act on each other within {range} m, and must not meet one \
             agent on both sides; lengthen it, or lower `avoidance_radius` or `support_radius`",
            period.length
        );
        return Err(Problem::new(LENGTH, reason));
    }
    let measurements = keys.measurements.iter().enumerate();
    let measured = measurements.flat_map(|(k, measurement)| {
        let places = measurement.places().into_iter();
        places.map(move |(key, place)| (format!("measurements[{k}].{key}"), place.bounds()))
    });
    let zones = scene.journeys.zones.iter().map(|zone| {
        let [min, max] = bounds(zone.area.points().iter().copied()).unwrap_or_default();
        (format!("zones: `{}`: area", zone.name), Region { min, max })
    });
    let pushes = scene.pushes.iter();
    let pushed = pushes.map(|push| (format!("events: `{}`: region", push.name), push.region));
    for (place, Region { min, max }) in measured.chain(pushed).chain(zones) {
        let [from, to] = period.ends();
        if period.along(min) < from || period.along(max) > to {
            let reason = format!(
                "reaches out of the period from {from} to {to} m, in which all agents are; keep it inside, or move the \
                 period with `periodic.from`"
            );
            return Err(Problem::new(place, reason));
        }
    }
    Ok(())
}

//! Notes on scenarios that are valid but doubtful: units, speeds, journeys without end, no agents.

use std::collections::BTreeSet;

use super::file::File;
use super::quote::shown;
use crate::engine::geometry::Walls;
use crate::engine::journeys::Kind;
use crate::engine::math::{Vector, bounds};
use crate::engine::scene::Scene;

/// Floors with a longer side are doubtful, meters.
const LONG: f64 = 300.0;
/// Floors with a longer side and fewer people per square meter are doubtful, too. Small empty rooms are not: a single
/// agent shows how the model walks.
const SIDE_IF_EMPTY: f64 = 100.0;
const EMPTY: f64 = 0.01;
/// Crowds do not run faster, m/s.
const FAST: f64 = 4.0;

/// The notes on a complete scene that at most `entering` agents enter.
pub(super) fn notes(keys: &File, scene: &Scene, entering: u64) -> Vec<String> {
    if entering == 0 {
        let none =
            "no agents enter: add `crowds`, `grids`, `agents`, `sources`, `entrances` or `from`";
        return vec![none.to_owned()];
    }
    let floor = floor(keys, &scene.walls, entering).into_iter();
    floor
        .chain(speeds(keys, scene))
        .chain(endless(scene))
        .chain(coincident(scene))
        .collect()
}

/// A note on a floor that is so large or empty that its unit may not be meters. Its size is that of the plan, without the
/// floors behind exits and entrances.
fn floor(keys: &File, walls: &Walls, entering: u64) -> Option<String> {
    let corners = keys.walkable_area.iter().flatten().flatten();
    let corners = corners.flat_map(|ring| ring.0.iter().map(|&corner| corner.into()));
    let [low, high] = bounds(corners)?;
    let extent = high - low;
    let unbounded = walls.obstacles().iter().filter(|one| one.is_unbounded());
    let outlines: Vec<&[Vector]> = unbounded.flat_map(|one| one.rings()).collect();
    let solids = walls.obstacles().iter().filter(|one| !one.is_unbounded());
    let twice = |ring: &[Vector]| -> f64 {
        let ends = ring.iter().cycle().skip(1);
        ring.iter().zip(ends).map(|(a, b)| a.perp(b)).sum()
    };
    // The outlines of floors and of the solids in them run in opposite senses.
    let outer: f64 = outlines.iter().map(|ring| twice(ring)).sum();
    let size = 0.5 * outer.abs() - solids.map(|solid| solid.area()).sum::<f64>();
    let density = entering as f64 / size.max(f64::MIN_POSITIVE);
    let is_empty = extent.max() > SIDE_IF_EMPTY && density < EMPTY;
    (extent.max() > LONG || is_empty).then(|| {
        format!(
            "walkable_area: {:.0} m × {:.0} m for {entering} agent(s): check that the unit is meters",
            extent.x, extent.y
        )
    })
}

/// Notes on preferred speeds above those of running crowds.
fn speeds(keys: &File, scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    let own = (scene.preferred_speed, "preferred_speed".to_owned());
    found.push(own);
    for (k, agent) in keys.agents.iter().enumerate() {
        let speed = agent.preferred_speed;
        found.extend(speed.map(|speed| (speed, format!("agents[{k}].preferred_speed"))));
    }
    for group in &scene.groups {
        let speed = group.traits.preferred_speed.as_ref();
        let place = || format!("preferred_speed of {}", shown(&group.name));
        found.extend(speed.map(|speed| (speed.mean(), place())));
    }
    let fast = found.into_iter().filter(|(speed, _)| *speed > FAST);
    let note = |(speed, place)| {
        format!(
            "{place}: {speed} m/s is faster than crowds run: check that the unit is m/s (walking is 1.3 m/s)"
        )
    };
    fast.map(note).collect()
}

/// A note on agents that start at the same point as another.
fn coincident(scene: &Scene) -> Option<String> {
    let positions = scene.agents.iter().map(|agent| agent.position);
    let mut positions: Vec<Vector> = positions.collect();
    positions.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let same = positions.windows(2).filter(|pair| pair[0] == pair[1]);
    let same: Vec<Vector> = same.map(|pair| pair[0]).collect();
    let first = same.first()?;
    Some(format!(
        "{} agent(s) start exactly where another one does, the first at ({}, {}): are two groups on one spot?",
        same.len(),
        first.x,
        first.y
    ))
}

/// Notes on the journeys after which agents stay on the floor, unless they end in waiting areas.
fn endless(scene: &Scene) -> Vec<String> {
    let used: BTreeSet<u16> = scene.groups.iter().filter_map(|one| one.journey).collect();
    let note = |journey: u16| {
        let journey = &scene.journeys.journeys[usize::from(journey)];
        let mut last = journey.stages.last()?.places.iter();
        let stays =
            |kind: &Kind| matches!(kind, Kind::Line(_) | Kind::Disk { .. } | Kind::Queue(_));
        let place = last.find_map(|&place| {
            let place = &scene.journeys.places[usize::from(place)];
            stays(&place.kind).then_some(place)
        })?;
        Some(format!(
            "journey `{}`: agents that have passed its last place, the {} `{}`, stand there until the end of the run; \
             add an exit as last stage if they should leave",
            shown(&journey.name),
            place.kind.name(),
            shown(&place.name),
        ))
    };
    used.into_iter().filter_map(note).collect()
}

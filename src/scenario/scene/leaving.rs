//! Notes on agents that cannot leave, leave at once, or have no room where they start, enter, walk to and wait.

use std::collections::BTreeSet;

use crate::error::numbers::brief;
use crate::error::quote::shown;
use crate::file::File;
use engine::agents::{NewAgent, RADIUS_RANGE, REFERENCE_RADIUS};
use engine::journeys::{JourneyStage, Kind, Place};
use engine::math::Vector;
use engine::scene::{Group, Scene, Source};

/// Bodies touch where more people stand on a square meter (Fruin's level F for queues).
const TOUCHING: f64 = 5.4;

/// The notes on a complete scene.
pub fn notes(keys: &File, scene: &Scene) -> Vec<String> {
    let trapped = trapped(keys, scene).into_iter();
    let of_people = trapped.chain(at_once(scene)).chain(overfull(scene));
    let all = of_people.chain(overrun(scene)).chain(in_walls(keys, scene));
    all.chain(narrow(scene)).collect()
}

fn group(scene: &Scene, k: u16) -> &Group {
    &scene.groups[usize::from(k)]
}

/// The stages of the journey of a group.
pub fn stages<'a>(scene: &'a Scene, group: &Group) -> impl Iterator<Item = &'a JourneyStage> {
    let journeys = &scene.journeys.journeys;
    let journey = group.journey.map(|k| &journeys[usize::from(k)]);
    journey.into_iter().flat_map(|journey| &journey.stages)
}

/// A note on a run that is to end when the floor is empty, but that no agent can leave.
fn trapped(keys: &File, scene: &Scene) -> Option<String> {
    let leaves = |one: &Group| {
        let mut stages = stages(scene, one);
        let place = |k: &u16| &scene.journeys.places[usize::from(*k)];
        one.removal_radius.is_some()
            || stages.any(|stage| stage.places.iter().any(|k| place(k).is_exit()))
    };
    let used = scene.agents.iter().map(|agent| agent.group);
    let mut used = used
        .chain(scene.sources.iter().map(|source| source.group))
        .chain(scene.entrances.iter().map(|entrance| entrance.group));
    let is_closed = scene.period.is_none() && !used.any(|k| leaves(group(scene, k)));
    (keys.stop.when_empty && is_closed).then(|| {
        "stop.when_empty: no agent can leave, so the run ends at its duration: give groups a journey to an exit, or a \
         goal with `remove_within`"
            .to_owned()
    })
}

/// A note on agents that start where they leave.
fn at_once(scene: &Scene) -> Option<String> {
    let leaves = |agent: &&NewAgent| {
        let radius = group(scene, agent.group).removal_radius;
        radius.is_some_and(|radius| (agent.goal - agent.position).norm() <= radius)
    };
    let mut there = scene.agents.iter().filter(leaves).peekable();
    let first = group(scene, there.peek()?.group);
    let (radius, name) = (first.removal_radius.unwrap_or_default(), shown(&first.name));
    let (count, all) = (there.count(), scene.agents.len());
    // A single agent is put there on purpose.
    (count > 1).then(|| format!(
        "{name}: {count} of the {all} agents at the start leave at once: they are within `remove_within`, {radius} m, \
         of their goal"
    ))
}

/// Notes on waiting areas that are too small for the agents that start and all wait there.
fn overfull(scene: &Scene) -> Vec<String> {
    let sent = |number: usize| {
        let waits = |agent: &&NewAgent| {
            let mut stages = stages(scene, group(scene, agent.group));
            stages.any(|stage| stage.places == [number as u16])
        };
        scene.agents.iter().filter(waits).count()
    };
    let note = |(number, place): (usize, &Place)| {
        let Kind::Waiting(waiting) = &place.kind else {
            return None;
        };
        waiting.until?;
        let (people, size) = (sent(number), waiting.area.area());
        let most = (TOUCHING * size).floor();
        (people as f64 > most).then(|| {
            format!(
                "waiting_areas: {people} agents are sent to `{}`, {size:.1} m², where bodies touch from {most} on; \
                 give it more room, or send fewer",
                shown(&place.name)
            )
        })
    };
    let places = scene.journeys.places.iter().enumerate();
    places.filter_map(note).collect()
}

/// Notes on sources whose agents enter where those before still stand.
fn overrun(scene: &Scene) -> Vec<String> {
    let note = |(k, source): (usize, &Source)| {
        let traits = &group(scene, source.group).traits;
        let speed = traits.preferred_speed.as_ref().map(|one| one.quantile(0.5));
        let way = source.every * speed.unwrap_or(scene.preferred_speed);
        let radius = traits.radius.as_ref().map(|one| one.quantile(0.5));
        let width = 2.0 * radius.unwrap_or(REFERENCE_RADIUS);
        let repeats = source.times != Some(1);
        (repeats && way < width).then(|| {
            format!(
                "sources[{k}].every_secs: agents walk {} m in {} s, less than the width of a body: they enter on top \
                 of those before; `entrances` wait for room",
                brief(way),
                brief(source.every)
            )
        })
    };
    let sources = scene.sources.iter().enumerate();
    sources.filter_map(note).collect()
}

/// A note on single agents that start with half of their body in a wall or more.
fn in_walls(keys: &File, scene: &Scene) -> Option<String> {
    let distance = |p: Vector, reach: f64| {
        let mut walls = Vec::new();
        scene.walls.near(p, reach, &mut walls);
        let nearest = walls
            .iter()
            .map(|&k| scene.walls.wall(k).nearest_point(p).point);
        nearest.map(|point| (point - p).norm()).reduce(f64::min)
    };
    let near_walls = keys.agents.iter().enumerate().filter_map(|(k, agent)| {
        let p = Vector::from(agent.position);
        let radius = agent.radius.unwrap_or(RADIUS_RANGE[0]);
        let distance = distance(p, 0.5 * radius)?;
        Some((k, distance, radius))
    });
    let starts: Vec<(usize, f64, f64)> = near_walls.collect();
    let (k, distance, radius) = starts.first()?;
    let more = match starts.len() - 1 {
        0 => String::new(),
        more => format!(", and so do {more} more"),
    };
    Some(format!(
        "agents[{k}].position: the agent starts {distance:.2} m from a wall, less than half of its radius{more}: walls \
         push it out; start at least {} m from walls",
        brief(*radius)
    ))
}

/// Notes on waypoints and goals from which several agents at once keep each other.
fn narrow(scene: &Scene) -> Vec<String> {
    let is_alone = scene.agents.len() < 2 && scene.sources.is_empty() && scene.entrances.is_empty();
    let note = |place: &Place| {
        let Kind::Disk { within, .. } = place.kind else {
            return None;
        };
        (within < REFERENCE_RADIUS && !is_alone).then(|| {
            format!(
                "waypoints: `{}` is reached `within` {} m, less than the radius of a body: agents that come together \
                 keep each other from it; give 0.5 m or more, or a line",
                shown(&place.name),
                brief(within)
            )
        })
    };
    let places = scene.journeys.places.iter().filter_map(note);
    let groups = scene.agents.iter().map(|agent| agent.group);
    let used = groups.collect::<BTreeSet<u16>>();
    let goals = used.into_iter().filter_map(|k| {
        let one = group(scene, k);
        let within = one.removal_radius.filter(|&within| within < REFERENCE_RADIUS && !is_alone)?;
        let is_one = scene.agents.iter().filter(|agent| agent.group == k).count() < 2;
        (!is_one && one.journey.is_none()).then(|| {
            format!(
                "{}: agents leave within `remove_within`, {} m, of their goal, less than the radius of a body: agents \
                 that come together keep each other from it; give 0.5 m or more",
                shown(&one.name),
                brief(within)
            )
        })
    });
    places.chain(goals).collect()
}

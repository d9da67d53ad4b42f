//! Notes on exits that people do not reach, because they leave at another exit before it.

use std::collections::BTreeSet;

use crate::error::quote::shown;
use engine::journeys::{JourneyStage, Place};
use engine::math::Vector;
use engine::routes::{Destination, Routes};
use engine::scene::Scene;

/// The routes of this many people of a journey are looked at.
const LOOKED_AT: usize = 30;

/// A note for each exit that the first stage of a journey offers, if the way of every person to it crosses the line of
/// another exit of the stage: people leave there.
pub fn notes(scene: &Scene) -> Vec<String> {
    let Some(routes) = &scene.routes else {
        return Vec::new();
    };
    let used: BTreeSet<u16> = scene.groups.iter().filter_map(|one| one.journey).collect();
    let of_journeys = used.into_iter().flat_map(|journey| {
        let starts = starts(scene, journey);
        let stage = scene.journeys.journeys[usize::from(journey)].stages.first();
        stage.map_or(Vec::new(), |stage| {
            of_stage(scene, (routes, stage), &starts)
        })
    });
    let notes: BTreeSet<String> = of_journeys.collect();
    notes.into_iter().collect()
}

/// The places where some of the people of a journey start, evenly chosen among those who are there at first.
fn starts(scene: &Scene, journey: u16) -> Vec<Vector> {
    let agents = scene.agents.iter();
    let of_it = agents.filter(|agent| {
        let group = &scene.groups[usize::from(agent.group)];
        group.journey == Some(journey)
    });
    let all: Vec<Vector> = of_it.map(|agent| agent.position).collect();
    let every = all.len().div_ceil(LOOKED_AT).max(1);
    all.into_iter().step_by(every).collect()
}

fn of_stage(
    scene: &Scene,
    (routes, stage): (&Routes, &JourneyStage),
    starts: &[Vector],
) -> Vec<String> {
    let place = |number: u16| &scene.journeys.places[usize::from(number)];
    let places = stage.places.iter().copied();
    let exits: Vec<u16> = places.filter(|&number| place(number).is_exit()).collect();
    let crosses = |to: u16, other: u16| {
        let line = place(other).line();
        let crossed = |start: &Vector| {
            let mut points = vec![*start];
            points.extend(routes.course(*start, Destination::Place(to)));
            let mut legs = points.windows(2);
            points.len() > 1
                && legs.any(|leg| line.is_some_and(|line| meet([leg[0], leg[1]], line)))
        };
        to != other && !starts.is_empty() && starts.iter().all(crossed)
    };
    let eclipsed = exits.iter().filter_map(|&to| {
        let other = exits.iter().find(|&&other| crosses(to, other))?;
        Some((place(to), place(*other)))
    });
    let note = |(exit, other): (&Place, &Place)| {
        format!(
            "the exit `{}` is behind the exit `{}`: every way to it crosses that line, and people leave there; move \
             one of the lines, or make a waypoint of the first one",
            shown(&exit.name),
            shown(&other.name)
        )
    };
    eclipsed.map(note).collect()
}

/// Whether two segments cross.
fn meet([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let side = |p: Vector, q: Vector, r: Vector| (q - p).perp(&(r - p));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

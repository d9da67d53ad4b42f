//! Closed exits and doors, which hold people back, and declared doors, which count people.

use super::Crowd;
use super::passing::{Crossing, across, crossed};
use crate::journeys::{Kind, Place};
use crate::math::{Vector, direction};
use crate::scene::Scene;

/// Agents that may not pass an exit stop this far before its line, meters.
const STOP_BEFORE: f64 = 1e-3;

impl Crowd {
    /// Whether a place stops some agents, also those that are not bound for it.
    pub(super) fn is_closed(&self, scene: &Scene, place: u16) -> bool {
        let state = self.progress.places.get(usize::from(place));
        let is_shut = state.is_some_and(|state| !state.open);
        match &scene.journeys.places[usize::from(place)].kind {
            Kind::Exit(_) => is_shut,
            Kind::Door(door) => is_shut || door.one_way,
            _ => false,
        }
    }

    /// Whether an open one-way door lets agents pass that come from this side, which is positive on its left.
    pub(super) fn lets_pass(&self, scene: &Scene, place: usize, from: f64) -> bool {
        let is_door = matches!(scene.journeys.places[place].kind, Kind::Door(_));
        is_door && self.progress.places[place].open && from > 0.0
    }

    /// The agents of `near` that have moved through declared doors have passed them, whatever they do there.
    pub(super) fn pass_doors(&mut self, scene: &Scene, before: &[Vector], near: &[usize]) {
        let agents = &self.agents;
        let places = scene.journeys.places.iter().zip(&mut self.progress.places);
        for (place, state) in places {
            let Kind::Door(door) = &place.kind else {
                continue;
            };
            let passes = |&&i: &&usize| {
                agents.is_present(i)
                    && crossed([before[i], agents.position[i]], door.line).is_some()
            };
            for &i in near.iter().filter(passes) {
                state.people.insert(agents.id[i]);
            }
            state.passed = state.people.len() as u32;
        }
    }

    /// Stops an agent before a line; it slides along the line, unless a wall or another line is in its way.
    pub(super) fn hold_back(&mut self, scene: &Scene, from: Vector, crossing: &Crossing) {
        let (position, velocity) = (
            &mut self.agents.position[crossing.agent],
            &mut self.agents.velocity[crossing.agent],
        );
        let way = *position - from;
        let length = way.norm();
        if length == 0.0 {
            return;
        }
        let across = across(crossing.line, way);
        let kept = (crossing.part * length - STOP_BEFORE).max(0.0);
        let stop = from + direction(way) * kept;
        let rest = way * (1.0 - kept / length);
        let end = stop + rest - across * rest.dot(&across);
        let near = scene.walls.near_any(&[stop, end], 0.0);
        let mut lines = scene.journeys.places.iter().filter_map(Place::line);
        let is_free = scene.walls.first_crossing(stop, end, &near).is_none()
            && lines.all(|line| crossed([stop, end], line).is_none());
        *position = if is_free { end } else { stop };
        *velocity = match is_free {
            true => *velocity - across * velocity.dot(&across).max(0.0),
            false => Vector::zeros(),
        };
    }
}

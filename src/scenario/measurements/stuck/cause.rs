//! Why an agent makes no way: a likely cause, from what lies between it and its goal.

use super::{Aim, Mark, STUCK_AFTER};
use crate::engine::agents::RADIUS_RANGE;
use crate::engine::geometry::Walls;
use crate::engine::journeys::Kind;
use crate::engine::math::{Vector, direction};
use crate::engine::simulation::Simulation;
use crate::scenario::quote::shown;

/// Agents whose centers are this far ahead block the way, as a multiple of the sum of the radii.
const AHEAD: f64 = 1.25;
/// An agent is ahead if its direction is within this cosine of the direction of walking: 60°.
const CONE: f64 = 0.5;
/// Bodies that overlap a wall by less than this only touch it, meters.
const TOUCH: f64 = 0.01;

/// The likely cause, in words.
pub fn of(simulation: &Simulation, i: usize, mark: &Mark) -> String {
    let (scene, frame) = (simulation.scene(), simulation.frame());
    let (agents, walls) = (frame.agents, frame.walls);
    let p = agents.position[i];
    if scene.pace(agents, i, frame.clock.time()) == 0.0 {
        return "its preferred speed is 0".to_owned();
    }
    if let Some(reason) = unreachable(simulation, p, mark) {
        return reason;
    }
    let ahead = heading(simulation, i, mark.aim);
    if ahead == Vector::zeros() {
        return "it stands where it wants to be, and does not leave there".to_owned();
    }
    let blockers = blockers(simulation, i, ahead);
    // Before a door, where agents still leave, others are the cause, not the wall beside the door.
    if let Aim::Goal(goal) = mark.aim
        && scene.ways.is_none()
        && is_between(walls, p, goal)
        && (blockers.is_none() || !agents_leave(simulation))
    {
        return "a wall lies between it and its goal, and `navigation` is `straight`".to_owned();
    }
    let pressing = walls_ahead(simulation, i, ahead);
    let is_wedged = |a: &Vector| pressing.iter().any(|b| ahead.perp(a) * ahead.perp(b) < 0.0);
    if pressing.iter().any(is_wedged) {
        return "the passage ahead is narrower than its body".to_owned();
    }
    if let Some(reason) = blockers {
        return reason;
    }
    match pressing.is_empty() {
        true => "the forces on it cancel out".to_owned(),
        false => "it walks against a wall".to_owned(),
    }
}

/// From agent `i` to the nearest points of walls that touch its body and lie ahead.
fn walls_ahead(simulation: &Simulation, i: usize, ahead: Vector) -> Vec<Vector> {
    let frame = simulation.frame();
    let (p, radius) = (frame.agents.position[i], frame.agents.radius[i]);
    let mut near = Vec::new();
    frame.walls.near(p, radius + TOUCH, &mut near);
    let to_points = near
        .iter()
        .map(|&k| frame.walls.wall(k).nearest_point(p).point - p);
    to_points.filter(|to| to.dot(&ahead) > 0.0).collect()
}

/// Why the goal cannot be reached from `p` at all.
fn unreachable(simulation: &Simulation, p: Vector, mark: &Mark) -> Option<String> {
    let (scene, walls) = (simulation.scene(), simulation.frame().walls);
    match mark.aim {
        Aim::Place(_, number) => {
            let place = &scene.journeys.places[usize::from(number)];
            let (kind, name) = (place.kind.name(), shown(&place.name));
            let state = simulation.progress().places.get(usize::from(number));
            if matches!(place.kind, Kind::Exit(_)) && state.is_some_and(|state| !state.open) {
                return Some(format!("the exit `{name}` is closed"));
            }
            (!mark.length.is_finite()).then(|| format!("no way leads to the {kind} `{name}`"))
        }
        Aim::Goal(goal) if walls.obstacle_at(goal).is_some() && is_between(walls, p, goal) => Some(
            format!("its goal ({}, {}) lies inside an obstacle", goal.x, goal.y),
        ),
        Aim::Goal(goal) if !mark.length.is_finite() => {
            Some(format!("no way leads to its goal ({}, {})", goal.x, goal.y))
        }
        Aim::Goal(_) | Aim::Direction(_) => None,
    }
}

/// The direction in which agent `i` wants to walk; zero if it wants to stay.
fn heading(simulation: &Simulation, i: usize, aim: Aim) -> Vector {
    let frame = simulation.frame();
    let preferred = frame.fields.preferred_velocity.get(i).copied();
    direction(preferred.unwrap_or_else(|| match aim {
        Aim::Goal(goal) => goal - frame.agents.position[i],
        Aim::Direction(along) => along,
        Aim::Place(..) => Vector::zeros(),
    }))
}

/// Which agents stand before agent `i` in the direction `ahead`, if any do.
fn blockers(simulation: &Simulation, i: usize, ahead: Vector) -> Option<String> {
    let frame = simulation.frame();
    let agents = frame.agents;
    let (p, radius) = (agents.position[i], agents.radius[i]);
    let blocks = |&(j, from): &(usize, Vector)| {
        let way = agents.position[j] - from;
        let near = AHEAD * (radius + agents.radius[j]);
        j != i && way.norm() < near && way.dot(&ahead) > CONE * way.norm()
    };
    let reach = 2.0 * AHEAD * radius.max(RADIUS_RANGE[1]);
    let around = frame.neighbors.around(p, reach).flat_map(|run| {
        let from = frame.neighbors.seen_from(p, run.laps);
        run.agents.map(move |j| (j as usize, from))
    });
    let found: Vec<usize> = around.filter(blocks).map(|(j, _)| j).collect();
    let against = |&&j: &&usize| {
        let theirs = frame.fields.preferred_velocity.get(j);
        theirs.is_some_and(|theirs| theirs.dot(&ahead) < 0.0)
    };
    if found.is_empty() {
        return None;
    }
    Some(match found.iter().filter(against).count() {
        0 => "other agents block its way".to_owned(),
        _ => "agents that walk the other way block it".to_owned(),
    })
}

/// Have agents left during the time after which agents are stuck?
fn agents_leave(simulation: &Simulation) -> bool {
    let now = simulation.frame().clock.time();
    let last = simulation.outcome().arrivals.last();
    last.is_some_and(|last| now - last.time < STUCK_AFTER)
}

/// Does a wall cross the straight line from `p` to `q`?
fn is_between(walls: &Walls, p: Vector, q: Vector) -> bool {
    let near = walls.near_any(&[p, q], 0.0);
    walls.first_crossing(p, q, &near).is_some()
}

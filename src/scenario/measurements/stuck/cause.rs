//! Why an agent makes no headway: a likely cause, from what lies between it and its goal.

use super::super::aim::Aim;
use super::{STUCK_AFTER, left};
use crate::error::numbers::tidy;
use crate::error::quote::shown;
use crate::measurements::passages::Openings;
use engine::agents::RADIUS_RANGE;
use engine::geometry::Walls;
use engine::journeys::{ChangeKind, Door, Kind};
use engine::math::{Vector, direction, perpendicular};
use engine::routes::side;
use engine::simulation::Simulation;

/// Agents whose centers are this far ahead touch, or almost, as a multiple of the sum of the radii.
const TOUCHING: f64 = 1.25;
/// Agents this far ahead slow those who follow, as a multiple of the sum of the radii.
const FOLLOWED: f64 = 3.0;
/// An agent is ahead if its direction is within this cosine of the direction of walking: 60°. It walks the other way if
/// the same is true of it.
const CONE: f64 = 0.5;
/// Two agents are exactly head-on if nothing leads them this far aside, meters and m/s.
const HEAD_ON: f64 = 1e-4;
/// Exits that pass this part of what they may hold people back by their limit.
const USED: f64 = 0.8;
/// Bodies that overlap a wall by less than this only touch it, meters.
const TOUCH: f64 = 0.01;

/// The likely cause, in words.
pub fn of(simulation: &Simulation, i: usize, aim: Aim, doors: &Openings) -> String {
    tidy(&likely(simulation, i, aim, doors))
}

fn likely(simulation: &Simulation, i: usize, aim: Aim, doors: &Openings) -> String {
    let (scene, frame) = (simulation.scene(), simulation.frame());
    let (agents, walls) = (frame.agents, frame.walls);
    let p = agents.position[i];
    if scene.pace(agents, i, frame.clock.time()) == 0.0 {
        return "its preferred speed is 0".to_owned();
    }
    if let Some(reason) = unreachable(simulation, p, aim) {
        return reason;
    }
    if let Some(reason) = shut(simulation, doors.doors_ahead(simulation, (i, aim))) {
        return reason;
    }
    let ahead = heading(simulation, i, aim);
    let leaving = leaving(simulation, aim);
    let limit = limit(simulation, aim, leaving);
    if ahead == Vector::zeros() {
        if let Some(limit) = limit {
            return limit;
        }
        return "it stands where it wants to be, and does not leave there".to_owned();
    }
    let touching = blockers(simulation, i, TOUCHING, (aim, ahead));
    // Before a door, where agents still leave, others are the cause, not the wall beside the door.
    if let Aim::Goal(goal) = aim
        && scene.routes.is_none()
        && is_between(walls, p, goal)
        && (touching.is_none() || leaving == 0)
    {
        return "a wall lies between it and its goal, and it walks straight".to_owned();
    }
    let pressing = walls_ahead(simulation, i, ahead);
    if are_on_both_sides(&pressing, ahead, 2.0 * agents.radius[i]) {
        return "the passage ahead is narrower than its body".to_owned();
    }
    let followed = || blockers(simulation, i, FOLLOWED, (aim, ahead));
    match touching.or_else(|| followed().filter(|_| pressing.is_empty())) {
        Some(Blockers::Others) => limit.unwrap_or_else(|| others(simulation, aim, leaving)),
        Some(Blockers::HeadOn) => {
            "two agents exactly head-on block each other; move one by a centimeter".to_owned()
        }
        Some(Blockers::Against) => {
            "agents that walk the other way block it; in narrow places that can last for good"
                .to_owned()
        }
        None if pressing.is_empty() => {
            limit.unwrap_or_else(|| "the forces on it cancel out".to_owned())
        }
        None => "it walks against a wall".to_owned(),
    }
}

/// That others block the way of an agent, in a crowd of which `leaving` have left in the last seconds.
fn others(simulation: &Simulation, aim: Aim, leaving: usize) -> String {
    if leaving == 0 {
        return "others block its way".to_owned();
    }
    let to = named(simulation, aim).map_or(String::new(), |name| format!(" by {name}"));
    format!(
        "others block its way, in a crowd that moves: {leaving} left{to} in the last {STUCK_AFTER} s"
    )
}

/// Whether two of these points stand less than `width` apart, on both sides of the direction `ahead`.
fn are_on_both_sides(points: &[Vector], ahead: Vector, width: f64) -> bool {
    let is_wedged = |a: &Vector| {
        let wedges = |b: &Vector| ahead.perp(a) * ahead.perp(b) < 0.0 && (a - b).norm() < width;
        points.iter().any(wedges)
    };
    points.iter().any(is_wedged)
}

/// How an exit holds people back that passes a limited number per second, if it does so now, or if nearly as many as it
/// passes, `leaving`, have left in the last seconds.
fn limit(simulation: &Simulation, aim: Aim, leaving: usize) -> Option<String> {
    let Aim::Place(number) = aim else {
        return None;
    };
    let place = &simulation.scene().journeys.places[usize::from(number)];
    let Kind::Exit(exit) = &place.kind else {
        return None;
    };
    let (rate, ready) = (
        exit.most_per_sec?,
        simulation.progress().places[usize::from(number)].ready,
    );
    let is_used = leaving as f64 >= USED * rate * STUCK_AFTER;
    (is_used || simulation.frame().clock.time() < ready).then(|| {
        format!(
            "the exit `{}` lets one person pass every {:.1} s (`most_per_sec` {rate})",
            shown(&place.name),
            1.0 / rate
        )
    })
}

/// From agent `i` to the nearest points of walls that touch its body and lie ahead.
fn walls_ahead(simulation: &Simulation, i: usize, ahead: Vector) -> Vec<Vector> {
    let frame = simulation.frame();
    let (p, radius) = (frame.agents.position[i], frame.agents.radius[i]);
    let mut near = Vec::new();
    frame.walls.near(p, radius + TOUCH, &mut near);
    let numbers = near.iter();
    let to_points = numbers.map(|&k| frame.walls.wall(k).nearest_point(p).point - p);
    to_points.filter(|to| to.dot(&ahead) > 0.0).collect()
}

/// Why the goal cannot be reached from `p` at all.
fn unreachable(simulation: &Simulation, p: Vector, aim: Aim) -> Option<String> {
    let (scene, walls) = (simulation.scene(), simulation.frame().walls);
    let has_way = left(simulation, p, aim).is_some();
    match aim {
        Aim::Place(number) => {
            let place = &scene.journeys.places[usize::from(number)];
            let (kind, name) = (place.kind.name(), shown(&place.name));
            if matches!(place.kind, Kind::Exit(_))
                && let Some(closed) = closed(simulation, number)
            {
                return Some(format!("the exit `{name}` {closed}"));
            }
            (!has_way).then(|| format!("no way leads to the {kind} `{name}`"))
        }
        Aim::Goal(goal) if walls.obstacle_at(goal).is_some() && is_between(walls, p, goal) => Some(
            format!("its goal ({}, {}) lies inside an obstacle", goal.x, goal.y),
        ),
        Aim::Goal(goal) if !has_way => {
            Some(format!("no way leads to its goal ({}, {})", goal.x, goal.y))
        }
        Aim::Goal(_) | Aim::Direction(_) => None,
    }
}

/// Why the doors on the way of an agent let nobody pass, each with a point of the way before it.
fn shut(simulation: &Simulation, doors: Vec<(u16, Vector)>) -> Option<String> {
    let shut = |(number, before): (u16, Vector)| {
        let place = &simulation.scene().journeys.places[usize::from(number)];
        let name = shown(&place.name);
        if let Some(closed) = closed(simulation, number) {
            return Some(format!("the door `{name}` {closed}"));
        }
        let Kind::Door(Door { line, one_way }) = place.kind else {
            return None;
        };
        let is_against = one_way && side(line[0], line[1], before) < 0.0;
        is_against.then(|| format!("the door `{name}` lets people pass only the other way"))
    };
    doors.into_iter().find_map(shut)
}

/// That an exit or door is closed, or was until a short time ago; `None` if it was open for longer.
fn closed(simulation: &Simulation, number: u16) -> Option<String> {
    let state = simulation.progress().places.get(usize::from(number))?;
    if !state.open {
        return Some(format!("is closed{}", until(simulation, number)));
    }
    let now = simulation.frame().clock.time();
    let changes = simulation.scene().journeys.changes.iter();
    let before = changes.filter(|change| change.place == number && change.at <= now);
    let mut latest = before.rev();
    let (opened, closed) = (latest.next()?, latest.next()?);
    let is_recent = opened.kind == ChangeKind::Open
        && closed.kind == ChangeKind::Close
        && now - opened.at < 0.5 * STUCK_AFTER;
    is_recent.then(|| format!("was closed until {} s", opened.at))
}

/// Until when a closed exit or door is closed, with a blank before it; empty if it does not open again.
fn until(simulation: &Simulation, number: u16) -> String {
    let now = simulation.frame().clock.time();
    let mut changes = simulation.scene().journeys.changes.iter();
    let opens = changes.find(|change| {
        change.place == number && change.kind == ChangeKind::Open && change.at > now
    });
    opens.map_or(String::new(), |change| format!(" until {} s", change.at))
}

/// The direction in which agent `i` wants to walk; zero if it wants to stay.
fn heading(simulation: &Simulation, i: usize, aim: Aim) -> Vector {
    let frame = simulation.frame();
    let preferred = frame.fields.preferred_velocity.get(i).copied();
    direction(preferred.unwrap_or_else(|| match aim {
        Aim::Goal(goal) => goal - frame.agents.position[i],
        Aim::Direction(along) => along,
        Aim::Place(_) => Vector::zeros(),
    }))
}

/// What blocks an agent.
enum Blockers {
    /// Other agents.
    Others,
    /// Some of them walk the other way.
    Against,
    /// One that comes exactly toward it, on the same line.
    HeadOn,
}

/// Whether agents within `far` times the sum of the radii stand before agent `i`, which walks to `aim`, first in the
/// direction `ahead`.
fn blockers(
    simulation: &Simulation,
    i: usize,
    far: f64,
    (aim, ahead): (Aim, Vector),
) -> Option<Blockers> {
    let frame = simulation.frame();
    let agents = frame.agents;
    let (p, radius) = (agents.position[i], agents.radius[i]);
    let blocks = |&(j, from): &(usize, Vector)| {
        let way = agents.position[j] - from;
        let near = far * (radius + agents.radius[j]);
        j != i && way.norm() < near && way.dot(&ahead) > CONE * way.norm()
    };
    let reach = 2.0 * far * radius.max(RADIUS_RANGE[1]);
    let around = frame.neighbors.around(i, &agents.position, reach);
    let around = around.flat_map(|run| {
        let from = frame.neighbors.seen_from(p, run.laps);
        run.agents.map(move |j| (j as usize, from))
    });
    let found: Vec<(usize, Vector)> = around.filter(blocks).collect();
    // Each wants to be where the other one is.
    let is_nearer = |aim: Aim, from: Vector, to: Vector| {
        let lengths = left(simulation, from, aim).zip(left(simulation, to, aim));
        lengths.is_some_and(|(before, after)| before - after > CONE * (to - from).norm())
    };
    let against = |&(j, from): &(usize, Vector)| {
        let there = agents.position[j];
        let theirs = super::aim(simulation, j);
        theirs.is_some_and(|theirs| is_nearer(theirs, there, from)) && is_nearer(aim, from, there)
    };
    if found.is_empty() {
        return None;
    }
    let is_head_on = match found[..] {
        [(j, from)] => are_head_on(simulation, [i, j], (from, ahead)),
        _ => false,
    };
    Some(match found.iter().any(against) {
        true if is_head_on => Blockers::HeadOn,
        true => Blockers::Against,
        false => Blockers::Others,
    })
}

/// Whether agent j stands exactly on the line ahead of agent i, seen `from` there, and walls leave room for both to
/// pass.
fn are_head_on(
    simulation: &Simulation,
    [i, j]: [usize; 2],
    (from, ahead): (Vector, Vector),
) -> bool {
    let frame = simulation.frame();
    let (agents, walls) = (frame.agents, frame.walls);
    let way = agents.position[j] - from;
    let speeds = [agents.velocity[i], agents.velocity[j]];
    let aside = speeds.map(|speed| ahead.perp(&speed).abs());
    let (p, width) = (
        agents.position[i],
        2.0 * (agents.radius[i] + agents.radius[j]),
    );
    let free = |side: Vector| {
        let end = p + side * width;
        let crossed = walls.first_crossing(p, end, &walls.near_any(&[p, end], 0.0));
        crossed.map_or(width, |(share, _)| share * width)
    };
    let side = perpendicular(ahead);
    let is_on_line = ahead.perp(&way).abs() < HEAD_ON && aside[0].max(aside[1]) < HEAD_ON;
    is_on_line && free(side) + free(-side) > width
}

/// How many agents have left at an aim during the time after which agents are stuck.
fn leaving(simulation: &Simulation, aim: Aim) -> usize {
    let now = simulation.frame().clock.time();
    let arrivals = simulation.outcome().arrivals.iter().rev();
    let recent = arrivals.take_while(|arrival| now - arrival.time < STUCK_AFTER);
    let left_there = recent.filter(|arrival| match aim {
        Aim::Place(place) => arrival.trip.is_some_and(|trip| trip.exit == place),
        Aim::Goal(_) => arrival.trip.is_none(),
        Aim::Direction(_) => false,
    });
    left_there.count()
}

/// What messages call an exit.
fn named(simulation: &Simulation, aim: Aim) -> Option<String> {
    let Aim::Place(number) = aim else {
        return None;
    };
    let place = &simulation.scene().journeys.places[usize::from(number)];
    Some(format!(
        "the {} `{}`",
        place.kind.name(),
        shown(&place.name)
    ))
}

/// Whether a wall crosses the straight line from `p` to `q`.
fn is_between(walls: &Walls, p: Vector, q: Vector) -> bool {
    let near = walls.near_any(&[p, q], 0.0);
    walls.first_crossing(p, q, &near).is_some()
}

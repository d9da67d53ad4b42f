//! Single exits, waypoints, queues and zones of a file → those of a scene.

use crate::error::{Problem, Under};
use crate::keys::places;
use crate::keys::shapes::{Point, Ring as GivenRing};
use engine::geometry::{Ring, Walls};
use engine::journeys::{Door, Exit, Kind, Place, Queue, Zone};
use engine::math::{Vector, direction};

/// Shorter lines are an error, meters.
pub const SHORTEST_LINE: f64 = 0.3;
/// Lengths may be off by this from rounding, meters.
const ROUNDING: f64 = 1e-6;
/// Default distance between people in a queue, meters.
const SPACING: f64 = 0.5;
/// A queue that goes on beyond its path ends this far before a wall, meters.
const TAIL_GAP: f64 = 0.3;
/// Farther walls do not end a queue, meters.
const LONGEST_TAIL: f64 = 1000.0;
/// Default radius of a waypoint, meters.
const WITHIN: f64 = 0.5;

/// The list of places of a kind, and the key of where such a place is.
fn keys_of(kind: &Kind) -> (&'static str, &'static str) {
    match kind {
        Kind::Exit(_) => ("exits", "line"),
        Kind::Line(_) => ("waypoints", "line"),
        Kind::Disk { .. } => ("waypoints", "at"),
        Kind::Waiting(_) => ("waiting_areas", "area"),
        Kind::Queue(_) => ("queues", "path"),
        Kind::Door(_) => ("doors", "line"),
    }
}

/// The key of where place number `k` is: `waypoints[0].at`.
pub fn key(places: &[Place], k: usize) -> String {
    let list = |place: &Place| keys_of(&place.kind).0;
    let (own, of_place) = keys_of(&places[k].kind);
    let before = places[..k].iter().filter(|place| list(place) == own);
    format!("{own}[{}].{of_place}", before.count())
}

/// An exit.
pub fn exit(given: &places::Exit) -> Result<Kind, Problem> {
    Ok(Kind::Exit(Exit {
        line: line(&given.line).under("line")?,
        most_per_sec: given.most_per_sec,
    }))
}

/// A door. People pass one-way doors from the left to the right of their lines.
pub fn door(given: &places::Door) -> Result<Kind, Problem> {
    let [a, b] = line(&given.line).under("line")?;
    let ahead = given.one_way.map(Vector::from);
    if ahead == Some(Vector::zeros()) {
        return Err(Problem::new("one_way", "must not be [0, 0]"));
    }
    let right = ahead.map(|way| (b - a).perp(&way));
    if right.is_some_and(|right| right.abs() <= ROUNDING * ahead.unwrap_or_default().norm()) {
        let reason =
            "points along the line; give the direction [x, y] in which people pass the door";
        return Err(Problem::new("one_way", reason));
    }
    let is_left = right.is_some_and(|right| right > 0.0);
    Ok(Kind::Door(Door {
        line: if is_left { [b, a] } else { [a, b] },
        one_way: given.one_way.is_some(),
    }))
}

/// A waypoint.
pub fn waypoint(given: &places::Waypoint) -> Result<Kind, Problem> {
    match (given.line, given.at) {
        (Some(ends), None) if given.within.is_none() => Ok(Kind::Line(line(&ends).under("line")?)),
        (None, Some(at)) => Ok(Kind::Disk {
            at: at.into(),
            within: given.within.unwrap_or(WITHIN),
        }),
        _ => {
            let reason = "give either `line`, or `at` and perhaps `within`";
            Err(Problem::new("", reason))
        }
    }
}

/// A queue among `walls`.
///
/// The queue goes on beyond its path up to a wall, or to one of `lines`: those of exits and entrances.
pub fn queue(given: &places::Queue, walls: &Walls, lines: &[[Vector; 2]]) -> Result<Kind, Problem> {
    let path: Vec<Vector> = given.path.iter().map(|&p| p.into()).collect();
    if path.len() < 2 {
        let reason = "needs at least 2 points: the front, and where the queue goes on";
        return Err(Problem::new("path", reason));
    }
    let mut length = 0.0;
    let mut tail = (path[0], Vector::zeros());
    for (k, pair) in path.windows(2).enumerate() {
        let way = pair[1] - pair[0];
        let problem = |reason| Err(Problem::new(format!("path[{k}]"), reason));
        if way == Vector::zeros() {
            return problem("the same point as the next one; remove one");
        }
        if first_wall(walls, pair[0], pair[1]).is_some() {
            return problem(
                "a wall stands between this point and the next; lead the path around it",
            );
        }
        length += way.norm();
        tail = (pair[1], direction(way) * LONGEST_TAIL);
    }
    let end = tail.0 + tail.1;
    let lines = lines.iter().filter_map(|line| meets([tail.0, end], *line));
    let limit = lines.chain(first_wall(walls, tail.0, end)).reduce(f64::min);
    length += limit.map_or(f64::INFINITY, |part| {
        (part * LONGEST_TAIL - TAIL_GAP).max(0.0)
    });
    let service = given.service_secs.times().under("service_secs")?;
    Ok(Kind::Queue(Queue {
        path,
        length,
        spacing: given.spacing.unwrap_or(SPACING),
        servers: given.servers.unwrap_or(1),
        mean_service: service.mean(),
        service,
    }))
}

/// The part of the way from `a` to `b` up to the first wall, if there is one.
fn first_wall(walls: &Walls, a: Vector, b: Vector) -> Option<f64> {
    let near = walls.near_any(&[a, b], 0.0);
    walls.first_crossing(a, b, &near).map(|(part, _)| part)
}

/// The part of the way from `a` to `b` up to a line, if it crosses it.
fn meets([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> Option<f64> {
    let (way, line) = (b - a, d - c);
    let cross = way.perp(&line);
    let [part, along] = [(c - a).perp(&line) / cross, (c - a).perp(&way) / cross];
    (cross != 0.0 && part > 0.0 && part <= 1.0 && (0.0..=1.0).contains(&along)).then_some(part)
}

/// A line that a person fits through.
fn line(given: &[Point; 2]) -> Result<[Vector; 2], Problem> {
    let [a, b] = given.map(Vector::from);
    let length = (b - a).norm();
    if length < SHORTEST_LINE - ROUNDING {
        let length = (length * 1e3).round() / 1e3;
        let reason = format!("{length} m long; no person fits through less than {SHORTEST_LINE} m");
        return Err(Problem::new("", reason));
    }
    Ok([a, b])
}

/// A ring of corners.
pub fn ring(GivenRing(given): &GivenRing) -> Result<Ring, Problem> {
    let points = given.iter().map(|&p| p.into()).collect();
    Ok(Ring::new(points)?)
}

/// Zone number `k`.
pub fn zone(k: usize, given: &places::Zone) -> Result<Zone, Problem> {
    let name = format!("zones[{k}]");
    let time = given.from_secs..given.until_secs.unwrap_or(f64::INFINITY);
    if time.is_empty() {
        let reason = "must be later than `from_secs`";
        return Err(Problem::new(format!("{name}.until_secs"), reason));
    }
    Ok(Zone {
        area: ring(&given.area).under(&format!("{name}.area"))?,
        name: given.name.clone().unwrap_or(name),
        speed_factor: given.speed_factor,
        motivation: given.motivation,
        time,
    })
}

//! The lifts of a building.

use crate::error::Problem;
use crate::error::Under;
use crate::error::quote::{shown, to_centimeters};
use crate::floor_plan::{Rings, parts_on_floor};
use crate::keys::places::Lift;
use crate::scene::places::ring;
use crate::scene::spots::even;
use engine::geometry::{Area, Ring, Walls};
use engine::journeys::{Lift as Built, Stop, WaitingArea};
use engine::levels::Levels;
use engine::math::{Vector, direction, perpendicular, sides};
use engine::routes::nearest_on;

/// At least this part of the cabin must lie on the floor of each level.
const ON_FLOOR: f64 = 0.98;
/// A side of the cabin is open if there is no wall this near to its middle, meters.
const OPEN: f64 = 0.1;
/// People enter the cabin from this far before its open side, meters.
const BEFORE: f64 = 0.3;
/// Spots in the cabin keep this distance from its sides, meters.
const FROM_SIDES: f64 = 0.15;
/// The densest spots in a cabin, P/m².
const DENSEST: f64 = 10.0;

/// A lift that stops at some waiting areas, each with the number of its place.
pub fn lift(
    given: &Lift,
    stops: &[(u16, &WaitingArea)],
    (walls, behind, levels): (&Walls, &Rings, &Levels),
) -> Result<Built, Problem> {
    let cabin = ring(&given.cabin).under("cabin")?;
    let mut built: Vec<Stop> = Vec::with_capacity(stops.len());
    for (k, &(place, waiting)) in stops.iter().enumerate() {
        let key = format!("stops[{k}]");
        let wait = middle(&waiting.area);
        let level = levels.level(wait);
        let sheet = &levels.all()[level];
        let name = shown(&sheet.name);
        if sheet.rise != Vector::zeros() {
            return Err(Problem::new(key, format!("`{name}` is no flat level")));
        }
        if built.iter().any(|stop| usize::from(stop.level) == level) {
            let reason = format!("a lift has one stop on `{name}`; remove the other");
            return Err(Problem::new(key, reason));
        }
        let way = levels.way(level as i32);
        let there = cabin.clone().moved(way);
        let on_floor = parts_on_floor(&there, walls, behind);
        let parts = on_floor.map_err(|error| Problem::new("cabin", error.to_string()))?;
        if parts.iter().map(Area::area).sum::<f64>() < ON_FLOOR * there.area() {
            let reason = format!(
                "must lie on the floor of each level, and a part of it is off the floor of `{name}`: add it to its \
                 `walkable_area`"
            );
            return Err(Problem::new("cabin", reason));
        }
        if there.contains(wait) || waiting.spots.iter().any(|&spot| there.contains(spot)) {
            let reason = "the waiting area reaches into the cabin: end it before that";
            return Err(Problem::new(key, reason));
        }
        let Some(entry) = entry(&there, walls, wait) else {
            let reason = format!("has walls on all sides on `{name}`: leave its entrance open");
            return Err(Problem::new("cabin", reason));
        };
        built.push(Stop {
            place,
            level: level as u16,
            height: sheet.height(levels.in_building(wait)),
            entry: entry - way,
        });
    }
    Ok(Built {
        spots: spots(&cabin, given.capacity)?,
        name: given.name.clone(),
        cabin,
        stops: built,
        speed: given.speed,
        door_secs: given.door_secs,
    })
}

/// The point from which people who wait at `wait` enter a cabin: before the middle of the nearest side without a wall.
fn entry(cabin: &Ring, walls: &Walls, wait: Vector) -> Option<Vector> {
    let middles =
        sides(cabin.points()).map(|(a, b)| ((a + b) / 2.0, perpendicular(direction(b - a))));
    let is_open = |&(p, _): &(Vector, Vector)| {
        let mut near = Vec::new();
        walls.near(p, OPEN, &mut near);
        let distance = |&k: &u32| (walls.wall(k).nearest_point(p).point - p).norm();
        !near.iter().map(distance).any(|distance| distance < OPEN)
    };
    let nearest = middles
        .filter(is_open)
        .min_by(|(p, _), (q, _)| (p - wait).norm().total_cmp(&(q - wait).norm()));
    nearest.map(|(p, aside)| match cabin.contains(p + aside * BEFORE) {
        true => p - aside * BEFORE,
        false => p + aside * BEFORE,
    })
}

/// Where people stand in a cabin.
fn spots(cabin: &Ring, capacity: u32) -> Result<Vec<Vector>, Problem> {
    let is_inside = |p: &Vector| {
        let mut distances = sides(cabin.points()).map(|(a, b)| (nearest_on(*p, a, b) - p).norm());
        cabin.contains(*p) && distances.all(|distance| distance >= FROM_SIDES)
    };
    let all: Vec<Vector> = even(cabin, DENSEST).filter(is_inside).collect();
    if all.len() < capacity as usize {
        let reason = format!(
            "a cabin of {} m² takes at most {}",
            to_centimeters(cabin.area()),
            all.len()
        );
        return Err(Problem::new("capacity", reason));
    }
    Ok(all[..capacity as usize].to_vec())
}

fn middle(area: &Ring) -> Vector {
    let points = area.points();
    points.iter().sum::<Vector>() / points.len() as f64
}

//! Checks that people can pass the lines of exits, and notes on lines of which much lies off the floor.

use libm::{cos, sin};
use std::f64::consts::TAU;

use crate::error::Problem;
use crate::error::quote::{shown, to_centimeters};
use crate::floor_plan::Rings;
use crate::scene::places;
use crate::scene::places::SHORTEST_LINE;
use engine::geometry::{Ring, Walls};
use engine::journeys::{Kind, Place};
use engine::math::{Vector, direction, perpendicular};
use engine::routes::{Floor, nearest_on};

/// The distance between the points of a line that are looked at, meters.
const STEP: f64 = 0.01;
/// On longer lines, this many points are looked at.
const MOST_STEPS: f64 = 1e4;
/// People pass a line where the floor reaches this far on both sides of it, meters.
const BESIDE: f64 = 0.1;
/// A line is at a floor that begins nearer than this, meters.
const NEAR: f64 = 0.02;
/// A note says how much of a line is off the floor if it is more than this part.
const MUCH: f64 = 0.1;
/// A door ends at a wall that is at most this many steps away, in one of these many directions.
const AT_WALL: u32 = 5;
const DIRECTIONS: u32 = 16;
/// Doors that are so near to each other, meters, over so many meters, are on one line.
const ON_LINE: f64 = 0.02;
const OVERLAP: f64 = 0.1;
/// The number of bisections that find the end of the floor between two points.
const HALVINGS: u32 = 20;

/// Checks that each exit and each door has a part on the floor that is wide enough for a person, and that doors end
/// at walls.
pub fn check(places: &[Place], floor: &Floor) -> Result<(), Problem> {
    check_apart(places)?;
    let [mut exits, mut doors] = [0, 0];
    for place in places {
        let (list, ends, count) = match &place.kind {
            Kind::Exit(exit) => ("exits", exit.line, &mut exits),
            Kind::Door(door) => ("doors", door.line, &mut doors),
            _ => continue,
        };
        let k = *count;
        *count += 1;
        let line = Line::new(floor, ends);
        if line.is_passable() {
            let others = places.iter().filter(|other| other.name != place.name);
            match line.open_end(others).filter(|_| list == "doors") {
                None => continue,
                Some([x, y]) => {
                    let name = shown(&place.name);
                    let reason = format!(
                        "people can walk around `{name}`: it ends at ({x}, {y}), not at a wall; draw it from wall to \
                         wall"
                    );
                    return Err(Problem::new(format!("{list}[{k}].line"), reason));
                }
            }
        }
        let name = shown(&place.name);
        let reason = match line.end_of_floor() {
            Some([x, y]) => format!(
                "no person can pass `{name}`: it leaves the walkable area, or meets an obstacle, at ({x}, {y}); end it \
                 there, or move what is in the way"
            ),
            None if line.is_at_floor(0.0) => format!(
                "no person can pass `{name}`: a wall or an obstacle is in the way; move it, or the line"
            ),
            None => format!(
                "`{name}` lies in an obstacle or outside of the walkable area; move it onto the floor"
            ),
        };
        return Err(Problem::new(format!("{list}[{k}].line"), reason));
    }
    Ok(())
}

/// Refuses a door on the line of another door or of an exit.
fn check_apart(places: &[Place]) -> Result<(), Problem> {
    let mut doors = on_one_line(places).filter(|(_, one, _)| is_door(one));
    let Some((k, door, other)) = doors.next() else {
        return Ok(());
    };
    let (name, other_name) = (shown(&door.name), shown(&other.name));
    let reason = match is_door(other) {
        true => format!(
            "`{name}` lies on the line of `{other_name}`: draw one door, with `one_way` and `closed_secs`, or move \
                 one of them"
        ),
        false => format!(
            "`{name}` lies on the line of the exit `{other_name}`, where people leave whatever the door says: give \
                 the exit the `closed_secs`, or move one of them"
        ),
    };
    Err(Problem::new(format!("doors[{k}].line"), reason))
}

/// Notes on exits on the lines of other exits.
pub fn doubled(places: &[Place]) -> Vec<String> {
    let exits = on_one_line(places).filter(|(_, one, other)| one.is_exit() && other.is_exit());
    let note = |(k, exit, other): (usize, &Place, &Place)| {
        format!(
            "exits[{k}].line: `{}` lies on the line of `{}`: people who may take both leave by the first one, and \
             widths and flows count twice; draw one exit, or move one of them",
            shown(&exit.name),
            shown(&other.name)
        )
    };
    exits.map(note).collect()
}

/// The exits, then the doors, that lie on the line of one before them; each with its number in its list.
fn on_one_line(places: &[Place]) -> impl Iterator<Item = (usize, &Place, &Place)> {
    let [exits, doors] = [Place::is_exit, is_door].map(|is_kind: fn(&Place) -> bool| {
        let all = places.iter().filter(move |place| is_kind(place));
        all.enumerate()
    });
    let all: Vec<(usize, &Place)> = exits.chain(doors).collect();
    let lines_before = all.clone();
    all.into_iter()
        .enumerate()
        .filter_map(move |(n, (k, one))| {
            let line = one.line()?;
            let mut before = lines_before[..n].iter();
            let (_, other) =
                before.find(|(_, other)| other.line().is_some_and(|o| overlap(line, o)))?;
            Some((k, one, *other))
        })
}

/// Whether the line from `a` to `b` lies on that with the other `ends`, over more than [`OVERLAP`] meters.
fn overlap([a, b]: [Vector; 2], ends: [Vector; 2]) -> bool {
    let (along, length) = (direction(b - a), (b - a).norm());
    let mut all = ends.iter();
    let near = all.all(|end| along.perp(&(end - a)).abs() <= ON_LINE);
    let [from, to] = ends.map(|end| along.dot(&(end - a)));
    near && from.max(to).min(length) - from.min(to).max(0.0) > OVERLAP
}

/// The problem of two doors whose lines cross near a point.
pub fn crossing(places: &[Place], at: Vector) -> Option<Problem> {
    let is_near = |&k: &usize| {
        let line = places[k].line().filter(|_| is_door(&places[k]));
        line.is_some_and(|[a, b]| (nearest_on(at, a, b) - at).norm() <= NEAR)
    };
    let mut near = (0..places.len()).filter(is_near);
    let (one, other) = (near.next()?, near.next()?);
    let [first, second] = [one, other].map(|k| shown(&places[k].name));
    let [x, y] = [at.x, at.y].map(to_centimeters);
    let reason = format!(
        "`{second}` crosses `{first}` near ({x}, {y}): move one of the two doors, or end it at the other"
    );
    Some(Problem::new(places::key(places, other), reason))
}

fn is_door(place: &Place) -> bool {
    matches!(place.kind, Kind::Door(_))
}

/// The line of a door up to the walls at which it ends.
pub fn up_to_walls([a, b]: [Vector; 2], walls: &Walls) -> [Vector; 2] {
    let along = direction(b - a);
    [(a, -along), (b, along)].map(|(end, away)| {
        if walls.obstacle_at(end + away * STEP).is_some() {
            return end;
        }
        let mut near = Vec::new();
        walls.near(end, f64::from(AT_WALL + 1) * STEP, &mut near);
        let points = near.iter().map(|&k| walls.wall(k).nearest_point(end).point);
        let distance = |p: &Vector| (p - end).norm();
        let nearest = points.min_by(|p, q| distance(p).total_cmp(&distance(q)));
        nearest.unwrap_or(end)
    })
}

/// Notes on exits of `places` of whose lines much lies in obstacles or outside of the walkable area as it is drawn,
/// without the floors `behind` exits and entrances.
pub fn notes(places: &[Place], floor: &Floor, behind: &Rings) -> Vec<String> {
    let ring = |points: &Vec<Vector>| Ring::new(points.clone()).ok();
    let behind: Vec<Ring> = behind.iter().filter_map(ring).collect();
    let note = |(k, place): (usize, &Place)| {
        let Kind::Exit(exit) = &place.kind else {
            return None;
        };
        let share = Line::new(floor, exit.line).share_off(&behind);
        (share > MUCH).then(|| {
            format!(
                "exits[{k}].line: {:.0} % of `{}` lies in obstacles or outside of the walkable area, where agents \
                 cannot pass; draw the line on the floor, or on its edge",
                100.0 * share,
                shown(&place.name)
            )
        })
    };
    places.iter().enumerate().filter_map(note).collect()
}

/// A line on a floor, as points in order.
struct Line<'a> {
    floor: &'a Floor,
    start: Vector,
    /// From one point to the next, meters.
    step: Vector,
    steps: u32,
    /// Of length 1.
    normal: Vector,
}

impl<'a> Line<'a> {
    fn new(floor: &'a Floor, [a, b]: [Vector; 2]) -> Self {
        let steps = ((b - a).norm() / STEP).clamp(1.0, MOST_STEPS).ceil();
        Self {
            floor,
            start: a,
            step: (b - a) / steps,
            steps: steps as u32,
            normal: perpendicular(direction(b - a)),
        }
    }

    fn at(&self, step: f64) -> Vector {
        self.start + self.step * step
    }

    /// Whether the floor reaches `distance` meters to the left and to the right of a point.
    fn sides(&self, step: f64, distance: f64) -> [bool; 2] {
        [1.0, -1.0].map(|sign| {
            let beside = self.at(step) + self.normal * (sign * distance);
            self.floor.locate(beside).is_some()
        })
    }

    /// An end of it that lies on the floor, at no wall and at no other door, meters, rounded to centimeters.
    fn open_end<'p>(&self, others: impl Iterator<Item = &'p Place> + Clone) -> Option<[f64; 2]> {
        let along = direction(self.step);
        let reach = f64::from(AT_WALL) * STEP;
        let is_open = |&end: &f64| {
            let end = self.at(end);
            let mut doors = others.clone().filter(|other| is_door(other));
            let is_at_door = doors.any(|door| {
                let line = door.line();
                line.is_some_and(|[a, b]| (nearest_on(end, a, b) - end).norm() <= reach)
            });
            let mut around = (0..AT_WALL * DIRECTIONS).map(|k| {
                let turn = TAU * f64::from(k % DIRECTIONS) / f64::from(DIRECTIONS);
                let way = along * cos(turn) + perpendicular(along) * sin(turn);
                end + way * (f64::from(k / DIRECTIONS + 1) * STEP)
            });
            !is_at_door && around.all(|p| self.floor.locate(p).is_some())
        };
        let end = [0.0, f64::from(self.steps)].into_iter().find(is_open)?;
        let p = self.at(end);
        Some([p.x, p.y].map(to_centimeters))
    }

    fn is_at_floor(&self, step: f64) -> bool {
        self.sides(step, NEAR) != [false; 2]
    }

    /// The part of it that is not at the floor without some areas.
    fn share_off(&self, areas: &[Ring]) -> f64 {
        let is_off = |k: &u32| {
            // Between points: at the ends, rounding decides.
            let p = self.at(f64::from(*k) + 0.5);
            let mut beside = [NEAR, -NEAR]
                .map(|distance| p + self.normal * distance)
                .into_iter();
            beside.all(|p| {
                self.floor.locate(p).is_none() || areas.iter().any(|area| area.contains(p))
            })
        };
        (0..self.steps).filter(is_off).count() as f64 / f64::from(self.steps)
    }

    /// Whether a part of it that people can pass is as long as the shortest line.
    fn is_passable(&self) -> bool {
        // At both ends, rounding may decide.
        let least = SHORTEST_LINE - 3.0 * self.step.norm();
        let mut length = 0.0;
        (0..=self.steps).any(|k| {
            let is_free = self.sides(f64::from(k), BESIDE) == [true; 2];
            length = if is_free {
                length + self.step.norm()
            } else {
                0.0
            };
            is_free && length - self.step.norm() >= least
        })
    }

    /// The point at which it first enters or leaves the floor, meters, rounded to centimeters; `None` if it does
    /// neither.
    fn end_of_floor(&self) -> Option<[f64; 2]> {
        let mut steps = 0..self.steps;
        let k = steps
            .find(|&k| self.is_at_floor(f64::from(k)) != self.is_at_floor(f64::from(k + 1)))?;
        let (mut low, mut high) = (f64::from(k), f64::from(k + 1));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match self.is_at_floor(middle) == self.is_at_floor(low) {
                true => low = middle,
                false => high = middle,
            }
        }
        let p = self.at(low);
        Some([p.x, p.y].map(to_centimeters))
    }
}

//! Walls without thickness: lines with floor on both sides become bodies.
//!
//! A plan may write a wall as a line: between two rooms, or within one. The union of the rooms knows nothing of it. So
//! each part of such a line that has floor on both sides becomes a body of [`THICKNESS`]; parts along the edge of the
//! floor are walls already, and doors leave the line open.

use super::error::FloorPlanError;
use super::kind::Kind;
use super::shape::{Form, SAME, Shape};
use super::unite;
use engine::geometry::{Area, AreaIndex, Polygon, PolygonError, Ring};
use engine::math::{Vector, bounds, direction, perpendicular, sides};

/// The thickness of walls that a file gives as lines, meters. Lines this near to each other are one.
pub const THICKNESS: f64 = 0.01;

/// Lines meet at a corner if the sine of the angle between them is at least this.
const SLANTED: f64 = 0.05;

/// A stretch of a line.
#[derive(Clone, Copy)]
struct Stretch {
    ends: [Vector; 2],
}

impl Stretch {
    fn at(&self, along: f64) -> Vector {
        let [a, b] = self.ends;
        a + (b - a) * along
    }

    fn length(&self) -> f64 {
        let [a, b] = self.ends;
        (b - a).norm()
    }

    fn direction(&self) -> Vector {
        let [a, b] = self.ends;
        direction(b - a)
    }

    /// The point of it that is nearest to `p`, as its part of the way from the first end to the second.
    fn nearest(&self, p: Vector) -> f64 {
        let [a, b] = self.ends;
        ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0)
    }

    fn distance(&self, p: Vector) -> f64 {
        (self.at(self.nearest(p)) - p).norm()
    }

    /// Whether the boxes around both are nearer than `reach` meters.
    fn is_near(&self, other: &Self, reach: f64) -> bool {
        let [low, high] = bounds(self.ends).unwrap_or_default();
        let [from, to] = bounds(other.ends).unwrap_or_default();
        let [one, another] = [from - high, low - to];
        one.max() < reach && another.max() < reach
    }

    /// The parts of the way at which it comes near another one, crosses it, or leaves it.
    fn cuts(&self, other: &Self) -> impl Iterator<Item = f64> {
        let ends = other.ends.map(|p| self.nearest(p));
        let ahead = self.ends[1] - self.ends[0];
        let across = perpendicular(other.direction());
        let (speed, begin) = (
            ahead.dot(&across),
            (other.ends[0] - self.ends[0]).dot(&across),
        );
        let offsets = [-THICKNESS, 0.0, THICKNESS].map(|offset| (begin + offset) / speed);
        ends.into_iter().chain(offsets)
    }
}

/// The stretches between successive points.
fn stretches(points: &[[f64; 2]]) -> impl Iterator<Item = Stretch> {
    let ends = points
        .windows(2)
        .map(|pair| [pair[0].into(), pair[1].into()]);
    let long = ends.filter(|[a, b]: &[Vector; 2]| (b - a).norm() > SAME);
    long.map(|ends| Stretch { ends })
}

/// Whether points are on a line, or lead there and back, so that they enclose nothing.
pub fn encloses_nothing(points: &[[f64; 2]]) -> bool {
    let mut path: Vec<Vector> = points.iter().map(|&p| p.into()).collect();
    let is_same = |a: &Vector, b: &Vector| (a - b).norm() < SAME;
    path.dedup_by(|next, last| is_same(last, next));
    while path.len() > 1 && path.last().is_some_and(|last| is_same(last, &path[0])) {
        path.pop();
    }
    let farthest = path.iter().copied().max_by(|a, b| {
        let [one, other] = [a, b].map(|p| (p - path[0]).norm());
        one.total_cmp(&other)
    });
    let Some(far) = farthest.filter(|far| path.len() > 1 && !is_same(far, &path[0])) else {
        return false;
    };
    let along = direction(far - path[0]);
    let is_straight = path.iter().all(|p| along.perp(&(p - path[0])).abs() < SAME);
    let count = path.len();
    is_straight || (1..count).all(|k| is_same(&path[k], &path[count - k]))
}

/// The bodies of the walls among `shapes` that are lines: of their parts with floor on both sides, or of all of them if
/// there is no floor.
pub fn bodies(shapes: &[Shape], floor: &[Area]) -> Result<Vec<Area>, FloorPlanError> {
    let lines = |kinds: &[Kind]| -> Vec<Stretch> {
        let all = shapes
            .iter()
            .filter(|shape| shape.form == Form::Line && kinds.contains(&shape.kind));
        all.flat_map(|line| line.rings.iter().flat_map(|points| stretches(points)))
            .collect()
    };
    let walls = lines(&[Kind::Wall]);
    if walls.is_empty() {
        return Ok(Vec::new());
    }
    let doors = lines(&[Kind::Door, Kind::Exit, Kind::Entrance]);
    let site = Site::new(floor, doors);
    let inner: Vec<Stretch> = walls
        .iter()
        .flat_map(|wall| site.parts(wall, Side::Within))
        .collect();
    let body = |wall: &Stretch| body(wall, inner.iter().chain(&site.edges));
    let bodies: Result<Vec<Area>, PolygonError> = inner.iter().map(body).collect();
    let bodies = bodies.map_err(|error| FloorPlanError::Geometry {
        place: "walls that are lines".to_owned(),
        reason: error.to_string(),
    })?;
    // A wall that is drawn twice stands once.
    unite::without(&bodies, &[])
}

/// The parts of lines on one side of the floor.
pub fn parts(lines: &[Vec<[f64; 2]>], floor: &[Area], side: Side) -> Vec<[Vector; 2]> {
    let site = Site::new(floor, Vec::new());
    let parts = lines.iter().flat_map(|points| stretches(points));
    parts
        .flat_map(|line| site.parts(&line, side))
        .map(|part| part.ends)
        .collect()
}

/// Where a part of a line lies.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// With floor on both sides.
    Within,
    /// With floor on one side.
    Edge,
}

/// The edges of areas.
fn edges(floor: &[Area]) -> Vec<Stretch> {
    let rings = floor.iter().flat_map(Area::rings);
    let ends = rings.flat_map(|ring| sides(ring.points()));
    ends.map(|(a, b)| Stretch { ends: [a, b] }).collect()
}

/// What surrounds walls that are lines.
struct Site<'a> {
    floor: AreaIndex<'a>,
    /// Whether everything is floor.
    is_open: bool,
    edges: Vec<Stretch>,
    doors: Vec<Stretch>,
}

impl<'a> Site<'a> {
    fn new(floor: &'a [Area], doors: Vec<Stretch>) -> Self {
        Self {
            floor: AreaIndex::new(floor),
            is_open: floor.is_empty(),
            edges: edges(floor),
            doors,
        }
    }

    fn is_floor(&self, p: Vector) -> bool {
        self.is_open || !self.floor.around(p).is_empty()
    }

    /// The parts of a wall on this side of the floor, and no door in them.
    fn parts(&self, wall: &Stretch, side: Side) -> Vec<Stretch> {
        let near = |other: &&Stretch| wall.is_near(other, 2.0 * THICKNESS);
        let edges: Vec<&Stretch> = self.edges.iter().filter(near).collect();
        let doors: Vec<&Stretch> = self.doors.iter().filter(near).collect();
        let others = edges.iter().chain(&doors);
        let mut cuts: Vec<f64> = others.flat_map(|other| wall.cuts(other)).collect();
        cuts.retain(|cut| *cut > 0.0 && *cut < 1.0);
        cuts.extend([0.0, 1.0]);
        cuts.sort_by(f64::total_cmp);
        let aside = perpendicular(wall.direction()) * (1.5 * THICKNESS);
        let wanted = if side == Side::Within { 2 } else { 1 };
        let is_there = |middle: Vector| {
            let beside = [middle + aside, middle - aside].into_iter();
            let is_door = doors.iter().any(|door| door.distance(middle) < THICKNESS);
            !is_door && beside.filter(|&p| self.is_floor(p)).count() == wanted
        };
        let mut inner: Vec<[f64; 2]> = Vec::new();
        for part in cuts
            .windows(2)
            .filter(|part| (part[1] - part[0]) * wall.length() > SAME)
        {
            if !is_there(wall.at(0.5 * (part[0] + part[1]))) {
                continue;
            }
            match inner
                .last_mut()
                .filter(|last| (part[0] - last[1]) * wall.length() <= SAME)
            {
                Some(last) => last[1] = part[1],
                None => inner.push([part[0], part[1]]),
            }
        }
        let long = inner
            .into_iter()
            .filter(|[from, to]| (to - from) * wall.length() > THICKNESS);
        let ends = long.map(|part| Stretch {
            ends: part.map(|along| wall.at(along)),
        });
        ends.collect()
    }
}

/// A body around a wall. An end that meets one of the `others` reaches to its far side, so that no slit remains.
fn body<'a>(
    wall: &Stretch,
    others: impl Iterator<Item = &'a Stretch>,
) -> Result<Area, PolygonError> {
    let ahead = wall.direction();
    let mut reach: [Option<f64>; 2] = [None; 2];
    let near = others.filter(|other| wall.is_near(other, 2.0 * THICKNESS));
    // Lines that go on in the same direction, or are drawn twice, leave no slit.
    for other in near.filter(|other| ahead.perp(&other.direction()).abs() > SLANTED) {
        for (end, reach) in wall.ends.into_iter().zip(&mut reach) {
            let gap = other.distance(end);
            if gap < THICKNESS {
                *reach = Some(reach.map_or(gap, |known| known.min(gap)));
            }
        }
    }
    let [before, after] = reach.map(|gap| gap.map_or(0.0, |gap| gap + 0.5 * THICKNESS));
    let [a, b] = [wall.ends[0] - ahead * before, wall.ends[1] + ahead * after];
    let aside = perpendicular(ahead) * (0.5 * THICKNESS);
    let ring = Ring::new(vec![a - aside, b - aside, b + aside, a + aside])?;
    let area = Area {
        exterior: ring,
        holes: Vec::new(),
    };
    Polygon::filling(area.clone()).map(|_| area)
}

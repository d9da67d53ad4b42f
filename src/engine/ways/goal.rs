//! What sees a goal: corners, and the parts of triangles from which agents go straight to it.

use super::WayError;
use super::corner::Bend;
use super::entries::Target;
use super::expansion::{Eye, Sight, View, expand};
use super::floor::Floor;
use super::mesh::{nearest_on, side};
use crate::engine::math::{Vector, perpendicular};

/// Where agents want to go.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// A point, meters.
    Point(Vector),
    /// Any point of a line, meters.
    Line([Vector; 2]),
}

/// What sees some goals.
pub struct Seen {
    /// The parts of triangles from which agents go straight to a goal.
    pub views: Vec<(u32, Target, View)>,
    /// The length of the way from each bend, meters; infinite for bends that do not see a goal.
    pub from_bend: Vec<f64>,
}

impl Seen {
    /// What sees `goals`. Lines are shortened by `margin` meters at both ends.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn new(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        let mut seen = Self {
            views: Vec::new(),
            from_bend: vec![f64::INFINITY; 2 * floor.corners.len()],
        };
        for goal in goals {
            match *goal {
                Goal::Point(point) => {
                    let found = seen.look_from(floor, point);
                    found.ok_or(WayError::NotOnFloor(point))?;
                }
                Goal::Line(line) => {
                    let pieces = free_parts(floor, line);
                    if pieces.is_empty() {
                        return Err(WayError::NotOnFloor(line[0]));
                    }
                    for piece in pieces {
                        let [a, b] = shortened(piece, margin);
                        seen.look_from(floor, a);
                        seen.look_from(floor, b);
                        seen.look_across(floor, [a, b]);
                    }
                }
            }
        }
        Ok(seen)
    }

    /// Adds everything that sees a point of the goal; `None` if it is not on the floor.
    fn look_from(&mut self, floor: &Floor, point: Vector) -> Option<()> {
        let Self { views, from_bend } = self;
        let mesh = &floor.mesh;
        let t = floor.locate(point)?;
        let corners = mesh.corners(t);
        // From a point on a side, a view through this side would have no right and left border.
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let eye = Eye::Near(point + (middle - point) * INSIDE);
        let target = Target::Point(point);
        let mut sights = Vec::new();
        for side in 0..3 {
            let (right, left) = (corners[side], corners[(side + 1) % 3]);
            let view = View { eye, right, left };
            views.push((t, target, view));
            if let Some(next) = mesh.triangle(t).across[side] {
                let side = mesh.side_along(next, t);
                sights.push(Sight {
                    triangle: next,
                    side,
                    view,
                });
            }
            meet(floor, (t, side), point, false, from_bend);
        }
        let enter = |sight: &Sight| {
            views.push((sight.triangle, target, sight.view));
            true
        };
        let see = |t, k, _| meet(floor, (t, k), point, true, from_bend);
        expand(mesh, floor.least_width, sights, enter, see);
        Some(())
    }

    /// Adds everything from which the nearest point of the goal's line lies between its ends.
    fn look_across(&mut self, floor: &Floor, [a, b]: [Vector; 2]) {
        let Self { views, from_bend } = self;
        let mesh = &floor.mesh;
        let target = Target::Line([a, b]);
        let mut meet = |t: u32, k: usize, through: bool| {
            let nearest = nearest_on(mesh.corners(t)[k], a, b);
            meet(floor, (t, k), nearest, through, from_bend);
        };
        for t in 0..mesh.triangles().len() as u32 {
            let corners = mesh.corners(t);
            let Some(piece) = clipped([a, b], corners) else {
                continue;
            };
            for way in [perpendicular(b - a), -perpendicular(b - a)] {
                let view = looking(way, piece);
                views.push((t, target, view));
                for k in (0..3).filter(|&k| view.holds(corners[k])) {
                    meet(t, k, false);
                }
                let sights = (0..3).filter_map(|side| {
                    let next = mesh.triangle(t).across[side]?;
                    let ends = [corners[side], corners[(side + 1) % 3]];
                    let view = view.through(ends)?;
                    let side = mesh.side_along(next, t);
                    Some(Sight {
                        triangle: next,
                        side,
                        view,
                    })
                });
                let enter = |sight: &Sight| {
                    views.push((sight.triangle, target, sight.view));
                    true
                };
                let see = |t, k, _| meet(t, k, true);
                expand(mesh, floor.least_width, sights.collect(), enter, see);
            }
        }
    }
}

/// How far the eye of a point moves to the inside of its triangle, as a part of the distance to its middle.
const INSIDE: f64 = 1e-7;

/// Notes that the corner of the floor at corner k of triangle `t` sees `point` of the goal.
fn meet(floor: &Floor, (t, k): (u32, usize), point: Vector, through: bool, from_bend: &mut [f64]) {
    if let Some((c, i)) = floor.at[t as usize][k] {
        let corner = &floor.corners[c as usize];
        if let Some(turn) = corner.admits(&floor.mesh, i as usize, point, through) {
            let bend = Bend {
                corner: c,
                turn: turn.other(),
            };
            let rest = &mut from_bend[bend.index()];
            *rest = rest.min((corner.place - point).norm());
        }
    }
}

/// The view from a part of a line in the direction `way`.
fn looking(way: Vector, [a, b]: [Vector; 2]) -> View {
    let eye = Eye::Far(way);
    let [right, left] = if way.perp(&(b - a)) > 0.0 {
        [a, b]
    } else {
        [b, a]
    };
    View { eye, right, left }
}

/// The part of a segment in a triangle; `None` if it is empty or a point.
fn clipped([a, b]: [Vector; 2], corners: [Vector; 3]) -> Option<[Vector; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..3 {
        let ends = [corners[k], corners[(k + 1) % 3]];
        let [at_a, at_b] = [a, b].map(|p| side(ends[0], ends[1], p));
        if at_a < 0.0 && at_b < 0.0 {
            return None;
        }
        let crossing = at_a / (at_a - at_b);
        if at_a < 0.0 {
            from = from.max(crossing);
        } else if at_b < 0.0 {
            to = to.min(crossing);
        }
    }
    let at = |part: f64| a + (b - a) * part;
    (from < to).then(|| [at(from), at(to)])
}

/// The parts of a line on the floor, in order.
fn free_parts(floor: &Floor, [a, b]: [Vector; 2]) -> Vec<[Vector; 2]> {
    let along = b - a;
    let part = |p: Vector| (p - a).dot(&along) / along.norm_squared();
    let triangles = 0..floor.mesh.triangles().len() as u32;
    let pieces = triangles.filter_map(|t| clipped([a, b], floor.mesh.corners(t)));
    let mut pieces: Vec<[f64; 2]> = pieces.map(|piece| piece.map(part)).collect();
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for piece in pieces {
        match joined.last_mut() {
            Some(last) if piece[0] <= last[1] + GAP => last[1] = last[1].max(piece[1]),
            _ => joined.push(piece),
        }
    }
    let ends = joined.into_iter();
    ends.map(|ends| ends.map(|part| a + along * part)).collect()
}

/// Gaps between the parts of a line that come from rounding, as a part of its length.
const GAP: f64 = 1e-9;

/// A line that is shorter by `margin` at both ends, at least a hundredth of it.
fn shortened([a, b]: [Vector; 2], margin: f64) -> [Vector; 2] {
    let length = (b - a).norm();
    let part = (margin / length).min(0.495);
    [a + (b - a) * part, b - (b - a) * part]
}

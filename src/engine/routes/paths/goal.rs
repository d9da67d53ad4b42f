//! The visibility of goals: the corners that see a goal, and the parts of triangles from which agents walk straight to
//! it.

use super::targets::{Source, Targets};
use crate::math::{Vector, perpendicular};
use crate::routes::WayError;
use crate::routes::floor::{Bend, Border, Eye, Floor, Sight, View, expand, side};

/// Where agents want to go.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// A point, meters.
    Point(Vector),
    /// Any point of a line, meters.
    Line([Vector; 2]),
}

/// Everything that sees some goals.
pub struct Seen {
    /// The parts of the goals, and the lengths of the routes from bends, infinite for bends that do not see a goal.
    pub targets: Targets,
    /// The parts of triangles from which agents go straight to a part of a goal: triangle, number of the target, view.
    pub views: Vec<(u32, u32, View)>,
}

impl Seen {
    /// Finds everything that sees `goals`. Lines are shortened by `margin` meters at both ends. Lines off the floor,
    /// such as sides of a waiting area along a wall, are left out.
    ///
    /// # Errors
    /// A point, or all of the goals, is not on the floor.
    pub fn new(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        let bends = 2 * floor.corners.len();
        let mut seen = Self {
            targets: Targets {
                rest: vec![f64::INFINITY; bends],
                next: vec![0; bends],
                ..Targets::default()
            },
            views: Vec::new(),
        };
        let mut off = None;
        for goal in goals {
            match *goal {
                Goal::Point(point) => {
                    let found = seen.look_from(floor, point, point);
                    found.ok_or(WayError::NotOnFloor(point))?;
                }
                Goal::Line(line) => {
                    let pieces = free_parts(floor, line);
                    if pieces.is_empty() {
                        off = off.or(Some(line[0]));
                    }
                    for piece in pieces {
                        let [a, b] = shortened(piece, margin);
                        let middle = (a + b) / 2.0;
                        seen.look_from(floor, a, middle);
                        seen.look_from(floor, b, middle);
                        let on_level = floor.triangles_at(middle).collect();
                        let line = [a, b].map(|end| floor.in_building(end));
                        seen.look_across(floor, line, on_level);
                    }
                }
            }
        }
        match off.filter(|_| seen.targets.sources.is_empty()) {
            Some(point) => Err(WayError::NotOnFloor(point)),
            None => Ok(seen),
        }
    }

    /// Adds a part of a goal; returns its number.
    fn add(&mut self, source: Source) -> u32 {
        let targets = &mut self.targets;
        targets.sources.push(source);
        (targets.rest.len() + targets.sources.len() - 1) as u32
    }

    /// Expands `sights` from part `target` of the goal.
    fn follow(&mut self, floor: &Floor, target: u32, sights: Vec<Sight>) {
        let Self { views, targets } = self;
        let enter = |sight: &Sight| {
            views.push((sight.triangle, target, sight.view));
            true
        };
        let see = |t: u32, k: usize, _: Vector| meet(floor, (t, k), target, targets);
        expand(&floor.mesh, sights, enter, see);
    }

    /// Adds everything that sees `point`, which is a goal or an end of the line with this `middle`, in the plane;
    /// `None` if it is not on the floor.
    fn look_from(&mut self, floor: &Floor, point: Vector, middle: Vector) -> Option<()> {
        let mesh = &floor.mesh;
        let t = floor.locate(point)?;
        let [point, middle] = [point, middle].map(|p| floor.in_building(p));
        let corners = mesh.corners(t);
        // For a point on a side, the visible cone through this side would have no width.
        let inside = (corners[0] + corners[1] + corners[2]) / 3.0;
        let eye = point + (inside - point) * INSIDE;
        let target = self.add(Source::Point { point, eye, middle });
        let mut sights = Vec::new();
        for side in 0..3 {
            let view = View {
                eye: Eye::Near(eye),
                right: mesh.border(t, side),
                left: mesh.border(t, (side + 1) % 3),
            };
            self.views.push((t, target, view));
            sights.extend(Sight::beyond(mesh, (t, side), view));
            meet(floor, (t, side), target, &mut self.targets);
        }
        self.follow(floor, target, sights);
        Some(())
    }

    /// Adds everything that sees the goal's line on these triangles at a right angle: its nearest point lies between
    /// the ends of the line.
    fn look_across(&mut self, floor: &Floor, [a, b]: [Vector; 2], on: Vec<u32>) {
        let mesh = &floor.mesh;
        for away in [perpendicular(b - a), -perpendicular(b - a)] {
            let ends = [a, b];
            let target = self.add(Source::Line { ends, away });
            for &t in &on {
                let corners = mesh.corners(t);
                let Some(piece) = clipped([a, b], corners) else {
                    continue;
                };
                let view = self.looking(floor, away, piece);
                self.views.push((t, target, view));
                for k in (0..3).filter(|&k| view.holds(corners[k])) {
                    meet(floor, (t, k), target, &mut self.targets);
                }
                let sights = (0..3).filter_map(|side| {
                    let ends = [mesh.border(t, side), mesh.border(t, (side + 1) % 3)];
                    Sight::beyond(mesh, (t, side), view.through(ends)?)
                });
                self.follow(floor, target, sights.collect());
            }
        }
    }

    /// The view from a part of a line in the direction `away`.
    fn looking(&mut self, floor: &Floor, away: Vector, [a, b]: [Vector; 2]) -> View {
        let ends = if away.perp(&(b - a)) > 0.0 {
            [a, b]
        } else {
            [b, a]
        };
        let [right, left] = ends.map(|at| {
            let borders = &mut self.targets.borders;
            let number = (floor.borders() + borders.len()) as u32;
            borders.push(at);
            Border { at, number }
        });
        let eye = Eye::Far(away);
        View { eye, right, left }
    }
}

/// The eye of a point lies toward the middle of its triangle by this fraction of the distance.
const INSIDE: f64 = 1e-7;

/// Records that the floor's corner at corner k of triangle `t` sees part `target` of the goal.
fn meet(floor: &Floor, (t, k): (u32, usize), target: u32, targets: &mut Targets) {
    if let Some((c, i)) = floor.at[t as usize][k] {
        let corner = &floor.corners[c as usize];
        let point = targets.nearest(floor, target, corner.place);
        if let Some(turn) = corner.turn(&floor.mesh, i as usize, point) {
            let bend = Bend {
                corner: c,
                turn: turn.other(),
            };
            let length = (corner.place - point).norm();
            if length < targets.rest[bend.index()] {
                targets.rest[bend.index()] = length;
                targets.next[bend.index()] = target;
            }
        }
    }
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

/// The parts of a line in the plane on the floor, in order.
fn free_parts(floor: &Floor, [a, b]: [Vector; 2]) -> Vec<[Vector; 2]> {
    let along = b - a;
    let part = |p: Vector| (p - a).dot(&along) / along.norm_squared();
    let triangles = 0..floor.mesh.triangles().len() as u32;
    let pieces = triangles.filter_map(|t| clipped([a, b], floor.plane().corners(t)));
    let mut pieces: Vec<[f64; 2]> = pieces.map(|piece| piece.map(part)).collect();
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for piece in pieces {
        match joined.last_mut() {
            Some(last) if piece[0] <= last[1] + GAP => last[1] = last[1].max(piece[1]),
            _ => joined.push(piece),
        }
    }
    let is_long = |ends: &[f64; 2]| (ends[1] - ends[0]) * along.norm() > SHORTEST;
    if joined.iter().any(is_long) {
        joined.retain(is_long);
    }
    let ends = joined.into_iter();
    ends.map(|ends| ends.map(|part| a + along * part)).collect()
}

/// Shorter parts of a line, such as one that reaches over a wall by rounding, are no goals, meters.
const SHORTEST: f64 = 1e-5;
/// Smaller gaps between the parts of a line come from rounding, as a fraction of its length.
const GAP: f64 = 1e-9;

/// A line shortened by `margin` at both ends; at least a hundredth of it remains.
fn shortened([a, b]: [Vector; 2], margin: f64) -> [Vector; 2] {
    let length = (b - a).norm();
    let part = (margin / length).min(0.495);
    [a + (b - a) * part, b - (b - a) * part]
}

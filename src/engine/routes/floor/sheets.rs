//! Floors of a building with several levels: triangles that are glued at the joins.
//!
//! On a floor of one level the triangles lie where people are. Those of several levels lie at their places in the
//! building, above each other, so that straight ways lead on across joins; people are looked for in the plane in which
//! the levels lie side by side.

use std::sync::Arc;

use super::lines::{side, to_segment};
use super::mesh::Mesh;
use super::narrow::{Narrow, narrow};
use crate::geometry::Area;
use crate::levels::{Join, Levels};
use crate::math::{Vector, direction, perpendicular};
use crate::routes::WayError;

/// Points of two levels this near to each other are the same, meters.
const SAME: f64 = 1e-5;

/// Joins are too narrow if they are narrower than the least width by more than this, meters.
const ROUNDING: f64 = 1e-6;

/// Joins are drawn this far into the walls at their ends: by rounding, they could end just before them, meters.
const INTO_WALLS: f64 = 1e-3;

/// The triangles of several levels, side by side in the plane.
#[derive(Debug, Clone)]
pub struct Sheets {
    /// The triangles in the plane, with the same numbers as those that are glued. Joins are walls.
    pub mesh: Mesh,
    /// The same floors as they go on behind joins; `None` in rooms, where nobody looks for narrowings.
    pub whole: Option<Mesh>,
    /// The level of each triangle.
    pub level: Vec<usize>,
    /// The levels.
    pub levels: Arc<Levels>,
}

impl Sheets {
    /// Where a point of triangle `t` in the building lies in the plane, meters.
    pub fn in_plane(&self, t: u32, p: Vector) -> Vector {
        p + self.levels.way(self.level[t as usize] as i32)
    }

    /// The number of the join between two triangles that are glued, or closed, there; `None` on one level.
    pub fn join_between(&self, [one, other]: [u32; 2], ends: [Vector; 2]) -> Option<usize> {
        let [from, to] = [one, other].map(|t| self.level[t as usize] as i32);
        let ends = ends.map(|p| self.in_plane(one, p));
        let mut joins = self.levels.joins().iter();
        let found = joins.position(|join| {
            let [a, b] = join.line;
            let is_on = |p: &Vector| to_segment(*p, a, b) <= SAME;
            join.to == to - from && ends.iter().all(is_on)
        });
        found.filter(|_| from != to)
    }

    /// By how much the way from one place in triangle `t` to another takes longer than on a floor.
    pub fn effort(&self, t: u32, [from, to]: [Vector; 2]) -> f64 {
        let level = &self.levels.all()[self.level[t as usize]];
        1.0 / level.progress(direction(to - from))
    }
}

/// What lies on the two sides of joins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joins {
    /// People walk across those of at least this width, meters.
    Open(f64),
    /// They are closed like doors.
    Closed,
}

/// A side of a triangle along a join.
#[derive(Debug, Clone, Copy)]
struct Edge {
    triangle: u32,
    side: usize,
    /// Where it begins, meters from the beginning of the join.
    from: f64,
}

impl Mesh {
    /// Triangulates the floors of some levels, which lie side by side in the plane and go on for a while behind their
    /// joins. Returns the triangles at their places in the building, glued at the joins, and those in the plane.
    ///
    /// # Errors
    /// As [`new`](Self::new), or the floors on both sides of a join differ along it.
    pub fn glued(
        areas: &[Area],
        least_width: f64,
        levels: Arc<Levels>,
    ) -> Result<(Self, Sheets), WayError> {
        let open = Self::new(areas, 0.0)?;
        let mut closed = narrow(&open, least_width);
        closed.retain(|passage| !meets_join(passage.ends(&open), &levels));
        let whole = Self::new(areas, least_width)?;
        let (glued, sheets) =
            Self::glued_with(areas, (&closed, &[]), levels, Joins::Open(least_width))?;
        let sheets_with = Sheets {
            whole: Some(whole),
            ..sheets
        };
        Ok((glued, sheets_with))
    }

    /// The same with passages and lines that are closed.
    ///
    /// # Errors
    /// As [`glued`](Self::glued).
    pub fn glued_with(
        areas: &[Area],
        (passages, lines): (&[Narrow], &[[Vector; 2]]),
        levels: Arc<Levels>,
        joins: Joins,
    ) -> Result<(Self, Sheets), WayError> {
        let ends: Vec<[Vector; 2]> = levels.joins().iter().map(|join| join.line).collect();
        let joined = ends.iter().map(|&line| into_walls(line, &ends, areas));
        let drawn: Vec<[Vector; 2]> = joined.chain(lines.iter().copied()).collect();
        let divided = Self::divided(areas, passages, &drawn)?;
        let beyond = divided.beyond_joins(&levels);
        let mesh = divided.without(&beyond);
        let on_level = |t: u32| levels.level(mesh.middle(t));
        let level: Vec<usize> = (0..mesh.triangles.len() as u32).map(on_level).collect();
        let glued = mesh.joined(&levels, &level, joins)?;
        let sheets = Sheets {
            mesh,
            whole: None,
            level,
            levels,
        };
        Ok((glued, sheets))
    }

    /// The sides of own triangles along a join, in order.
    fn edges_at(&self, join: &Join) -> Vec<Edge> {
        let [a, b] = join.line;
        let along = direction(b - a);
        let mut edges = Vec::new();
        for (t, triangle) in (0..).zip(&self.triangles) {
            let corners = self.corners(t);
            for side in (0..3).filter(|&side| triangle.across[side].is_none()) {
                let ends = [corners[side], corners[(side + 1) % 3]];
                let is_on = ends.iter().all(|&end| to_segment(end, a, b) <= SAME);
                if is_on && (ends[1] - ends[0]).dot(&along) > 0.0 {
                    let from = (ends[0] - a).dot(&along);
                    edges.push(Edge {
                        triangle: t,
                        side,
                        from,
                    });
                }
            }
        }
        edges.sort_by(|one, other| one.from.total_cmp(&other.from));
        edges
    }

    /// Whether each triangle lies beyond a join: on the floor of another level.
    fn beyond_joins(&self, levels: &Levels) -> Vec<bool> {
        let mut is_beyond = vec![false; self.triangles.len()];
        let edges: Vec<Edge> = levels
            .joins()
            .iter()
            .flat_map(|join| self.edges_at(join))
            .collect();
        let is_join = |t: u32, side: usize| {
            edges
                .iter()
                .any(|edge| edge.triangle == t && edge.side == side)
        };
        let behind = |edge: &Edge| self.triangle(edge.triangle).closed[edge.side];
        let mut waiting: Vec<u32> = edges.iter().filter_map(behind).collect();
        while let Some(t) = waiting.pop() {
            if std::mem::replace(&mut is_beyond[t as usize], true) {
                continue;
            }
            for side in 0..3 {
                let next = self.triangle(t).beyond(side);
                // From beyond a join, its sides belong to the triangles on the other side.
                let is_back = next.is_some_and(|next| is_join(next, self.side_along(next, t)));
                if !is_back {
                    waiting.extend(next);
                }
            }
        }
        is_beyond
    }

    /// The triangles that are not `dropped`.
    fn without(&self, dropped: &[bool]) -> Self {
        let mut number: Vec<Option<u32>> = vec![None; dropped.len()];
        let kept = (0..dropped.len()).filter(|&t| !dropped[t]);
        for (new, old) in (0..).zip(kept) {
            number[old] = Some(new);
        }
        let renamed = |next: Option<u32>| next.and_then(|next| number[next as usize]);
        let kept = self
            .triangles
            .iter()
            .zip(dropped)
            .filter(|(_, dropped)| !**dropped);
        let triangles = kept.map(|(triangle, _)| {
            let mut triangle = triangle.clone();
            triangle.across = triangle.across.map(renamed);
            triangle.closed = triangle.closed.map(renamed);
            triangle
        });
        Self {
            points: self.points.clone(),
            triangles: triangles.collect(),
        }
    }

    /// The triangles at their places in the building, glued at the joins, or closed there.
    fn joined(&self, levels: &Levels, level: &[usize], joins: Joins) -> Result<Self, WayError> {
        let mut glued = self.clone();
        let mut same: Vec<u32> = (0..self.points.len() as u32).collect();
        for (t, triangle) in self.triangles.iter().enumerate() {
            let way = levels.way(level[t] as i32);
            for &corner in &triangle.corners {
                glued.points[corner as usize] = self.point(corner) - way;
            }
        }
        for join in levels.joins().iter().filter(|join| join.to > 0) {
            let beyond = Join {
                line: [1, 0].map(|end: usize| join.line[end] + levels.way(join.to)),
                to: -join.to,
            };
            let (own, other) = (self.edges_at(join), self.edges_at(&beyond));
            let width = (join.line[1] - join.line[0]).norm();
            let differ = || WayError::Join(join.line[0]);
            if own.is_empty() || own.len() != other.len() {
                return Err(differ());
            }
            for (one, two) in own.into_iter().zip(other.into_iter().rev()) {
                for (here, there) in [(one, two), (two, one)] {
                    let triangle = &mut glued.triangles[here.triangle as usize];
                    let beyond = match joins {
                        Joins::Open(least) if width > least - ROUNDING => &mut triangle.across,
                        Joins::Open(_) | Joins::Closed => &mut triangle.closed,
                    };
                    beyond[here.side] = Some(there.triangle);
                }
                let ends = |edge: Edge| {
                    let corners = self.triangle(edge.triangle).corners;
                    [corners[edge.side], corners[(edge.side + 1) % 3]]
                };
                let ([a, b], [c, d]) = (ends(one), ends(two));
                for (keep, drop) in [(a, d), (b, c)] {
                    let [p, q] = [keep, drop].map(|point| glued.point(point));
                    if (p - q).norm() > 2.0 * SAME {
                        return Err(differ());
                    }
                    let [one, other] = [keep, drop].map(|point| root(&same, point));
                    same[one.max(other) as usize] = one.min(other);
                }
            }
        }
        for triangle in &mut glued.triangles {
            triangle.corners = triangle.corners.map(|corner| root(&same, corner));
        }
        Ok(glued)
    }
}

/// A line that is longer at its ends, but for those at which another of all `lines` begins, and those on the floor, at
/// which an exit may begin.
fn into_walls([a, b]: [Vector; 2], lines: &[[Vector; 2]], areas: &[Area]) -> [Vector; 2] {
    let more = direction(b - a) * INTO_WALLS;
    let aside = perpendicular(more) * 0.5;
    [(a, -more), (b, more)].map(|(end, more)| {
        let is_end = |line: &&[Vector; 2]| line.iter().any(|other| (other - end).norm() <= SAME);
        let is_on_floor = [aside, -aside].iter().all(|aside| {
            let p = end + more + aside;
            areas.iter().any(|area| area.contains(p))
        });
        match lines.iter().filter(is_end).count() == 1 && !is_on_floor {
            true => end + more,
            false => end,
        }
    })
}

/// The point that stands for all that are the same.
fn root(same: &[u32], mut point: u32) -> u32 {
    while same[point as usize] != point {
        point = same[point as usize];
    }
    point
}

/// Whether a passage in the plane crosses a join, or lies on it.
pub fn meets_join(ends: [Vector; 2], levels: &Levels) -> bool {
    let mut joins = levels.joins().iter();
    joins.any(|join| meet(ends, join.line))
}

/// Whether a segment crosses a line, or lies on it.
fn meet([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    let lies_on = [a, b].into_iter().all(|end| to_segment(end, c, d) <= SAME);
    crosses || lies_on
}

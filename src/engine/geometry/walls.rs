//! All obstacles of a scene, with a spatial index of their walls.

use parry2d::bounding_volume::{Aabb, BoundingVolume};
use parry2d::partitioning::Bvh;

use super::{Polygon, Wall, WallPart, bounds_of, index_of, to_parry};
use crate::math::Vector;

/// Distance in front of a wall at which a move stops, meters: far above the rounding of coordinates up to
/// 10⁶ m, far below anything that matters to a person.
const CLEARANCE: f64 = 1e-6;

/// Radius of the first circle in which a way out of an obstacle is searched, meters.
const FIRST_REACH: f64 = 1.0;

/// Obstacles, their walls in order, and parry's bounding volume hierarchies over both.
#[derive(Debug, Clone)]
pub struct Walls {
    obstacles: Vec<Polygon>,
    walls: Vec<Wall>,
    obstacle_index: Bvh,
    /// Indices of the unbounded obstacles, which are solid outside their bounding boxes, too.
    unbounded: Vec<usize>,
    index: Bvh,
}

impl Walls {
    /// Numbers the edges of all obstacles in order, starting at 0.
    pub fn new(obstacles: Vec<Polygon>) -> Self {
        let mut walls = Vec::new();
        for (obstacle, polygon) in obstacles.iter().enumerate() {
            for ring in polygon.rings() {
                let first = walls.len();
                walls.extend((0..ring.len()).map(|k| {
                    let previous = first + (k + ring.len() - 1) % ring.len();
                    let end = ring[(k + 1) % ring.len()];
                    Wall::new(ring[k], end, obstacle as u32, previous as u32)
                }));
            }
        }
        let around = |polygon: &Polygon| bounds_of(polygon.points().iter().copied());
        let endless = obstacles.iter().enumerate();
        let endless = endless.filter(|(_, polygon)| polygon.is_unbounded());
        Self {
            unbounded: endless.map(|(k, _)| k).collect(),
            obstacle_index: index_of(obstacles.iter().map(around)),
            index: index_of(walls.iter().map(bounds_of_wall)),
            obstacles,
            walls,
        }
    }

    /// Whether there are no walls.
    pub fn is_empty(&self) -> bool {
        self.walls.is_empty()
    }

    /// The number of walls.
    pub fn len(&self) -> usize {
        self.walls.len()
    }

    /// Wall `k`.
    pub fn wall(&self, k: u32) -> &Wall {
        &self.walls[k as usize]
    }

    /// All walls in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Wall> {
        self.walls.iter()
    }

    /// The obstacles in the order given.
    pub fn obstacles(&self) -> &[Polygon] {
        &self.obstacles
    }

    /// Appends the walls with a point less than `radius` meters from `p`, in ascending order.
    pub fn near(&self, p: Vector, radius: f64, found: &mut Vec<u32>) {
        let first = found.len();
        let half = Vector::new(radius, radius);
        let reach = Aabb::new(to_parry(p - half), to_parry(p + half));
        found.extend(self.index.intersect_aabb(&reach).filter(|&k| {
            let nearest = self.wall(k).nearest_point(p).point;
            (nearest - p).norm_squared() < radius * radius
        }));
        found[first..].sort_unstable();
    }

    /// All walls with a point less than `radius` meters from any of `points`, and possibly others, in ascending
    /// order.
    pub fn near_any(&self, points: &[Vector], radius: f64) -> Vec<u32> {
        let reach = bounds_of(points.iter().copied()).loosened(radius);
        let mut found: Vec<u32> = self.index.intersect_aabb(&reach).collect();
        found.sort_unstable();
        found
    }

    /// The vectors to `p` from its nearest points on those of `candidates` whose free side it is on, with the wall. A
    /// corner belongs to two walls but counts once: for the wall that ends there.
    pub fn facing<'a>(
        &'a self,
        p: Vector,
        candidates: &'a [u32],
    ) -> impl Iterator<Item = (u32, Vector)> + 'a {
        candidates.iter().filter_map(move |&k| {
            let wall = self.wall(k);
            if !wall.faces(p) {
                return None;
            }
            let nearest = wall.nearest_point(p);
            let before = self.wall(wall.previous);
            let counted = nearest.part == WallPart::Start
                && before.faces(p)
                && before.nearest_point(p).part == WallPart::End;
            (!counted).then(|| (k, p - nearest.point))
        })
    }

    /// The fraction of the move `from` → `to` at which it first crosses one of the walls `candidates` from the
    /// wall's free side, and that wall; `None` if the way is free.
    pub fn first_crossing(
        &self,
        from: Vector,
        to: Vector,
        candidates: &[u32],
    ) -> Option<(f64, u32)> {
        candidates
            .iter()
            .filter_map(|&k| Some((self.wall(k).crossing(from, to)?, k)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The point at which the walls `candidates` stop a move from `from` to `to`, just in front of the first wall,
    /// and that wall; `None` if the way is free.
    pub fn stop(&self, from: Vector, to: Vector, candidates: &[u32]) -> Option<(Vector, u32)> {
        let (_, k) = self.first_crossing(from, to, candidates)?;
        let [before, after] = [from, to].map(|p| self.wall(k).signed_distance(p));
        // An agent already closer than the clearance does not move: rounding must never put it behind the wall.
        let free = (before - CLEARANCE).max(0.0) / (before - after);
        Some((from + (to - from) * free, k))
    }

    /// The point nearest to `p`, just in front of a wall, that lies in no obstacle. Candidates are the walls' points
    /// nearest to `p` and the points where two walls meet: corners of rooms and of overlapping obstacles.
    ///
    /// Beside a corner, the point in front of one wall can be on the line of the other, where rounding could let an
    /// agent through. Such points are taken only where there are no others, as in very narrow gaps.
    pub fn free_point_near(&self, p: Vector) -> Option<Vector> {
        let clear = self.free_point(p, 0.5 * CLEARANCE);
        clear.or_else(|| self.free_point(p, 0.0))
    }

    /// As [`free_point_near`](Self::free_point_near), `gap` meters from all walls.
    fn free_point(&self, p: Vector, gap: f64) -> Option<Vector> {
        let foot = self.free_foot(p, gap);
        let reach = foot.map_or(f64::INFINITY, |(distance, _)| distance);
        let corner = self.nearest_free(p, gap, self.corners_near(p, reach));
        let nearest = [foot, corner].into_iter().flatten();
        nearest
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, exit)| exit)
    }

    /// The nearest free point among the walls' points nearest to `p`, with its distance, meters. Searches in growing
    /// circles.
    fn free_foot(&self, p: Vector, gap: f64) -> Option<(f64, Vector)> {
        let mut reach = FIRST_REACH;
        let mut found = Vec::new();
        loop {
            found.clear();
            self.near(p, reach, &mut found);
            let feet = found.iter().map(|&k| {
                let wall = self.wall(k);
                wall.nearest_point(p).point + wall.normal * CLEARANCE
            });
            let foot = self.nearest_free(p, gap, feet.collect());
            let complete = found.len() == self.walls.len() || reach == f64::INFINITY;
            // Points lie `CLEARANCE` in front of their walls, so the point of a wall out of reach may be nearer by
            // that.
            if complete || foot.is_some_and(|(distance, _)| distance < reach - CLEARANCE) {
                return foot;
            }
            reach *= 2.0;
        }
    }

    /// The points just in front of two walls, where they meet; both have a point less than `reach` meters from `p`.
    fn corners_near(&self, p: Vector, reach: f64) -> Vec<Vector> {
        let mut near = Vec::new();
        self.near(p, reach, &mut near);
        let mut corners = Vec::new();
        let mut others: Vec<u32> = Vec::new();
        for &k in &near {
            let a = self.wall(k);
            others.clear();
            let meeting = bounds_of_wall(a).loosened(CLEARANCE);
            others.extend(self.index.intersect_aabb(&meeting).filter(|&j| j < k));
            others.retain(|j| near.binary_search(j).is_ok());
            others.sort_unstable();
            let crossings = others.iter().map(|&j| self.wall(j));
            corners.extend(crossings.filter_map(|b| a.corner_with(b, CLEARANCE)));
        }
        corners
    }

    /// The nearest to `p` of the `exits` outside all obstacles and `gap` meters from all walls, with its distance,
    /// meters.
    fn nearest_free(&self, p: Vector, gap: f64, exits: Vec<Vector>) -> Option<(f64, Vector)> {
        let distance = |exit: Vector| ((exit - p).norm(), exit);
        let mut exits: Vec<(f64, Vector)> = exits.into_iter().map(distance).collect();
        exits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut near = Vec::new();
        exits.into_iter().find(|&(_, exit)| {
            near.clear();
            self.near(exit, gap, &mut near);
            near.is_empty() && self.obstacle_at(exit).is_none()
        })
    }

    /// The index of the first obstacle that contains `p`.
    pub fn obstacle_at(&self, p: Vector) -> Option<usize> {
        let here = bounds_of([p]);
        let near = self.obstacle_index.intersect_aabb(&here);
        near.map(|k| k as usize)
            .chain(self.unbounded.iter().copied())
            .filter(|&k| self.obstacles[k].contains(p))
            .min()
    }
}

fn bounds_of_wall(wall: &Wall) -> Aabb {
    bounds_of([wall.start, wall.end])
}

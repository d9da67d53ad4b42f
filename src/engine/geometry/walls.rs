//! All obstacles of a scene, with a spatial index of their walls.

use parry2d::bounding_volume::{Aabb, BoundingVolume};
use parry2d::partitioning::{Bvh, BvhBuildStrategy};

use super::{Polygon, Wall, to_parry};
use crate::engine::math::Vector;

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
        let bounds: Vec<Aabb> = walls.iter().map(bounds_of).collect();
        let around: Vec<Aabb> = obstacles
            .iter()
            .map(|polygon| Aabb::from_points(polygon.points().iter().map(|&p| to_parry(p))))
            .collect();
        let endless = obstacles.iter().enumerate();
        let endless = endless.filter(|(_, polygon)| polygon.is_unbounded());
        Self {
            unbounded: endless.map(|(k, _)| k).collect(),
            obstacles,
            walls,
            obstacle_index: Bvh::from_leaves(BvhBuildStrategy::Binned, &around),
            index: Bvh::from_leaves(BvhBuildStrategy::Binned, &bounds),
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
        let points = points.iter().map(|&p| to_parry(p));
        let reach = Aabb::from_points(points).loosened(radius);
        let mut found: Vec<u32> = self.index.intersect_aabb(&reach).collect();
        found.sort_unstable();
        found
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
    pub fn free_point_near(&self, p: Vector) -> Option<Vector> {
        let foot = self.free_foot(p);
        let reach = foot.map_or(f64::INFINITY, |(distance, _)| distance);
        let corner = self.nearest_free(p, self.corners_near(p, reach));
        let nearest = [foot, corner].into_iter().flatten();
        nearest
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, exit)| exit)
    }

    /// Of all walls' points nearest to `p`, the nearest that is free, after its distance. Searches in growing
    /// circles.
    fn free_foot(&self, p: Vector) -> Option<(f64, Vector)> {
        let mut reach = FIRST_REACH;
        let mut found = Vec::new();
        loop {
            found.clear();
            self.near(p, reach, &mut found);
            let feet = found.iter().map(|&k| {
                let wall = self.wall(k);
                wall.nearest_point(p).point + wall.normal * CLEARANCE
            });
            let foot = self.nearest_free(p, feet.collect());
            let complete = found.len() == self.walls.len() || reach == f64::INFINITY;
            // Points lie `CLEARANCE` in front of their walls, so a wall out of reach may have one that much nearer.
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
            let meeting = bounds_of(a).loosened(CLEARANCE);
            others.extend(self.index.intersect_aabb(&meeting).filter(|&j| j < k));
            others.retain(|j| near.binary_search(j).is_ok());
            others.sort_unstable();
            let crossings = others.iter().map(|&j| self.wall(j));
            corners.extend(crossings.filter_map(|b| a.corner_with(b, CLEARANCE)));
        }
        corners
    }

    /// Of the `exits` outside all obstacles, the nearest to `p`, after its distance in meters.
    fn nearest_free(&self, p: Vector, exits: Vec<Vector>) -> Option<(f64, Vector)> {
        let distance = |exit: Vector| ((exit - p).norm(), exit);
        let mut exits: Vec<(f64, Vector)> = exits.into_iter().map(distance).collect();
        exits.sort_by(|a, b| a.0.total_cmp(&b.0));
        exits
            .into_iter()
            .find(|&(_, exit)| self.obstacle_at(exit).is_none())
    }

    /// The index of the first obstacle that contains `p`.
    pub fn obstacle_at(&self, p: Vector) -> Option<usize> {
        let here = Aabb::from_points([to_parry(p)]);
        let near = self.obstacle_index.intersect_aabb(&here);
        near.map(|k| k as usize)
            .chain(self.unbounded.iter().copied())
            .filter(|&k| self.obstacles[k].contains(p))
            .min()
    }
}

fn bounds_of(wall: &Wall) -> Aabb {
    Aabb::from_points([to_parry(wall.start), to_parry(wall.end)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: [f64; 2], y: [f64; 2]) -> Polygon {
        let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
        Polygon::new(corners.map(|(x, y)| Vector::new(x, y)).to_vec()).unwrap()
    }

    #[test]
    fn walls_are_numbered_by_obstacle_and_point_and_know_the_one_before() {
        let walls = Walls::new(vec![
            rectangle([0.0, 1.0], [0.0, 1.0]),
            rectangle([2.0, 3.0], [0.0, 1.0]),
        ]);
        assert_eq!(walls.len(), 8);
        for (k, wall) in walls.iter().enumerate() {
            assert_eq!(wall.obstacle as usize, k / 4);
            assert_eq!(walls.wall(wall.previous).end, wall.start);
        }
    }

    #[test]
    fn the_index_finds_what_brute_force_finds() {
        let boxes = (0..40)
            .map(|i| {
                let (x, y) = ((i % 8) as f64 * 1.7, (i / 8) as f64 * 2.3);
                rectangle([x, x + 0.9], [y, y + 0.4])
            })
            .collect();
        let walls = Walls::new(boxes);
        for step in 0..200 {
            let p = Vector::new((step % 20) as f64 * 0.7, (step / 20) as f64 * 1.1);
            let mut found = Vec::new();
            walls.near(p, 1.0, &mut found);
            let expected: Vec<u32> = (0..walls.len() as u32)
                .filter(|&k| (walls.wall(k).nearest_point(p).point - p).norm() < 1.0)
                .collect();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_move_through_a_wall_ends_before_it() {
        let walls = Walls::new(vec![rectangle([0.0, 0.01], [-5.0, 5.0])]);
        let all: Vec<u32> = (0..4).collect();
        let from = Vector::new(-1.0, 0.0);
        let (stopped, k) = walls.stop(from, Vector::new(1.0, 0.5), &all).unwrap();
        assert!(stopped.x < 0.0 && stopped.x > -1e-5);
        assert_eq!(walls.wall(k).normal, Vector::new(-1.0, 0.0));
        assert_eq!(walls.stop(from, Vector::new(-0.5, 3.0), &all), None);
    }

    #[test]
    fn no_move_slips_between_two_walls_at_their_corner() {
        // A convex and a reentrant corner, rotated and translated. All moves aim at the corner itself, where
        // rounding can place the crossing beyond the ends of both walls.
        let solid = vec![[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0], [-1.0, 0.0]];
        let (long, short) = ([5.0, -1.0], [-1.0, 5.0]);
        let inner = vec![
            [-1.0, -1.0],
            long,
            [5.0, 0.0],
            [0.0, 0.0],
            [0.0, 5.0],
            short,
        ];
        for points in [solid, inner] {
            for turn in 0..40 {
                let (sine, cosine) = (0.17 * f64::from(turn)).sin_cos();
                let place = |[x, y]: [f64; 2]| {
                    let corner = Vector::new(17.1 / 3.0, -2.0 / 7.0);
                    corner + Vector::new(cosine * x - sine * y, sine * x + cosine * y)
                };
                let placed = points.iter().map(|&p| place(p)).collect();
                let walls = Walls::new(vec![Polygon::new(placed).unwrap()]);
                let all: Vec<u32> = (0..walls.len() as u32).collect();
                for k in 1..500 {
                    let x = 1e-4 * f64::from(k);
                    let from = place([x, x * f64::from(1 + k % 12)]);
                    let to = from + (place([0.0, 0.0]) - from) * 1.7;
                    let (stopped, _) = walls.stop(from, to, &all).unwrap();
                    assert!(
                        walls
                            .iter()
                            .all(|wall| wall.faces(stopped) || !wall.faces(from))
                    );
                }
            }
        }
    }

    #[test]
    fn somebody_inside_an_obstacle_is_put_at_the_nearest_free_point() {
        // Two boxes side by side: the nearest edge of the first leads into the second.
        let walls = Walls::new(vec![
            rectangle([0.0, 2.0], [0.0, 3.0]),
            rectangle([2.0, 4.0], [0.0, 3.0]),
        ]);
        let inside = Vector::new(1.9, 1.0);
        assert_eq!(walls.obstacle_at(inside), Some(0));
        let free = walls.free_point_near(inside).unwrap();
        assert!((free - Vector::new(1.9, 0.0)).norm() < 1e-5);
        assert_eq!(walls.obstacle_at(free), None);
    }

    #[test]
    fn where_obstacles_overlap_the_nearest_free_point_may_be_a_corner_between_two() {
        // A cross of two bars: on all walls but the far ends, the point nearest to the middle lies in the other
        // bar. Agents used to be moved to a far end, 10 m away, although a free corner is 1.41 m away.
        let cross = Walls::new(vec![
            rectangle([-10.0, 10.0], [-1.0, 1.0]),
            rectangle([-1.0, 1.0], [-10.0, 10.0]),
        ]);
        let free = cross.free_point_near(Vector::new(0.1, 0.2)).unwrap();
        assert!((free - Vector::new(1.0, 1.0)).norm() < 1e-5, "{free}");
        assert_eq!(cross.obstacle_at(free), None);
    }
}

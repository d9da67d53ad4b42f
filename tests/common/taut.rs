//! Short routes without a triangulation and without a visibility graph: a search on a grid of points, then the way is
//! pulled taut like a string.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use sandbox::engine::math::Vector;

use super::floors::Plan;
use super::plans::edges;

/// Points on a grid over a plan, with the straight routes between neighbors.
pub struct Web<'a> {
    plan: &'a Plan,
    walls: Vec<[Vector; 2]>,
    points: Vec<Vector>,
    /// For each point, the points that it sees nearby.
    near: Vec<Vec<usize>>,
}

fn side(a: Vector, b: Vector, p: Vector) -> f64 {
    (b - a).perp(&(p - a))
}

/// Pulling a string taut moves it at most this often.
const MOST_MOVES: usize = 10_000;
/// Corners this near to a string are on it, meters.
const TINY: f64 = 1e-9;

impl<'a> Web<'a> {
    /// A grid with one point in each square of `step` meters, and `ends`.
    pub fn new(plan: &'a Plan, step: f64, ends: &[Vector]) -> Self {
        let walls: Vec<[Vector; 2]> = plan.rings.iter().flat_map(edges).collect();
        let corners = || walls.iter().map(|wall| wall[0]);
        let low = corners().fold(Vector::repeat(f64::INFINITY), |low, p| low.inf(&p));
        let high = corners().fold(Vector::repeat(-f64::INFINITY), |high, p| high.sup(&p));
        let [columns, rows] =
            [high.x - low.x, high.y - low.y].map(|size| (size / step) as usize + 1);
        let place = |x: usize, y: usize| low + Vector::new(x as f64 + 0.37, y as f64 + 0.41) * step;
        let all = (0..columns).flat_map(|x| (0..rows).map(move |y| place(x, y)));
        let free = all.filter(|&p| plan.is_free(p, 1e-6));
        let points: Vec<Vector> = ends.iter().copied().chain(free).collect();
        let mut web = Self {
            plan,
            walls,
            points,
            near: Vec::new(),
        };
        web.near = (0..web.points.len())
            .map(|k| web.neighbors(k, 2.3 * step))
            .collect();
        web
    }

    fn neighbors(&self, k: usize, reach: f64) -> Vec<usize> {
        let p = self.points[k];
        let is_near = |&j: &usize| j != k && (self.points[j] - p).norm() < reach;
        let near = (0..self.points.len()).filter(is_near);
        near.filter(|&j| self.is_clear(p, self.points[j])).collect()
    }

    /// Whether the segment crosses no wall.
    fn is_clear(&self, a: Vector, b: Vector) -> bool {
        let crosses = |&[c, d]: &[Vector; 2]| {
            side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
        };
        !self.walls.iter().any(crosses)
    }

    /// The length of a taut way from point `from` to point `to`; `None` if the web has none.
    pub fn length(&self, from: usize, to: usize) -> Option<f64> {
        let way = self.way(from, to)?;
        let taut = self.taut(way);
        Some(taut.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum())
    }

    /// The shortest way along the web.
    fn way(&self, from: usize, to: usize) -> Option<Vec<Vector>> {
        let mut best = vec![(f64::INFINITY, usize::MAX); self.points.len()];
        best[from] = (0.0, usize::MAX);
        let mut queue = BinaryHeap::from([Reverse((0, from))]);
        while let Some(Reverse((bits, here))) = queue.pop() {
            let length = f64::from_bits(bits);
            if length > best[here].0 {
                continue;
            }
            for &next in &self.near[here] {
                let there = length + (self.points[next] - self.points[here]).norm();
                if there < best[next].0 {
                    best[next] = (there, here);
                    queue.push(Reverse((there.to_bits(), next)));
                }
            }
        }
        if best[to].0.is_infinite() {
            return None;
        }
        let back =
            std::iter::successors(Some(to), |&k| Some(best[k].1).filter(|&k| k != usize::MAX));
        Some(back.map(|k| self.points[k]).collect())
    }

    /// Pulls a way taut: each of its points is replaced by the corners of walls that keep its neighbors apart.
    fn taut(&self, mut way: Vec<Vector>) -> Vec<Vector> {
        let (mut k, mut still) = (1, 0);
        for _ in 0..MOST_MOVES {
            if way.len() < 3 || still > way.len() {
                return way;
            }
            k = if k + 1 < way.len() { k } else { 1 };
            let between = self.around([way[k - 1], way[k], way[k + 1]]);
            if between == [way[k]] {
                still += 1;
                k += 1;
            } else {
                way.splice(k..=k, between);
                still = 0;
                k = k.saturating_sub(1).max(1);
            }
        }
        panic!(
            "the string does not come to rest: {way:?} in {:?}",
            self.plan
        );
    }

    /// The corners around which a string from a over b to c lies when it is pulled taut on the side of b.
    fn around(&self, [a, b, c]: [Vector; 3]) -> Vec<Vector> {
        let turn = side(a, b, c).signum();
        let depth = |p: Vector| -turn * side(a, c, p);
        let is_inside = |p: &Vector| {
            let reach = TINY * (b - a).norm().max((c - b).norm());
            turn * side(a, b, *p) >= -reach && turn * side(b, c, *p) >= -reach && depth(*p) > reach
        };
        let corners = self.walls.iter().map(|wall| wall[0]);
        let inside: Vec<Vector> = corners.filter(is_inside).collect();
        // The convex hull of them and a and c, from a to c.
        let mut hull = vec![a];
        while hull[hull.len() - 1] != c {
            let last = hull[hull.len() - 1];
            let others = inside.iter().copied().filter(|p| !hull.contains(p));
            let outermost = |best: Vector, p: Vector| {
                let aside = turn * side(last, best, p);
                let reach = TINY * (best - last).norm();
                let is_farther = (p - last).norm() > (best - last).norm();
                let is_outside = aside < -reach || aside <= reach && is_farther;
                if is_outside { p } else { best }
            };
            hull.push(others.fold(c, outermost));
        }
        hull[1..hull.len() - 1].to_vec()
    }
}

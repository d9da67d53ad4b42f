//! Lengths of shortest ways over the levels of a building, by brute force: a graph of all corners that see each other
//! over joins, and Dijkstra's algorithm. All levels lie at their places in the building, so a straight way leads on
//! across joins. A level has walls of 1 cm along what is seen beside it of the level behind a join.

use sandbox::engine::math::Vector;

use super::plans::{Ring, contains, edges, margin};
use super::random_buildings::Building;

/// Points this near to each other are the same, meters.
const TINY: f64 = 1e-8;
/// Exits are this much shorter at each end, meters: agents do not walk to their very ends.
const END: f64 = 0.01;
/// The thickness of walls between a level and what is seen of the next one beside it, meters.
const THICKNESS: f64 = 0.01;
/// A straight way crosses at most this many joins, and this many edges.
const MOST_JOINS: usize = 4;
const MOST: usize = 200;

/// A level with its joins, each with the number of the level beyond.
struct Sheet {
    edges: Vec<[Vector; 2]>,
    rings: Vec<Ring>,
    joins: Vec<([Vector; 2], usize)>,
}

/// All corners of a building, and the exits.
pub struct Sheets {
    sheets: Vec<Sheet>,
    nodes: Vec<(usize, Vector)>,
    /// The numbers of joins between each two levels.
    joins_between: Vec<Vec<usize>>,
    /// For each exit, the length of the way from each node.
    lengths: Vec<Vec<f64>>,
    exits: Vec<([Vector; 2], usize)>,
}

impl Sheet {
    /// Whether `p` lies on it, or on its edge.
    fn holds(&self, p: Vector) -> bool {
        let is_on = |ring: &Ring| margin(std::slice::from_ref(ring), p) < TINY;
        let (outline, holes) = (&self.rings[0], &self.rings[1..]);
        let is_inside = contains(outline, p) || is_on(outline);
        is_inside && holes.iter().all(|hole| !contains(hole, p) || is_on(hole))
    }

    /// Where on the way of this direction from `p` it meets the next edge, beyond `after` meters.
    fn next(&self, p: Vector, along: Vector, after: f64) -> f64 {
        let mut next = f64::INFINITY;
        let mut meet = |at: f64| {
            if at > after + TINY {
                next = next.min(at);
            }
        };
        for [a, b] in &self.edges {
            let [from, to] = [a - p, b - p].map(|way| along.perp(&way));
            if from.abs() < TINY {
                meet((a - p).dot(&along));
            }
            if to.abs() < TINY {
                meet((b - p).dot(&along));
            }
            if from * to < 0.0 && from.abs() >= TINY && to.abs() >= TINY {
                let crossing = a + (b - a) * (from / (from - to));
                meet((crossing - p).dot(&along));
            }
        }
        next
    }

    /// The corners at which shortest ways may bend: those that stand out into the floor, and the ends of joins.
    fn bends(&self) -> Vec<Vector> {
        let mut bends = Vec::new();
        for (k, ring) in self.rings.iter().enumerate() {
            let points: Vec<Vector> = ring.iter().map(|&p| p.into()).collect();
            let n = points.len();
            let doubled: f64 = edges(ring).map(|[a, b]| a.perp(&b)).sum();
            for i in 0..n {
                let [a, b, c] = [points[(i + n - 1) % n], points[i], points[(i + 1) % n]];
                let turn = (b - a).perp(&(c - b)) * doubled.signum();
                if (turn > 0.0) == (k > 0) {
                    bends.push(b);
                }
            }
        }
        let ends = self.joins.iter().flat_map(|(line, _)| line);
        bends.extend(ends);
        bends
    }
}

impl Sheets {
    pub fn new(building: &Building) -> Self {
        let sheets = (0..building.levels.len()).map(|k| {
            let joins = building.joins.iter().filter_map(|&(line, [a, b])| match k {
                k if k == a => Some((line, b)),
                k if k == b => Some((line, a)),
                _ => None,
            });
            let joins: Vec<([Vector; 2], usize)> = joins.collect();
            let own = &building.levels[k].rings;
            let walls = joins.iter().flat_map(|&(join, other)| {
                walls_between(own, &building.levels[other].rings[0], join)
            });
            let rings: Vec<Ring> = own.iter().cloned().chain(walls).collect();
            Sheet {
                edges: rings.iter().flat_map(edges).collect(),
                rings,
                joins,
            }
        });
        let shorter = |&([a, b], level): &([Vector; 2], usize)| {
            let end = (b - a).normalize() * END;
            ([a + end, b - end], level)
        };
        let mut all = Self {
            sheets: sheets.collect(),
            nodes: Vec::new(),
            joins_between: (0..building.levels.len())
                .map(|level| building.joins_from(level))
                .collect(),
            lengths: Vec::new(),
            exits: building.exits.iter().map(shorter).collect(),
        };
        let of_level = |(k, sheet): (usize, &Sheet)| {
            let bends = sheet.bends().into_iter();
            bends.map(move |p| (k, p)).collect::<Vec<_>>()
        };
        all.nodes = all.sheets.iter().enumerate().flat_map(of_level).collect();
        let mut near = vec![Vec::new(); all.nodes.len()];
        for (i, &from) in all.nodes.iter().enumerate() {
            for (j, length) in all.seen_from(from, i + 1) {
                near[i].push((j, length));
                near[j].push((i, length));
            }
        }
        let exits = 0..all.exits.len();
        all.lengths = exits.map(|exit| all.dijkstra(exit, &near)).collect();
        all
    }

    /// The nodes from number `first` on that are seen from a place, with the lengths of the ways.
    fn seen_from(&self, from: (usize, Vector), first: usize) -> Vec<(usize, f64)> {
        let joins = &self.joins_between[from.0];
        let nodes = self.nodes.iter().enumerate().skip(first);
        let near = nodes.filter(|(_, (level, _))| joins[*level] <= MOST_JOINS);
        let seen = near.filter(|&(_, &to)| self.is_clear(from, to));
        seen.map(|(k, (_, p))| (k, (p - from.1).norm())).collect()
    }

    /// Whether a straight way leads from one place to another.
    fn is_clear(&self, (level, p): (usize, Vector), (goal, q): (usize, Vector)) -> bool {
        let length = (q - p).norm();
        if length < TINY {
            let joins = &self.sheets[level].joins;
            let is_joined = |(line, to): &([Vector; 2], usize)| *to == goal && on(*line, p);
            return level == goal || joins.iter().any(is_joined);
        }
        let along = (q - p) / length;
        let (mut level, mut at, mut crossed) = (level, 0.0, 0);
        for _ in 0..MOST {
            let sheet = &self.sheets[level];
            let next = sheet.next(p, along, at).min(length);
            if next > length - TINY && at > length - TINY {
                return level == goal;
            }
            if sheet.holds(p + along * (0.5 * (at + next))) {
                at = next;
                crossed = 0;
                if at > length - TINY {
                    return level == goal;
                }
                continue;
            }
            // It leaves the level: over a join behind which the next one goes on.
            let here = p + along * at;
            let beyond = |(line, to): &&([Vector; 2], usize)| {
                let other = &self.sheets[*to];
                let next = other.next(p, along, at).min(length);
                on(*line, here) && other.holds(p + along * (0.5 * (at + next)))
            };
            crossed += 1;
            match sheet.joins.iter().find(beyond) {
                Some((_, to)) if crossed < 4 => level = *to,
                _ => return false,
            }
        }
        panic!("from {p} to {q}: too many edges");
    }

    /// The length of the straight way from a place to an exit, if one leads there.
    fn straight(&self, from: (usize, Vector), exit: usize) -> f64 {
        let ([a, b], level) = self.exits[exit];
        let part = (b - a).dot(&(from.1 - a)) / (b - a).norm_squared();
        let foot = a + (b - a) * part.clamp(0.0, 1.0);
        let ends = [a, b, foot].into_iter();
        let seen = ends.filter(|&end| self.is_clear(from, (level, end)));
        seen.map(|end| (end - from.1).norm())
            .fold(f64::INFINITY, f64::min)
    }

    fn dijkstra(&self, exit: usize, near: &[Vec<(usize, f64)>]) -> Vec<f64> {
        let mut lengths: Vec<f64> = self
            .nodes
            .iter()
            .map(|&node| self.straight(node, exit))
            .collect();
        let mut open: Vec<usize> = (0..lengths.len()).collect();
        while !open.is_empty() {
            let least =
                (0..open.len()).min_by(|&a, &b| lengths[open[a]].total_cmp(&lengths[open[b]]));
            let here = open.swap_remove(least.unwrap());
            for &(to, length) in &near[here] {
                lengths[to] = lengths[to].min(lengths[here] + length);
            }
        }
        lengths
    }

    /// The length of the shortest way from a place to an exit; infinite if no way leads there.
    pub fn length(&self, from: (usize, Vector), exit: usize) -> f64 {
        let over = self.seen_from(from, 0).into_iter();
        let over = over.map(|(node, length)| length + self.lengths[exit][node]);
        over.fold(self.straight(from, exit), f64::min)
    }
}

/// The walls along the edges that a level shares with the outline of the one behind a join, but for the join. They
/// reach into the holes of the level, too.
fn walls_between(own: &[Ring], other: &Ring, join: [Vector; 2]) -> Vec<Ring> {
    let mut walls = Vec::new();
    for [a, b] in own.iter().flat_map(edges) {
        let along = (b - a).normalize();
        let lies_on = |line: [Vector; 2]| line.iter().all(|p| along.perp(&(p - a)).abs() < TINY);
        let part = |p: Vector| (p - a).dot(&along);
        for [c, d] in edges(other).filter(|&edge| lies_on(edge)) {
            let from = part(c).min(part(d)).max(0.0);
            let to = part(c).max(part(d)).min((b - a).norm());
            let free = match lies_on(join) {
                true => [
                    part(join[0]).min(part(join[1])),
                    part(join[0]).max(part(join[1])),
                ],
                false => [f64::INFINITY; 2],
            };
            for [from, to] in [[from, to.min(free[0])], [from.max(free[1]), to]] {
                if to - from > TINY {
                    let aside = Vector::new(-along.y, along.x) * THICKNESS;
                    let [p, q] = [from, to].map(|at| a + along * at);
                    walls.push(
                        [p - aside, q - aside, q + aside, p + aside]
                            .map(Into::into)
                            .to_vec(),
                    );
                }
            }
        }
    }
    walls
}

/// Whether `p` lies on a segment.
pub fn on([a, b]: [Vector; 2], p: Vector) -> bool {
    let part = (b - a).dot(&(p - a)) / (b - a).norm_squared();
    (a + (b - a) * part.clamp(0.0, 1.0) - p).norm() < TINY
}

//! The edges of the floor: its walls, and the passages that are closed.

use std::collections::{BTreeSet, HashMap};

use super::lines::{side, to_segment};
use super::narrow::{End, Narrow};
use crate::geometry::Area;
use crate::math::{Vector, bounds, sides};

/// Two points by their numbers.
pub type Edge = [usize; 2];

/// Walls and closed passages between points.
#[derive(Debug, Clone)]
pub struct Edges {
    /// The points, meters, each once.
    pub points: Vec<Vector>,
    walls: Vec<Edge>,
    /// The closed passages, each with the smaller number first.
    pub closed: BTreeSet<Edge>,
}

/// An end of an edge within this distance of another edge lies on it: in meters, and as a fraction of the floor's
/// extent. Snapping moves the corners of floor plans by up to a micrometer.
const TOUCHING: f64 = 4e-6;
const TOUCHING_PART: f64 = 4e-8;

impl Edges {
    /// The distinct corners of the areas, and the walls between them.
    pub fn of(areas: &[Area]) -> Self {
        let (mut points, mut walls) = (Vec::new(), Vec::new());
        let mut numbers = HashMap::new();
        for ring in areas.iter().flat_map(Area::rings) {
            let mut number = |p: &Vector| {
                // + 0.0 turns −0 into 0.
                let key = [p.x, p.y].map(|x| (x + 0.0).to_bits());
                *numbers.entry(key).or_insert_with(|| {
                    points.push(*p);
                    points.len() - 1
                })
            };
            let around: Vec<usize> = ring.points().iter().map(&mut number).collect();
            walls.extend(sides(&around).map(|(a, b)| [a, b]));
        }
        Self {
            points,
            walls,
            closed: BTreeSet::new(),
        }
    }

    /// Adds a point; returns its number.
    fn add(&mut self, p: Vector) -> usize {
        self.points.push(p);
        self.points.len() - 1
    }

    /// The ends of an edge, the smaller number first.
    pub fn sorted([a, b]: Edge) -> Edge {
        [a.min(b), a.max(b)]
    }

    /// All edges: the walls, then the closed passages.
    pub fn all(&self) -> Vec<Edge> {
        let closed = self.closed.iter().copied();
        self.walls.iter().copied().chain(closed).collect()
    }

    /// Closes lines, which may end in walls or beyond them, and lead along walls.
    pub fn draw(&mut self, lines: &[[Vector; 2]]) {
        let mut drawn = Vec::new();
        for line in lines {
            let ends = line.map(|end| {
                let here = |p: &Vector| (p - end).norm() <= TOUCHING;
                let known = self.points.iter().position(here);
                known.unwrap_or_else(|| self.add(end))
            });
            let edge = Self::sorted(ends);
            self.closed.insert(edge);
            drawn.push(edge);
        }
        // The triangulation sees no crossing where a line leads through a corner.
        let leads_through = |edge: &Edge| {
            let [a, b] = edge.map(|end| self.points[end]);
            let mut others = self.points.iter().enumerate();
            others.any(|(k, &p)| !edge.contains(&k) && to_segment(p, a, b) <= TOUCHING)
        };
        drawn.retain(leads_through);
        if !drawn.is_empty() {
            self.split(&drawn);
        }
    }

    /// Closes passages. Where one ends inside of a wall, the wall gets a point.
    pub fn close(&mut self, passages: &[Narrow]) {
        let mut cuts: HashMap<Edge, Vec<usize>> = HashMap::new();
        for &Narrow { from, to } in passages {
            let from = from as usize;
            let to = match to {
                End::Corner(corner) => corner as usize,
                End::Wall { ends, at } => {
                    let cuts = cuts.entry(Self::sorted(ends.map(|end| end as usize)));
                    let cuts = cuts.or_default();
                    let mut known = cuts.iter().copied().chain([from]);
                    let here = known.find(|&point| self.points[point] == at);
                    let point = here.unwrap_or_else(|| self.add(at));
                    cuts.push(point);
                    point
                }
            };
            if from != to {
                self.closed.insert(Self::sorted([from, to]));
            }
        }
        let cuts_of = |wall: &Edge| cuts.get(&Self::sorted(*wall)).cloned().unwrap_or_default();
        let cuts = self.walls.iter().map(cuts_of).collect();
        self.cut(cuts, vec![Vec::new(); self.closed.len()]);
    }

    /// Splits the edges in `crossing` and the edges that they cross: at an end that lies on the other edge, otherwise
    /// at the crossing.
    pub fn split(&mut self, crossing: &[Edge]) {
        let [low, high] = bounds(self.points.iter().copied()).unwrap_or_default();
        let touching = TOUCHING.max((high - low).max() * TOUCHING_PART);
        let all = self.all();
        // The triangulation may swap the ends of edges.
        let crossing: BTreeSet<Edge> = crossing.iter().copied().map(Self::sorted).collect();
        let mut cuts: Vec<Vec<usize>> = vec![Vec::new(); all.len()];
        let points = &mut self.points;
        for (k, one) in all
            .iter()
            .enumerate()
            .filter(|(_, edge)| crossing.contains(&Self::sorted(**edge)))
        {
            let [a, b] = one.map(|end| points[end]);
            for (other, ends) in all.iter().enumerate() {
                let [c, d] = ends.map(|end| points[end]);
                let (from, to) = (side(a, b, c), side(a, b, d));
                let crosses = from * to < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
                // Rounding hides crossings at ends, which the triangulation sees.
                let on = |ends: &Edge, edge: &Edge| {
                    let [a, b] = edge.map(|end| points[end]);
                    let near = |end: &&usize| {
                        !edge.contains(end) && to_segment(points[**end], a, b) <= touching
                    };
                    ends.iter().filter(near).copied().collect::<Vec<usize>>()
                };
                let (on_one, on_other) = (on(ends, one), on(one, ends));
                if crosses && on_one.is_empty() && on_other.is_empty() {
                    points.push(c + (d - c) * (from / (from - to)));
                    cuts[k].push(points.len() - 1);
                    cuts[other].push(points.len() - 1);
                }
                cuts[k].extend(on_one);
                cuts[other].extend(on_other);
            }
        }
        let of_closed = cuts.split_off(self.walls.len());
        self.cut(cuts, of_closed);
    }

    /// Cuts each wall and each closed passage at these points.
    fn cut(&mut self, of_walls: Vec<Vec<usize>>, of_closed: Vec<Vec<usize>>) {
        let points = &self.points;
        let parts = |[from, to]: Edge, mut cuts: Vec<usize>| {
            let distance = |&point: &usize| (points[point] - points[from]).norm_squared();
            cuts.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            cuts.insert(0, from);
            cuts.push(to);
            let parts = cuts.windows(2).map(|pair| Self::sorted([pair[0], pair[1]]));
            let parts = parts.filter(|[from, to]| from != to);
            parts.collect::<Vec<Edge>>()
        };
        let walls = self.walls.iter().zip(of_walls);
        // Two identical walls cancel: nothing lies between them.
        let mut odd = BTreeSet::new();
        for part in walls.flat_map(|(&wall, cuts)| parts(wall, cuts)) {
            if !odd.remove(&part) {
                odd.insert(part);
            }
        }
        let closed = self.closed.iter().zip(of_closed);
        let closed = closed.flat_map(|(&passage, cuts)| parts(passage, cuts));
        self.closed = closed.filter(|part| !odd.contains(part)).collect();
        self.walls = odd.into_iter().collect();
    }
}

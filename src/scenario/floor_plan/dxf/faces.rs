//! The areas that lines enclose.

use std::cmp::Ordering;

use super::gaps;
use super::map::Point;
use super::network::{Line, Network};
use super::rows::Rows;
use crate::floor_plan::boundary::{self, Edge, Point as GridPoint};
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::shape::SAME;
use engine::geometry::{Area, assemble};
use engine::math::Vector;

/// The number of the area around everything.
pub const OUTSIDE: usize = 0;

/// The areas into which lines divide the plane.
pub struct Faces {
    /// The lines.
    pub network: Network,
    /// For each half of an edge, the number of the area on its left.
    left: Vec<usize>,
    /// Twice the sizes of the areas on the grid.
    sizes: Vec<i128>,
    rows: Rows,
    /// The points of the lines.
    given: Vec<Vector>,
}

/// A closed path along halves of edges.
struct Loop {
    /// Its leftmost node, the lowest of several.
    first: usize,
    /// Twice the area inside, positive if that is on its left.
    size: i128,
}

impl Faces {
    /// The areas into which lines divide the plane.
    pub fn new(lines: &[Line]) -> Self {
        let network = Network::new(lines);
        let given = lines.iter().flat_map(|line| line.points.iter().copied());
        let heights = network.edges.iter().map(|edge| {
            let [a, b] = edge.nodes.map(|node| network.nodes[node][1] as f64);
            [a.min(b), a.max(b)]
        });
        let rows = Rows::new(&heights.collect::<Vec<_>>());
        let (loops, of_half) = loops(&network);
        let mut faces = Self {
            network,
            left: of_half,
            sizes: vec![0],
            rows,
            given: given.map(Vector::from).collect(),
        };
        let faces_of_loops = faces.number(&loops);
        for face in &mut faces.left {
            *face = faces_of_loops[*face];
        }
        faces
    }

    /// The faces of loops. A loop around nothing bounds the area in which it lies.
    fn number(&mut self, loops: &[Loop]) -> Vec<usize> {
        let mut found = vec![OUTSIDE; loops.len()];
        for (k, one) in loops.iter().enumerate().filter(|(_, one)| one.size > 0) {
            found[k] = self.sizes.len();
            self.sizes.push(one.size);
        }
        let mut around: Vec<usize> = (0..loops.len()).filter(|&k| loops[k].size <= 0).collect();
        // What lies to the left of the leftmost node was numbered before.
        around.sort_by_key(|&k| loops[k].first);
        for k in around {
            let first = self.network.nodes[loops[k].first];
            if let Some(half) = self.half_left_of(first) {
                let face = found[self.left[half]];
                found[k] = face;
                if face != OUTSIDE {
                    self.sizes[face] += loops[k].size;
                }
            }
        }
        found
    }

    /// The half of an edge with a point on its left, of the edge nearest to the point on its left side.
    fn half_left_of(&self, p: GridPoint) -> Option<usize> {
        let mut nearest: Option<(usize, Crossing)> = None;
        for &k in self.rows.at(p[1] as f64) {
            let [a, b] = self.network.edges[k]
                .nodes
                .map(|node| self.network.nodes[node]);
            let is_up = a[1] < b[1];
            let [low, high] = if is_up { [a, b] } else { [b, a] };
            if !(low[1] <= p[1] && p[1] < high[1]) {
                continue;
            }
            let crossing = Crossing::new(low, high, p[1]);
            let is_left = crossing.is_left_of(p[0]);
            let is_nearer = nearest
                .as_ref()
                .is_none_or(|(_, other)| crossing.cmp(other).is_gt());
            if is_left && is_nearer {
                // The point is on the right of an edge that leads up.
                nearest = Some((2 * k + usize::from(is_up), crossing));
            }
        }
        nearest.map(|(half, _)| half)
    }

    /// The number of areas, with that around everything.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// The size of an area, m².
    pub fn size(&self, face: usize) -> f64 {
        0.5 * self.sizes[face] as f64 * self.network.grid.step * self.network.grid.step
    }

    /// The number of the area at a point.
    pub fn at(&self, p: Point) -> usize {
        let half = self.half_left_of(self.network.grid.nearest(p));
        half.map_or(OUTSIDE, |half| self.left[half])
    }

    /// The areas on both sides of an edge.
    pub fn sides(&self, edge: usize) -> [usize; 2] {
        [self.left[2 * edge], self.left[2 * edge + 1]]
    }

    /// The union of some areas. Corners near a given point are that point, to the last bit.
    pub fn union(&self, is_in: impl Fn(usize) -> bool) -> Result<Vec<Area>, FloorPlanError> {
        let grid = &self.network.grid;
        let mut edges = Vec::new();
        for k in 0..self.network.edges.len() {
            let [left, right] = self.sides(k).map(&is_in);
            let [from, to] = self
                .network
                .ends(2 * k)
                .map(|node| self.network.nodes[node]);
            match [left, right] {
                [true, false] => edges.push(Edge { from, to }),
                [false, true] => edges.push(Edge { from: to, to: from }),
                _ => {}
            }
        }
        let wrong = |at: Point, reason: String| FloorPlanError::Geometry {
            place: format!("near ({}, {})", at[0], at[1]),
            reason,
        };
        let on_grid = boundary::rings(edges)
            .map_err(|at| wrong(grid.place(at), "the boundary does not close".to_owned()))?;
        let placed = |ring: Vec<GridPoint>| -> Vec<Vector> {
            ring.into_iter()
                .map(|p| Vector::from(grid.place(p)))
                .collect()
        };
        let rings: Vec<Vec<Vector>> = on_grid.into_iter().map(placed).collect();
        let tolerance = SAME.max(4.0 * grid.step);
        assemble(&rings, self.given.iter().copied(), tolerance)
            .map_err(|(error, ring)| wrong(ring[0].into(), error.to_string()))
    }
}

/// Where an edge crosses a horizontal line, exactly: x = numerator / height.
struct Crossing {
    numerator: i128,
    height: i128,
    width: i128,
}

impl Crossing {
    fn new(low: GridPoint, high: GridPoint, y: i64) -> Self {
        let [width, height] = [high[0] - low[0], high[1] - low[1]].map(i128::from);
        let numerator = i128::from(low[0]) * height + width * i128::from(y - low[1]);
        Self {
            numerator,
            height,
            width,
        }
    }

    fn is_left_of(&self, x: i64) -> bool {
        self.numerator < i128::from(x) * self.height
    }

    /// By the place, then by the place just above.
    fn cmp(&self, other: &Self) -> Ordering {
        let place = (self.numerator * other.height).cmp(&(other.numerator * self.height));
        place.then((self.width * other.height).cmp(&(other.width * self.height)))
    }
}

/// The closed paths around areas, and for each half of an edge the number of its path.
fn loops(network: &Network) -> (Vec<Loop>, Vec<usize>) {
    let mut of_half = vec![usize::MAX; 2 * network.edges.len()];
    let mut loops = Vec::new();
    for start in 0..of_half.len() {
        if of_half[start] != usize::MAX {
            continue;
        }
        let (mut half, mut first, mut size) = (start, usize::MAX, 0);
        while of_half[half] == usize::MAX {
            of_half[half] = loops.len();
            let [from, to] = network.ends(half);
            let [a, b] = [from, to].map(|node| network.nodes[node].map(i128::from));
            size += a[0] * b[1] - a[1] * b[0];
            // The nodes are sorted from left to right, then upwards.
            first = first.min(from);
            half = network.after(half);
        }
        loops.push(Loop { first, size });
    }
    (loops, of_half)
}

/// The areas that closed lines enclose, each of which may cross itself.
pub fn enclosed(rings: &[Vec<Point>]) -> Result<Vec<Area>, FloorPlanError> {
    let closed = |ring: &Vec<Point>| Line {
        points: ring.iter().chain(ring.first()).copied().collect(),
        is_open: false,
    };
    let lines: Vec<Line> = rings.iter().map(closed).collect();
    gaps::refuse_crowded(&lines)?;
    Faces::new(&lines).union(|face| face != OUTSIDE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Line {
        let [right, top] = [x + side, y + side];
        Line {
            points: vec![[x, y], [right, y], [right, top], [x, top], [x, y]],
            is_open: false,
        }
    }

    fn line(points: &[Point], is_open: bool) -> Line {
        Line {
            points: points.to_vec(),
            is_open,
        }
    }

    #[test]
    fn an_island_is_not_part_of_the_area_around_it() {
        let faces = Faces::new(&[
            square(0.0, 0.0, 10.0),
            square(4.0, 4.0, 2.0),
            square(5.0, 5.0, 0.5),
        ]);
        let [around, island] = [faces.at([1.0, 1.0]), faces.at([4.5, 4.5])];
        assert!((faces.size(around) - 96.0).abs() < 1e-6);
        assert!((faces.size(island) - 3.75).abs() < 1e-6);
        assert_eq!(faces.at([11.0, 5.0]), OUTSIDE);
        assert_eq!(faces.count(), 4);
        let areas = faces.union(|face| face == around).unwrap();
        assert_eq!((areas.len(), areas[0].holes.len()), (1, 1));
    }

    #[test]
    fn doubled_crossing_and_dangling_lines_are_harmless() {
        let mut lines = vec![square(0.0, 0.0, 4.0), square(0.0, 0.0, 4.0)];
        lines.push(line(&[[-1.0, 2.0], [5.0, 2.0]], false));
        lines.push(line(&[[1.0, 1.0], [2.0, 1.5]], false));
        let faces = Faces::new(&lines);
        assert_eq!(faces.count(), 3);
        assert!((faces.size(faces.at([3.0, 1.0])) - 8.0).abs() < 1e-6);
        let areas = faces.union(|face| face != OUTSIDE).unwrap();
        assert!((areas[0].area() - 16.0).abs() < 1e-6);
        assert_eq!(faces.network.loose_ends().len(), 4);
    }

    #[test]
    fn only_edges_without_a_wall_are_open() {
        let door = line(&[[2.0, 4.0], [2.0, 0.0]], true);
        let wall = line(&[[2.0, 3.0], [2.0, 0.0]], false);
        let network = Faces::new(&[square(0.0, 0.0, 4.0), door, wall]).network;
        let open = network.edges.iter().filter(|edge| edge.is_open);
        let ends: Vec<[Point; 2]> = open
            .map(|edge| {
                edge.nodes
                    .map(|node| network.grid.place(network.nodes[node]))
            })
            .collect();
        assert_eq!(ends, [[[2.0, 3.0], [2.0, 4.0]]]);
    }

    #[test]
    fn a_line_that_crosses_itself_encloses_both_parts() {
        let bow = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        let areas = enclosed(&[bow]).unwrap();
        let size: f64 = areas.iter().map(Area::area).sum();
        assert!((size - 2.0).abs() < 1e-6);
    }
}

//! Cuts of the plane into parts, one per process.

use rayon::prelude::*;
use sandbox::engine::math::{Vector, bounds};

/// A way to cut a crowd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Equal rectangles over the bounding box.
    Rectangles,
    /// Recursive coordinate bisection: halves of equal counts across the longer side, again and again.
    Bisection,
    /// The same with halves of equal work.
    Work,
    /// Equal counts along a Hilbert curve.
    Curve,
}

impl Way {
    pub const ALL: [Self; 4] = [Self::Rectangles, Self::Bisection, Self::Work, Self::Curve];

    pub fn name(self) -> &'static str {
        match self {
            Self::Rectangles => "rectangles",
            Self::Bisection => "bisection",
            Self::Work => "bisection by work",
            Self::Curve => "Hilbert curve",
        }
    }

    /// Cuts a crowd into `parts` parts; `work` has the work of each agent.
    pub fn cut(self, positions: &[Vector], work: &[f64], parts: usize) -> Cut {
        match self {
            Self::Rectangles => Cut::Rectangles(Rectangles::over(positions, parts)),
            Self::Bisection => {
                let points = positions.iter().map(|&p| (p, 1.0));
                Cut::Bisection(Bisection::of(points.collect(), parts))
            }
            Self::Work => {
                let points = positions.iter().copied().zip(work.iter().copied());
                Cut::Bisection(Bisection::of(points.collect(), parts))
            }
            Self::Curve => Cut::Curve(Curve::through(positions, parts)),
        }
    }
}

/// A part for each point of the plane, numbered from 0.
pub enum Cut {
    Rectangles(Rectangles),
    Bisection(Bisection),
    Curve(Curve),
}

impl Cut {
    /// The part of `p`.
    pub fn part(&self, p: Vector) -> u32 {
        match self {
            Self::Rectangles(cut) => cut.part(p),
            Self::Bisection(cut) => cut.part(p),
            Self::Curve(cut) => cut.part(p),
        }
    }

    /// The part of each of `positions`.
    pub fn parts(&self, positions: &[Vector]) -> Vec<u32> {
        positions.par_iter().map(|&p| self.part(p)).collect()
    }
}

/// Equal rectangles; those at the border have all points beyond it.
pub struct Rectangles {
    low: Vector,
    per_meter: Vector,
    columns: usize,
    rows: usize,
}

impl Rectangles {
    /// The columns and rows that make the rectangles most like squares.
    fn over(positions: &[Vector], parts: usize) -> Self {
        let [low, high] = bounds(positions.iter().copied()).unwrap_or_default();
        // A crowd on a line has no height.
        let size = (high - low).map(|side| side.max(f64::EPSILON));
        let stretch = |&columns: &usize| {
            let rows = parts / columns;
            let ratio = size.x / columns as f64 / (size.y / rows as f64);
            ratio.ln().abs()
        };
        let columns = (1..=parts).filter(|columns| parts.is_multiple_of(*columns));
        let columns = columns.min_by(|a, b| stretch(a).total_cmp(&stretch(b)));
        let columns = columns.unwrap_or(1);
        let rows = parts / columns;
        Self {
            low,
            per_meter: Vector::new(columns as f64 / size.x, rows as f64 / size.y),
            columns,
            rows,
        }
    }

    fn part(&self, p: Vector) -> u32 {
        let place = (p - self.low).component_mul(&self.per_meter);
        // Negative numbers become 0.
        let column = (place.x as usize).min(self.columns - 1);
        let row = (place.y as usize).min(self.rows - 1);
        (row * self.columns + column) as u32
    }
}

/// A tree of straight cuts.
pub struct Bisection {
    splits: Vec<Split>,
    root: Branch,
}

#[derive(Clone, Copy)]
enum Branch {
    Part(u32),
    Split(usize),
}

/// A cut across one axis.
struct Split {
    axis: usize,
    /// The smallest coordinate above the cut, meters.
    at: f64,
    below: Branch,
    above: Branch,
}

impl Bisection {
    /// Halves of equal weight. If the weights are 1, no two agents share a coordinate and `parts` is a power of two,
    /// the counts differ by at most 1.
    fn of(mut points: Vec<(Vector, f64)>, parts: usize) -> Self {
        let mut cut = Self {
            splits: Vec::with_capacity(parts),
            root: Branch::Part(0),
        };
        cut.root = cut.bisect(&mut points, 0, parts);
        cut
    }

    /// Cuts some agents into the parts from `first` on.
    fn bisect(&mut self, points: &mut [(Vector, f64)], first: usize, parts: usize) -> Branch {
        let half = parts / 2;
        let box_of = bounds(points.iter().map(|point| point.0));
        let Some([low, high]) = box_of.filter(|_| half > 0) else {
            return Branch::Part(first as u32);
        };
        let axis = (high - low).imax();
        points.par_sort_unstable_by(|(p, _), (q, _)| p[axis].total_cmp(&q[axis]));
        let wanted = total(points) * half as f64 / parts as f64;
        let mut sum = 0.0;
        let count = points.iter().take_while(|(_, weight)| {
            sum += weight;
            sum <= wanted
        });
        let count = count.count().min(points.len() - 1);
        let at = points[count].0[axis];
        let (below, above) = points.split_at_mut(count);
        let below = self.bisect(below, first, half);
        let above = self.bisect(above, first + half, parts - half);
        self.splits.push(Split {
            axis,
            at,
            below,
            above,
        });
        Branch::Split(self.splits.len() - 1)
    }

    fn part(&self, p: Vector) -> u32 {
        let mut branch = self.root;
        loop {
            match branch {
                Branch::Part(part) => return part,
                Branch::Split(k) => {
                    let split = &self.splits[k];
                    let is_below = p[split.axis] < split.at;
                    branch = if is_below { split.below } else { split.above };
                }
            }
        }
    }
}

fn total(points: &[(Vector, f64)]) -> f64 {
    points.iter().map(|(_, weight)| weight).sum()
}

/// Bits per coordinate of the Hilbert curve: cells of 1/65,536 of the crowd's extent.
const BITS: u32 = 16;

/// Sections of a Hilbert curve over the square around the crowd.
pub struct Curve {
    low: Vector,
    per_meter: f64,
    /// Where each part after the first begins.
    starts: Vec<u32>,
}

impl Curve {
    /// If no two agents share a cell of the curve, the counts differ by at most 1.
    fn through(positions: &[Vector], parts: usize) -> Self {
        let [low, high] = bounds(positions.iter().copied()).unwrap_or_default();
        let side = (high - low).max().max(f64::EPSILON);
        let mut curve = Self {
            low,
            per_meter: f64::from(1 << BITS) / side,
            starts: Vec::new(),
        };
        let mut order: Vec<u32> = positions.par_iter().map(|&p| curve.index(p)).collect();
        order.par_sort_unstable();
        let starts = (1..parts).map(|part| order.get(part * order.len() / parts));
        curve.starts = starts.flatten().copied().collect();
        curve
    }

    /// How far along the curve the cell of `p` lies.
    fn index(&self, p: Vector) -> u32 {
        let most = f64::from((1 << BITS) - 1);
        let cell = ((p - self.low) * self.per_meter).map(|x| x.clamp(0.0, most));
        hilbert(BITS, [cell.x as u32, cell.y as u32])
    }

    fn part(&self, p: Vector) -> u32 {
        let index = self.index(p);
        self.starts.partition_point(|&start| start <= index) as u32
    }
}

/// The place of a cell on the Hilbert curve through 2^`bits` × 2^`bits` cells.
fn hilbert(bits: u32, [mut x, mut y]: [u32; 2]) -> u32 {
    let last = (1 << bits) - 1;
    let mut index = 0;
    for bit in (0..bits).rev() {
        let (right, top) = ((x >> bit) & 1, (y >> bit) & 1);
        index = 4 * index + ((3 * right) ^ top);
        if top == 0 {
            // Turns the quarter so that its curve begins and ends at its neighbors.
            if right == 1 {
                (x, y) = (last - x, last - y);
            }
            (x, y) = (y, x);
        }
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng, rngs::StdRng};

    /// Denser on the left.
    fn crowd(count: usize) -> Vec<Vector> {
        let mut random = StdRng::seed_from_u64(7);
        let mut place = |_| {
            let x: f64 = random.random();
            Vector::new(60.0 * x * x - 10.0, 35.0 * random.random::<f64>())
        };
        (0..count).map(&mut place).collect()
    }

    fn ones(positions: &[Vector]) -> Vec<f64> {
        vec![1.0; positions.len()]
    }

    fn counts(way: Way, positions: &[Vector], parts: usize) -> Vec<usize> {
        let mut counts = vec![0; parts];
        for part in way.cut(positions, &ones(positions), parts).parts(positions) {
            counts[part as usize] += 1; // panics beyond the last part
        }
        counts
    }

    #[test]
    fn every_agent_is_in_one_of_the_parts() {
        let crowd = crowd(1003);
        for way in Way::ALL {
            for parts in [1, 2, 3, 4, 16, 60, 64] {
                let counts = counts(way, &crowd, parts);
                assert_eq!(counts.iter().sum::<usize>(), crowd.len());
            }
        }
    }

    #[test]
    fn points_outside_of_the_crowd_belong_to_a_part_too() {
        let crowd = crowd(500);
        for way in Way::ALL {
            let cut = way.cut(&crowd, &ones(&crowd), 16);
            for p in [[-1e6, 3.0], [1e6, 1e6], [4.0, -1e9]] {
                assert!(cut.part(Vector::new(p[0], p[1])) < 16);
            }
        }
    }

    #[test]
    fn bisection_and_curve_give_parts_of_equal_counts() {
        for count in [640, 1000, 1003] {
            let crowd = crowd(count);
            for way in [Way::Bisection, Way::Work, Way::Curve] {
                for parts in [2, 4, 16, 64] {
                    let counts = counts(way, &crowd, parts);
                    let (least, most) = (counts.iter().min(), counts.iter().max());
                    let difference = most.unwrap() - least.unwrap();
                    assert!(difference <= 1, "{}, {parts}: {counts:?}", way.name());
                }
            }
        }
    }

    #[test]
    fn bisection_by_work_gives_each_part_its_share() {
        let crowd = crowd(2000);
        let weights: Vec<f64> = crowd.iter().map(|p| 1.0 + p.x.max(0.0)).collect();
        let (all, largest) = (weights.iter().sum::<f64>(), 51.0);
        for parts in [2, 4, 16, 64] {
            let part_of = Way::Work.cut(&crowd, &weights, parts).parts(&crowd);
            let mut work = vec![0.0; parts];
            for (part, weight) in part_of.into_iter().zip(&weights) {
                work[part as usize] += weight;
            }
            // Each halving is off by less than one agent, and later halvings halve the error.
            let fair = all / parts as f64;
            assert!(work.iter().all(|work| (work - fair).abs() < 2.0 * largest));
        }
    }

    #[test]
    fn rectangles_of_a_square_are_squares() {
        let corners = [[0.0, 0.0], [8.0, 8.0]].map(|[x, y]| Vector::new(x, y));
        let cut = Way::Rectangles.cut(&corners, &[], 16);
        let parts = (0..16).map(|k| [k % 4, k / 4].map(|i| 2.0 * f64::from(i) + 1.0));
        let parts = parts.map(|[x, y]| cut.part(Vector::new(x, y)));
        assert!(parts.eq(0..16));
    }

    #[test]
    fn the_curve_visits_every_cell_once_and_steps_to_adjacent_cells() {
        for bits in 1..=6 {
            let side = 1_u32 << bits;
            let cells = (0..side).flat_map(|x| (0..side).map(move |y| [x, y]));
            let mut path: Vec<(u32, [u32; 2])> =
                cells.map(|cell| (hilbert(bits, cell), cell)).collect();
            path.sort_unstable();
            assert!(path.iter().map(|step| step.0).eq(0..side * side));
            for pair in path.windows(2) {
                let [[a, b], [c, d]] = [pair[0].1, pair[1].1];
                assert_eq!(a.abs_diff(c) + b.abs_diff(d), 1, "{pair:?}");
            }
        }
    }
}

//! Splines: rational B-splines, and cubic splines through points.

use super::map::{MOST_POINTS, Point};
use libm::hypot;

/// The highest degree.
const MOST_DEGREE: usize = 20;
/// How often a part between two knots is halved at most.
const DEEPEST: u32 = 8;

/// A rational B-spline.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    degree: usize,
    knots: Vec<f64>,
    /// The control points, multiplied by their weights, and the weights.
    points: Vec<[f64; 3]>,
}

impl Spline {
    /// A B-spline; without weights they are 1.
    ///
    /// # Errors
    /// What is wrong, as the rest of a sentence.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        controls: &[Point],
        weights: &[f64],
    ) -> Result<Self, String> {
        if degree == 0 || degree > MOST_DEGREE {
            return Err(format!(
                "has degree {degree}; it must be 1 to {MOST_DEGREE}"
            ));
        }
        let needed = controls.len() + degree + 1;
        if controls.len() <= degree || knots.len() != needed {
            return Err(format!(
                "has {} knots and {} control points; degree {degree} needs {needed} knots, and more points than the \
                 degree",
                knots.len(),
                controls.len()
            ));
        }
        if !knots.is_sorted() {
            return Err("has knots that decrease".to_owned());
        }
        let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
        let weighted = |(k, p): (usize, &Point)| [p[0] * weight(k), p[1] * weight(k), weight(k)];
        Ok(Self {
            degree,
            knots,
            points: controls.iter().enumerate().map(weighted).collect(),
        })
    }

    /// The point at a parameter within the span that begins at knot `k`, by de Boor's algorithm.
    fn at(&self, k: usize, t: f64) -> Point {
        let p = self.degree;
        let mut d = [[0.0; 3]; MOST_DEGREE + 1];
        d[..=p].copy_from_slice(&self.points[k - p..=k]);
        for r in 1..=p {
            for j in (r..=p).rev() {
                let [low, high] = [self.knots[j + k - p], self.knots[j + 1 + k - r]];
                let share = if high > low {
                    (t - low) / (high - low)
                } else {
                    0.0
                };
                d[j] = [0, 1, 2].map(|c| (1.0 - share) * d[j - 1][c] + share * d[j][c]);
            }
        }
        let [x, y, weight] = d[p];
        [x / weight, y / weight]
    }

    /// Adds its points.
    pub fn add(&self, tolerance: f64, points: &mut Vec<Point>) {
        for k in self.degree..self.points.len() {
            let [low, high] = [self.knots[k], self.knots[k + 1]];
            if low < high {
                let span = Span { spline: self, k };
                points.push(self.at(k, low));
                span.add([low, high], tolerance, DEEPEST, points);
                points.push(self.at(k, high));
            }
            if points.len() > MOST_POINTS {
                return;
            }
        }
    }
}

/// The part of a spline between two knots.
struct Span<'a> {
    spline: &'a Spline,
    k: usize,
}

impl Span<'_> {
    /// Adds points between two parameters, where the chord deviates by more than the tolerance.
    fn add(&self, [low, high]: [f64; 2], tolerance: f64, depth: u32, points: &mut Vec<Point>) {
        let at = |share: f64| self.spline.at(self.k, low + (high - low) * share);
        let [from, to] = [at(0.0), at(1.0)];
        let deviates = [0.25, 0.5, 0.75].map(|share| distance_to(at(share), from, to));
        // The largest deviation may be between these three; it exceeds them by less than a quarter.
        let is_straight = deviates
            .iter()
            .all(|&distance| distance <= 0.75 * tolerance);
        if is_straight && depth < DEEPEST || depth == 0 {
            return;
        }
        let middle = 0.5 * (low + high);
        self.add([low, middle], tolerance, depth - 1, points);
        points.push(at(0.5));
        self.add([middle, high], tolerance, depth - 1, points);
    }
}

/// The distance of a point from the line between two others.
fn distance_to(p: Point, from: Point, to: Point) -> f64 {
    let [along, off] = [
        [to[0] - from[0], to[1] - from[1]],
        [p[0] - from[0], p[1] - from[1]],
    ];
    let squared = along[0] * along[0] + along[1] * along[1];
    let share = match squared > 0.0 {
        true => ((off[0] * along[0] + off[1] * along[1]) / squared).clamp(0.0, 1.0),
        false => 0.0,
    };
    hypot(off[0] - share * along[0], off[1] - share * along[1])
}

/// The natural cubic spline through points, with the lengths of its chords as parameter: 16 points per chord.
pub fn through(points: &[Point]) -> Vec<Point> {
    let mut points = points.to_vec();
    points.dedup();
    let lengths: Vec<f64> = points
        .windows(2)
        .map(|p| distance_to(p[1], p[0], p[0]))
        .collect();
    if points.len() < 3 {
        return points;
    }
    let curvatures = [0, 1].map(|axis| curvature(&points, &lengths, axis));
    let mut found = vec![points[0]];
    for (k, &length) in lengths.iter().enumerate() {
        for step in 1..=16 {
            let b = f64::from(step) / 16.0;
            let a = 1.0 - b;
            let one = |axis: usize| {
                let [left, right] = [points[k][axis], points[k + 1][axis]];
                let [low, high] = [curvatures[axis][k], curvatures[axis][k + 1]];
                let bend = (a * a * a - a) * low + (b * b * b - b) * high;
                a * left + b * right + bend * length * length / 6.0
            };
            found.push([one(0), one(1)]);
        }
    }
    found
}

/// The second derivatives of the natural cubic spline at its points, by Thomas' algorithm.
fn curvature(points: &[Point], lengths: &[f64], axis: usize) -> Vec<f64> {
    let slope = |k: usize| (points[k + 1][axis] - points[k][axis]) / lengths[k];
    let last = points.len() - 1;
    let mut factors = vec![0.0; points.len()];
    let mut found = vec![0.0; points.len()];
    for k in 1..last {
        let diagonal = 2.0 * (lengths[k - 1] + lengths[k]) - lengths[k - 1] * factors[k - 1];
        factors[k] = lengths[k] / diagonal;
        found[k] = (6.0 * (slope(k) - slope(k - 1)) - lengths[k - 1] * found[k - 1]) / diagonal;
    }
    for k in (1..last).rev() {
        found[k] -= factors[k] * found[k + 1];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rational_spline_is_a_quarter_of_a_circle() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let controls = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let quarter = Spline::new(2, knots, &controls, &[1.0, half, 1.0]).unwrap();
        let mut points = Vec::new();
        quarter.add(1e-4, &mut points);
        assert!(
            points
                .iter()
                .all(|p| (hypot(p[0], p[1]) - 1.0).abs() < 1e-12)
        );
        let deviates = points.windows(2).map(|p| {
            let middle = [0.5 * (p[0][0] + p[1][0]), 0.5 * (p[0][1] + p[1][1])];
            1.0 - hypot(middle[0], middle[1])
        });
        assert!(deviates.fold(0.0, f64::max) <= 1e-4);
        assert!(points.len() < 130, "{}", points.len());
    }

    #[test]
    fn a_spline_through_points_meets_them_and_is_straight_where_they_are() {
        let given = [[0.0, 0.0], [1.0, 2.0], [3.0, 6.0], [4.0, 8.0]];
        let found = through(&given);
        assert!(
            given
                .iter()
                .all(|p| found.iter().any(|q| distance_to(*p, *q, *q) < 1e-12))
        );
        assert!(found.iter().all(|p| (p[1] - 2.0 * p[0]).abs() < 1e-9));
    }

    #[test]
    fn a_spline_without_enough_knots_is_refused() {
        let wrong = Spline::new(3, vec![0.0; 5], &[[0.0, 0.0]; 4], &[]);
        assert!(wrong.unwrap_err().contains("needs 8 knots"));
    }
}

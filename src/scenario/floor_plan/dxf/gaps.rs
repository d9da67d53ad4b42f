//! Gaps between the ends of lines and other lines.

use super::map::Point;
use super::network::Line;
use super::rows::Rows;
use crate::floor_plan::error::FloorPlanError;
use libm::hypot;

/// Ends nearer than this to another line meet it, meters.
const MEETING: f64 = 1e-9;

/// Most pairs of straight parts that cross: each pair takes about 200 bytes.
const MOST_CROSSINGS: usize = 2_000_000;
/// Most pairs of straight parts that are compared.
const MOST_PAIRS: usize = 300_000_000;

/// A gap that was closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// The end of a line.
    pub from: Point,
    /// The nearest point of another line.
    pub to: Point,
}

impl Gap {
    /// Its length.
    pub fn length(&self) -> f64 {
        distance(self.from, self.to)
    }
}

/// The distance between two points.
pub fn distance(a: Point, b: Point) -> f64 {
    hypot(a[0] - b[0], a[1] - b[1])
}

/// A straight part of a line.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The number of its line, and its place on it.
    line: usize,
    place: usize,
    ends: [Point; 2],
}

impl Part {
    /// Its nearest point to another one.
    fn nearest(&self, p: Point) -> Point {
        let [a, b] = self.ends;
        let along = [b[0] - a[0], b[1] - a[1]];
        let squared = along[0] * along[0] + along[1] * along[1];
        if squared == 0.0 {
            return a;
        }
        let share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / squared;
        match share {
            share if share <= 0.0 => a,
            share if share >= 1.0 => b,
            share => [a[0] + share * along[0], a[1] + share * along[1]],
        }
    }

    /// Whether it crosses or meets another one.
    fn meets(&self, other: &Self) -> bool {
        let side = |[a, b]: [Point; 2], p: Point| {
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
        };
        let crosses = |one: &Self, two: &Self| {
            let [p, q] = two.ends.map(|end| side(one.ends, end));
            p < 0.0 && q > 0.0 || p > 0.0 && q < 0.0
        };
        let is_near = |one: &Self, two: &Self| {
            let near = |&end: &Point| distance(end, two.nearest(end)) < MEETING;
            one.ends.iter().any(near)
        };
        crosses(self, other) && crosses(other, self) || is_near(self, other) || is_near(other, self)
    }
}

/// The straight parts of lines, by their heights.
struct Parts {
    all: Vec<Part>,
    rows: Rows,
}

impl Parts {
    fn new(lines: &[Line]) -> Self {
        let mut all = Vec::new();
        for (line, Line { points, .. }) in lines.iter().enumerate() {
            let parts = points.windows(2).enumerate();
            all.extend(parts.map(|(place, pair)| Part {
                line,
                place,
                ends: [pair[0], pair[1]],
            }));
        }
        let heights = all.iter().map(|part: &Part| {
            let [a, b] = part.ends.map(|end| end[1]);
            [a.min(b), a.max(b)]
        });
        let rows = Rows::new(&heights.collect::<Vec<_>>());
        Self { all, rows }
    }

    /// The nearest point of other lines to the end of a part; `None` if there is none within `gap`, or the part meets
    /// another line within it.
    fn gap(&self, own: &Part, end: Point, gap: f64) -> Option<Gap> {
        let mut nearest: Option<Gap> = None;
        for k in self.rows.within([end[1] - gap, end[1] + gap]) {
            let other = &self.all[k];
            // The parts beside it share its other end.
            if other.line == own.line && other.place.abs_diff(own.place) < 2 {
                continue;
            }
            let found = Gap {
                from: end,
                to: other.nearest(end),
            };
            if found.length() > gap {
                continue;
            }
            if own.meets(other) {
                return None;
            }
            if nearest.is_none_or(|nearest| found.length() < nearest.length()) {
                nearest = Some(found);
            }
        }
        nearest
    }
}

/// Refuses lines that cross each other too often.
pub fn refuse_crowded(lines: &[Line]) -> Result<(), FloorPlanError> {
    match cross_too_often(lines) {
        false => Ok(()),
        true => Err(FloorPlanError::Geometry {
            place: String::new(),
            reason: "the lines cross each other millions of times; say in `plan.layers` which layers are left out \
                     (`none`)"
                .to_owned(),
        }),
    }
}

/// Whether more pairs of straight parts of lines cross than [`MOST_CROSSINGS`], or are near each other than
/// [`MOST_PAIRS`].
fn cross_too_often(lines: &[Line]) -> bool {
    let parts = Parts::new(lines);
    let span = |part: &Part, k: usize| {
        let [a, b] = part.ends.map(|end| end[k]);
        [a.min(b), a.max(b)]
    };
    let overlap = |[low, high]: [f64; 2], [from, to]: [f64; 2]| low <= to && high >= from;
    let (mut pairs, mut crossings) = (0, 0);
    parts.rows.pairs(|one, other| {
        let [one, other] = [&parts.all[one], &parts.all[other]];
        let is_near = overlap(span(one, 0), span(other, 0));
        pairs += 1;
        crossings += usize::from(is_near && one.meets(other));
        pairs > MOST_PAIRS || crossings > MOST_CROSSINGS
    });
    pairs > MOST_PAIRS || crossings > MOST_CROSSINGS
}

/// Extends the ends of lines that are within `gap` of another line to it.
pub fn close(lines: &mut [Line], gap: f64) -> Vec<Gap> {
    let parts = Parts::new(lines);
    let mut gaps: Vec<Gap> = Vec::new();
    let mut first = 0;
    for line in lines.iter_mut() {
        let count = line.points.len().saturating_sub(1);
        let own = &parts.all[first..first + count];
        first += count;
        let (Some(start), Some(end)) = (own.first(), own.last()) else {
            continue;
        };
        if start.ends[0] == end.ends[1] {
            continue;
        }
        let before = parts.gap(start, start.ends[0], gap);
        let after = parts.gap(end, end.ends[1], gap);
        if let Some(gap) = before {
            line.points.insert(0, gap.to);
        }
        if let Some(gap) = after {
            line.points.push(gap.to);
        }
        for gap in before.into_iter().chain(after) {
            // Two ends that face each other are one gap.
            let is_known = gaps
                .iter()
                .rev()
                .take(1000)
                .any(|known| known.from == gap.to && known.to == gap.from);
            if !is_known {
                gaps.push(gap);
            }
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[Point]) -> Line {
        Line {
            points: points.to_vec(),
            is_open: false,
        }
    }

    #[test]
    fn ends_are_extended_to_lines_within_the_gap_only() {
        let mut lines = [
            line(&[[0.0, 0.0], [4.0, 0.0]]),
            line(&[[1.0, 0.01], [1.0, 2.0]]),
            line(&[[2.0, 0.03], [2.0, 2.0]]),
        ];
        let gaps = close(&mut lines, 0.02);
        assert_eq!(gaps.len(), 1);
        assert_eq!(lines[1].points, [[1.0, 0.0], [1.0, 0.01], [1.0, 2.0]]);
        assert_eq!(lines[2].points.len(), 2);
    }

    #[test]
    fn two_ends_that_face_each_other_are_one_gap_and_overshoots_are_none() {
        let mut facing = [
            line(&[[0.0, 0.0], [1.0, 0.0]]),
            line(&[[1.01, 0.0], [2.0, 0.0]]),
        ];
        assert_eq!(close(&mut facing, 0.02).len(), 1);
        let mut crossing = [
            line(&[[0.0, 0.0], [1.0, 0.0]]),
            line(&[[0.99, -1.0], [0.99, 0.01]]),
        ];
        assert_eq!(close(&mut crossing, 0.02), []);
    }
}

//! An index of intervals on the y axis.

/// Most rows.
const MOST_ROWS: usize = 1024;

/// Intervals by the rows of equal height that they meet.
pub struct Rows {
    low: f64,
    /// Rows per length.
    density: f64,
    rows: Vec<Vec<usize>>,
    /// The first row of each interval.
    first: Vec<usize>,
}

impl Rows {
    /// An index of intervals, each from its low to its high end.
    pub fn new(intervals: &[[f64; 2]]) -> Self {
        let low = intervals
            .iter()
            .map(|ends| ends[0])
            .fold(f64::INFINITY, f64::min);
        let high = intervals.iter().map(|ends| ends[1]).fold(low, f64::max);
        let count = (intervals.len() as f64)
            .sqrt()
            .ceil()
            .clamp(1.0, MOST_ROWS as f64);
        let density = if high > low {
            count / (high - low)
        } else {
            0.0
        };
        let mut index = Self {
            low,
            density,
            rows: vec![Vec::new(); count as usize],
            first: Vec::with_capacity(intervals.len()),
        };
        for (k, &[from, to]) in intervals.iter().enumerate() {
            let [first, last] = [index.row(from), index.row(to)];
            index.first.push(first);
            for row in &mut index.rows[first..=last.max(first)] {
                row.push(k);
            }
        }
        index
    }

    /// The row at a height; the first or the last one beyond.
    fn row(&self, y: f64) -> usize {
        let row = ((y - self.low) * self.density).max(0.0) as usize;
        row.min(self.rows.len() - 1)
    }

    /// The numbers of the intervals that may contain a height.
    pub fn at(&self, y: f64) -> &[usize] {
        &self.rows[self.row(y)]
    }

    /// The numbers of the intervals that may meet another one, some of them several times.
    pub fn within(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = usize> {
        let [first, last] = [self.row(from), self.row(to)];
        self.rows[first..=last.max(first)].iter().flatten().copied()
    }

    /// Visits pairs of intervals that share rows, once each, until `visit` says that it is enough.
    pub fn pairs(&self, mut visit: impl FnMut(usize, usize) -> bool) {
        for (number, row) in self.rows.iter().enumerate() {
            for (k, &one) in row.iter().enumerate() {
                for &other in &row[k + 1..] {
                    let is_first = self.first[one].max(self.first[other]) == number;
                    if is_first && visit(one, other) {
                        return;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_that_overlap_are_visited_once() {
        let intervals = [[0.0, 9.0], [1.0, 8.0], [0.0, 1.0], [8.5, 9.0], [4.0, 4.0]];
        let rows = Rows::new(&intervals);
        let mut found = Vec::new();
        rows.pairs(|a, b| {
            found.push([a, b]);
            false
        });
        found.sort_unstable();
        let visited = found.len();
        found.dedup();
        assert_eq!(found.len(), visited);
        for overlapping in [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [1, 4]] {
            assert!(found.contains(&overlapping));
        }
        assert!(!found.contains(&[2, 3]));
    }
}

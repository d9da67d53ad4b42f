//! An index of intervals on the y axis.

/// Most rows.
const MOST_ROWS: usize = 1024;

/// Intervals by the rows of equal height that they meet.
pub struct Rows {
    low: f64,
    /// Rows per length.
    density: f64,
    rows: Vec<Vec<usize>>,
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
        };
        for (k, &[from, to]) in intervals.iter().enumerate() {
            let [first, last] = [index.row(from), index.row(to)];
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
}

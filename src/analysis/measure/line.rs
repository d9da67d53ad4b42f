//! Who crosses a line, when, and how many that makes.

use serde::Serialize;

use crate::engine::math::Vector;
use crate::output::trajectory::read::Tracks;

/// A line to be crossed. Forward is from its left to its right, seen from its first end to its second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// First end, metres; it belongs to the line.
    pub start: Vector,
    /// Second end, metres; it does not, so that nobody crosses two lines where they join.
    pub end: Vector,
}

impl Line {
    /// Length in metres.
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// Positive on the left; whoever is on the line itself is on its right.
    fn left(&self, p: Vector) -> f64 {
        (self.end - self.start).perp(&(p - self.start))
    }

    /// How far along the way from `from` to `to` it crosses the line, 0 to 1, and whether forward.
    pub fn crossed(&self, from: Vector, to: Vector) -> Option<(f64, bool)> {
        let [before, after] = [from, to].map(|p| self.left(p));
        if (before > 0.0) == (after > 0.0) {
            return None;
        }
        let part = before / (before - after);
        let along = (from + (to - from) * part - self.start).dot(&(self.end - self.start));
        let within = (0.0..self.length() * self.length()).contains(&along);
        within.then_some((part, before > 0.0))
    }
}

/// Somebody crosses a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Crossing {
    /// The line, in the order given from 1.
    pub line: usize,
    /// When, seconds: between two frames, as if the person walked evenly.
    pub time: f64,
    /// The first frame in which the person is beyond.
    pub frame: i64,
    /// Who.
    pub id: i64,
    /// Where, metres.
    pub x: f64,
    /// Likewise.
    pub y: f64,
    /// 1 forward, −1 backward.
    pub direction: i8,
    /// Does it count? Who sways to and fro over the line passes it once: a crossing counts if it takes the
    /// person's balance, crossings forward less backward, where it has never been.
    pub passage: bool,
    /// How many have passed forward until now.
    pub forward: u64,
    /// How many have passed backward.
    pub backward: u64,
    /// All crossings forward less all backward until now.
    pub net: i64,
}

/// All that cross one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossings {
    /// The line.
    pub line: Line,
    /// By time.
    pub list: Vec<Crossing>,
    /// How many are on the other side after a gap: not counted, for nobody saw where they went.
    pub across_gaps: u64,
}

impl Crossings {
    /// Of line `number`, at times in seconds between `from` and `until`.
    pub fn of(tracks: &Tracks, number: usize, line: Line, [from, until]: [f64; 2]) -> Self {
        let mut list = Vec::new();
        let mut across_gaps = 0;
        for (p, &id) in tracks.ids.iter().enumerate() {
            let (mut balance, mut lowest, mut highest) = (0, 0, 0);
            for pair in tracks.rows_of(p).windows(2) {
                let [before, after] = [pair[0], pair[1]].map(|row| row as usize);
                let [start, end] = [before, after].map(|row| tracks.position[row]);
                let Some((part, is_forward)) = line.crossed(start, end) else {
                    continue;
                };
                let [left, frame] = [before, after].map(|row| tracks.frame_of(row));
                let time = (left as f64 + (frame - left) as f64 * part) / tracks.fps;
                if !(from..=until).contains(&time) {
                    continue;
                }
                if frame - left != tracks.step {
                    across_gaps += 1;
                    continue;
                }
                let direction: i8 = if is_forward { 1 } else { -1 };
                balance += i64::from(direction);
                let passage = balance < lowest || balance > highest;
                (lowest, highest) = (lowest.min(balance), highest.max(balance));
                let place = start + (end - start) * part;
                list.push(Crossing {
                    line: number,
                    time,
                    frame,
                    id,
                    x: place.x,
                    y: place.y,
                    direction,
                    passage,
                    forward: 0,
                    backward: 0,
                    net: 0,
                });
            }
        }
        list.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.id.cmp(&b.id)));
        let (mut forward, mut backward, mut net) = (0, 0, 0);
        for crossing in &mut list {
            net += i64::from(crossing.direction);
            forward += u64::from(crossing.passage && crossing.direction > 0);
            backward += u64::from(crossing.passage && crossing.direction < 0);
            (crossing.forward, crossing.backward, crossing.net) = (forward, backward, net);
        }
        Self {
            line,
            list,
            across_gaps,
        }
    }

    /// When somebody passes in this direction, seconds, rising.
    pub fn passages(&self, direction: i8) -> impl Iterator<Item = f64> + '_ {
        let passages = self.list.iter().filter(|crossing| crossing.passage);
        passages
            .filter(move |crossing| crossing.direction == direction)
            .map(|crossing| crossing.time)
    }

    /// (n − 1) / (time of the last passage in this direction − time of the first), P/s; `None` for fewer
    /// than two.
    pub fn flow(&self, direction: i8) -> Option<f64> {
        let count = self.passages(direction).count();
        let first = self.passages(direction).next()?;
        let last = self.passages(direction).last()?;
        (last > first).then(|| (count - 1) as f64 / (last - first))
    }
}

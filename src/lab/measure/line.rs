//! Crossings of a line: people, times and counts.

use serde::Serialize;

use super::{MeasureError, Options};
use analysis::crossing::{Balance, FlowBetween, Line, Passages};
use analysis::site::Site;
use scenario::floor_plan::is_line_on_floor;
use scenario::trajectories::Tracks;

/// A person crosses a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Crossing {
    /// Number of the line, from 1 in the given order.
    pub line: usize,
    /// Time, seconds, interpolated linearly between two frames.
    pub time: f64,
    /// The first frame in which the person is beyond the line.
    pub frame: i64,
    /// The person's id.
    pub id: i64,
    /// Position, meters.
    pub x: f64,
    /// Its y component.
    pub y: f64,
    /// 1 forward, −1 backward.
    pub direction: i8,
    /// Whether the crossing counts as a passage. A person who sways back and forth across the line passes it once: a
    /// crossing counts if the person's balance, crossings forward minus backward, reaches a new extreme.
    pub passage: bool,
    /// Passages forward so far.
    pub forward: u64,
    /// Passages backward so far.
    pub backward: u64,
    /// All crossings forward minus all backward so far.
    pub net: i64,
}

/// All crossings of one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossings {
    /// The line.
    pub line: Line,
    /// Sorted by time.
    pub list: Vec<Crossing>,
    /// Number of crossings during gaps in a person's data. They do not count, because the path is unknown.
    pub across_gaps: u64,
}

/// Refuses lines off the floor, unless someone crosses them: real people may walk a little beyond the plan.
///
/// # Errors
/// The number of the first such line.
pub fn check(tracks: &Tracks, site: &Site, options: &Options) -> Result<(), MeasureError> {
    for (k, &line) in options.lines.iter().enumerate() {
        let is_on = is_line_on_floor([line.start, line.end], &site.walls);
        if is_on.map_err(|error| MeasureError::Floor(error.to_string()))? {
            continue;
        }
        let crossed = Crossings::of(tracks, k + 1, line, options.times);
        if crossed.list.is_empty() && crossed.across_gaps == 0 {
            return Err(MeasureError::LineOffFloor(k + 1));
        }
    }
    Ok(())
}

impl Crossings {
    /// The crossings of line `number` from time `from` until time `until`, seconds.
    pub fn of(tracks: &Tracks, number: usize, line: Line, [from, until]: [f64; 2]) -> Self {
        let mut list = Vec::new();
        let mut across_gaps = 0;
        for (p, &id) in tracks.ids.iter().enumerate() {
            let mut balance = Balance::default();
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
                if tracks.is_gap(p, frame - left) {
                    across_gaps += 1;
                    continue;
                }
                let direction: i8 = if is_forward { 1 } else { -1 };
                let passage = balance.passes(is_forward);
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

    /// The crossings in a direction: 1 forward, −1 backward; and the flow between two of its passages.
    pub fn way(&self, direction: i8, part: Passages) -> Way {
        let all = self.list.iter().filter(|c| c.direction == direction);
        let times: Vec<f64> = self.passages(direction).collect();
        let (first, last) = (times.first(), times.last());
        let span = first.zip(last).map(|(first, last)| last - first);
        let lasting = span.filter(|&span| span > 0.0);
        let flow = lasting.map(|span| (times.len() - 1) as f64 / span);
        Way {
            passages: times.len(),
            crossings: all.count(),
            first_secs: first.copied(),
            last_secs: last.copied(),
            flow_per_s: flow,
            specific_flow_per_m_s: flow.map(|flow| flow / self.line.length()),
            part: part.flow(&times),
        }
    }

    /// Times of the passages in a direction, seconds, ascending.
    pub fn passages(&self, direction: i8) -> impl Iterator<Item = f64> + '_ {
        let passages = self.list.iter().filter(|crossing| crossing.passage);
        passages
            .filter(move |crossing| crossing.direction == direction)
            .map(|crossing| crossing.time)
    }
}

/// The crossings of a line in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Way {
    /// Number of passages.
    pub passages: usize,
    /// Number of crossings, passages or not.
    pub crossings: usize,
    /// Time of the first passage, seconds.
    pub first_secs: Option<f64>,
    /// Time of the last passage, seconds.
    pub last_secs: Option<f64>,
    /// (n − 1) / (time of the last passage − time of the first), P/s; `None` for fewer than two passages.
    pub flow_per_s: Option<f64>,
    /// The flow divided by the length of the line, P/(m s).
    pub specific_flow_per_m_s: Option<f64>,
    /// The flow between the two passages that the options name.
    pub part: Option<FlowBetween>,
}

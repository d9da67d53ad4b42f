//! The log of events of a run: entries, exits, pushes, arrivals, and the end.

use analysis::round;
use engine::simulation::{Event, EventKind, Simulation};

/// The levels of lines.
const INFO: &str = "INFO";
const WARN: &str = "WARN";
/// The most lines on arrivals.
const MOST_ARRIVALS: f64 = 100.0;

/// A line of the log.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The number of the frame.
    pub frame: i64,
    /// Seconds.
    pub time: f64,
    /// What happened.
    pub text: String,
    /// `INFO` or `WARN`.
    pub level: &'static str,
}

impl Line {
    /// An ordinary line.
    pub fn info((frame, time): (i64, f64), text: String) -> Self {
        let level = INFO;
        Self {
            frame,
            time,
            text,
            level,
        }
    }
}

/// The state of the log.
#[derive(Debug, Clone)]
pub struct Events {
    /// A line on arrivals is written after this many.
    step: usize,
    /// Number of events and of arrivals that were logged or left out; `None` before the first frame.
    seen: Option<[usize; 2]>,
    /// Counted arrivals so far.
    pub evacuated: usize,
}

impl Events {
    /// The log of a run that at most `entering` agents enter.
    pub fn new(entering: u64) -> Self {
        Self {
            step: step(entering),
            seen: None,
            evacuated: 0,
        }
    }

    /// The lines on what has happened since the last call. Events before the first call are left out: they would only
    /// stretch the time line.
    pub fn new_lines(&mut self, simulation: &Simulation) -> Vec<Line> {
        let (clock, events) = (simulation.frame().clock, simulation.events());
        let arrivals = &simulation.outcome().arrivals;
        let is_first = self.seen.is_none();
        let [known, arrived] = self
            .seen
            .replace([events.len(), arrivals.len()])
            .unwrap_or_default();
        let unseen = events[known..].iter();
        let new = unseen.filter(|event| !is_first || event.frame == clock.frame());
        let line = |event: &Event| {
            let (text, level) = in_words(event);
            Line {
                frame: event.frame.cast_signed(),
                time: clock.time_at(event.frame),
                text,
                level,
            }
        };
        let mut lines: Vec<Line> = new.map(line).collect();
        for arrival in arrivals[arrived..].iter().filter(|arrival| arrival.counted) {
            self.evacuated += 1;
            if self.evacuated.is_multiple_of(self.step) && !is_first {
                let frame = clock.frame_at(arrival.time).cast_signed();
                let text = format!("{} agents have arrived", self.evacuated);
                lines.push(Line::info((frame, arrival.time), text));
            }
        }
        lines
    }
}

/// 10, or the smallest of 20, 50, 100, 200, … with which `entering` agents make at most a hundred lines.
fn step(entering: u64) -> usize {
    let least = (entering as f64 + 1.0) / (MOST_ARRIVALS + 1.0);
    round::step(least).max(10.0) as usize
}

fn in_words(event: &Event) -> (String, &'static str) {
    let name = &event.name;
    match event.kind {
        EventKind::Entered(count) => (format!("{name}: {count} agents enter"), INFO),
        EventKind::PushBegan(count) => (format!("{name}: {count} agents begin to push"), WARN),
        EventKind::Opened => (format!("{name} opens"), INFO),
        EventKind::Closed => (format!("{name} closes"), WARN),
        EventKind::Released => (format!("{name}: agents wait no longer"), INFO),
        EventKind::Intervention => (name.clone(), INFO),
        EventKind::PushEnded => (format!("{name}: the push is over"), WARN),
    }
}

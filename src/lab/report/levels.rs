//! The people on each level of a building over the time of a run.

use std::sync::Arc;

use crate::gallery::color;
use engine::levels::Levels;
use engine::simulation::Simulation;
use output::document::Block;
use output::plot::{Axis, Corner, Mark, Panel, Sheet, Style};
use output::table::Table;
use scenario::Scenario;
use scenario::quote::shown;

/// The most steps of a curve: nearer ones are not seen apart.
const STEPS: f64 = 1000.0;

/// The number of people on a level from a time on, seconds.
type Change = (f64, u32);

/// The people on each level so far.
pub struct OnLevels {
    levels: Option<Arc<Levels>>,
    /// The changes of their number on each level, from the first frame on.
    changes: Vec<Vec<Change>>,
    /// The time of the last frame, seconds.
    end: f64,
}

/// A row of the table.
struct Row {
    level: String,
    start: u32,
    most: u32,
    /// The time of the first maximum, and the time from which on the level is empty, seconds.
    most_at: f64,
    empty_from: Option<f64>,
    end: u32,
}

impl Row {
    fn of(level: String, changes: &[Change]) -> Self {
        let (_, start) = changes.first().copied().unwrap_or_default();
        let (last_at, end) = changes.last().copied().unwrap_or_default();
        let most = most(changes);
        let first = changes.iter().find(|(_, count)| *count == most);
        Self {
            level,
            start,
            most,
            most_at: first.map_or(0.0, |&(time, _)| time),
            empty_from: (end == 0).then_some(last_at),
            end,
        }
    }
}

/// The largest number of people on a level.
fn most(changes: &[Change]) -> u32 {
    let counts = changes.iter().map(|&(_, count)| count);
    counts.max().unwrap_or_default()
}

impl OnLevels {
    /// Nothing yet.
    pub fn new(scenario: &Scenario) -> Self {
        let levels = scenario.scene.levels.clone();
        let count = levels.as_ref().map_or(0, |levels| levels.all().len());
        Self {
            levels,
            changes: vec![Vec::new(); count],
            end: 0.0,
        }
    }

    /// Counts people in the current frame.
    pub fn see(&mut self, simulation: &Simulation) {
        let Some(levels) = &self.levels else {
            return;
        };
        let frame = simulation.frame();
        self.end = frame.clock.time();
        let mut counts = vec![0; self.changes.len()];
        for i in frame.agents.present() {
            counts[levels.level(frame.agents.position[i])] += 1;
        }
        for (changes, count) in self.changes.iter_mut().zip(counts) {
            if changes.last().is_none_or(|&(_, last)| last != count) {
                changes.push((self.end, count));
            }
        }
    }

    /// The levels on which people were, with the changes there.
    fn used(&self) -> impl Iterator<Item = (String, &[Change])> {
        let levels = self.levels.iter().flat_map(|levels| levels.all());
        let counted = levels.zip(&self.changes);
        let used = counted.filter(|(_, changes)| most(changes) > 0);
        used.map(|(level, changes)| (shown(&level.name), &changes[..]))
    }

    /// The table and the curves; nothing of a scene on one floor.
    pub fn blocks(&self) -> Vec<Block> {
        let rows: Vec<Row> = self
            .used()
            .map(|(level, changes)| Row::of(level, changes))
            .collect();
        if rows.is_empty() {
            return Vec::new();
        }
        let table = Table::of(&rows)
            .column("level", |row| row.level.as_str())
            .column("at the start", |row| row.start)
            .column("most at once", |row| row.most)
            .fixed("at [s]", 1, |row| row.most_at)
            .fixed("empty from [s]", 1, |row| row.empty_from)
            .column("at the end", |row| row.end)
            .table();
        let caption = "The number of people on each level, counted in every frame.";
        vec![
            Block::heading("Levels"),
            Block::Table(table, caption.to_owned()),
            Block::figure(
                "",
                self.sheet(),
                "People on each level over time.".to_owned(),
            ),
        ]
    }

    fn sheet(&self) -> Sheet {
        let mut marks = Vec::new();
        let mut top: u32 = 1;
        for (k, (name, changes)) in self.used().enumerate() {
            top = top.max(most(changes));
            let style = Style::full(color(k), 1.4, &name);
            marks.push(Mark::line(self.steps(changes), style));
        }
        let x = Axis::linear("time [s]", [0.0, self.end.max(1.0)]);
        let y = Axis::linear("people", [0.0, 1.05 * f64::from(top)]);
        let panel = Panel::new("", x, y, marks).with_legend(Corner::Beside);
        Sheet::new("", 1, [420.0, 240.0], vec![panel])
    }

    /// The corners of the curve of a level.
    fn steps(&self, changes: &[Change]) -> Vec<[f64; 2]> {
        let bin = |time: f64| (STEPS * time / self.end.max(1.0)) as u32;
        let near = changes.chunk_by(|(one, _), (other, _)| bin(*one) == bin(*other));
        let mut corners: Vec<[f64; 2]> = Vec::new();
        for &(time, count) in near.filter_map(<[Change]>::last) {
            if let Some(&[_, before]) = corners.last() {
                corners.push([time, before]);
            }
            corners.push([time, f64::from(count)]);
        }
        if let Some(&[_, last]) = corners.last() {
            corners.push([self.end, last]);
        }
        corners
    }
}

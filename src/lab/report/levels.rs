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

/// The time between two counts, seconds.
const EVERY: f64 = 1.0;

/// The people on each level so far.
pub struct OnLevels {
    levels: Option<Arc<Levels>>,
    /// The times of the counts, seconds.
    times: Vec<f64>,
    /// The number of people on each level, at each time.
    counts: Vec<Vec<u32>>,
    /// Whether the last count is due. Otherwise it is that of the current frame, and the next one replaces it.
    is_kept: bool,
}

/// A row of the table.
struct Row {
    level: String,
    start: u32,
    most: u32,
    /// When most people were there, and when the last one left, seconds.
    most_at: f64,
    empty_at: Option<f64>,
    end: u32,
}

impl OnLevels {
    /// Nothing yet.
    pub fn new(scenario: &Scenario) -> Self {
        let levels = scenario.scene.levels.clone();
        let count = levels.as_ref().map_or(0, |levels| levels.all().len());
        Self {
            levels,
            times: Vec::new(),
            counts: vec![Vec::new(); count],
            is_kept: true,
        }
    }

    /// Counts people in the current frame: once per second, when the building `is_empty`, and in the last frame.
    pub fn see(&mut self, simulation: &Simulation, is_empty: bool) {
        let Some(levels) = &self.levels else {
            return;
        };
        let now = simulation.frame().clock.time();
        if !self.is_kept {
            self.times.pop();
            self.counts.iter_mut().for_each(|all| _ = all.pop());
        }
        let last = self.times.last().copied();
        if last.is_some_and(|last| now <= last) {
            return;
        }
        self.is_kept = is_empty || last.is_none_or(|last| now >= last + EVERY - 1e-9);
        let agents = simulation.frame().agents;
        let mut counts = vec![0; self.counts.len()];
        for i in agents.present() {
            counts[levels.level(agents.position[i])] += 1;
        }
        self.times.push(now);
        for (all, count) in self.counts.iter_mut().zip(counts) {
            all.push(count);
        }
    }

    /// The levels on which people were, with the counts.
    fn used(&self) -> impl Iterator<Item = (String, &[u32])> {
        let levels = self.levels.iter().flat_map(|levels| levels.all());
        let counted = levels.zip(&self.counts);
        let used = counted.filter(|(_, counts)| counts.iter().any(|&count| count > 0));
        used.map(|(level, counts)| (shown(&level.name), &counts[..]))
    }

    /// The table and the curves; nothing of a scene on one floor.
    pub fn blocks(&self) -> Vec<Block> {
        let rows: Vec<Row> = self
            .used()
            .map(|(level, counts)| self.row(level, counts))
            .collect();
        if rows.is_empty() {
            return Vec::new();
        }
        let table = Table::of(&rows)
            .column("level", |row| row.level.as_str())
            .column("at the start", |row| row.start)
            .column("most at once", |row| row.most)
            .fixed("at [s]", 0, |row| row.most_at)
            .fixed("empty from [s]", 0, |row| row.empty_at)
            .column("at the end", |row| row.end)
            .table();
        let caption =
            "The number of people on each level, counted every second and in the last frame.";
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

    fn row(&self, level: String, counts: &[u32]) -> Row {
        let most = counts.iter().copied().max().unwrap_or_default();
        let first = counts.iter().position(|&count| count == most);
        let last = counts.iter().rposition(|&count| count > 0);
        Row {
            level,
            start: counts.first().copied().unwrap_or_default(),
            most,
            most_at: first.map_or(0.0, |k| self.times[k]),
            empty_at: last.and_then(|k| self.times.get(k + 1).copied()),
            end: counts.last().copied().unwrap_or_default(),
        }
    }

    fn sheet(&self) -> Sheet {
        let mut marks = Vec::new();
        let mut top: u32 = 1;
        for (k, (name, counts)) in self.used().enumerate() {
            top = counts.iter().copied().fold(top, u32::max);
            let counted = self.times.iter().zip(counts);
            let points = counted.map(|(&time, &count)| [time, f64::from(count)]);
            marks.push(Mark::line(points, Style::full(color(k), 1.4, &name)));
        }
        let end = self.times.last().copied().unwrap_or_default().max(EVERY);
        let x = Axis::linear("time [s]", [0.0, end]);
        let y = Axis::linear("people", [0.0, 1.05 * f64::from(top)]);
        let panel = Panel::new("", x, y, marks).with_legend(Corner::Beside);
        Sheet::new("", 1, [420.0, 240.0], vec![panel])
    }
}

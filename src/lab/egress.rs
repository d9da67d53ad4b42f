//! How people leave: the number of people out over time, by exit, as a table and a curve.

use crate::gallery::{color, spanned};
use engine::simulation::Simulation;
use output::plot::{Axis, Corner, GRAY, Mark, Panel, Sheet, Style};
use output::table::Table;
use scenario::measurements::times_to_leave;
use scenario::trajectories::Tracks;

/// What a row of the table and a line of the curve with all people are called.
const ALL: &str = "all";
/// People who leave at goals, not at exits.
const GOALS: &str = "goals";

/// The people who leave.
#[derive(Debug, Clone, Default)]
pub struct Egress {
    /// The number of people who entered.
    pub entered: u32,
    /// The exits at which people have left, in the order of the scenario, with the times of all people, seconds,
    /// ascending.
    pub exits: Vec<(String, Vec<f64>)>,
    /// The number of people present in the last frame.
    pub remaining: u32,
    /// The time of the last frame, seconds.
    pub until: f64,
}

/// A row of the table.
struct Row<'a> {
    name: &'a str,
    times: &'a [f64],
    /// The number of people of whom it gives the times to leave.
    of: u32,
    share: f64,
}

impl Egress {
    /// The people who have left a run so far.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let places = &simulation.scene().journeys.places;
        let mut exits: Vec<(String, Vec<f64>)> = places
            .iter()
            .map(|place| (place.name.clone(), Vec::new()))
            .chain([(GOALS.to_owned(), Vec::new())])
            .collect();
        for arrival in &simulation.outcome().arrivals {
            let exit = arrival.trip.map(|trip| usize::from(trip.exit));
            exits[exit.unwrap_or(places.len())].1.push(arrival.time);
        }
        exits.retain(|(_, times)| !times.is_empty());
        Self {
            entered: frame.agents.entered(),
            exits,
            remaining: frame.agents.count_present() as u32,
            until: frame.clock.time(),
        }
    }

    /// The people in trajectories: they leave when they are last seen. Those in the last frame of `all`, which have the
    /// people of all levels, have not left.
    pub fn of_tracks(tracks: &Tracks, all: &Tracks) -> Self {
        let until = all.frames.last().map_or(0.0, |&last| all.time(last));
        let people = 0..tracks.ids.len();
        let ends = people.map(|p| tracks.times_of(p)[1]);
        let mut times: Vec<f64> = ends.collect();
        let entered = times.len() as u32;
        times.retain(|&end| end < until - tracks.rounding());
        times.sort_by(f64::total_cmp);
        Self {
            entered,
            remaining: entered - times.len() as u32,
            exits: vec![("last seen".to_owned(), times)],
            until,
        }
    }

    /// A note on the people who have not left; `None` without any.
    pub fn note(&self) -> Option<String> {
        let people = match self.remaining {
            0 => return None,
            1 => "1 person is".to_owned(),
            count => format!("{count} people are"),
        };
        let until = self.until;
        Some(format!(
            "{people} still there in the last frame, at {until:.2} s"
        ))
    }

    /// The times of all people who have left, seconds, ascending.
    fn all(&self) -> Vec<f64> {
        let all = self.exits.iter().flat_map(|(_, times)| times);
        let mut times: Vec<f64> = all.copied().collect();
        times.sort_by(f64::total_cmp);
        times
    }

    /// The people out, their share of all who entered, and when the first one, 50 %, 95 % and the last one left; by
    /// exit.
    pub fn table(&self) -> Table {
        let all = self.all();
        let row = |(name, times, of)| Row {
            name,
            times,
            of,
            share: 100.0 * times.len() as f64 / f64::from(self.entered.max(1)),
        };
        let named = self.exits.iter();
        let exits =
            named.map(|(name, times)| (name.as_str(), times.as_slice(), times.len() as u32));
        let whole = (ALL, all.as_slice(), self.entered);
        let rows: Vec<Row> = match self.exits.len() {
            1 => [whole].map(row).into(),
            _ => exits.chain([whole]).map(row).collect(),
        };
        Table::of(&rows)
            .column("exit", |row| row.name)
            .column("people out", |row| row.times.len())
            .fixed("share [%]", 1, |row| row.share)
            .fixed("first [s]", 1, |row| row.times.first().copied())
            .fixed("50 % [s]", 1, |row| times_to_leave(row.times, row.of)[0])
            .fixed("95 % [s]", 1, |row| times_to_leave(row.times, row.of)[1])
            .fixed("all [s]", 1, |row| times_to_leave(row.times, row.of)[2])
            .table()
    }

    /// The number of people out over time, by exit, with the times to 50, 95 and 100 %, and the note.
    pub fn sheet(&self, title: &str) -> Sheet {
        let all = self.all();
        let [start, end] = [0.0, self.until.max(1.0)];
        let entered = f64::from(self.entered).max(1.0);
        let mut marks = Vec::new();
        for (time, part) in times_to_leave(&all, self.entered)
            .into_iter()
            .zip([0.5, 0.95, 1.0])
        {
            if let Some(time) = time {
                let to = part * entered;
                let path = [[start, to], [time, to], [time, 0.0]];
                marks.push(Mark::line(path, Style::broken(GRAY, 0.7, "")));
                let text = format!("{:.0} %: {time:.1} s", 100.0 * part);
                marks.push(Mark::label([start + 0.01 * end, to], [1, 1], text));
            }
        }
        let mut curve = |times: &[f64], style| marks.push(Mark::line(self.steps(times), style));
        if self.exits.len() > 1 {
            for (k, (name, times)) in self.exits.iter().enumerate() {
                curve(times, Style::full(color(k + 1), 1.2, name));
            }
        }
        curve(&all, Style::full(color(0), 1.6, ALL));
        if let Some(note) = self.note() {
            marks.push(Mark::label([end, 0.0], [-1, 1], note));
        }
        let x = Axis::linear("time [s]", [start, 1.02 * end]);
        let top = spanned([0.0, entered].into_iter())[1];
        let y = Axis::linear("people out", [0.0, top]);
        let plain = Panel::new("", x, y, marks);
        let panel = match self.exits.len() {
            1 => plain,
            _ => plain.with_legend(Corner::Beside),
        };
        Sheet::new(title, 1, [420.0, 240.0], vec![panel])
    }

    /// The corners of the curve of some times.
    fn steps(&self, times: &[f64]) -> Vec<[f64; 2]> {
        let steps = times.iter().enumerate().flat_map(|(k, &time)| {
            let before = k as f64;
            [[time, before], [time, before + 1.0]]
        });
        let start = [0.0, 0.0];
        let end = [self.until, times.len() as f64];
        [start].into_iter().chain(steps).chain([end]).collect()
    }
}

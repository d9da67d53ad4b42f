//! The summary of a measurement, as text or JSON.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::{CLASS, Class, Crossings, Diagram, Measured, Options, Way, safety_report};
use crate::analysis::statistics::MeanStd;
use crate::output::table::{Cell, Table};
use crate::scenario::trajectories::Tracks;

/// The summary of a measurement.
pub struct Report<'a> {
    /// The measured trajectories.
    pub tracks: &'a Tracks,
    /// The options of the measurement.
    pub options: &'a Options,
    /// The results.
    pub measured: &'a Measured,
}

impl Report<'_> {
    /// As text for a terminal.
    pub fn text(&self) -> String {
        let overview = &self.measured.overview;
        let ([first, last], reach) = (overview.times, self.reach());
        let spread = |of: &MeanStd| format!("{:.3} ± {:.3}", of.mean, of.population_std());
        let empty = match overview.empty_frames {
            0 => String::new(),
            empty => format!(", {empty} without people"),
        };
        let mut text = format!(
            "{} people, {} rows in {} frames at {} fps, {first:.2} s to {last:.2} s{empty}\n",
            overview.people, overview.rows, overview.frames, self.tracks.fps,
        );
        text += &format!(
            "  density  {} P/m² over all rows, h = {} m\n",
            spread(&overview.density),
            self.options.kernel.support_radius,
        );
        if let Some((person, frame, time)) = overview.densest {
            let place = person.position;
            text += &format!(
                "           at most {:.3} P/m²: person {} at ({:.2}, {:.2}) m, {time:.2} s, frame {frame}\n",
                person.density, person.id, place.x, place.y,
            );
        }
        text += &match overview.speed.count {
            0 => "  speed    unknown for all rows\n".to_owned(),
            _ => format!(
                "  speed    {} m/s, from {reach:.2} s before to {reach:.2} s after\n",
                spread(&overview.speed),
            ),
        };
        text += &format!("\n{}", safety_report::text(self.measured));
        if !self.measured.crossings.is_empty() {
            text += &format!("\n{}", flows(&self.measured.crossings).text());
        }
        for (k, diagram) in self.measured.diagrams.iter().enumerate() {
            let place = diagram.region.map(|region| {
                let [min, max] = [region.min, region.max].map(|p| format!("({}, {})", p.x, p.y));
                format!("region {}: {min} to {max} m", k + 1)
            });
            let place = place.unwrap_or_else(|| "everywhere".to_owned());
            let classes = classes(diagram).text();
            text += &format!("\nfundamental diagram, {place}\n{classes}");
        }
        text
    }

    /// Time that a velocity looks back and ahead, seconds.
    fn reach(&self) -> f64 {
        self.options.speed_reach as f64 * self.tracks.interval()
    }

    /// As a JSON object.
    pub fn json(&self) -> Value {
        let overview = &self.measured.overview;
        let kernel = self.options.kernel;
        json!({
            "people": overview.people,
            "rows": overview.rows,
            "frames": overview.frames,
            "empty_frames": overview.empty_frames,
            "fps": self.tracks.fps,
            "from_secs": overview.times[0],
            "until_secs": overview.times[1],
            "support_radius": kernel.support_radius,
            "wall_method": kernel.walls,
            "speed_window_secs": 2.0 * self.reach(),
            "rows_inside_obstacles": overview.inside.0,
            "density": mean_and_std(&overview.density),
            "speed": mean_and_std(&overview.speed),
            "densest": overview.densest.map(|(person, frame, time)| json!({
                "density": person.density,
                "id": person.id,
                "x": person.position.x,
                "y": person.position.y,
                "time_secs": time,
                "frame": frame,
            })),
            "safety": safety_report::json(self.measured),
            "lines": self.measured.crossings.iter().map(line).collect::<Vec<_>>(),
            "fundamental_diagrams": self.measured.diagrams.iter().map(diagram).collect::<Vec<_>>(),
            "notes": self.tracks.notes,
        })
    }
}

/// Two rows per line: forward and backward.
fn flows(crossings: &[Crossings]) -> Table {
    let lines = crossings.iter().zip(1_usize..);
    let ways = lines.flat_map(|(line, number)| {
        [(1, "forward"), (-1, "backward")].map(|(way, name)| (number, name, line.way(way)))
    });
    let ways: Vec<(usize, &str, Way)> = ways.collect();
    Table::of(&ways)
        .column("line", |row| row.0)
        .column("direction", |row| row.1)
        .column("passages", |row| row.2.passages)
        .column("crossings", |row| row.2.crossings)
        .fixed("first [s]", 2, |row| row.2.first_secs)
        .fixed("last [s]", 2, |row| row.2.last_secs)
        .fixed("flow [1/s]", 3, |row| row.2.flow_per_s)
        .fixed("flow [1/(m s)]", 3, |row| row.2.specific_flow_per_m_s)
        .table()
}

/// One row per density class, with values of people and of frames.
fn classes(diagram: &Diagram) -> Table {
    let class = |classes: &BTreeMap<usize, Class>, k| classes.get(k).copied().unwrap_or_default();
    let numbers = diagram.of_persons.keys().chain(diagram.of_frames.keys());
    let numbers: BTreeSet<&usize> = numbers.collect();
    let both = |k| [&diagram.of_persons, &diagram.of_frames].map(|classes| class(classes, k));
    let rows = numbers.into_iter().map(|k| (*k as f64 * CLASS, both(k)));
    let rows: Vec<(f64, [Class; 2])> = rows.collect();
    let spread =
        |of: MeanStd| (of.count > 0).then(|| Cell::Spread(of.mean, Some(of.population_std())));
    Table::of(&rows)
        .column("density [P/m²]", |row| {
            format!("{:.1}–{:.1}", row.0, row.0 + CLASS)
        })
        .column("rows", |(_, [persons, _])| persons.density.count)
        .fixed("speed [m/s]", 3, |(_, [persons, _])| spread(persons.speed))
        .fixed("flow [1/(m s)]", 3, |(_, [persons, _])| {
            spread(persons.flow)
        })
        .column("frames", |(_, [_, frames])| frames.density.count)
        .fixed("speed [m/s]", 3, |(_, [_, frames])| spread(frames.speed))
        .table()
}

/// `null` without values.
fn mean_and_std(of: &MeanStd) -> Option<Value> {
    (of.count > 0).then(|| json!({"mean": of.mean, "std": of.population_std()}))
}

fn line(crossings: &Crossings) -> Value {
    let ends = [crossings.line.start, crossings.line.end].map(|p| [p.x, p.y]);
    json!({
        "ends": ends,
        "length": crossings.line.length(),
        "forward": crossings.way(1),
        "backward": crossings.way(-1),
        "across_gaps": crossings.across_gaps,
    })
}

fn diagram(diagram: &Diagram) -> Value {
    let kind = |classes: &BTreeMap<usize, Class>| {
        let class = |(&k, class): (&usize, &Class)| {
            json!({
                "density_from": k as f64 * CLASS,
                "density_to": (k as f64 + 1.0) * CLASS,
                "count": class.density.count,
                "density": mean_and_std(&class.density),
                "speed": mean_and_std(&class.speed),
                "flow": mean_and_std(&class.flow),
            })
        };
        classes.iter().map(class).collect::<Vec<_>>()
    };
    json!({
        "region": diagram.region.map(|region| [region.min, region.max].map(|p| [p.x, p.y])),
        "frames_with_people": diagram.frames.len(),
        "persons": kind(&diagram.of_persons),
        "frames": kind(&diagram.of_frames),
    })
}

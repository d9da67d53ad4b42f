//! The summary of a measurement, as text or JSON.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::{CLASS, Class, Crossings, Diagram, Measured, Options};
use crate::analysis::statistics::MeanStd;
use crate::output::table::OldTable as Table;
use crate::output::trajectory::read::Tracks;

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
        let [first, last] = overview.times;
        let mut text = format!(
            "{} people, {} rows in {} frames at {} fps, {first:.2} s to {last:.2} s{}\n",
            overview.people,
            overview.rows,
            overview.frames,
            self.tracks.fps,
            match overview.empty_frames {
                0 => String::new(),
                empty => format!(", {empty} without anybody"),
            },
        );
        text += &format!(
            "  density  {:.3} ± {:.3} P/m² over all rows, h = {} m\n",
            overview.density.mean,
            overview.density.population_std(),
            self.options.kernel.support_radius,
        );
        if let Some(densest) = overview.densest {
            let person = densest.person;
            text += &format!(
                "           at most {:.3} P/m²: person {} at ({:.2}, {:.2}) m, {:.2} s, frame {}\n",
                person.density,
                person.id,
                person.position.x,
                person.position.y,
                densest.time,
                densest.frame,
            );
        }
        text += &match overview.speed.count {
            0 => "  speed    not known of anybody\n".to_owned(),
            _ => format!(
                "  speed    {:.3} ± {:.3} m/s, from {:.2} s before to {:.2} s after\n",
                overview.speed.mean,
                overview.speed.population_std(),
                self.reach(),
                self.reach(),
            ),
        };
        if !self.measured.crossings.is_empty() {
            text += &format!("\n{}", self.flows().text());
        }
        for (k, diagram) in self.measured.diagrams.iter().enumerate() {
            let place = match diagram.region {
                None => "everywhere".to_owned(),
                Some(r) => {
                    let (min, max) = (r.min, r.max);
                    format!(
                        "region {}: ({}, {}) to ({}, {}) m",
                        k + 1,
                        min.x,
                        min.y,
                        max.x,
                        max.y
                    )
                }
            };
            text += &format!(
                "\nfundamental diagram, {place}\n{}",
                classes(diagram).text()
            );
        }
        text
    }

    /// Time that a velocity looks back and ahead, seconds.
    fn reach(&self) -> f64 {
        self.options.speed_reach as f64 * self.tracks.interval()
    }

    fn flows(&self) -> Table {
        let mut table = Table::new(
            2,
            &[
                "line",
                "direction",
                "passages",
                "crossings",
                "first s",
                "last s",
                "flow 1/s",
                "1/(m s)",
            ],
        );
        for (k, crossings) in self.measured.crossings.iter().enumerate() {
            for (direction, name) in [(1, "forward"), (-1, "backward")] {
                let time = |time: Option<f64>| time.map_or("–".to_owned(), |t| format!("{t:.2}"));
                let rate = |flow: Option<f64>| flow.map_or("–".to_owned(), |f| format!("{f:.3}"));
                let flow = crossings.flow(direction);
                let all = crossings.list.iter().filter(|c| c.direction == direction);
                table.add([
                    (k + 1).to_string(),
                    name.to_owned(),
                    crossings.passages(direction).count().to_string(),
                    all.count().to_string(),
                    time(crossings.passages(direction).next()),
                    time(crossings.passages(direction).last()),
                    rate(flow),
                    rate(flow.map(|flow| flow / crossings.line.length())),
                ]);
            }
        }
        table
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
            "density": spread(&overview.density),
            "speed": spread(&overview.speed),
            "densest": overview.densest.map(|densest| json!({
                "density": densest.person.density,
                "id": densest.person.id,
                "x": densest.person.position.x,
                "y": densest.person.position.y,
                "time_secs": densest.time,
                "frame": densest.frame,
            })),
            "lines": self.measured.crossings.iter().map(line).collect::<Vec<_>>(),
            "fundamental_diagrams": self.measured.diagrams.iter().map(diagram).collect::<Vec<_>>(),
            "notes": self.tracks.notes,
        })
    }
}

/// One row per density class, with values of people and of frames.
fn classes(diagram: &Diagram) -> Table {
    let head = [
        "density P/m²",
        "rows",
        "speed m/s",
        "±",
        "flow 1/(m s)",
        "±",
        "frames",
        "speed m/s",
        "±",
    ];
    let mut table = Table::new(1, &head);
    let none = Class::default();
    let numbers = diagram.of_persons.keys().chain(diagram.of_frames.keys());
    for k in numbers.collect::<BTreeSet<_>>() {
        let persons = diagram.of_persons.get(k).unwrap_or(&none);
        let frames = diagram.of_frames.get(k).unwrap_or(&none);
        let from = *k as f64 * CLASS;
        let number = |spread: &MeanStd, value: f64| match spread.count {
            0 => "–".to_owned(),
            _ => format!("{value:.3}"),
        };
        let mean = |spread: &MeanStd| number(spread, spread.mean);
        let deviation = |spread: &MeanStd| number(spread, spread.population_std());
        table.add([
            format!("{from:.1}–{:.1}", from + CLASS),
            persons.density.count.to_string(),
            mean(&persons.speed),
            deviation(&persons.speed),
            mean(&persons.flow),
            deviation(&persons.flow),
            frames.density.count.to_string(),
            mean(&frames.speed),
            deviation(&frames.speed),
        ]);
    }
    table
}

fn spread(spread: &MeanStd) -> Value {
    match spread.count {
        0 => Value::Null,
        _ => json!({"mean": spread.mean, "std": spread.population_std()}),
    }
}

fn line(crossings: &Crossings) -> Value {
    let ends = [crossings.line.start, crossings.line.end].map(|p| [p.x, p.y]);
    let way = |direction: i8| {
        let flow = crossings.flow(direction);
        json!({
            "passages": crossings.passages(direction).count(),
            "crossings": crossings.list.iter().filter(|c| c.direction == direction).count(),
            "first_secs": crossings.passages(direction).next(),
            "last_secs": crossings.passages(direction).last(),
            "flow_per_s": flow,
            "specific_flow_per_m_s": flow.map(|flow| flow / crossings.line.length()),
        })
    };
    json!({
        "ends": ends,
        "length": crossings.line.length(),
        "forward": way(1),
        "backward": way(-1),
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
                "density": spread(&class.density),
                "speed": spread(&class.speed),
                "flow": spread(&class.flow),
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

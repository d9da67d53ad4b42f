//! The summary of a measurement.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::regions_report::{corners, mean_and_std, of_class, spread};
use super::{
    CLASS, Class, Classes, Crossings, Density, Diagram, Measured, Options, Site, Way, output,
    pictures, regions_report, safety_report,
};
use crate::error::LabError;
use ::output::document::{Block, Document, Findings, Names};
use ::output::table::Table;
use analysis::crossing::Passages;
use scenario::trajectories::Tracks;

/// The name of the files with all results.
const NAME: &str = "measured";

/// The names of the files with results, but the file of all people and the recording.
pub fn names() -> Names {
    Names::new(NAME, &output::TABLES, &pictures::STEMS)
}

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
    /// Everything for readers and programs, but the file of all people.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self, site: &Site) -> Result<Findings, LabError> {
        let mut blocks = self.overview();
        blocks.extend(safety_report::blocks(self.measured));
        if !self.measured.crossings.is_empty() {
            let flow_of = self.options.flow_of;
            blocks.push(Block::table(flows(&self.measured.crossings, flow_of)));
        }
        blocks.extend(regions_report::block(self.measured));
        for (k, diagram) in self.measured.diagrams.iter().enumerate() {
            let named = diagram.region.map(|region| {
                let [min, max] = [region.min, region.max].map(|p| format!("({}, {})", p.x, p.y));
                format!("region {}: {min} to {max} m", k + 1)
            });
            let place = named.unwrap_or_else(|| "everywhere".to_owned());
            let caption = format!("Fundamental diagram, {place}: speeds by density.");
            blocks.push(Block::Table(classes(diagram), caption));
        }
        let figures = pictures::sheets(self.measured, site);
        blocks.extend(figures.map(|(name, sheet)| Block::figure(name, sheet, "")));
        let document = Document::of("Measurements in trajectories", blocks);
        let mut findings = Findings::new(NAME, document, self.json());
        findings.tables = output::tables(self.measured, self.tracks)?;
        Ok(findings)
    }

    /// People, densities and speeds over all rows.
    fn overview(&self) -> Vec<Block> {
        let overview = &self.measured.overview;
        let [first, last] = overview.times;
        let empty = match overview.empty_frames {
            0 => String::new(),
            empty => format!(", {empty} without people"),
        };
        let mut blocks = vec![Block::Text(format!(
            "{} people, {} rows in {} frames at {} fps, {first:.2} s to {last:.2} s{empty}",
            overview.people, overview.rows, overview.frames, self.tracks.fps,
        ))];
        let cut_off = match self.options.cells.cut_off {
            Some(radius) => format!(", cut off at {radius} m"),
            None => String::new(),
        };
        let (reach, looks) = (self.options.kernel.support_radius, self.reach());
        let rows = [
            (
                format!("SPH density, own weight included, h = {reach} m (Eq. 9) [P/m²]"),
                overview.density,
            ),
            (
                "SPH density of the others [P/m²]".to_owned(),
                overview.density_of_others,
            ),
            (
                format!("Voronoi density, 1 / cell{cut_off} [P/m²]"),
                overview.voronoi,
            ),
            (
                format!("speed, from {looks:.2} s before to {looks:.2} s after [m/s]"),
                overview.speed,
            ),
        ];
        let table = Table::of(&rows)
            .column("at people, over all rows", |(name, _)| name.as_str())
            .fixed("mean ± standard deviation", 3, |(_, of)| spread(*of))
            .table();
        blocks.push(Block::table(table));
        if let Some((person, frame, time)) = overview.densest {
            let place = person.position;
            blocks.push(Block::Text(format!(
                "Highest SPH density: {:.3} P/m², person {} at ({:.2}, {:.2}) m, {time:.2} s, frame {frame}.",
                person.density, person.id, place.x, place.y,
            )));
        }
        blocks
    }

    /// Time that a velocity looks back and ahead, seconds.
    fn reach(&self) -> f64 {
        self.options.speed_reach as f64 * self.tracks.interval()
    }

    /// As a JSON object.
    pub fn json(&self) -> Value {
        let overview = &self.measured.overview;
        let (kernel, cells) = (self.options.kernel, self.options.cells);
        let crossings = self.measured.crossings.iter();
        let lines = crossings.map(|crossings| line(crossings, self.options.flow_of));
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
            "voronoi_cutoff": cells.cut_off,
            "voronoi_quad_segments": cells.quad_segments,
            "density": mean_and_std(&overview.density),
            "density_of_others": mean_and_std(&overview.density_of_others),
            "voronoi_density": mean_and_std(&overview.voronoi),
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
            "lines": lines.collect::<Vec<_>>(),
            "regions": regions_report::json(self.measured),
            "fundamental_diagrams": self.measured.diagrams.iter().map(diagram).collect::<Vec<_>>(),
            "notes": self.tracks.notes,
        })
    }
}

/// Two rows per line: forward and backward.
fn flows(crossings: &[Crossings], flow_of: Passages) -> Table {
    let directed = crossings.iter().zip(1_usize..).flat_map(|(line, number)| {
        [(1, "forward"), (-1, "backward")].map(|(way, name)| (number, name, line.way(way, flow_of)))
    });
    let rows: Vec<(usize, &str, Way)> = directed.collect();
    let passages = |way: &Way| {
        let between = way.part.map(|part| part.passages);
        between.map_or("–".to_owned(), |[n, m]| format!("{n}–{m}"))
    };
    Table::of(&rows)
        .column("line", |row| row.0)
        .column("direction", |row| row.1)
        .column("passages", |row| row.2.passages)
        .column("crossings", |row| row.2.crossings)
        .fixed("first [s]", 2, |row| row.2.first_secs)
        .fixed("last [s]", 2, |row| row.2.last_secs)
        .fixed("flow [1/s]", 3, |row| row.2.flow_per_s)
        .fixed("flow [1/(m s)]", 3, |row| row.2.specific_flow_per_m_s)
        .column("passages n–m", |row| passages(&row.2))
        .fixed("flow n–m [1/s]", 3, |row| {
            row.2.part.map(|part| part.flow_per_s)
        })
        .table()
}

/// One row per density class, and for each density the number of values and their speeds.
fn classes(diagram: &Diagram) -> Table {
    let kinds = Density::ALL.into_iter();
    let found = kinds.filter_map(|kind| Some((kind, diagram.classes(kind)?)));
    let known: Vec<(Density, (&str, &Classes))> = found.collect();
    let numbers = known.iter().flat_map(|(_, (_, classes))| classes.keys());
    let rows: Vec<usize> = numbers
        .copied()
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let begun = Table::of(&rows).column("density [P/m²]", |&k| {
        let from = k as f64 * CLASS;
        format!("{from:.1}–{:.1}", from + CLASS)
    });
    let columns = known.iter().fold(begun, |columns, (kind, (of, classes))| {
        let count = format!("{} [{of}]", kind.name());
        columns
            .column(&count, |k| {
                classes.get(k).map_or(0, |class| class.density.count)
            })
            .fixed("speed [m/s]", 3, |k| spread(classes.get(k)?.speed))
    });
    columns.table()
}

fn line(crossings: &Crossings, flow_of: Passages) -> Value {
    let ends = [crossings.line.start, crossings.line.end].map(|p| [p.x, p.y]);
    json!({
        "ends": ends,
        "length": crossings.line.length(),
        "forward": crossings.way(1, flow_of),
        "backward": crossings.way(-1, flow_of),
        "across_gaps": crossings.across_gaps,
    })
}

fn diagram(diagram: &Diagram) -> Value {
    let class = |(&k, class): (&usize, &Class)| {
        let mut value = of_class(class);
        value["density_from"] = json!(k as f64 * CLASS);
        value["density_to"] = json!((k as f64 + 1.0) * CLASS);
        value["count"] = json!(class.density.count);
        value
    };
    let kinds = |kinds: &BTreeMap<Density, Classes>| -> BTreeMap<&str, Vec<Value>> {
        let kinds = kinds.iter();
        kinds
            .map(|(kind, classes)| (kind.key(), classes.iter().map(class).collect()))
            .collect()
    };
    let with_people = diagram.frames.iter().filter(|frame| frame.people > 0);
    json!({
        "region": diagram.region.as_ref().map(corners),
        "frames_with_people": with_people.count(),
        "persons": kinds(&diagram.of_persons),
        "frames": kinds(&diagram.of_frames),
    })
}

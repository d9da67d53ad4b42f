//! The summary of a measurement.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value, json};

use super::{
    CLASS, Class, Classes, Crossings, Density, Diagram, Measured, Options, Site, Way, output,
    pictures, safety_report,
};
use crate::error::LabError;
use ::output::document::{Block, Document, Findings, Names};
use ::output::table::{Cell, Table};
use analysis::crossing::Passages;
use analysis::statistics::MeanStd;
use engine::scene::Region;
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
        blocks.extend(regions(self.measured));
        for (k, diagram) in self.measured.diagrams.iter().enumerate() {
            let place = diagram.region.map(|region| {
                let [min, max] = [region.min, region.max].map(|p| format!("({}, {})", p.x, p.y));
                format!("region {}: {min} to {max} m", k + 1)
            });
            let place = place.unwrap_or_else(|| "everywhere".to_owned());
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
        let lines = self.measured.crossings.iter();
        let lines = lines.map(|crossings| line(crossings, self.options.flow_of));
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
            "regions": regions_json(self.measured),
            "fundamental_diagrams": self.measured.diagrams.iter().map(diagram).collect::<Vec<_>>(),
            "notes": self.tracks.notes,
        })
    }
}

/// Two rows per line: forward and backward.
fn flows(crossings: &[Crossings], flow_of: Passages) -> Table {
    let lines = crossings.iter().zip(1_usize..);
    let ways = lines.flat_map(|(line, number)| {
        let directions = [(1, "forward"), (-1, "backward")];
        directions.map(|(way, name)| (number, name, line.way(way, flow_of)))
    });
    let ways: Vec<(usize, &str, Way)> = ways.collect();
    let passages = |way: &Way| {
        let between = way.part.map(|part| part.passages);
        between.map_or("–".to_owned(), |[n, m]| format!("{n}–{m}"))
    };
    Table::of(&ways)
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
    let known = Density::ALL.into_iter();
    let known = known.filter_map(|kind| Some((kind, diagram.classes(kind)?)));
    let known: Vec<(Density, (&str, &Classes))> = known.collect();
    let numbers = known.iter().flat_map(|(_, (_, classes))| classes.keys());
    let rows: Vec<usize> = numbers
        .copied()
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let columns = Table::of(&rows).column("density [P/m²]", |&k| {
        let from = k as f64 * CLASS;
        format!("{from:.1}–{:.1}", from + CLASS)
    });
    let columns = known
        .iter()
        .fold(columns, |columns, (kind, (of, classes))| {
            let count = format!("{} [{of}]", kind.name());
            columns
                .column(&count, |k| {
                    classes.get(k).map_or(0, |class| class.density.count)
                })
                .fixed("speed [m/s]", 3, |k| spread(classes.get(k)?.speed))
        });
    columns.table()
}

/// A mean and its standard deviation; `None` without values.
fn spread(of: MeanStd) -> Option<Cell> {
    (of.count > 0).then(|| Cell::Spread(of.mean, Some(of.population_std())))
}

/// `null` without values.
fn mean_and_std(of: &MeanStd) -> Option<Value> {
    (of.count > 0).then(|| json!({"mean": of.mean, "std": of.population_std()}))
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

/// The means of a region by one density.
struct RegionMeans<'m> {
    /// The number of the region, from 1.
    number: usize,
    region: Region,
    diagram: &'m Diagram,
    kind: Density,
    means: Class,
}

/// One row per region and density.
fn region_means(measured: &Measured) -> Vec<RegionMeans<'_>> {
    let regions = measured.diagrams.iter().zip(1..);
    let rows = regions.flat_map(|(diagram, number)| {
        let row = move |kind| {
            Some(RegionMeans {
                number,
                region: diagram.region?,
                diagram,
                kind,
                means: diagram.means(kind, measured.overview.frames)?,
            })
        };
        Density::ALL.into_iter().filter_map(row)
    });
    rows.collect()
}

/// The means of regions; nothing without regions.
fn regions(measured: &Measured) -> Option<Block> {
    let rows = region_means(measured);
    let [from, until] = measured.overview.times;
    let table = Table::of(&rows)
        .column("region", |row| row.number)
        .fixed("walkable [m²]", 2, |row| row.diagram.walkable)
        .column("by", |row| row.kind.name())
        .fixed("density [P/m²]", 3, |row| spread(row.means.density))
        .fixed("speed [m/s]", 3, |row| spread(row.means.speed))
        .fixed("flow [1/(m s)]", 3, |row| spread(row.means.flow))
        .table();
    let caption = format!(
        "Regions, means over {} frames from {from:.2} s to {until:.2} s.",
        measured.overview.frames,
    );
    (!rows.is_empty()).then_some(Block::Table(table, caption))
}

/// The means of regions as a table for programs.
pub fn regions_table(measured: &Measured) -> Table {
    let [from, until] = measured.overview.times;
    let rows = region_means(measured);
    let parts = ["_mean", "_std"];
    Table::of(&rows)
        .column("region", |row| row.number)
        .column("walkable_m2", |row| row.diagram.walkable)
        .column("from_secs", |_| from)
        .column("until_secs", |_| until)
        .column("by", |row| row.kind.key())
        .spread("density", 3, parts, |row| spread(row.means.density))
        .spread("speed", 3, parts, |row| spread(row.means.speed))
        .spread("flow", 3, parts, |row| spread(row.means.flow))
        .table()
}

fn regions_json(measured: &Measured) -> Vec<Value> {
    let rows = region_means(measured);
    let regions = rows.chunk_by(|a, b| a.number == b.number);
    let region = |rows: &[RegionMeans]| {
        let means = rows.iter();
        let means = means.map(|row| (row.kind.key().to_owned(), of_class(&row.means)));
        json!({
            "region": corners(&rows[0].region),
            "walkable_m2": rows[0].diagram.walkable,
            "means": means.collect::<Map<_, _>>(),
        })
    };
    regions.map(region).collect()
}

fn of_class(class: &Class) -> Value {
    json!({
        "density": mean_and_std(&class.density),
        "speed": mean_and_std(&class.speed),
        "flow": mean_and_std(&class.flow),
    })
}

fn corners(region: &Region) -> [[f64; 2]; 2] {
    [region.min, region.max].map(|p| [p.x, p.y])
}

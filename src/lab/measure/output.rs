//! Writes results to a folder, as CSV.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::pictures::STEMS;
use super::record::RECORDING;
use super::{CLASS, Class, Measured, Moment, Person};
use crate::analysis::statistics::MeanStd;
use crate::output::table::{Cell, Table, csv_lines};
use crate::runs::error::StoreError;

/// All people, frame by frame.
const AGENTS: &str = "agents.csv";
const FIELDS: &str = "fields.csv";
const DIAGRAM: &str = "fundamental_diagram.csv";
const CLASSES: &str = "fundamental_classes.csv";
const FLOW: &str = "flow.csv";

/// The names of all files that a measurement may write, with its recording and its pictures.
pub fn files() -> impl Iterator<Item = String> {
    let tables = [AGENTS, FIELDS, DIAGRAM, CLASSES, FLOW, RECORDING];
    let pictures = STEMS.map(|stem| ["svg", "png"].map(|kind| format!("{stem}.{kind}")));
    let tables = tables.into_iter().map(str::to_owned);
    tables.chain(pictures.into_iter().flatten())
}

/// A folder for results, with an open file of people.
pub struct Results {
    folder: PathBuf,
    agents: BufWriter<File>,
    /// Has no frame been written yet?
    is_empty: bool,
}

/// A row of [`AGENTS`].
#[derive(Serialize)]
struct AgentRow {
    frame: i64,
    time: f64,
    id: i64,
    x: f64,
    y: f64,
    vel_x: Option<f64>,
    vel_y: Option<f64>,
    speed: Option<f64>,
    density: f64,
    density_from_walls: f64,
}

/// A row of [`FIELDS`]: a cell outside obstacles.
#[derive(Serialize)]
struct FieldRow {
    x: f64,
    y: f64,
    density: f64,
    vel_x: Option<f64>,
    vel_y: Option<f64>,
    speed: Option<f64>,
    flow_x: Option<f64>,
    flow_y: Option<f64>,
    people: f64,
}

impl Results {
    /// Opens `folder`, creating it if necessary, and begins the file of people, replacing an older one.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn create(folder: &Path) -> Result<Self, StoreError> {
        fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
        let path = folder.join(AGENTS);
        let file = File::create(&path).map_err(|error| unwritten(&path, &error))?;
        Ok(Self {
            folder: folder.to_owned(),
            agents: BufWriter::new(file),
            is_empty: true,
        })
    }

    /// Adds the people of some frames.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, moments: &[Moment]) -> Result<(), StoreError> {
        let row = |moment: &Moment, person: &Person| AgentRow {
            frame: moment.frame,
            time: moment.time,
            id: person.id,
            x: person.position.x,
            y: person.position.y,
            vel_x: person.velocity.map(|v| v.x),
            vel_y: person.velocity.map(|v| v.y),
            speed: person.velocity.map(|v| v.norm()),
            density: person.density,
            density_from_walls: person.density_from_walls,
        };
        let rows = moments.iter();
        let rows = rows.flat_map(|moment| moment.people.iter().map(|person| row(moment, person)));
        let lines = csv_lines(&rows.collect::<Vec<_>>(), self.is_empty);
        let written = lines
            .map_err(Into::into)
            .and_then(|l| self.agents.write_all(&l));
        self.is_empty = false;
        written.map_err(|error| unwritten(&self.folder.join(AGENTS), &error))
    }

    /// Writes the other files, and closes the file of people.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self, measured: &Measured) -> Result<(), StoreError> {
        let flushed = self.agents.flush();
        flushed.map_err(|error| unwritten(&self.folder.join(AGENTS), &error))?;
        let Measured {
            diagrams,
            crossings,
            ..
        } = measured;
        self.write(FIELDS, csv_lines(&field_rows(measured), true))?;
        let frames = diagrams.iter().flat_map(|diagram| &diagram.frames);
        self.write(DIAGRAM, csv_lines(&frames.collect::<Vec<_>>(), true))?;
        self.write(CLASSES, classes(measured).csv())?;
        if crossings.is_empty() {
            return Ok(());
        }
        let all = crossings.iter().flat_map(|crossings| &crossings.list);
        self.write(FLOW, csv_lines(&all.collect::<Vec<_>>(), true))
    }

    fn write(&self, name: &str, text: Result<Vec<u8>, csv::Error>) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        let written = text
            .map_err(Into::into)
            .and_then(|text| fs::write(&path, text));
        written.map_err(|error| unwritten(&path, &error))
    }
}

fn unwritten(path: &Path, error: &std::io::Error) -> StoreError {
    StoreError::Unwritable {
        path: path.display().to_string(),
        reason: error.to_string(),
        kept: String::new(),
    }
}

fn field_rows(measured: &Measured) -> Vec<FieldRow> {
    let fields = &measured.fields;
    let means = fields.means(measured.overview.frames).enumerate();
    let rows = means.filter_map(|(k, mean)| {
        let (center, mean) = (fields.grid().center(k), mean?);
        let flow = mean.velocity.map(|velocity| velocity * mean.density);
        Some(FieldRow {
            x: center.x,
            y: center.y,
            density: mean.density,
            vel_x: mean.velocity.map(|v| v.x),
            vel_y: mean.velocity.map(|v| v.y),
            speed: mean.speed,
            flow_x: flow.map(|j| j.x),
            flow_y: flow.map(|j| j.y),
            people: mean.people,
        })
    });
    rows.collect()
}

/// One row per region, kind of values and density class.
fn classes(measured: &Measured) -> Table {
    let regions = measured.diagrams.iter().zip(1_usize..);
    let classes = regions.flat_map(|(diagram, region)| {
        let persons = diagram.of_persons.iter().map(|class| ("persons", class));
        let frames = diagram.of_frames.iter().map(|class| ("frames", class));
        let both = persons.chain(frames);
        both.map(move |(of, (&k, class))| (region, of, k, class))
    });
    let rows: Vec<(usize, &str, usize, &Class)> = classes.collect();
    let parts = ["_mean", "_std"];
    let spread = |of: MeanStd| Cell::Spread(of.mean, Some(of.population_std()));
    Table::of(&rows)
        .column("region", |row| row.0)
        .column("of", |row| row.1)
        .column("density_from", |row| row.2 as f64 * CLASS)
        .column("density_to", |row| (row.2 as f64 + 1.0) * CLASS)
        .column("count", |row| row.3.density.count)
        .spread("density", 3, parts, |row| spread(row.3.density))
        .spread("speed", 3, parts, |row| spread(row.3.speed))
        .spread("flow", 3, parts, |row| spread(row.3.flow))
        .table()
}

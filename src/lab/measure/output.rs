//! Writes results to a folder, as CSV.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::{CLASS, Class, Diagram, Fields, Measured, Moment, Person};

/// All people, frame by frame.
const AGENTS: &str = "agents.csv";
const FIELDS: &str = "fields.csv";
const DIAGRAM: &str = "fundamental_diagram.csv";
const CLASSES: &str = "fundamental_classes.csv";
const FLOW: &str = "flow.csv";

/// People per parallel task.
const SOME: usize = 4096;

/// Results cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("cannot write {}: {reason}", path.display())]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// The system's message.
    pub reason: String,
}

/// A folder for results, with an open file of people.
pub struct Results {
    folder: PathBuf,
    agents: BufWriter<File>,
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

#[derive(Serialize)]
struct ClassRow {
    region: usize,
    of: &'static str,
    density_from: f64,
    density_to: f64,
    count: usize,
    density_mean: f64,
    density_std: f64,
    speed_mean: f64,
    speed_std: f64,
    flow_mean: f64,
    flow_std: f64,
}

impl Results {
    /// The names of all files that may be written.
    pub const FILES: [&str; 5] = [AGENTS, FIELDS, DIAGRAM, CLASSES, FLOW];

    /// Opens `folder`, creating it if necessary, and begins the file of people, replacing an older one.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn create(folder: &Path) -> Result<Self, OutputError> {
        fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
        let path = folder.join(AGENTS);
        let file = File::create(&path).map_err(|error| unwritten(&path, &error))?;
        let mut results = Self {
            folder: folder.to_owned(),
            agents: BufWriter::new(file),
        };
        let head = "frame,time,id,x,y,vel_x,vel_y,speed,density,density_from_walls\n";
        results.extend(head.as_bytes())?;
        Ok(results)
    }

    /// Adds the people of some frames.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, moments: &[Moment]) -> Result<(), OutputError> {
        let people = moments.iter();
        let people =
            people.flat_map(|moment| moment.people.iter().map(move |person| (moment, person)));
        let people: Vec<(&Moment, &Person)> = people.collect();
        let parts = people.par_chunks(SOME).map(|some| {
            let rows = some
                .iter()
                .map(|(moment, person)| agent_row(moment, person));
            csv_of(rows, false)
        });
        let lines = parts.collect::<Result<Vec<_>, _>>();
        let lines = lines
            .map_err(|error| self.agents_unwritten(&error))?
            .concat();
        self.extend(&lines)
    }

    fn extend(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        let written = self.agents.write_all(bytes);
        written.map_err(|error| self.agents_unwritten(&error))
    }

    fn agents_unwritten(&self, error: &dyn std::error::Error) -> OutputError {
        unwritten(&self.folder.join(AGENTS), error)
    }

    /// Writes the other files, and closes the file of people.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self, measured: &Measured) -> Result<(), OutputError> {
        let Measured {
            overview,
            fields,
            diagrams,
            crossings,
        } = measured;
        let flushed = self.agents.flush();
        flushed.map_err(|error| self.agents_unwritten(&error))?;
        self.write(FIELDS, field_rows(fields, overview.frames))?;
        let frames = diagrams.iter().flat_map(|diagram| &diagram.frames);
        self.write(DIAGRAM, frames)?;
        self.write(CLASSES, diagrams.iter().enumerate().flat_map(class_rows))?;
        if crossings.is_empty() {
            return Ok(());
        }
        self.write(FLOW, crossings.iter().flat_map(|crossings| &crossings.list))
    }

    fn write(&self, name: &str, rows: impl Iterator<Item: Serialize>) -> Result<(), OutputError> {
        let path = self.folder.join(name);
        let text = csv_of(rows, true).map_err(|error| unwritten(&path, &error))?;
        fs::write(&path, text).map_err(|error| unwritten(&path, &error))
    }
}

fn unwritten(path: &Path, error: &dyn std::error::Error) -> OutputError {
    OutputError {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

fn csv_of(rows: impl Iterator<Item: Serialize>, head: bool) -> Result<Vec<u8>, csv::Error> {
    let mut lines = Vec::new();
    let mut writer = csv::WriterBuilder::new()
        .has_headers(head)
        .from_writer(&mut lines);
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    drop(writer);
    Ok(lines)
}

fn agent_row(moment: &Moment, person: &Person) -> AgentRow {
    AgentRow {
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
    }
}

/// One row per cell outside obstacles.
fn field_rows(fields: &Fields, frames: u64) -> impl Iterator<Item = FieldRow> + '_ {
    let means = fields.means(frames).enumerate();
    means.filter_map(|(k, mean)| {
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
    })
}

fn class_rows((k, diagram): (usize, &Diagram)) -> impl Iterator<Item = ClassRow> + '_ {
    let kinds = [
        ("persons", &diagram.of_persons),
        ("frames", &diagram.of_frames),
    ];
    kinds.into_iter().flat_map(move |(of, classes)| {
        let rows = classes.iter();
        rows.map(move |(&number, class)| class_row(k + 1, of, number, class))
    })
}

fn class_row(region: usize, of: &'static str, number: usize, class: &Class) -> ClassRow {
    ClassRow {
        region,
        of,
        density_from: number as f64 * CLASS,
        density_to: (number as f64 + 1.0) * CLASS,
        count: class.density.count,
        density_mean: class.density.mean,
        density_std: class.density.population_std(),
        speed_mean: class.speed.mean,
        speed_std: class.speed.population_std(),
        flow_mean: class.flow.mean,
        flow_std: class.flow.population_std(),
    }
}

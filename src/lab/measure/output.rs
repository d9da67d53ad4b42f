//! Writes results to a folder, as CSV.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

use super::record::RECORDING;
use super::regions_report;
use super::{CLASS, Class, Classes, Density, Measured, Moment, Safety};
use analysis::exposure::PersonExposure;
use analysis::statistics::MeanStd;
use engine::math::Vector;
use output::table::{Cell, Table, csv_lines};
use runs::error::StoreError;
use runs::outputs::Replacement;
use runs::store::Store;
use scenario::trajectories::Tracks;

/// All people, frame by frame.
const AGENTS: &str = "agents.csv";
/// The other tables, by the names of their files.
pub const TABLES: [&str; 7] = [
    "fields",
    "fundamental_diagram",
    "fundamental_classes",
    "regions",
    "exposure",
    "alarms",
    "flow",
];

const AGENT_COLUMNS: &str = "frame,time,id,x,y,vel_x,vel_y,speed,density,density_from_walls,density_of_others,\
                             voronoi_density";
const FIELD_COLUMNS: &str = "x,y,density,vel_x,vel_y,speed,flow_x,flow_y,people";

/// The files that are written while the rows are measured.
pub const STREAMED: [&str; 2] = [AGENTS, RECORDING];

/// A folder for results, with an open file of people.
pub struct Results {
    store: Store,
    agents: BufWriter<File>,
    /// The file of people, under a temporary name until the end.
    replacement: Replacement,
}

impl Results {
    /// Opens `folder`, creating it if necessary, and begins the file of people, replacing an older one.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn create(folder: &Path) -> Result<Self, StoreError> {
        fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
        let path = folder.join(AGENTS);
        let opened = Replacement::begin(&path).map_err(|error| unwritten(&path, &error));
        let (replacement, file) = opened?;
        let mut agents = BufWriter::new(file);
        writeln!(agents, "{AGENT_COLUMNS}").map_err(|error| unwritten(&path, &error))?;
        Ok(Self {
            store: Store::at(folder),
            agents,
            replacement,
        })
    }

    /// Adds the people of some frames.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, moments: &[Moment]) -> Result<(), StoreError> {
        let rows = moments.iter().flat_map(|moment| {
            moment.people.iter().map(|person| {
                let (velocity, speed) = (parts(person.velocity), person.velocity.map(|v| v.norm()));
                let densities = [
                    person.density,
                    person.density_from_walls,
                    person.density_of_others,
                ];
                (
                    (moment.frame, moment.time, person.id),
                    [person.position.x, person.position.y],
                    velocity,
                    speed,
                    densities,
                    person.voronoi,
                )
            })
        });
        let lines = csv_lines(&rows.collect::<Vec<_>>(), false);
        let written = lines
            .map_err(Into::into)
            .and_then(|lines| self.agents.write_all(&lines));
        written.map_err(|error| unwritten(&self.store.path(AGENTS), &error))
    }

    /// Closes the file of people.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), StoreError> {
        let kept = self.agents.flush().and_then(|()| self.replacement.keep());
        kept.map_err(|error| unwritten(&self.store.path(AGENTS), &error))
    }
}

/// The contents of the files in [`TABLES`]; without lines there is no flow.
pub fn tables(measured: &Measured, tracks: &Tracks) -> Result<Vec<(String, Vec<u8>)>, csv::Error> {
    let frames = measured.diagrams.iter().flat_map(|diagram| &diagram.frames);
    let crossings = measured.crossings.iter().flat_map(|line| &line.list);
    let contents = [
        fields(measured)?,
        csv_lines(&frames.collect::<Vec<_>>(), true)?,
        classes(measured).csv()?,
        regions_report::table(measured).csv()?,
        exposure(&measured.safety, tracks).csv()?,
        csv_lines(&measured.safety.samples, true)?,
        csv_lines(&crossings.collect::<Vec<_>>(), true)?,
    ];
    let mut tables: Vec<_> = TABLES
        .map(str::to_owned)
        .into_iter()
        .zip(contents)
        .collect();
    if measured.crossings.is_empty() {
        tables.pop();
    }
    Ok(tables)
}

fn unwritten(path: &Path, error: &std::io::Error) -> StoreError {
    StoreError::Unwritable {
        path: path.display().to_string(),
        reason: error.to_string(),
        kept: String::new(),
    }
}

/// The components of a vector, if it is known.
fn parts(of: Option<Vector>) -> [Option<f64>; 2] {
    of.map_or([None; 2], |of| [Some(of.x), Some(of.y)])
}

/// A line for each cell outside obstacles.
fn fields(measured: &Measured) -> Result<Vec<u8>, csv::Error> {
    let fields = &measured.fields;
    let means = fields.means(measured.overview.frames).enumerate();
    let rows = means.filter_map(|(k, mean)| {
        let (center, mean) = (fields.grid.center(k), mean?);
        let flow = parts(mean.velocity.map(|velocity| velocity * mean.density));
        let velocity = (parts(mean.velocity), mean.speed);
        Some((
            [center.x, center.y],
            mean.density,
            velocity,
            flow,
            mean.people,
        ))
    });
    let lines = csv_lines(&rows.collect::<Vec<_>>(), false)?;
    Ok([format!("{FIELD_COLUMNS}\n").as_bytes(), &lines].concat())
}

/// The seconds of each person who was in a dense crowd or stood.
fn exposure(safety: &Safety, tracks: &Tracks) -> Table {
    let rows: Vec<PersonExposure> = safety.exposure.of_people(safety.secs).collect();
    Table::of(&rows)
        .column("id", |row| tracks.ids[row.agent as usize].to_string())
        .column("above_4_secs", |row| row.above_4_secs)
        .column("above_5_secs", |row| row.above_5_secs)
        .column("above_6_secs", |row| row.above_6_secs)
        .column("below_0.2_m_per_s_secs", |row| row.slow_secs)
        .table()
}

/// One row per region, kind of values, density and density class.
fn classes(measured: &Measured) -> Table {
    let regions = measured.diagrams.iter().zip(1_usize..);
    let classes = regions.flat_map(|(diagram, region)| {
        let persons = diagram
            .of_persons
            .iter()
            .map(|classes| ("persons", classes));
        let frames = diagram.of_frames.iter().map(|classes| ("frames", classes));
        persons
            .chain(frames)
            .flat_map(move |(of, (kind, classes)): (_, (&Density, &Classes))| {
                let classes = classes.iter();
                classes.map(move |(&k, class)| (region, [of, kind.key()], k, class))
            })
    });
    let rows: Vec<(usize, [&str; 2], usize, &Class)> = classes.collect();
    let parts = ["_mean", "_std"];
    let spread = |of: MeanStd| Cell::Spread(of.mean, Some(of.population_std()));
    Table::of(&rows)
        .column("region", |row| row.0)
        .column("of", |row| row.1[0])
        .column("by", |row| row.1[1])
        .column("density_from", |row| row.2 as f64 * CLASS)
        .column("density_to", |row| (row.2 as f64 + 1.0) * CLASS)
        .column("count", |row| row.3.density.count)
        .spread("density", 3, parts, |row| spread(row.3.density))
        .spread("speed", 3, parts, |row| spread(row.3.speed))
        .spread("flow", 3, parts, |row| spread(row.3.flow))
        .table()
}

//! Frames of a trajectory file.

use std::path::{Path, PathBuf};

use super::{Film, Over, Run};
use crate::cli::failure::Failure;
use crate::cli::inputs::{self, TRAJECTORY_FPS};
use engine::agents::REFERENCE_RADIUS;
use engine::math::Vector;
use engine::scene::Scene;
use lab::measure::speed;
use output::picture::Crowd;
use runs::outputs::Outputs;
use scenario::quote::shown;
use scenario::trajectories::{Column, ReadOptions, Tracks, columns};

struct Tracked {
    path: PathBuf,
    tracks: Tracks,
    velocities: Vec<Option<Vector>>,
    /// The columns of the file beside positions and masses.
    columns: Vec<Column>,
}

/// The run that a trajectory file holds, with the walls of a floor plan or else those of the file. `wanted` are the
/// columns that are needed. Adds the files to `outputs`.
pub fn open(
    path: &Path,
    options: &ReadOptions,
    geometry: Option<&Path>,
    wanted: &[&str],
    outputs: &mut Outputs,
) -> Result<Run, Failure> {
    outputs.reads("the trajectories", path);
    if let Some(plan) = geometry.filter(|plan| plan.as_os_str() != inputs::NO_WALLS) {
        outputs.reads("--geometry", plan);
    }
    let own = inputs::tracks(path, options, TRAJECTORY_FPS)?;
    let mut columns = columns(path, wanted, &own)?;
    let tracks = own.together().into_owned();
    if tracks.len() != own.len() || tracks.frames != own.frames {
        let rows: Vec<usize> = (0..tracks.len()).map(|row| tracks.source(row)).collect();
        for column in columns
            .iter_mut()
            .filter(|column| !column.values.is_empty())
        {
            column.values = rows.iter().map(|&row| column.values[row]).collect();
        }
    }
    let site = inputs::site(path, geometry, &tracks)?;
    let scene = Scene::with_obstacles(site.walls.obstacles().to_vec());
    let corners: Vec<Vector> = scene.walls.iter().map(|wall| wall.start).collect();
    let frames = tracks.frames.iter();
    let times: Vec<f64> = frames.map(|&frame| tracks.time(frame)).collect();
    let ends = [times.first(), times.last()].map(|time| time.copied().unwrap_or(0.0));
    let shown = [corners, tracks.position.clone()].concat();
    let tracked = Tracked {
        path: path.to_owned(),
        velocities: speed::velocities(&tracks, speed::FRAMES),
        columns,
        tracks,
    };
    let title = path.file_stem().unwrap_or_default().to_string_lossy();
    let frames = Over::new(tracked, times, scene);
    Ok(Run {
        title: title.into_owned(),
        times: Some(ends),
        ..Run::around(shown.into_iter(), Box::new(frames))
    })
}

impl Tracked {
    fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    fn masses(&self, k: usize) -> Vec<f64> {
        let rows = self.tracks.rows(k);
        rows.map(|row| self.tracks.mass_of(row)).collect()
    }
}

impl Film for Tracked {
    fn crowd(&self, k: usize) -> Crowd {
        let (tracks, rows) = (&self.tracks, self.tracks.rows(k));
        let column = self.column("radius");
        let radius = column.map(|column| column.values[rows.clone()].to_vec());
        let mass = self.masses(k);
        // The mass is proportional to the area.
        let own = |mass: &f64| REFERENCE_RADIUS * mass.max(0.0).sqrt();
        let people = tracks.person[rows.clone()].iter();
        Crowd {
            time: tracks.time(tracks.frames[k]),
            id: people.map(|&person| tracks.ids[person as usize]).collect(),
            position: tracks.position[rows.clone()].to_vec(),
            radius: radius.unwrap_or_else(|| mass.iter().map(own).collect()),
            mass,
            velocity: self.velocities[rows].to_vec(),
        }
    }

    fn names(&self) -> Vec<&str> {
        let columns = self.columns.iter().map(|column| column.name.as_str());
        let own = columns.filter(|name| *name != "mass");
        std::iter::once("mass").chain(own).collect()
    }

    fn values(&self, k: usize, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        match self.column(name) {
            Some(column) if column.values.is_empty() => {
                let (path, name) = (self.path.display(), shown(name));
                let problem = format!("{path}: its column `{name}` has no numbers");
                Err(Failure::Input(problem))
            }
            Some(column) => Ok(Some(column.values[self.tracks.rows(k)].to_vec())),
            None => Ok((name == "mass").then(|| self.masses(k))),
        }
    }
}

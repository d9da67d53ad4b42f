//! Frames of a trajectory file.

use std::path::{Path, PathBuf};

use super::frames::{ALWAYS, Frames, Run, around, densities, kernel, speeds};
use crate::cli::failure::Failure;
use crate::cli::inputs;
use crate::engine::agents::REFERENCE_RADIUS;
use crate::engine::math::Vector;
use crate::engine::scene::Scene;
use crate::lab::measure::{Site, speed};
use crate::output::colors::{DENSITY_RANGE, SPEED_RANGE};
use crate::output::picture::Crowd;
use crate::scenario::quote::shown;
use crate::scenario::trajectories::{Column, ReadOptions, Tracks, columns};

/// The support radius of the kernel, meters (§5.6).
const SUPPORT: f64 = 1.0;
/// Margin around walls and people, meters.
const MARGIN: f64 = 1.0;

struct Tracked {
    path: PathBuf,
    tracks: Tracks,
    velocities: Vec<Option<Vector>>,
    site: Site,
    scene: Scene,
    /// The columns of the file beside positions and masses.
    columns: Vec<Column>,
    /// The current frame, among those with people.
    current: usize,
    crowd: Crowd,
}

/// The run that a trajectory file holds, with the walls of a floor plan or else those of the file. `wanted` is the
/// column that is needed.
pub fn open(
    path: &Path,
    options: &ReadOptions,
    geometry: Option<&Path>,
    wanted: &str,
) -> Result<Run, Failure> {
    let tracks = inputs::tracks(path, options)?;
    let site = inputs::site(path, geometry, &tracks)?;
    let solids = site.walls.obstacles().to_vec();
    let mut tracked = Tracked {
        path: path.to_owned(),
        velocities: speed::velocities(&tracks, speed::FRAMES),
        columns: columns(path, wanted, &tracks)?,
        scene: Scene::with_obstacles(solids),
        site,
        current: 0,
        crowd: Crowd::default(),
        tracks,
    };
    tracked.take();
    let tracks = &tracked.tracks;
    let corners = tracked.scene.walls.iter().map(|wall| wall.start);
    let view = around(corners.chain(tracks.position.iter().copied()), MARGIN);
    let ends = [tracks.frames.first(), tracks.frames.last()];
    let times = ends.map(|frame| frame.map_or(0.0, |&frame| tracks.time(frame)));
    Ok(Run {
        title: path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        view,
        density_range: [0.0, DENSITY_RANGE.into()],
        speed_range: [0.0, SPEED_RANGE.into()],
        support_radius: SUPPORT,
        observed: Vec::new(),
        labels: Vec::new(),
        body_mass: None,
        times: Some(times),
        frames: Box::new(tracked),
    })
}

impl Tracked {
    /// Takes the crowd of the current frame.
    fn take(&mut self) {
        let tracks = &self.tracks;
        let rows = tracks.rows(self.current);
        let column = |name: &str| self.columns.iter().find(|column| column.name == name);
        let radius = column("radius").map(|column| column.values[rows.clone()].to_vec());
        let mass: Vec<f64> = rows.clone().map(|row| tracks.mass_of(row)).collect();
        // The mass is proportional to the area.
        let own = |mass: &f64| REFERENCE_RADIUS * mass.max(0.0).sqrt();
        self.crowd = Crowd {
            time: tracks.time(tracks.frames[self.current]),
            id: rows
                .clone()
                .map(|row| tracks.ids[tracks.person[row] as usize])
                .collect(),
            position: tracks.position[rows.clone()].to_vec(),
            radius: radius.unwrap_or_else(|| mass.iter().map(own).collect()),
            mass,
            velocity: self.velocities[rows].to_vec(),
        };
    }
}

impl Frames for Tracked {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn go_to(&mut self, time: f64) -> Result<(), Failure> {
        let tracks = &self.tracks;
        let next = tracks
            .frames
            .partition_point(|&frame| tracks.time(frame) < time);
        let away = |k: &usize| (tracks.time(tracks.frames[*k]) - time).abs();
        let near = [next.saturating_sub(1), next.min(tracks.frames.len() - 1)];
        let nearest = near.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        self.current = nearest.unwrap_or(0);
        self.take();
        Ok(())
    }

    fn crowd(&self) -> &Crowd {
        &self.crowd
    }

    fn columns(&self) -> Vec<String> {
        let own = self.columns.iter().map(|column| column.name.as_str());
        let own = own.filter(|name| !ALWAYS.contains(name) && *name != "mass");
        ALWAYS
            .into_iter()
            .chain(["mass"])
            .chain(own)
            .map(str::to_owned)
            .collect()
    }

    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        let own = self.columns.iter().find(|column| column.name == name);
        if let Some(column) = own {
            if column.values.is_empty() {
                let (path, name) = (self.path.display(), shown(name));
                let problem = format!("{path}: its column `{name}` has no numbers");
                return Err(Failure::Input(problem));
            }
            return Ok(Some(column.values[self.tracks.rows(self.current)].to_vec()));
        }
        Ok(match name {
            "density" => Some(densities(&self.crowd, &self.site, &kernel(SUPPORT))),
            "speed" => Some(speeds(&self.crowd)),
            "radius" => Some(self.crowd.radius.clone()),
            "mass" => Some(self.crowd.mass.clone()),
            _ => None,
        })
    }
}

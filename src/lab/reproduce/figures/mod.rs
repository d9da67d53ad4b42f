//! The figures of the paper, drawn from the results of runs.

mod concert;
mod crossing;
mod evacuation;
mod frame_time;
mod grid;
mod pairs;
mod performance;
mod shockwave;
mod speeds;
mod study;

use std::sync::LazyLock;

use super::case::Case;
use super::error::ReproduceError;
use super::snapshot::Snapshot;
use super::store::Store;
use crate::engine::scene::{Region, Scene};
use crate::output::colors::{self, ColorMap};
use crate::output::plot::{Axis, ColorBar, Disc, GRAY, Mark, Panel, Sheet};

pub use crossing::PRODUCT as FIG6;
pub use evacuation::PRODUCT as FIG5;
pub use pairs::{FIG8_PRODUCT as FIG8, FIG10_PRODUCT as FIG10};
pub use performance::PRODUCT as FIG11;
pub use shockwave::{FIG7_PRODUCT as FIG7, FIG9_PRODUCT as FIG9};
pub use speeds::PRODUCT as WAVES;
pub use study::PRODUCT as STUDY;

/// Writes a picture into the store's folder, and returns a line with the file names.
fn save(sheet: &Sheet, store: &Store, name: &str) -> Result<String, ReproduceError> {
    let stem = store.path(name);
    sheet.save(&stem)?;
    Ok(format!("{0}.svg, {0}.png\n", stem.display()))
}

/// The scene of a case.
fn scene(case: &Case) -> Result<Scene, ReproduceError> {
    Ok(case.scenario()?.scene)
}

/// Inferno up to 1 m/s: the push itself reaches 0.9 m/s.
static CROWD_SPEED: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::inferno([0.0, 1.0]));

/// The meaning of the discs' colors (Fig. 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coloring {
    /// |v_i|.
    Speed,
    /// |v_i| in a crowd that hardly moves: the color range ends at the speed of its waves.
    CrowdSpeed,
    /// ρ_i.
    Density,
}

impl Coloring {
    fn map(self) -> &'static ColorMap {
        match self {
            Self::Speed => &colors::SPEED,
            Self::CrowdSpeed => &CROWD_SPEED,
            Self::Density => &colors::DENSITY,
        }
    }

    /// Its color bar.
    pub fn bar(self) -> ColorBar {
        let label = match self {
            Self::Speed | Self::CrowdSpeed => "speed [m/s]",
            Self::Density => "density [P/m²]",
        };
        ColorBar {
            label: label.to_owned(),
            map: self.map().clone(),
        }
    }
}

/// A part of a scene with its obstacles, on which snapshots are drawn.
#[derive(Debug, Clone)]
pub struct Stage {
    obstacles: Vec<Vec<[f64; 2]>>,
    region: Region,
}

impl Stage {
    /// The part of `scene` inside `region`.
    pub fn new(scene: &Scene, region: Region) -> Self {
        let corners =
            |p: &crate::engine::geometry::Polygon| p.points().iter().map(|c| [c.x, c.y]).collect();
        Self {
            obstacles: scene.walls.obstacles().iter().map(corners).collect(),
            region,
        }
    }

    /// Width and height of a panel that is `width` points wide, with equal scales on both axes.
    pub fn panel_size(&self, width: f64) -> [f64; 2] {
        let size = self.region.max - self.region.min;
        [width, width * size.y / size.x]
    }

    /// A snapshot as a panel.
    pub fn panel(&self, title: &str, snapshot: &Snapshot, coloring: Coloring) -> Panel {
        let values = match coloring {
            Coloring::Speed | Coloring::CrowdSpeed => &snapshot.speed,
            Coloring::Density => &snapshot.density,
        };
        let discs = values.iter().enumerate().map(|(i, &value)| Disc {
            center: [snapshot.x[i], snapshot.y[i]],
            radius: snapshot.radius[i],
            color: coloring.map().color(value as f32),
        });
        let mut marks = vec![Mark::Discs(discs.collect())];
        marks.extend(self.obstacles.iter().map(|c| Mark::Area(c.clone(), GRAY)));
        let (min, max) = (self.region.min, self.region.max);
        Panel {
            title: title.to_owned(),
            x: Axis::linear("x [m]", [min.x, max.x]),
            y: Axis::linear("y [m]", [min.y, max.y]),
            marks,
            bar: None,
            legend: None,
        }
    }
}

/// (a), (b), …
fn letter(k: usize) -> char {
    char::from(b'a' + (k % 26) as u8)
}

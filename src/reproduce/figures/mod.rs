//! What each figure of the paper shows, from what the runs have left.

pub mod crossing;
pub mod evacuation;
pub mod pairs;
pub mod performance;
pub mod shockwave;
pub mod speeds;
pub mod study;

use super::snapshot::Snapshot;
use crate::colors::{self, ColorMap};
use crate::plot::{Axis, ColorBar, Disc, GRAY, Mark, Panel};
use crate::scene::{Region, Scene};

/// What the discs' colours say (Fig. 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coloring {
    /// |v_i|.
    Speed,
    /// ρ_i.
    Density,
}

impl Coloring {
    fn map(self) -> &'static ColorMap {
        match self {
            Self::Speed => &colors::SPEED,
            Self::Density => &colors::DENSITY,
        }
    }

    /// What explains it.
    pub fn bar(self) -> ColorBar {
        let label = match self {
            Self::Speed => "speed [m/s]",
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
    /// A part of a scene.
    pub fn new(scene: &Scene, region: Region) -> Self {
        let corners =
            |p: &crate::geometry::Polygon| p.points().iter().map(|c| [c.x, c.y]).collect();
        Self {
            obstacles: scene.walls.obstacles().iter().map(corners).collect(),
            region,
        }
    }

    /// Width and height of a panel that is so many points wide, with equal scales on both axes.
    pub fn panel_size(&self, width: f64) -> [f64; 2] {
        let size = self.region.max - self.region.min;
        [width, width * size.y / size.x]
    }

    /// A snapshot as a panel.
    pub fn panel(&self, title: &str, snapshot: &Snapshot, coloring: Coloring) -> Panel {
        let values = match coloring {
            Coloring::Speed => &snapshot.speed,
            Coloring::Density => &snapshot.density,
        };
        let discs = values.iter().enumerate().map(|(i, &value)| Disc {
            center: [f64::from(snapshot.x[i]), f64::from(snapshot.y[i])],
            radius: f64::from(snapshot.radius[i]),
            color: coloring.map().color(value),
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

//! The options of a measurement, and why one is impossible.

use analysis::crossing::{Line, Passages};
use analysis::site::Kernel;
use engine::scene::Region;

/// Maximum number of cells of mean fields.
pub const MOST_CELLS: usize = 4_000_000;

/// The density assumed behind walls: ρ_i⁰ in Eq. 10.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Behind {
    /// The density at the person's position: ρ_i = Σ_j m_j W / (1 − Σ_k ∫ W over P_k), summed over the people that
    /// walls do not hide. A uniform crowd then has the same density up to its walls, and people behind a thin wall do
    /// not count.
    #[default]
    Same,
    /// As in the engine: the moving average ρ̂_i of the person's own density (Eq. 8), clamped between 0 and this
    /// value, P/m². It depends on earlier frames, and all people within reach count.
    Rest(f64),
}

/// The reach of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellLimit {
    /// Radius of the circle around each person that limits its cell, meters; `None`: only walls limit cells.
    pub cut_off: Option<f64>,
    /// The circle is a regular polygon of four times as many corners, which lie on it (`quad_segments` in PedPy).
    pub quad_segments: u32,
}

impl Default for CellLimit {
    /// 2 m: people at less than 0.08 P/m² would need more. 8 segments: the polygon has 97 % of the circle's area.
    fn default() -> Self {
        Self {
            cut_off: Some(2.0),
            quad_segments: 8,
        }
    }
}

/// The options of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The kernel.
    pub kernel: Kernel,
    /// The density assumed behind walls.
    pub behind: Behind,
    /// Number of recorded frames that a velocity looks back and ahead, at least 1.
    pub speed_reach: i64,
    /// Start and end of the measurement, seconds, both included.
    pub times: [f64; 2],
    /// Side of the cells of mean fields, meters.
    pub cell: f64,
    /// The reach of Voronoi cells.
    pub cells: CellLimit,
    /// Regions of the fundamental diagrams; if empty, one diagram covers everything.
    pub regions: Vec<Region>,
    /// The lines across which flow is measured.
    pub lines: Vec<Line>,
    /// The passages of a line between which flow is also measured.
    pub flow_of: Passages,
    /// Time between samples of exposure, level of service and crowd pressure, seconds.
    pub sample_every: f64,
}

/// The reason why a measurement is impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasureError {
    /// No frame is in the requested time.
    #[error("no agents from {0} s to {1} s; there are agents from {2} s to {3} s")]
    Nobody(f64, f64, f64, f64),
    /// No distance and no floor limit Voronoi cells.
    #[error(
        "nothing limits the Voronoi cells: there is no walkable area; give one with --geometry, or a distance with \
         --voronoi-cutoff"
    )]
    Unlimited,
    /// The number of a region, from 1, that is outside of the walkable area.
    #[error("region {0} is outside of the walkable area; give another --region")]
    Unwalkable(usize),
    /// The number of a line, from 1, that is outside of the walkable area, and that no one crosses.
    #[error(
        "line {0} is in an obstacle or outside of the walkable area, and no one crosses it; give another --line"
    )]
    LineOffFloor(usize),
    /// The walkable area cannot be cut, with the reason.
    #[error("the walkable area: {0}")]
    Floor(String),
    /// Too many cells.
    #[error("fields would have more than {MOST_CELLS} cells of {0} m; give a larger --cell")]
    Cells(f64),
}

//! The source of pictures of a crowd: a simulation, a trajectory file, or a recording.

use crate::cli::failure::Failure;
use crate::engine::boundary::WallMethod;
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::engine::simulation::Simulation;
use crate::lab::measure::{Behind, Kernel, MOST_HIDDEN, Site, parts};
use crate::output::picture::Crowd;
use crate::scenario::floor_plan::Label;
use crate::scenario::measurements::Observed;

/// The crowd at the moments of a run.
pub trait Frames: Send {
    /// Walls and places.
    fn scene(&self) -> &Scene;

    /// The simulation, if there is one. Its agents are those of [`crowd`](Self::crowd), in the same order.
    fn simulation(&self) -> Option<&Simulation> {
        None
    }

    /// Goes to the frame nearest to a time, seconds, not before the current frame.
    fn go_to(&mut self, time: f64) -> Result<(), Failure>;

    /// The crowd in the current frame.
    fn crowd(&self) -> &Crowd;

    /// The names of the quantities of which the current frame has values.
    fn columns(&self) -> Vec<String>;

    /// The values of a quantity in the current frame, NaN where unknown; `None`: there is no such quantity.
    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure>;
}

/// A run to draw.
pub struct Run {
    pub frames: Box<dyn Frames>,
    /// Its title in pictures.
    pub title: String,
    /// The part of the plane to show.
    pub view: Region,
    /// The densities with the first and the last color, P/m².
    pub density_range: [f64; 2],
    /// The speeds with the first and the last color, m/s.
    pub speed_range: [f64; 2],
    /// The support radius of the kernel, meters.
    pub support_radius: f64,
    /// The places that its measurements observe.
    pub observed: Vec<(String, Observed)>,
    /// Texts.
    pub labels: Vec<Label>,
    /// The mass of an average person, kg, if forces on walls are measured.
    pub body_mass: Option<f64>,
    /// The times of the first and the last frame, seconds, if they are known.
    pub times: Option<[f64; 2]>,
}

/// The speeds of a crowd, m/s.
pub fn speeds(crowd: &Crowd) -> Vec<f64> {
    let speeds = crowd.velocity.iter();
    speeds
        .map(|velocity| velocity.map_or(f64::NAN, |velocity| velocity.norm()))
        .collect()
}

/// The kernel with which densities are computed where a run has none.
pub fn kernel(support_radius: f64) -> Kernel {
    Kernel {
        support_radius,
        walls: WallMethod::Union,
    }
}

/// The SPH density of each person (§8), P/m².
pub fn densities(crowd: &Crowd, site: &Site, kernel: &Kernel) -> Vec<f64> {
    let how = (kernel, Behind::Same);
    let parts = parts(site, &crowd.position, &crowd.mass, how);
    let density = parts.into_iter().map(|part| {
        let seen = 1.0 - part.hidden.share.min(MOST_HIDDEN);
        part.from_people / seen
    });
    density.collect()
}

/// The names of quantities that every crowd has.
pub const ALWAYS: [&str; 3] = ["density", "speed", "radius"];

/// The bounding box of points, with a margin.
pub fn around(points: impl Iterator<Item = Vector>, margin: f64) -> Region {
    let [low, high] = crate::engine::math::bounds(points).unwrap_or_default();
    let margin = Vector::repeat(margin);
    Region {
        min: low - margin,
        max: high + margin,
    }
}

/// The range from the 1st to the 99th percentile of the known values; from 0 to 1 without any.
pub fn usual(values: &[f64]) -> [f64; 2] {
    let mut known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    if known.is_empty() {
        return [0.0, 1.0];
    }
    let last = (known.len() - 1) as f64;
    let [low, high] = [0.01, 0.99].map(|part| known[(part * last).round() as usize]);
    // One value for everybody still needs a range.
    let least = 1e-6 * low.abs().max(high.abs()).max(1e-3);
    match high - low > least {
        true => [low, high],
        false => [low - 0.5, low + 0.5],
    }
}

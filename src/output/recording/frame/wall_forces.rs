//! Walls, colored by the force on them.

use rerun::{LineStrips2D, RecordingStream, Scalars};

use crate::analysis::wall_forces::Outlines;
use crate::engine::simulation::Simulation;
use crate::output::colors::WALL_FORCE;
use crate::output::recording::draw::{Point, color, log_series, px, xy};
use crate::output::recording::error::Cause;

/// The entity of the colored walls.
pub const ENTITY: &str = "world/wall_forces";
/// The time series of the largest force.
pub const SERIES: &str = "stats/wall_forces";

/// A part of a wall with the force on it, N/m.
pub type Part = ([Point; 2], f32);

/// The parts of walls with a force on them in an evaluated frame.
pub fn parts(outlines: &Outlines, simulation: &Simulation, body_mass: f64) -> Vec<Part> {
    let pressed = outlines.pressed(simulation, body_mass);
    let parts = pressed.map(|(ends, force)| (ends.map(xy), force as f32));
    parts.collect()
}

/// Logs the style of the layer and of its time series.
pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let style = LineStrips2D::update_fields()
        .with_radii(px(3.0))
        .with_draw_order(7.0);
    stream.log_static(ENTITY, &style)?;
    let name = "largest force on 1 m of wall [N/m]";
    log_series(stream, SERIES, name, Some([240, 90, 60]))
}

/// Logs the parts of one frame.
pub fn log(stream: &RecordingStream, parts: &[Part]) -> Result<(), Cause> {
    let lines = LineStrips2D::update_fields()
        .with_strips(parts.iter().map(|(ends, _)| *ends))
        .with_colors(
            parts
                .iter()
                .map(|&(_, force)| color(WALL_FORCE.color(force))),
        );
    stream.log(ENTITY, &lines)?;
    let largest = parts.iter().map(|&(_, force)| force).fold(0.0, f32::max);
    Ok(stream.log(SERIES, &Scalars::single(f64::from(largest)))?)
}

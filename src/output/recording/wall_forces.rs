//! Walls, colored by the force on them.

use rerun::{Color, LineStrips2D, Radius, RecordingStream, Scalars, SeriesLines};

use super::error::Cause;
use super::geometry::xy;
use crate::analysis::wall_forces::Outlines;
use crate::engine::simulation::Simulation;
use crate::output::colors::WALL_FORCE;

/// The entity of the colored walls.
pub const ENTITY: &str = "world/wall_forces";
/// The time series of the largest force.
pub const SERIES: &str = "stats/wall_forces";

/// A part of a wall with the force on it, N/m.
pub type Part = ([[f32; 2]; 2], f32);

/// The parts of walls with a force on them in an evaluated frame.
pub fn parts(outlines: &Outlines, simulation: &Simulation, body_mass: f64) -> Vec<Part> {
    let forces = outlines.per_meter(&outlines.forces(simulation, body_mass));
    let parts = outlines.cells().iter().zip(forces);
    let pressed = parts.filter(|&(_, force)| force > 0.0);
    pressed
        .map(|(cell, force)| (cell.ends.map(xy), force as f32))
        .collect()
}

/// Logs the style of the layer and of its time series.
pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let style = LineStrips2D::update_fields()
        .with_radii([Radius::new_ui_points(3.0)])
        .with_draw_order(7.0);
    stream.log_static(ENTITY, &style)?;
    let style = SeriesLines::new()
        .with_names(["largest force on 1 m of wall [N/m]"])
        .with_colors([Color::from_rgb(240, 90, 60)])
        .with_widths([1.5]);
    Ok(stream.log_static(SERIES, &style)?)
}

/// Logs the parts of one frame.
pub fn log(stream: &RecordingStream, parts: &[Part]) -> Result<(), Cause> {
    let color = |&(_, force): &Part| {
        let [r, g, b] = WALL_FORCE.color(force);
        Color::from_rgb(r, g, b)
    };
    let lines = LineStrips2D::update_fields()
        .with_strips(parts.iter().map(|(ends, _)| *ends))
        .with_colors(parts.iter().map(color));
    stream.log(ENTITY, &lines)?;
    let largest = parts.iter().map(|&(_, force)| force).fold(0.0, f32::max);
    Ok(stream.log(SERIES, &Scalars::single(f64::from(largest)))?)
}

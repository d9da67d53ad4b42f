//! Walls, colored by the force on them.

use super::xy;
use crate::drawing::Drawing;
use analysis::wall_forces::Outlines;
use engine::simulation::Simulation;
use figures::colors::WALL_FORCE;
use figures::plot::{ColorBar, Mark, Style};

/// The parts of walls with a force on them, colored by the force on 1 m.
pub fn marks(simulation: &Simulation, body_mass: f64, drawing: Option<&Drawing>) -> Vec<Mark> {
    let place = |p| drawing.map_or(p, |drawing| drawing.place(p));
    let outlines = Outlines::new(&simulation.scene().walls);
    let pressed = outlines.pressed(simulation, body_mass);
    let marks = pressed.map(|(ends, force)| {
        let style = Style::full(WALL_FORCE.color(force as f32), 3.0, "");
        Mark::line(ends.map(|p| xy(place(p))), style)
    });
    marks.collect()
}

/// The colors of forces on walls.
pub fn bar() -> ColorBar {
    ColorBar::new("force on 1 m of wall [N/m]", &WALL_FORCE)
}

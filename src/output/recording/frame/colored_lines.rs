//! Lines colored by a value, with the time series of the largest one: the force on walls, the waits before openings,
//! the leans of people.

use std::sync::LazyLock;

use rerun::{LineStrips2D, RecordingStream, Scalars};

use crate::drawing::Drawing;
use crate::recording::draw::{Point, color, log_series, px, xy};
use crate::recording::error::Cause;
use analysis::wall_forces::Outlines;
use engine::forces::legs;
use engine::math::Vector;
use engine::simulation::Simulation;
use figures::colors::{ColorMap, LEAN, Rgb, WAIT, WALL_FORCE};

/// A line with its value.
pub type Part = ([Point; 2], f32);

/// A layer of lines.
#[derive(Debug)]
pub struct ColoredLines {
    /// Its entity.
    pub entity: &'static str,
    /// The time series of the largest value, and its name.
    pub series: &'static str,
    name: &'static str,
    /// The title of its plot.
    pub title: &'static str,
    rgb: Rgb,
    /// Half the width of the lines, pixels.
    width: f32,
    map: &'static LazyLock<ColorMap>,
}

/// Walls, colored by the force on them, N/m.
pub static WALL_FORCES: ColoredLines = ColoredLines {
    entity: "world/wall_forces",
    series: "stats/wall_forces",
    name: "largest force on 1 m of wall [N/m]",
    title: "Force on walls",
    rgb: [240, 90, 60],
    width: 3.0,
    map: &WALL_FORCE,
};

/// Openings between rooms, colored by the time that the last agent bound for them waits, seconds.
pub static WAITS: ColoredLines = ColoredLines {
    entity: "world/waits",
    series: "stats/waits",
    name: "longest wait before an opening [s]",
    title: "Waits before openings",
    rgb: [230, 160, 60],
    width: 3.0,
    map: &WAIT,
};

/// Lines from legs to bodies, colored by the lean, meters.
pub static LEANS: ColoredLines = ColoredLines {
    entity: "world/leans",
    series: "stats/leans",
    name: "longest lean [m]",
    title: "Leans",
    rgb: [200, 120, 200],
    width: 1.5,
    map: &LEAN,
};

/// The parts of walls with a force on them in an evaluated frame.
pub fn wall_forces(
    outlines: &Outlines,
    (simulation, body_mass): (&Simulation, f64),
    drawing: Option<&Drawing>,
) -> Vec<Part> {
    let pressed = outlines.pressed(simulation, body_mass);
    let place = |p| xy(drawing.map_or(p, |drawing| drawing.place(p)));
    let parts = pressed.map(|(ends, force)| (ends.map(place), force as f32));
    parts.collect()
}

/// Whether some profile has legs.
pub fn have_legs(simulation: &Simulation) -> bool {
    let mut states = simulation.frame().agents.states.iter();
    states.any(|states| states.force == legs::NAME)
}

/// The leans of all agents that have legs; `None` if no profile has legs.
pub fn leans(simulation: &Simulation, drawing: Option<&Drawing>) -> Option<Vec<Part>> {
    let agents = simulation.frame().agents;
    if !have_legs(simulation) {
        return None;
    }
    let part = |i: usize| {
        let body = agents.position[i];
        let shift = drawing.map_or(Vector::zeros(), |drawing| drawing.place(body) - body);
        let ends = [legs::position(agents, i)?, body];
        Some((
            ends.map(|p| xy(p + shift)),
            legs::lean(agents, i).norm() as f32,
        ))
    };
    Some(agents.present().filter_map(part).collect())
}

/// The openings before which agents wait; `None` if they do not choose quickest routes.
pub fn waits(simulation: &Simulation, drawing: Option<&Drawing>) -> Option<Vec<Part>> {
    let rooms = simulation.scene().rooms()?;
    let drawn = |p| xy(drawing.map_or(p, |drawing| drawing.place(p)));
    let all = rooms.openings().iter().zip(simulation.waits());
    let waits = all.filter(|(_, wait)| *wait > 0.0);
    let parts = waits.flat_map(|(opening, wait)| {
        let pieces = rooms.pieces_of(opening);
        pieces.map(move |ends| (ends.map(drawn), wait as f32))
    });
    Some(parts.collect())
}

/// Layers have different entities.
impl PartialEq for ColoredLines {
    fn eq(&self, other: &Self) -> bool {
        self.entity == other.entity
    }
}

impl Eq for ColoredLines {}

impl ColoredLines {
    /// Logs the style of the layer and of its time series.
    pub fn log_style(&self, stream: &RecordingStream) -> Result<(), Cause> {
        let style = LineStrips2D::update_fields()
            .with_radii(px(self.width))
            .with_draw_order(7.0);
        stream.log_static(self.entity, &style)?;
        log_series(stream, self.series, self.name, Some(self.rgb))
    }

    /// Logs the lines of one frame.
    pub fn log(&self, stream: &RecordingStream, parts: &[Part]) -> Result<(), Cause> {
        let colors = parts.iter().map(|&(_, value)| color(self.map.color(value)));
        let lines = LineStrips2D::update_fields()
            .with_strips(parts.iter().map(|(ends, _)| *ends))
            .with_colors(colors);
        stream.log(self.entity, &lines)?;
        let largest = parts.iter().map(|&(_, value)| value).fold(0.0, f32::max);
        Ok(stream.log(self.series, &Scalars::single(f64::from(largest)))?)
    }
}

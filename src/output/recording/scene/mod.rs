//! The static data of a scene, logged once before the first frame.

pub mod bars;
pub mod markers;
pub mod names;
pub mod obstacles;
pub mod places;
pub mod routes;

use rerun::{Points2D, RecordingStream};

use super::draw::{color, log_lines, px, xy, y_up};
use super::error::Cause;
use super::options::RecordingOptions;
use crate::drawing::{self, Drawing};
use crate::labels;
use crate::scenery::{self, GoalOf, closed};
use engine::agents::Agents;
use engine::geometry::Polygon;
use engine::math::bounds;
use engine::period::Axis;
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;
use figures::colors::Rgb;
use names::Names;

const WALL: Rgb = [214, 214, 222];
const GOAL: Rgb = [95, 211, 120];
const LEVEL: Rgb = [200, 200, 200];
const STEP: Rgb = [70, 72, 84];
const JOIN: Rgb = [160, 140, 220];

/// Logs everything that stays constant in a run.
pub fn log(
    stream: &RecordingStream,
    simulation: &Simulation,
    (scene, drawing): (&Scene, Option<&Drawing>),
    options: &RecordingOptions,
) -> Result<(), Cause> {
    let agents = simulation.frame().agents;
    let goals = drawing::goals(scenery::goals(simulation.scene(), agents), drawing);
    let mut names = Names::of_scene(&options.view, scene);
    places::log(stream, scene, &mut names)?;
    log_walls(stream, scene.walls.obstacles())?;
    log_period(stream, scene, agents)?;
    log_goals(stream, (scene, &goals), &mut names)?;
    if let Some(drawing) = drawing {
        log_levels(stream, drawing, &mut names)?;
    }
    routes::log(stream, scene)?;
    markers::log(stream, scene, options, &mut names)?;
    names.log(stream)
}

/// Logs the direction of y, walls and obstacles.
pub fn log_walls(stream: &RecordingStream, obstacles: &[Polygon]) -> Result<(), Cause> {
    stream.log_static("world", &y_up())?;
    let rings = obstacles.iter().flat_map(Polygon::rings);
    log_lines(stream, "walls", (WALL, 0.75, 5.0), rings.map(closed))?;
    obstacles::log(stream, obstacles)
}

/// Logs a line at each end of the period.
fn log_period(stream: &RecordingStream, scene: &Scene, agents: &Agents) -> Result<(), Cause> {
    let Some(period) = &scene.period else {
        return Ok(());
    };
    let starts = scene.walls.iter().map(|wall| wall.start);
    let corners = bounds(starts.chain(agents.position.iter().copied())).unwrap_or_default();
    let [min, max] = period.clipped(corners);
    let [a, b, c, d] = Region { min, max }.corners();
    let ends = match period.axis {
        Axis::X => [vec![a, d], vec![b, c]],
        Axis::Y => [vec![a, b], vec![d, c]],
    };
    log_lines(stream, "period", (GOAL, 0.75, 6.0), ends)
}

/// Logs the steps of stairs and the joins of levels.
fn log_levels(stream: &RecordingStream, drawing: &Drawing, names: &mut Names) -> Result<(), Cause> {
    let steps = drawing.steps(0.0).into_iter().map(|line| line.to_vec());
    log_lines(stream, "steps", (STEP, 0.25, -2.0), steps)?;
    for (name, [top, bottom]) in drawing.names() {
        names.add(
            "names",
            1,
            name,
            (LEVEL, &[(top, [0, 1]), (bottom, [0, -1])]),
        );
    }
    let joins = drawing.joins();
    let lines = joins.iter().map(|way| way.line.to_vec());
    log_lines(stream, "joins", (JOIN, 1.5, 5.5), lines)?;
    for way in &joins {
        let spots = labels::around(&way.line, false);
        let name = format!("to {}", way.to);
        names.add("joins/names", joins.len(), &name, (JOIN, &spots));
    }
    Ok(())
}

fn log_goals(
    stream: &RecordingStream,
    (scene, goals): (&Scene, &[GoalOf]),
    names: &mut Names,
) -> Result<(), Cause> {
    if goals.is_empty() {
        return Ok(());
    }
    for (text, spots) in labels::of_goals(scene, goals) {
        names.add("goals/names", goals.len(), &text, (GOAL, &spots));
    }
    let points = Points2D::new(goals.iter().map(|(p, _)| xy(*p)))
        .with_radii(px(5.0))
        .with_colors([color(GOAL)])
        .with_draw_order(6.0);
    Ok(stream.log_static("world/geometry/goals", &points)?)
}

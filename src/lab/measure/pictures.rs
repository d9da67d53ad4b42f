//! Pictures of mean fields, fundamental diagrams and N(t).

use std::path::Path;

use super::{Class, Crossings, Diagram, FrameMean, Mean, Measured, Site, safety_report};
use crate::analysis::statistics::MeanStd;
use crate::engine::geometry::Walls;
use crate::engine::math::Vector;
use crate::output::colors::{ColorMap, DENSITY, SPEED};
use crate::output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, GRAY, LINES, Mark, Panel, PlotError, Point, Sheet, Style,
};

/// Length of the longer side of a map, points.
const MAP_SIDE: f64 = 330.0;
/// Minimum length of a side of a map, points.
const LEAST_SIDE: f64 = 70.0;
/// Maximum number of dots per diagram; more would hide each other.
const MOST_DOTS: usize = 1500;
/// Below this density, P/m², the mean speed is not meaningful and is left blank.
const NOBODY: f64 = 1e-3;

/// The file names of the pictures, without extension.
pub const STEMS: [&str; 4] = ["fields", "fundamental_diagram", "flow", "safety"];

/// Draws all pictures into `folder`, as SVG and PNG.
///
/// # Errors
/// A picture cannot be written.
pub fn save(folder: &Path, measured: &Measured, site: &Site) -> Result<(), PlotError> {
    let [fields, diagram, flow, safety] = STEMS;
    maps(measured, &site.walls).save(&folder.join(fields))?;
    diagrams(&measured.diagrams).save(&folder.join(diagram))?;
    safety_report::picture(&measured.safety).save(&folder.join(safety))?;
    if !measured.crossings.is_empty() {
        counts(&measured.crossings).save(&folder.join(flow))?;
    }
    Ok(())
}

/// Maps of density and speed, with the walls.
fn maps(measured: &Measured, walls: &Walls) -> Sheet {
    let grid = &measured.fields.grid;
    let means: Vec<_> = measured.fields.means(measured.overview.frames).collect();
    let high = grid.center(grid.cells() - 1) + Vector::repeat(0.5 * grid.cell);
    let (x, y) = ([grid.min.x, high.x], [grid.min.y, high.y]);
    let (width, height) = (x[1] - x[0], y[1] - y[0]);
    let scale = MAP_SIDE / width.max(height);
    let map = |title: &str, label: &str, map: &ColorMap, value: fn(&Mean) -> Option<f64>| {
        // Obstacles cover the cells in them.
        let values = means.iter().map(|mean| match mean {
            Some(mean) => value(mean),
            None => Some(0.0),
        });
        let mut marks = vec![Mark::Cells(Cells {
            extent: [[x[0], y[0]], [x[1], y[1]]],
            columns: grid.columns,
            values: values.collect(),
            map: map.clone(),
        })];
        let solid = means.iter().map(|mean| mean.is_none().then_some(0.0));
        marks.push(Mark::Overlay(Cells {
            extent: [[x[0], y[0]], [x[1], y[1]]],
            columns: grid.columns,
            values: solid.collect(),
            map: ColorMap::plain(GRAY),
        }));
        marks.extend(walls.iter().map(|wall| {
            let ends = [wall.start, wall.end].map(|p| [p.x, p.y]);
            Mark::Line(ends.to_vec(), Style::full(BLACK, 1.2, ""))
        }));
        Panel {
            bar: Some(ColorBar {
                label: label.to_owned(),
                map: map.clone(),
            }),
            ..Panel::new(
                title,
                Axis::linear("x [m]", x),
                Axis::linear("y [m]", y),
                marks,
            )
        }
    };
    let columns = if width > 1.5 * height { 1 } else { 2 };
    let size = [width, height].map(|side| (side * scale).max(LEAST_SIDE));
    let density = map("mean density", "density [P/m²]", &DENSITY, |mean| {
        Some(mean.density)
    });
    let speed = map("mean speed", "speed [m/s]", &SPEED, |mean| {
        mean.speed.filter(|_| mean.density > NOBODY)
    });
    sheet(columns, size, vec![density, speed])
}

/// Speed and flow over density: means of frames as dots, classes of people with standard deviations.
fn diagrams(diagrams: &[Diagram]) -> Sheet {
    let panel = |title: &str,
                 label: &str,
                 frame: fn(&FrameMean) -> Option<f64>,
                 class: fn(&Class) -> MeanStd| {
        let mut marks = Vec::new();
        for (k, diagram) in diagrams.iter().enumerate() {
            let pale = LINES[k % LINES.len()].map(|channel| channel / 3 + 170);
            // Thinned: more dots would hide each other.
            let every = diagram.frames.len().div_ceil(MOST_DOTS).max(1);
            let frames = diagram.frames.iter().step_by(every);
            let dots = frames.filter_map(|mean| Some([mean.density, frame(mean)?]));
            marks.push(Mark::dots(dots, Style::full(pale, 1.0, "")));
        }
        for (k, diagram) in diagrams.iter().enumerate() {
            let classes = diagram.of_persons.values();
            let points = classes.filter(|of| class(of).count > 0).map(|of| Point {
                x: of.density.mean,
                y: class(of).mean,
                error: class(of).population_std(),
            });
            let name = match diagram.region {
                None => "everywhere".to_owned(),
                Some(_) => format!("region {}", k + 1),
            };
            let style = Style::full(LINES[k % LINES.len()], 2.6, &name);
            marks.push(Mark::Points(points.collect(), style));
        }
        let points = marks.iter().flat_map(|mark| match mark {
            Mark::Points(points, _) => points.as_slice(),
            _ => &[],
        });
        let top = points.map(|point| point.y + point.error);
        let classes = diagrams.iter().flat_map(|all| all.of_persons.values());
        let right = classes.map(|class| class.density.mean);
        let x = Axis::linear("density [P/m²]", [0.0, 1.1 * right.fold(0.5, f64::max)]);
        let y = Axis::linear(label, [0.0, 1.1 * top.fold(0.1, f64::max)]);
        Panel::new(title, x, y, marks)
    };
    let title = "speed: persons ± deviation, frames as dots";
    let mut speed = panel(title, "speed [m/s]", |mean| mean.speed, |class| class.speed);
    speed.legend = Some(Corner::UpperRight);
    let flow = panel(
        "flow",
        "flow [1/(m s)]",
        |mean| mean.flow,
        |class| class.flow,
    );
    sheet(2, [240.0, 200.0], vec![speed, flow])
}

/// N(t) for every line; dashed for passages backward.
fn counts(crossings: &[Crossings]) -> Sheet {
    let all = || crossings.iter().flat_map(|line| &line.list);
    let last = all().map(|c| c.time).fold(0.0, f64::max);
    let first = all().map(|c| c.time).fold(f64::INFINITY, f64::min);
    let first = if first < last { first } else { last - 1.0 };
    let mut marks = Vec::new();
    let mut most: f64 = 1.0;
    for (k, line) in crossings.iter().enumerate() {
        let color = LINES[k % LINES.len()];
        let styles: [(_, _, fn(_, _, &str) -> _); 2] =
            [(1, "forward", Style::full), (-1, "backward", Style::broken)];
        for (direction, name, style) in styles {
            let times = line.passages(direction).enumerate();
            let steps = times.flat_map(|(n, time)| [[time, n as f64], [time, (n + 1) as f64]]);
            let steps: Vec<[f64; 2]> = steps.collect();
            if let Some([_, count]) = steps.last() {
                most = most.max(*count);
                let label = format!("line {} {name}", k + 1);
                marks.push(Mark::Line(steps, style(color, 1.2, &label)));
            }
        }
    }
    if marks.is_empty() {
        let middle = [0.5 * (first + last), 0.5];
        marks.push(Mark::Text(middle, "no passages".to_owned(), BLACK));
    }
    let (x, y) = (
        Axis::linear("t [s]", [first, last]),
        Axis::linear("N", [0.0, 1.05 * most]),
    );
    let mut panel = Panel::new("crossings so far", x, y, marks);
    panel.legend = Some(Corner::UpperLeft);
    sheet(1, [330.0, 210.0], vec![panel])
}

fn sheet(columns: usize, panel_size: [f64; 2], panels: Vec<Panel>) -> Sheet {
    Sheet {
        columns,
        panel_size,
        panels,
        ..Sheet::default()
    }
}

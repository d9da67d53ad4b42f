//! Pictures of mean fields, fundamental diagrams and N(t).

use std::path::Path;

use super::{Class, Crossings, Diagram, Measured, Site};
use crate::analysis::statistics::MeanStd;
use crate::engine::geometry::Walls;
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
pub const STEMS: [&str; 3] = ["fields", "fundamental_diagram", "flow"];

/// Draws all pictures into `folder`, as SVG and PNG.
///
/// # Errors
/// A picture cannot be written.
pub fn save(folder: &Path, measured: &Measured, site: &Site) -> Result<(), PlotError> {
    let [fields, diagram, flow] = STEMS;
    maps(measured, site.walls()).save(&folder.join(fields))?;
    diagrams(&measured.diagrams).save(&folder.join(diagram))?;
    if !measured.crossings.is_empty() {
        counts(&measured.crossings).save(&folder.join(flow))?;
    }
    Ok(())
}

/// Maps of density and speed, with the walls.
fn maps(measured: &Measured, walls: &Walls) -> Sheet {
    let grid = measured.fields.grid();
    let means: Vec<_> = measured.fields.means(measured.overview.frames).collect();
    let high = grid.center(grid.len() - 1) + crate::engine::math::Vector::repeat(0.5 * grid.cell);
    let (x, y) = ([grid.min.x, high.x], [grid.min.y, high.y]);
    let (width, height) = (x[1] - x[0], y[1] - y[0]);
    let scale = MAP_SIDE / width.max(height);
    let map = |title: &str, label: &str, map: &ColorMap, values: Vec<Option<f64>>| {
        let mut marks = vec![Mark::Cells(Cells {
            extent: [[x[0], y[0]], [x[1], y[1]]],
            columns: grid.columns,
            values,
            map: map.clone(),
        })];
        marks.extend(walls.iter().map(|wall| {
            let ends = [wall.start, wall.end].map(|p| [p.x, p.y]);
            Mark::Line(ends.to_vec(), Style::full(GRAY, 1.2, ""))
        }));
        Panel {
            title: title.to_owned(),
            x: Axis::linear("x [m]", x),
            y: Axis::linear("y [m]", y),
            marks,
            bar: Some(ColorBar {
                label: label.to_owned(),
                map: map.clone(),
            }),
            legend: None,
        }
    };
    let density = means.iter().map(|mean| mean.map(|mean| mean.density));
    let speed = means.iter().map(|mean| {
        let there = mean.filter(|mean| mean.density > NOBODY)?;
        there.speed
    });
    Sheet {
        title: String::new(),
        columns: if width > 1.5 * height { 1 } else { 2 },
        panel_size: [width, height].map(|side| (side * scale).max(LEAST_SIDE)),
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![
            map(
                "mean density",
                "density [P/m²]",
                &DENSITY,
                density.collect(),
            ),
            map("mean speed", "speed [m/s]", &SPEED, speed.collect()),
        ],
    }
}

/// Speed and flow over density: means of frames as dots, classes of people with standard deviations.
fn diagrams(diagrams: &[Diagram]) -> Sheet {
    let classes = || {
        diagrams
            .iter()
            .flat_map(|diagram| diagram.of_persons.values())
    };
    let top = |of: fn(&Class) -> &MeanStd| {
        let tops = classes().map(of).filter(|spread| spread.count > 0);
        let classes = tops.map(|spread| spread.mean + spread.population_std());
        let dots = diagrams.iter().flat_map(|diagram| dots(diagram, of));
        classes.chain(dots.map(|dot| dot.y)).fold(0.1, f64::max) * 1.1
    };
    let density = classes().filter(|class| class.density.count > 0);
    let density = density.map(|class| class.density.mean).fold(0.5, f64::max) * 1.1;
    let panel = |title: &str, label: &str, of: fn(&Class) -> &MeanStd, legend: bool| {
        let mut marks = Vec::new();
        for (k, diagram) in diagrams.iter().enumerate() {
            let color = LINES[k % LINES.len()];
            let pale = color.map(|channel| channel / 3 + 170);
            marks.push(Mark::Points(dots(diagram, of), Style::full(pale, 1.0, "")));
        }
        for (k, diagram) in diagrams.iter().enumerate() {
            let filled = diagram
                .of_persons
                .values()
                .filter(|class| of(class).count > 0);
            let points: Vec<Point> = filled
                .map(|class| Point {
                    x: class.density.mean,
                    y: of(class).mean,
                    error: of(class).population_std(),
                })
                .collect();
            let name = match diagram.region {
                None => "everywhere".to_owned(),
                Some(_) => format!("region {}", k + 1),
            };
            let style = Style::full(LINES[k % LINES.len()], 2.6, &name);
            marks.push(Mark::Points(points, style));
        }
        Panel {
            title: title.to_owned(),
            x: Axis::linear("density [P/m²]", [0.0, density]),
            y: Axis::linear(label, [0.0, top(of)]),
            marks,
            bar: None,
            legend: legend.then_some(Corner::UpperRight),
        }
    };
    Sheet {
        title: String::new(),
        columns: 2,
        panel_size: [240.0, 200.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![
            panel(
                "speed: persons ± deviation, frames as dots",
                "speed [m/s]",
                |c| &c.speed,
                true,
            ),
            panel("flow", "flow [1/(m s)]", |c| &c.flow, false),
        ],
    }
}

/// Means of frames as dots, thinned to at most [`MOST_DOTS`].
fn dots(diagram: &Diagram, of: fn(&Class) -> &MeanStd) -> Vec<Point> {
    let every = diagram.frames.len().div_ceil(MOST_DOTS).max(1);
    let frames = diagram.frames.iter().step_by(every);
    let dot = |frame: &super::FrameMean| {
        // A class with a single value, because `of` takes a class.
        let mut one = Class::default();
        one.add(frame.density, frame.speed?);
        Some(Point {
            x: frame.density,
            y: of(&one).mean,
            error: 0.0,
        })
    };
    frames.filter_map(dot).collect()
}

/// N(t) for every line; dashed for passages backward.
fn counts(crossings: &[Crossings]) -> Sheet {
    let times = || {
        crossings
            .iter()
            .flat_map(|line| line.list.iter().map(|c| c.time))
    };
    let (first, last) = (
        times().fold(f64::INFINITY, f64::min),
        times().fold(0.0, f64::max),
    );
    let first = if first < last { first } else { last - 1.0 };
    let mut marks = Vec::new();
    let mut most: f64 = 1.0;
    for (k, line) in crossings.iter().enumerate() {
        let color = LINES[k % LINES.len()];
        for (direction, name) in [(1, "forward"), (-1, "backward")] {
            let mut steps = Vec::new();
            for (n, time) in line.passages(direction).enumerate() {
                steps.extend([[time, n as f64], [time, (n + 1) as f64]]);
                most = most.max((n + 1) as f64);
            }
            if steps.is_empty() {
                continue;
            }
            let label = format!("line {} {name}", k + 1);
            let style = match direction {
                1 => Style::full(color, 1.2, &label),
                _ => Style::broken(color, 1.2, &label),
            };
            marks.push(Mark::Line(steps, style));
        }
    }
    if marks.is_empty() {
        let middle = [0.5 * (first + last), 0.5];
        marks.push(Mark::Text(middle, "nobody passes".to_owned(), BLACK));
    }
    Sheet {
        title: String::new(),
        columns: 1,
        panel_size: [330.0, 210.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![Panel {
            title: "persons who have passed".to_owned(),
            x: Axis::linear("t [s]", [first, last]),
            y: Axis::linear("N", [0.0, 1.05 * most]),
            marks,
            bar: None,
            legend: Some(Corner::UpperLeft),
        }],
    }
}

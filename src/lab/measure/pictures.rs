//! Pictures of mean fields, fundamental diagrams and N(t).

use std::path::Path;

use super::{
    Class, Crossings, Density, Diagram, FrameMean, Mean, Measured, Site, region_report,
    safety_report,
};
use crate::analysis::statistics::MeanStd;
use crate::engine::geometry::Walls;
use crate::engine::math::{Vector, bounds};
use crate::output::colors::{ColorMap, DENSITY, SPEED};
use crate::output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, GRAY, LINES, Label, Mark, Panel, PlotError, Point, Sheet,
    Style,
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
pub const STEMS: [&str; 5] = ["fields", "fundamental_diagram", "flow", "safety", "regions"];

/// Draws all pictures into `folder`, as SVG and PNG.
///
/// # Errors
/// A picture cannot be written.
pub fn save(folder: &Path, measured: &Measured, site: &Site) -> Result<(), PlotError> {
    let [fields, diagram, flow, safety, regions] = STEMS;
    maps(measured, &site.walls).save(&folder.join(fields))?;
    diagrams(&measured.diagrams).save(&folder.join(diagram))?;
    safety_report::picture(&measured.safety).save(&folder.join(safety))?;
    if let Some(sheet) = region_report::picture(measured) {
        sheet.save(&folder.join(regions))?;
    }
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
        let cells = |values, map| Cells {
            extent: [[x[0], y[0]], [x[1], y[1]]],
            columns: grid.columns,
            values,
            map,
        };
        let solid = means.iter().map(|mean| mean.is_none().then_some(0.0));
        let solid = cells(solid.collect(), ColorMap::plain(GRAY));
        let field = Mark::Cells(cells(values.collect(), map.clone()));
        let mut marks = vec![Mark::Group(vec![field, Mark::Overlay(solid)])];
        marks.extend(walls.iter().map(|wall| {
            let ends = [wall.start, wall.end].map(|p| [p.x, p.y]);
            Mark::Line(ends.to_vec(), Style::full(BLACK, 1.2, ""))
        }));
        marks.extend(places(measured));
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

/// The outlines of regions and the lines, with their numbers.
fn places(measured: &Measured) -> Vec<Mark> {
    let regions = measured.diagrams.iter().enumerate();
    let regions = regions.filter_map(|(k, diagram)| {
        let [a, b, c, d] = diagram.region?.corners();
        Some((vec![a, b, c, d, a], [0, 0], format!("region {}", k + 1)))
    });
    let lines = measured.crossings.iter().enumerate();
    let lines = lines.map(|(k, crossings)| {
        let ends = vec![crossings.line.start, crossings.line.end];
        (ends, [-1, 0], format!("line {}", k + 1))
    });
    let marks = regions.chain(lines);
    let marks = marks.flat_map(|(path, side, text): (Vec<Vector>, [i8; 2], String)| {
        let [low, high] = bounds(path.iter().copied()).unwrap_or_default();
        let middle = (low + high) / 2.0;
        let path: Vec<[f64; 2]> = path.iter().map(|p| [p.x, p.y]).collect();
        // Black and white are visible on all colors of a map.
        [
            Mark::Line(path.clone(), Style::full(BLACK, 2.0, "")),
            Mark::Line(path, Style::full([255; 3], 1.0, "")),
            Mark::Label(Label {
                at: middle.into(),
                side,
                text,
                color: BLACK,
            }),
        ]
    });
    marks.collect()
}

/// Speed and flow over each density that is known, side by side: frames as dots, classes with standard deviations.
fn diagrams(diagrams: &[Diagram]) -> Sheet {
    let known = |kind: &Density| diagrams.iter().any(|all| all.classes(*kind).is_some());
    let kinds: Vec<Density> = Density::ALL.into_iter().filter(known).collect();
    let right = values(diagrams, &kinds, |class| class.density.mean);
    let top = |of: OfClass, frame: OfFrame| {
        let top = |class: &Class| of(class).mean + of(class).population_std();
        let frames = diagrams.iter().flat_map(|diagram| &diagram.frames);
        let frames = frames.flat_map(|mean| kinds.iter().filter_map(|&kind| frame(mean, kind)));
        1.1 * values(diagrams, &kinds, top)
            .chain(frames)
            .fold(0.1, f64::max)
    };
    let right = 1.3 * right.fold(0.5, f64::max); // room for the legend
    let panel = |kind: Density, (label, top): (&str, f64), (frame, class): (OfFrame, OfClass)| {
        let mut marks = Vec::new();
        for (k, diagram) in diagrams.iter().enumerate() {
            let pale = LINES[k % LINES.len()].map(|channel| channel / 3 + 170);
            // Thinned: more dots would hide each other.
            let every = diagram.frames.len().div_ceil(MOST_DOTS).max(1);
            let frames = diagram.frames.iter().step_by(every);
            let dots = frames.filter_map(|mean| Some([mean.density(kind)?, frame(mean, kind)?]));
            marks.push(Mark::dots(dots, Style::full(pale, 1.0, "")));
        }
        for (k, diagram) in diagrams.iter().enumerate() {
            let classes = diagram.classes(kind).into_iter();
            let classes = classes.flat_map(|(_, classes)| classes.values());
            let points = classes.map(|of| Point {
                x: of.density.mean,
                y: class(of).mean,
                error: class(of).population_std(),
            });
            let style = Style::full(LINES[k % LINES.len()], 2.6, &name(diagram, k));
            marks.push(Mark::Points(points.collect(), style));
        }
        let x = Axis::linear("density [P/m²]", [0.0, right]);
        let of = diagrams.iter().find_map(|diagram| diagram.classes(kind));
        let title = match of {
            Some(("rows", _)) => format!("{}: people ± deviation", kind.name()),
            _ => format!("{}: frames ± deviation", kind.name()),
        };
        let mut panel = Panel::new(&title, x, Axis::linear(label, [0.0, top]), marks);
        panel.legend = Some(Corner::UpperRight);
        panel
    };
    let speed: (OfFrame, OfClass) = (|mean, kind| mean.speed(kind), |class| class.speed);
    let flow: (OfFrame, OfClass) = (|mean, kind| mean.flow(kind), |class| class.flow);
    let axes = [
        ("speed [m/s]", top(speed.1, speed.0)),
        ("flow [1/(m s)]", top(flow.1, flow.0)),
    ];
    let speeds = kinds.iter().map(|&kind| panel(kind, axes[0], speed));
    let flows = kinds.iter().map(|&kind| panel(kind, axes[1], flow));
    let panels = speeds.chain(flows).collect();
    sheet(kinds.len().max(1), [210.0, 180.0], panels)
}

/// A value of a frame by a density.
type OfFrame = fn(&FrameMean, Density) -> Option<f64>;
/// A value of a class.
type OfClass = fn(&Class) -> MeanStd;

/// A value of all classes of all diagrams.
fn values<'a>(
    diagrams: &'a [Diagram],
    kinds: &'a [Density],
    value: impl Fn(&Class) -> f64 + 'a,
) -> impl Iterator<Item = f64> + 'a {
    let classes = kinds.iter().flat_map(move |&kind| {
        let classes = diagrams.iter().filter_map(move |all| all.classes(kind));
        classes.flat_map(|(_, classes)| classes.values())
    });
    classes.map(value)
}

/// The name of a diagram in a legend.
fn name(diagram: &Diagram, k: usize) -> String {
    match diagram.region {
        None => "everywhere".to_owned(),
        Some(_) => format!("region {}", k + 1),
    }
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

//! Pictures of mean fields, fundamental diagrams, N(t), regions and alarms.

use super::safety_report::is_packed;
use super::{Class, Crossings, Density, Diagram, FrameMean, Mean, Measured, Safety, Sample, Site};
use crate::gallery::thinned;
use analysis::crowd_pressure::BEFORE_ACCIDENT;
use analysis::exposure::DENSITIES;
use analysis::statistics::MeanStd;
use engine::geometry::Walls;
use engine::math::{Vector, bounds};
use output::colors::{ColorMap, DENSITY, SPEED, light};
use output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, GRAY, LINES, Mark, Panel, Point, Sheet, Style, line_color,
};

/// Length of the longer side of a map, points.
const MAP_SIDE: f64 = 330.0;
/// Minimum length of a side of a map, points.
const LEAST_SIDE: f64 = 70.0;
/// Maximum number of dots per diagram; more would hide each other.
const MOST_DOTS: usize = 1500;
/// Maximum number of points of a curve over time.
const MOST_POINTS: usize = 2000;
/// The color of frames, as a part of that of their classes.
const LIGHT: f64 = 1.0 / 3.0;
/// Below this density, P/m², the mean speed is not meaningful and is left blank.
const NOBODY: f64 = 1e-3;

/// The file names of the pictures, without extension.
pub const STEMS: [&str; 5] = ["fields", "fundamental_diagram", "flow", "safety", "regions"];

/// The pictures by their stems; without regions or lines there are fewer.
pub fn sheets(measured: &Measured, site: &Site) -> impl Iterator<Item = (&'static str, Sheet)> {
    let crossings = &measured.crossings;
    let sheets = [
        Some(maps(measured, &site.walls)),
        Some(diagrams(&measured.diagrams)),
        (!crossings.is_empty()).then(|| counts(crossings)),
        Some(safety(&measured.safety)),
        regions(measured),
    ];
    let named = STEMS.into_iter().zip(sheets);
    named.filter_map(|(stem, sheet)| Some((stem, sheet?)))
}

/// Maps of density and speed, with the walls.
fn maps(measured: &Measured, walls: &Walls) -> Sheet {
    let grid = &measured.fields.grid;
    let means: Vec<_> = measured.fields.means(measured.overview.frames).collect();
    let high = grid.center(grid.len() - 1) + Vector::repeat(0.5 * grid.cell);
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
        let nowhere = means.iter().map(|mean| mean.is_none().then_some(0.0));
        let solid = cells(nowhere.collect(), ColorMap::plain(GRAY));
        let field = Mark::Cells(cells(values.collect(), map.clone()));
        let mut marks = vec![Mark::Group(vec![field, Mark::Overlay(solid)])];
        marks.extend(walls.iter().map(|wall| {
            let ends = [wall.start, wall.end].map(|p| [p.x, p.y]);
            Mark::line(ends, Style::full(BLACK, 1.2, ""))
        }));
        marks.extend(places(measured));
        let (x, y) = (Axis::linear("x [m]", x), Axis::linear("y [m]", y));
        Panel::new(title, x, y, marks).with_bar(ColorBar::new(label, map))
    };
    let columns = if width > 1.5 * height { 1 } else { 2 };
    let size = [width, height].map(|side| (side * scale).max(LEAST_SIDE));
    let density = map("mean density", "density [P/m²]", &DENSITY, |mean| {
        Some(mean.density)
    });
    let speed = map("mean speed", "speed [m/s]", &SPEED, |mean| {
        mean.speed.filter(|_| mean.density > NOBODY)
    });
    Sheet::new("", columns, size, vec![density, speed])
}

/// The outlines of regions and the lines, with their numbers.
fn places(measured: &Measured) -> Vec<Mark> {
    let diagrams = measured.diagrams.iter().enumerate();
    let regions = diagrams.filter_map(|(k, diagram)| {
        let [a, b, c, d] = diagram.region?.corners();
        Some((vec![a, b, c, d, a], [0, 0], format!("region {}", k + 1)))
    });
    let lines = measured.crossings.iter().enumerate().map(|(k, crossings)| {
        let ends = vec![crossings.line.start, crossings.line.end];
        (ends, [-1, 0], format!("line {}", k + 1))
    });
    let places = regions.chain(lines);
    let marks = places.flat_map(|(path, side, text): (Vec<Vector>, [i8; 2], String)| {
        let [low, high] = bounds(path.iter().copied()).unwrap_or_default();
        let middle = (low + high) / 2.0;
        let path: Vec<[f64; 2]> = path.iter().map(|p| [p.x, p.y]).collect();
        // Black and white are visible on all colors of a map.
        [
            Mark::Line(path.clone(), Style::full(BLACK, 2.0, "")),
            Mark::Line(path, Style::full([255; 3], 1.0, "")),
            Mark::label(middle.into(), side, text),
        ]
    });
    marks.collect()
}

/// A quantity of diagrams: its axis, and its values of frames and of classes.
struct Quantity {
    label: &'static str,
    frame: fn(&FrameMean, Density) -> Option<f64>,
    class: fn(&Class) -> MeanStd,
}

const QUANTITIES: [Quantity; 2] = [
    Quantity {
        label: "speed [m/s]",
        frame: |mean, kind| mean.speed(kind),
        class: |class| class.speed,
    },
    Quantity {
        label: "flow [1/(m s)]",
        frame: |mean, kind| mean.flow(kind),
        class: |class| class.flow,
    },
];

/// Speed and flow over each density that is known, side by side: frames as dots, classes with standard deviations.
fn diagrams(diagrams: &[Diagram]) -> Sheet {
    let known = |kind: &Density| diagrams.iter().any(|all| all.classes(*kind).is_some());
    let kinds: Vec<Density> = Density::ALL.into_iter().filter(known).collect();
    let classes = || {
        let of = |&kind: &Density| diagrams.iter().filter_map(move |all| all.classes(kind));
        kinds
            .iter()
            .flat_map(of)
            .flat_map(|(_, classes)| classes.values())
    };
    let densities = classes().map(|class| class.density.mean);
    let right = 1.3 * densities.fold(0.5, f64::max); // room for the legend
    let top = |of: &Quantity| {
        let highest = |mean: MeanStd| mean.mean + mean.population_std();
        let means = diagrams.iter().flat_map(|diagram| &diagram.frames);
        let frames = means.flat_map(|mean| kinds.iter().filter_map(|&kind| (of.frame)(mean, kind)));
        let classes = classes().map(|class| highest((of.class)(class)));
        1.1 * classes.chain(frames).fold(0.1, f64::max)
    };
    let panel = |kind: Density, of: &Quantity| {
        let mut marks = Vec::new();
        for (k, diagram) in diagrams.iter().enumerate() {
            let frames = thinned(&diagram.frames, MOST_DOTS);
            let dots =
                frames.filter_map(|mean| Some([mean.density(kind)?, (of.frame)(mean, kind)?]));
            let style = Style::full(light(line_color(k), LIGHT), 1.0, "");
            marks.push(Mark::dots(dots, style));
        }
        for (k, diagram) in diagrams.iter().enumerate() {
            let known = diagram.classes(kind).into_iter();
            let classes = known.flat_map(|(_, classes)| classes.values());
            let points = classes.map(|class| {
                let value = (of.class)(class);
                let (x, y, error) = (class.density.mean, value.mean, value.population_std());
                Point { x, y, error }
            });
            let style = Style::full(line_color(k), 2.6, &name(diagram, k));
            marks.push(Mark::Points(points.collect(), style));
        }
        let x = Axis::linear("density [P/m²]", [0.0, right]);
        let y = Axis::linear(of.label, [0.0, top(of)]);
        let rows = diagrams.iter().find_map(|diagram| diagram.classes(kind));
        let title = match rows {
            Some(("rows", _)) => format!("{}: people ± deviation", kind.name()),
            _ => format!("{}: frames ± deviation", kind.name()),
        };
        Panel::new(&title, x, y, marks).with_legend(Corner::UpperRight)
    };
    let (kinds, panel) = (&kinds, &panel);
    let quantities = QUANTITIES.iter();
    let panels = quantities.flat_map(|of| kinds.iter().map(move |&kind| panel(kind, of)));
    Sheet::new("", kinds.len().max(1), [210.0, 180.0], panels.collect())
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
    let start = all().map(|c| c.time).fold(f64::INFINITY, f64::min);
    let first = if start < last { start } else { last - 1.0 };
    let mut marks = Vec::new();
    let mut most: f64 = 1.0;
    for (k, line) in crossings.iter().enumerate() {
        let color = line_color(k);
        let styles: [(_, _, fn(_, _, &str) -> _); 2] =
            [(1, "forward", Style::full), (-1, "backward", Style::broken)];
        for (direction, name, style) in styles {
            let times = line.passages(direction).enumerate();
            let corners = times.flat_map(|(n, time)| [[time, n as f64], [time, (n + 1) as f64]]);
            let steps: Vec<[f64; 2]> = corners.collect();
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
    let x = Axis::linear("t [s]", [first, last]);
    let y = Axis::linear("N", [0.0, 1.05 * most]);
    let panel = Panel::new("crossings so far", x, y, marks).with_legend(Corner::UpperLeft);
    Sheet::new("", 1, [330.0, 210.0], vec![panel])
}

/// The points of a curve, and its style.
type Curve = (Vec<[f64; 2]>, Style);

/// Curves over time; the vertical axis reaches at least up to `least`.
fn over_time(
    [title, label]: [&str; 2],
    [first, last]: [f64; 2],
    least: f64,
    curves: Vec<Curve>,
) -> Panel {
    let values = curves.iter().flat_map(|(points, _)| points).map(|at| at[1]);
    let top = 1.35 * values.fold(least, f64::max); // room for the legend
    let time = Axis::linear("t [s]", [first, last.max(first + 1.0)]);
    let lines = curves.into_iter();
    let marks = lines.map(|(points, style)| Mark::Line(points, style));
    let value = Axis::linear(label, [0.0, top]);
    Panel::new(title, time, value, marks.collect()).with_legend(Corner::UpperRight)
}

/// The densities and speeds of each region over time, side by side; `None` without regions.
fn regions(measured: &Measured) -> Option<Sheet> {
    type ByDensity = fn(&FrameMean, Density) -> Option<f64>;
    let numbered = measured.diagrams.iter().zip(1..);
    let regions = numbered.filter(|(diagram, _)| diagram.region.is_some());
    let pairs = regions.flat_map(|(diagram, number)| {
        let panel = |[what, label]: [&str; 2], kinds: &[Density], value: ByDensity| {
            let named = kinds.iter().map(|&kind| {
                let frames = thinned(&diagram.frames, MOST_POINTS);
                let points = frames.filter_map(|frame| Some([frame.time, value(frame, kind)?]));
                let name = match (kind, what) {
                    (Density::SphAtPeople, "speed") => "mean of the people",
                    _ => kind.name(),
                };
                let style = Style::full(line_color(kind as usize), 1.0, name);
                (points.collect(), style)
            });
            let title = format!("region {number}: {what}");
            let curves = named.collect();
            over_time([&title, label], measured.overview.times, 0.1, curves)
        };
        let speeds = [Density::SphAtPeople, Density::Voronoi];
        let density = ["density", "density [P/m²]"];
        [
            panel(density, &Density::ALL, FrameMean::density),
            panel(["speed", "speed [m/s]"], &speeds, FrameMean::speed),
        ]
    });
    let panels: Vec<Panel> = pairs.collect();
    (!panels.is_empty()).then(|| Sheet::new("", 2, [260.0, 190.0], panels))
}

/// The area above each density and the highest crowd pressure, over time.
fn safety(safety: &Safety) -> Sheet {
    let samples = &safety.samples;
    let ends = [samples.first(), samples.last()].map(|of| of.map_or(0.0, |sample| sample.time));
    let series = |value: fn(&Sample) -> Option<f64>| -> Vec<[f64; 2]> {
        let point = |sample: &Sample| Some([sample.time, value(sample)?]);
        samples.iter().filter_map(point).collect()
    };
    let above = [
        series(|sample| Some(sample.area_above_4)),
        series(|sample| Some(sample.area_above_5)),
        series(|sample| Some(sample.area_above_6)),
    ];
    let styles = DENSITIES.into_iter().zip(LINES).map(|(density, color)| {
        let label = format!("above {density} P/m²");
        Style::full(color, 1.2, &label)
    });
    let areas = above.into_iter().zip(styles).collect();
    let label = format!("{BEFORE_ACCIDENT}: before the accident at Mina, 2006");
    let mark = ends.map(|time| [time, BEFORE_ACCIDENT]).to_vec();
    let highest = series(|sample| sample.pressure);
    let mut pressures = vec![(highest, Style::full(LINES[0], 1.2, "highest"))];
    if is_packed(safety) {
        pressures.insert(0, (mark, Style::broken(LINES[1], 1.2, &label)));
    }
    let pressure = ["crowd pressure", "ρ Var(v) [1/s²]"];
    let panels = vec![
        over_time(["alarms", "area [m²]"], ends, 1.0, areas),
        over_time(pressure, ends, BEFORE_ACCIDENT, pressures),
    ];
    let title = "thresholds from the literature, not safety limits";
    Sheet::new(title, 2, [240.0, 200.0], panels)
}

//! The routes to one destination: lengths as bands of color, the cells of the path map, and the routes of some agents.

use std::sync::Arc;

use super::{Frame, xy};
use analysis::way_field::{Grid, WayField};
use engine::math::{Vector, direction, perpendicular};
use engine::routes::{Destination, Routes};
use engine::simulation::Simulation;
use figures::colors::{ColorMap, Rgb, WAIT};
use figures::plot::{BLACK, Cells, ColorBar, Mark, Style};

/// The side of a cell of the field, points.
const CELL: f64 = 0.5;
/// The color of the borders of the path map's cells.
pub const BORDER: Rgb = [120, 60, 130];
/// The number of agents whose routes are shown.
const WAYS: usize = 12;
/// The number of agents from which these are chosen.
const CANDIDATES: usize = 2000;
/// The distance between arrows, points.
const ARROWS: f64 = 34.0;
/// Shorter waits before openings are not shown, seconds.
pub const LEAST_WAIT: f64 = 5.0;
/// The color of arrows.
const ARROW: Rgb = [90, 110, 120];

/// Routes to show.
pub struct Paths {
    /// The name of the destination.
    pub name: String,
    /// The routes.
    pub routes: Arc<Routes>,
    /// The destination, to which they have a path map.
    pub to: Destination,
    /// The number of the place in the scene, if it is one.
    pub place: Option<u16>,
    /// Whether the scene has a path map to the destination.
    pub is_known: bool,
}

/// The marks of some routes.
pub struct Drawn {
    pub title: String,
    pub field: Vec<Mark>,
    pub lines: Vec<Mark>,
    pub bar: ColorBar,
}

/// The colors of lengths.
pub fn bar(map: &ColorMap) -> ColorBar {
    ColorBar::new("length of the shortest way [m]", map)
}

impl Paths {
    pub(super) fn draw(&self, simulation: &Simulation, frame: &Frame) -> Drawn {
        let grid = Grid::over([frame.min, frame.max], frame.meters(CELL));
        let field = WayField::new(&self.routes, self.to, grid);
        let bands = field.bands();
        let map = ColorMap::pale([0.0, bands.end() as f32], bands.count);
        let size = Vector::new(grid.columns as f64, grid.rows as f64) * grid.cell;
        let cells = |values, map| {
            Mark::Overlay(Cells {
                extent: [xy(grid.min), xy(grid.min + size)],
                columns: grid.columns,
                values,
                map,
            })
        };
        let values = (0..grid.len()).map(|k| field.is_border(k).then_some(0.0));
        let borders = cells(values.collect(), ColorMap::plain(BORDER));
        let numbers = field.corners();
        let places = numbers
            .iter()
            .map(|&c| self.routes.floor.corners[c as usize].place);
        let corners = Mark::dots(places.map(xy), Style::full(BORDER, 1.7, ""));
        let mut lines = self.arrows(frame);
        let starts = self.starts(simulation);
        let has_rooms = simulation.scene().rooms().is_some() && self.is_known;
        let course = |start: Vector| match has_rooms {
            true => simulation.course(start, self.to),
            false => self.routes.course(start, self.to),
        };
        let drawn = starts.iter();
        lines.extend(drawn.flat_map(|&start| way(start, course(start), frame)));
        lines.push(corners);
        lines.extend(waits(simulation));
        let by = match has_rooms && simulation.scene().by_time() {
            true => " by time",
            false => "",
        };
        Drawn {
            title: format!("Routes{by} to {}", self.name),
            field: vec![cells(field.lengths, map.clone()), borders],
            lines,
            bar: bar(&map),
        }
    }

    /// Some agents far from each other: agents bound for the destination, otherwise any; without agents, the places
    /// where agents enter.
    fn starts(&self, simulation: &Simulation) -> Vec<Vector> {
        let (agents, scene) = (simulation.frame().agents, simulation.scene());
        let wants = |i: &usize| match (self.place, self.to) {
            (Some(place), _) => {
                let trip = agents.trip.get(*i).and_then(Option::as_ref);
                trip.is_some_and(|trip| trip.place == place)
            }
            (None, Destination::Goal(goal)) => agents.goal[*i] == goal,
            (None, Destination::Place(_)) => false,
        };
        let mut order: Vec<usize> = agents.present().collect();
        order.sort_unstable_by_key(|&i| agents.id[i]);
        let bound: Vec<usize> = order.iter().copied().filter(wants).collect();
        let candidates = if bound.is_empty() { order } else { bound };
        let sources = scene.sources.iter();
        let entries = sources.flat_map(|source| source.grid.positions(scene.seed, 0).take(50));
        let every = candidates.len().div_ceil(CANDIDATES).max(1);
        let chosen = candidates.iter().step_by(every);
        let mut from: Vec<Vector> = chosen.map(|&i| agents.position[i]).collect();
        if from.is_empty() {
            from.extend(entries.chain(scene.entrances.iter().flat_map(|entrance| entrance.line)));
        }
        from.retain(|&p| self.routes.is_open(p, self.to));
        far_apart(&from)
    }

    /// Arrows in the direction of the next corner, at the points of a grid.
    fn arrows(&self, frame: &Frame) -> Vec<Mark> {
        let grid = Grid::over([frame.min, frame.max], frame.meters(ARROWS));
        let centers = (0..grid.len()).map(|k| grid.center(k));
        let on_floor = centers.filter(|&p| self.routes.floor.locate(p).is_some());
        let arrow = |p: Vector| {
            let way = self.routes.open_way(p, self.to)?;
            let next = way.next.place(&self.routes.floor);
            let reach = frame.meters(11.0);
            let along = direction(next - p) * reach.min((next - p).norm());
            let ends = [p, p + along];
            let line = Mark::line(ends.map(xy), Style::full(ARROW, 0.6, ""));
            Some([line, head(ends, frame.meters(3.2), ARROW)])
        };
        on_floor.filter_map(arrow).flatten().collect()
    }
}

/// The way of one agent over `course`, with an arrowhead at its end.
fn way(start: Vector, course: Vec<Vector>, frame: &Frame) -> Vec<Mark> {
    let mut points = vec![start];
    points.extend(course);
    let last = points
        .windows(2)
        .rfind(|pair| (pair[1] - pair[0]).norm() > 0.0);
    let head = last.map(|pair| head([pair[0], pair[1]], frame.meters(5.0), BLACK));
    let line = Mark::line(points.into_iter().map(xy), Style::full(BLACK, 0.9, ""));
    let start = Mark::dots([xy(start)], Style::full(BLACK, 1.8, ""));
    [line, start].into_iter().chain(head).collect()
}

/// The line of an opening before which agents wait for so long, seconds.
pub fn waited(secs: f64) -> Style {
    Style::full(WAIT.color(secs as f32), 2.6, "")
}

/// The openings before which agents wait for a while, in the colors of recordings.
fn waits(simulation: &Simulation) -> Vec<Mark> {
    let openings = simulation
        .scene()
        .rooms()
        .map_or(&[][..], |rooms| rooms.openings());
    let waits = openings.iter().zip(simulation.waits());
    let long = waits.filter(|(_, wait)| *wait >= LEAST_WAIT);
    let marks = long.flat_map(|(opening, wait)| {
        let style = waited(wait);
        let pieces = opening.pieces().iter();
        pieces.map(move |ends| Mark::line(ends.map(xy), style.clone()))
    });
    marks.collect()
}

/// The head of an arrow.
fn head([from, to]: [Vector; 2], length: f64, color: Rgb) -> Mark {
    let along = direction(to - from) * length;
    let aside = perpendicular(along) * 0.4;
    let corners = [to, to - along + aside, to - along - aside];
    Mark::Area(corners.map(xy).to_vec(), color)
}

/// Up to [`WAYS`] of some points, each as far from those before as possible.
fn far_apart(points: &[Vector]) -> Vec<Vector> {
    let mut chosen: Vec<Vector> = points.first().copied().into_iter().collect();
    while chosen.len() < WAYS.min(points.len()) {
        let distance = |p: &Vector| {
            let distances = chosen.iter().map(|other| (p - other).norm_squared());
            distances.fold(f64::INFINITY, f64::min)
        };
        let next = points
            .iter()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)));
        chosen.extend(next);
    }
    chosen
}

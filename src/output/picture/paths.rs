//! The routes to one destination: lengths as bands of color, the cells of the path map, and the routes of some agents.

use std::sync::Arc;

use super::{Frame, xy};
use crate::drawing::Drawing;
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
    pub(super) fn draw(
        &self,
        simulation: &Simulation,
        frame: &Frame,
        drawing: Option<&Drawing>,
    ) -> Drawn {
        let grid = Grid::over([frame.min, frame.max], frame.meters(CELL));
        let field = WayField::drawn(&self.routes, self.to, grid, |p| on_floor(p, drawing));
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
        let numbers = field.corners().into_iter();
        let places = numbers.flat_map(|c| self.corner(c as usize, drawing));
        let corners = Mark::dots(places.map(xy), Style::full(BORDER, 1.7, ""));
        let mut lines = self.arrows(frame, drawing);
        let starts = self.starts(simulation, drawing);
        let has_rooms = simulation.scene().rooms().is_some() && self.is_known;
        let course = |start: Vector| match has_rooms {
            true => simulation.course(start, self.to),
            false => self.routes.course(start, self.to),
        };
        let drawn = starts.iter();
        lines.extend(drawn.flat_map(|&start| way(start, course(start), (frame, drawing))));
        lines.push(corners);
        lines.extend(waits(simulation, drawing));
        let by = match has_rooms && simulation.scene().by_time() {
            true => " by time",
            false => "",
        };
        let only = drawing.and_then(Drawing::only_level);
        let on = only.map_or(String::new(), |level| format!(" on {level}"));
        Drawn {
            title: format!("Routes{by} to {}{on}", self.name),
            field: vec![cells(field.lengths, map.clone()), borders],
            lines,
            bar: bar(&map),
        }
    }

    /// Some agents far from each other: agents bound for the destination, otherwise any; without agents, the places
    /// where agents enter. Of a drawing of one level, those on it.
    fn starts(&self, simulation: &Simulation, drawing: Option<&Drawing>) -> Vec<Vector> {
        let (agents, scene) = (simulation.frame().agents, simulation.scene());
        let wants = |i: &usize| match (self.place, self.to) {
            (Some(place), _) => {
                let trip = agents.trip.get(*i).and_then(Option::as_ref);
                trip.is_some_and(|trip| trip.place == place)
            }
            (None, Destination::Goal(goal)) => agents.goal[*i] == goal,
            (None, Destination::Place(_)) => false,
        };
        let is_shown = |p: Vector| drawing.is_none_or(|drawing| drawing.shows(p));
        let shown = agents.present().filter(|&i| is_shown(agents.position[i]));
        let mut order: Vec<usize> = shown.collect();
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
        from.retain(|&p| is_shown(p) && self.routes.is_open(p, self.to));
        far_apart(&from)
    }

    /// Where a corner of the floor is drawn: at a join, on both levels.
    fn corner(&self, number: usize, drawing: Option<&Drawing>) -> Vec<Vector> {
        let floor = &self.routes.floor;
        let corner = &floor.corners[number];
        let Some(drawing) = drawing else {
            return vec![corner.place];
        };
        let on_levels = corner
            .fan
            .iter()
            .map(|&(t, _)| floor.in_plane(t, corner.place));
        let mut places: Vec<Vector> = on_levels
            .filter(|&p| drawing.shows(p))
            .map(|p| drawing.place(p))
            .collect();
        places.dedup();
        places
    }

    /// Arrows in the direction of the next corner, at the points of a grid.
    fn arrows(&self, frame: &Frame, drawing: Option<&Drawing>) -> Vec<Mark> {
        let floor = &self.routes.floor;
        let grid = Grid::over([frame.min, frame.max], frame.meters(ARROWS));
        let centers = (0..grid.len()).map(|k| grid.center(k));
        let arrow = |p: Vector| {
            let here = on_floor(p, drawing).filter(|&here| floor.locate(here).is_some())?;
            let way = self.routes.open_way(here, self.to)?;
            let ahead = way.next.place(floor) - floor.in_building(here);
            let reach = frame.meters(11.0);
            let along = direction(ahead) * reach.min(ahead.norm());
            let ends = [p, p + along];
            let line = Mark::line(ends.map(xy), Style::full(ARROW, 0.6, ""));
            Some([line, head(ends, frame.meters(3.2), ARROW)])
        };
        centers.filter_map(arrow).flatten().collect()
    }
}

/// The place of the engine's plane that is drawn at `p`, if there is one.
fn on_floor(p: Vector, drawing: Option<&Drawing>) -> Option<Vector> {
    drawing.map_or(Some(p), |drawing| drawing.in_plane(p))
}

/// The way of one agent over `course`, with an arrowhead at the end of its last part.
fn way(
    start: Vector,
    course: Vec<Vector>,
    (frame, drawing): (&Frame, Option<&Drawing>),
) -> Vec<Mark> {
    let mut points = vec![start];
    points.extend(course);
    let parts = match drawing {
        Some(drawing) => drawing.parts(&points),
        None => vec![points],
    };
    let mut pairs = parts.iter().flat_map(|part| part.windows(2)).rev();
    let last = pairs.find(|pair| (pair[1] - pair[0]).norm() > 0.0);
    let head = last.map(|pair| head([pair[0], pair[1]], frame.meters(5.0), BLACK));
    let first = parts.first().and_then(|part| part.first()).copied();
    let start = Mark::dots(first.map(xy), Style::full(BLACK, 1.8, ""));
    let line =
        |part: Vec<Vector>| Mark::line(part.into_iter().map(xy), Style::full(BLACK, 0.9, ""));
    let lines: Vec<Mark> = parts.into_iter().map(line).collect();
    lines.into_iter().chain([start]).chain(head).collect()
}

/// The line of an opening before which agents wait for so long, seconds.
pub fn waited(secs: f64) -> Style {
    Style::full(WAIT.color(secs as f32), 2.6, "")
}

/// The openings before which agents wait for a while, in the colors of recordings.
fn waits(simulation: &Simulation, drawing: Option<&Drawing>) -> Vec<Mark> {
    let Some(rooms) = simulation.scene().rooms() else {
        return Vec::new();
    };
    let drawn = |p: Vector| xy(drawing.map_or(p, |drawing| drawing.place(p)));
    let waits = rooms.openings().iter().zip(simulation.waits());
    let long = waits.filter(|(_, wait)| *wait >= LEAST_WAIT);
    let marks = long.flat_map(|(opening, wait)| {
        let style = waited(wait);
        let pieces = rooms.pieces_of(opening);
        pieces.map(move |ends| Mark::line(ends.map(drawn), style.clone()))
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

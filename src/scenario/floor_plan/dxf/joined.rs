//! Lines on one layer that enclose areas together.

use super::faces::{Faces, OUTSIDE};
use super::gaps::{self, Gap, distance};
use super::items::{Form, Item};
use super::map::Point;
use super::network::{Line, Network};
use crate::floor_plan::error::FloorPlanError;
use engine::geometry::Area;

/// How far from a line its two sides are probed, meters.
const BESIDE: f64 = 1e-4;

/// What lines enclose.
pub struct Joined<'a> {
    /// The enclosed areas.
    pub areas: Vec<Area>,
    /// The lines, or parts of them, that bound no area.
    pub rest: Vec<&'a Item>,
    /// The gaps that were closed.
    pub gaps: Vec<Gap>,
}

/// The open lines among items.
fn open_lines<'a>(items: &[&'a Item]) -> Vec<(&'a Item, Line)> {
    let open = items.iter().filter_map(|item| match &item.form {
        Form::Line(points) => Some((
            *item,
            Line {
                points: points.clone(),
                is_open: false,
            },
        )),
        _ => None,
    });
    open.collect()
}

/// The areas that the open lines among items enclose, and the lines that bound none.
pub fn joined<'a>(items: &[&'a Item], gap: f64) -> Result<Joined<'a>, FloorPlanError> {
    let (open, mut lines): (Vec<&Item>, Vec<Line>) = open_lines(items).into_iter().unzip();
    let gaps = gaps::close(&mut lines, gap);
    let faces = Faces::new(&lines);
    let bounds = |line: &Line| {
        line.points
            .windows(2)
            .all(|pair| is_boundary(&faces, pair[0], pair[1], gap))
    };
    let rest = open.iter().zip(&lines).filter(|(_, line)| !bounds(line));
    Ok(Joined {
        areas: faces.union(|face| face != OUTSIDE)?,
        rest: rest.map(|(item, _)| *item).collect(),
        gaps,
    })
}

/// The points on the left and on the right of the middle of a straight line.
pub fn beside(a: Point, b: Point) -> [Point; 2] {
    let length = distance(a, b).max(BESIDE);
    let left = [(a[1] - b[1]) / length, (b[0] - a[0]) / length];
    [1.0, -1.0].map(|side| [0, 1].map(|k| 0.5 * (a[k] + b[k]) + side * BESIDE * left[k]))
}

/// Whether there are different areas on the two sides of the middle of a line. Short lines count as boundaries.
fn is_boundary(faces: &Faces, a: Point, b: Point, gap: f64) -> bool {
    let [left, right] = beside(a, b).map(|p| faces.at(p));
    left != right || distance(a, b) <= gap.max(BESIDE)
}

/// The outline of a floor that does not close.
pub struct Open {
    /// The line with the open end.
    pub place: String,
    /// The open end.
    pub end: Point,
    /// The nearest other open end.
    pub next: Option<Point>,
}

/// An open outline among the open lines of items, if there is one. A single straight line is none, and ends that stick
/// out by at most `gap` do not matter.
pub fn open_outline(items: &[&Item], gap: f64) -> Option<Open> {
    let (open, mut lines): (Vec<&Item>, Vec<Line>) = open_lines(items).into_iter().unzip();
    gaps::close(&mut lines, gap);
    let network = Network::new(&lines);
    let place = |node: usize| network.grid.place(network.nodes[node]);
    let loose = network.loose_ends();
    let ends: Vec<usize> = loose
        .into_iter()
        .filter(|&node| !is_stub(&network, node, gap))
        .collect();
    let &first = ends.first()?;
    let end = place(first);
    let others = ends[1..].iter().map(|&node| place(node));
    let next = others.min_by(|a, b| distance(*a, end).total_cmp(&distance(*b, end)));
    let reach = |line: &Line| {
        let [from, to] = [line.points.first(), line.points.last()]
            .map(|p| p.map_or(f64::MAX, |p| distance(*p, end)));
        from.min(to)
    };
    let nearest = open
        .iter()
        .zip(&lines)
        .min_by(|a, b| reach(a.1).total_cmp(&reach(b.1)))?;
    Some(Open {
        place: nearest.0.place.clone(),
        end,
        next,
    })
}

/// Whether a loose end belongs to a line that sticks out by at most `gap`, or to a single straight line.
fn is_stub(network: &Network, node: usize, gap: f64) -> bool {
    let [half] = network.leaving[node][..] else {
        return false;
    };
    let [from, to] = network
        .ends(half)
        .map(|node| network.grid.place(network.nodes[node]));
    match network.leaving[network.ends(half)[1]].len() {
        1 => true,
        2 => false,
        _ => distance(from, to) <= gap,
    }
}

//! Entities → geometries in meters.

use super::blocks::{Placed, place};
use super::curves::Path;
use super::entities::Content;
use super::gaps::distance;
use super::layers::Sorted;
use super::map::{MOST_POINTS, Point};
use super::syntax;
use super::units::{Extent, Frame};
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::kind::Kind;
use crate::floor_plan::shape::SAME;

/// How far straight lines may deviate from curves, meters.
const DEVIATION: f64 = 0.005;
/// Most points of a plan.
const MOST_POINTS_OF_ALL: usize = 5_000_000;
/// The largest coordinates of a drawing.
const FARTHEST: f64 = 1e12;

/// The form of a geometry.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// An open line.
    Line(Vec<Point>),
    /// A closed line, without its first point at the end.
    Ring(Vec<Point>),
    /// An area: the outline, then the holes.
    Area(Vec<Vec<Point>>),
    /// A point.
    Point(Point),
}

/// A geometry of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// What it is.
    pub kind: Kind,
    /// Its name in messages.
    pub place: String,
    /// The number of its layer.
    pub layer: usize,
    /// Its form.
    pub form: Form,
    /// Its name.
    pub name: Option<String>,
    /// The number of the block that it is part of.
    pub block: Option<usize>,
}

impl Item {
    /// The lines of which it consists: closed ones end at their first point.
    pub fn lines(&self) -> Vec<Vec<Point>> {
        let closed = |ring: &Vec<Point>| ring.iter().chain(ring.first()).copied().collect();
        match &self.form {
            Form::Line(points) => vec![points.clone()],
            Form::Ring(ring) => vec![closed(ring)],
            Form::Area(rings) => rings.iter().map(closed).collect(),
            Form::Point(_) => Vec::new(),
        }
    }

    /// All points.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        let (one, several): (&[Point], &[Vec<Point>]) = match &self.form {
            Form::Line(points) | Form::Ring(points) => (points, &[]),
            Form::Area(rings) => (&[], rings),
            Form::Point(point) => (std::slice::from_ref(point), &[]),
        };
        one.iter().chain(several.iter().flatten())
    }
}

/// The closed and open lines of an entity.
fn paths<'a>(placed: &Placed<'a>) -> &'a [Path] {
    match &placed.entity.content {
        Content::Path(path) => std::slice::from_ref(path),
        Content::Area(paths) => paths,
        _ => &[],
    }
}

/// The extents of the built entities, and of all of them, in the coordinates of the drawing. Curves count roughly.
///
/// # Errors
/// Coordinates that are too large.
pub fn extents(sorted: &Sorted) -> Result<Option<[Extent; 2]>, FloorPlanError> {
    let mut built: Option<Extent> = None;
    let mut all: Option<Extent> = None;
    for (placed, kind) in &sorted.known {
        let mut points: Vec<Point> = Vec::new();
        for path in paths(placed) {
            points.extend(path.points(f64::MAX).into_iter().map(|p| placed.map.at(p)));
        }
        if let Content::Point(at) = placed.entity.content {
            points.push(placed.map.at(at));
        }
        let is_far = |p: &&Point| !p.iter().all(|x| x.abs() < FARTHEST);
        if let Some([x, y]) = points.iter().find(is_far) {
            let place = place(placed.entity, &sorted.layer(placed.layer));
            return Err(syntax(format!(
                "{place} reaches ({x}, {y}), which is out of range; remove or move it"
            )));
        }
        let Some(own) = Extent::of(&points) else {
            continue;
        };
        let joined = |other: Option<Extent>| match other {
            Some(other) => Extent::of(&[other.low, other.high, own.low, own.high]),
            None => Some(own),
        };
        all = joined(all);
        if kind.is_built() {
            built = joined(built);
        }
    }
    Ok(all.map(|all| [built.unwrap_or(all), all]))
}

/// The geometries of the known entities. Lines whose ends are within `gap` are closed; those without length are
/// left out.
///
/// # Errors
/// There are too many points.
pub fn items(sorted: &Sorted, frame: &Frame, gap: f64) -> Result<Vec<Item>, FloorPlanError> {
    let mut items = Vec::new();
    let mut count = 0;
    for (placed, kind) in &sorted.known {
        let place = place(placed.entity, &sorted.layer(placed.layer));
        let tolerance = DEVIATION / (frame.unit * placed.map.growth()).max(1e-12);
        let points = |path: &Path| -> Vec<Point> {
            let points = path.points(tolerance).into_iter();
            points.map(|p| frame.at(placed.map.at(p))).collect()
        };
        let form = match &placed.entity.content {
            Content::Path(path) => line(points(path), path.is_closed, gap),
            Content::Area(paths) => area(paths.iter().map(points).collect()),
            Content::Point(at) => vec![Form::Point(frame.at(placed.map.at(*at)))],
            _ => Vec::new(),
        };
        for form in form {
            let item = Item {
                kind: *kind,
                place: place.clone(),
                layer: placed.layer,
                form,
                name: placed.name.map(str::to_owned),
                block: placed.block,
            };
            let own = item.points().count();
            count += own;
            if own > MOST_POINTS || count > MOST_POINTS_OF_ALL {
                return Err(syntax(format!(
                    "{place}: an entity has more than {MOST_POINTS} points, or all have more than \
                     {MOST_POINTS_OF_ALL}; leave some out"
                )));
            }
            items.push(item);
        }
    }
    Ok(items)
}

/// A line or a ring; none without length.
fn line(mut points: Vec<Point>, is_closed: bool, gap: f64) -> Vec<Form> {
    points.dedup_by(|next, last| distance(*next, *last) < SAME);
    let Some((&first, &last)) = points.first().zip(points.last()) else {
        return Vec::new();
    };
    let apart = distance(first, last);
    let is_ring = is_closed || apart <= gap.max(SAME) && points.len() > 3;
    if is_ring && apart < SAME {
        points.pop();
    }
    match points.len() {
        0 | 1 => Vec::new(),
        2 => vec![Form::Line(points)],
        _ if is_ring => vec![Form::Ring(points)],
        _ => vec![Form::Line(points)],
    }
}

/// The areas between closed lines: a line within an odd number of others is a hole.
fn area(rings: Vec<Vec<Point>>) -> Vec<Form> {
    let rings: Vec<Vec<Point>> = rings.into_iter().filter(|ring| ring.len() > 2).collect();
    // Hatches of thousands of areas have no holes that matter.
    if rings.len() > 2000 {
        return rings.into_iter().map(Form::Ring).collect();
    }
    let around = |k: usize| -> Vec<usize> {
        let others = (0..rings.len()).filter(|&other| other != k);
        others
            .filter(|&other| is_inside(rings[k][0], &rings[other]))
            .collect()
    };
    let all: Vec<Vec<usize>> = (0..rings.len()).map(around).collect();
    let is_hole = |k: usize| all[k].len() % 2 == 1;
    let mut areas: Vec<(usize, Vec<Vec<Point>>)> = Vec::new();
    for k in (0..rings.len()).filter(|&k| !is_hole(k)) {
        areas.push((k, vec![rings[k].clone()]));
    }
    for k in (0..rings.len()).filter(|&k| is_hole(k)) {
        // The innermost one around it is itself inside of all others.
        let innermost = all[k]
            .iter()
            .filter(|&&outer| !is_hole(outer))
            .max_by_key(|&&outer| all[outer].len());
        let area = innermost.and_then(|outer| areas.iter_mut().find(|(number, _)| number == outer));
        if let Some((_, area)) = area {
            area.push(rings[k].clone());
        }
    }
    let form = |(_, mut rings): (usize, Vec<Vec<Point>>)| match rings.len() {
        1 => Form::Ring(rings.remove(0)),
        _ => Form::Area(rings),
    };
    areas.into_iter().map(form).collect()
}

/// Whether a point is inside of a ring.
pub fn is_inside([x, y]: Point, ring: &[Point]) -> bool {
    let next = ring.iter().cycle().skip(1);
    let sides = ring.iter().zip(next);
    let crossed = sides.filter(|(a, b)| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(from: f64, to: f64) -> Vec<Point> {
        vec![[from, from], [to, from], [to, to], [from, to]]
    }

    #[test]
    fn lines_within_lines_are_holes_by_turns() {
        let found = area(vec![square(2.0, 3.0), square(0.0, 9.0), square(1.0, 8.0)]);
        let around = vec![square(0.0, 9.0), square(1.0, 8.0)];
        assert_eq!(found, [Form::Ring(square(2.0, 3.0)), Form::Area(around)]);
    }

    #[test]
    fn lines_whose_ends_meet_are_closed() {
        let mut points = square(0.0, 1.0);
        points.push([0.0, 0.015]);
        assert_eq!(
            line(points.clone(), false, 0.02),
            [Form::Ring(points.clone())]
        );
        assert_eq!(line(points.clone(), false, 0.01), [Form::Line(points)]);
        assert_eq!(line(vec![[1.0, 1.0]; 4], true, 0.02), []);
    }
}

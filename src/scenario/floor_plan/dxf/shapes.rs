//! Geometries → the shapes of a plan.

use std::collections::BTreeMap;

use i_overlay::mesh::outline::offset::OutlineOffset;
use i_overlay::mesh::style::OutlineStyle;

use super::faces;
use super::gaps::{self, Gap, distance};
use super::items::{Form, Item};
use super::joined::{self, Open};
use super::layers::Sorted;
use super::map::Point;
use super::network::Line;
use super::rooms::{rings, shown_point};
use crate::error::quote::{shown, to_centimeters};
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::kind::Kind;
use crate::floor_plan::shape::{self, Shape};

/// Closed walls that are thinner than this are bodies, not rooms, meters.
const THIN: f64 = 1.0;

/// The shapes of a plan.
#[derive(Default)]
pub struct Shapes {
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// How they were read.
    pub notes: Vec<String>,
    /// The places of geometries without effect.
    idle: Vec<String>,
    /// The places of outlines that cross themselves.
    crossing: Vec<String>,
    /// The gaps that were closed.
    pub gaps: Vec<Gap>,
}

/// The shapes of all items.
///
/// # Errors
/// The outline of a floor is open.
pub fn shapes(items: &[Item], gap: f64, sorted: &Sorted) -> Result<Shapes, FloorPlanError> {
    let mut found = Shapes::default();
    let mut open: BTreeMap<(usize, bool), Vec<&Item>> = BTreeMap::new();
    for item in items {
        let is_floor = item.kind == Kind::Floor;
        match (&item.form, item.kind) {
            (Form::Line(_), Kind::Floor | Kind::Obstacle) => {
                open.entry((item.layer, is_floor)).or_default().push(item);
            }
            (Form::Point(_), kind) if kind.is_built() => found.idle.push(item.place.clone()),
            (Form::Line(points), _) => found.add_line(item, points.clone(), item.kind),
            (Form::Point(point), _) => found.add_point(item, *point),
            (Form::Ring(ring), Kind::Wall) => found.add_wall(item, std::slice::from_ref(ring))?,
            (Form::Area(rings), Kind::Wall) => found.add_wall(item, rings)?,
            (Form::Ring(ring), _) => found.add_area(item, vec![ring.clone()], item.kind)?,
            (Form::Area(rings), _) => found.add_area(item, rings.clone(), item.kind)?,
        }
    }
    for ((layer, is_floor), lines) in open {
        found.join(&lines, &sorted.layer(layer), is_floor, gap)?;
    }
    found.note();
    Ok(found)
}

impl Shapes {
    fn push(&mut self, item: &Item, shape: Shape) {
        self.shapes.push(Shape {
            name: item.name.clone(),
            ..shape
        });
    }

    fn add_line(&mut self, item: &Item, points: Vec<Point>, kind: Kind) {
        self.push(item, Shape::line(item.place.clone(), points, kind));
    }

    fn add_point(&mut self, item: &Item, point: Point) {
        let shape = Shape {
            form: shape::Form::Point,
            ..Shape::new(item.place.clone(), vec![vec![point]], item.kind)
        };
        self.push(item, shape);
    }

    /// Adds an area. One that crosses itself is divided.
    fn add_area(
        &mut self,
        item: &Item,
        outlines: Vec<Vec<Point>>,
        kind: Kind,
    ) -> Result<(), FloorPlanError> {
        let shape = Shape::new(item.place.clone(), outlines, kind);
        let is_single = shape.rings.len() == 1;
        if shape.area().is_ok() || !is_single {
            self.push(item, shape);
            return Ok(());
        }
        let areas = faces::enclosed(&shape.rings)?;
        if areas.is_empty() {
            self.idle.push(item.place.clone());
            return Ok(());
        }
        self.crossing.push(item.place.clone());
        for area in &areas {
            self.push(item, Shape::new(item.place.clone(), rings(area), kind));
        }
        Ok(())
    }

    /// Adds a closed wall: a body if it is thin, else lines.
    fn add_wall(&mut self, item: &Item, outlines: &[Vec<Point>]) -> Result<(), FloorPlanError> {
        if is_thin(outlines) {
            return self.add_area(item, outlines.to_vec(), Kind::Obstacle);
        }
        for line in item.lines() {
            self.add_line(item, line, Kind::Wall);
        }
        Ok(())
    }

    /// Adds what the open lines of a layer enclose. Other lines are walls, but a floor must close.
    fn join(
        &mut self,
        lines: &[&Item],
        layer: &str,
        is_floor: bool,
        gap: f64,
    ) -> Result<(), FloorPlanError> {
        let kind = if is_floor {
            Kind::Floor
        } else {
            Kind::Obstacle
        };
        let given = |item: &&Item| Line {
            points: item.points().copied().collect(),
            is_open: false,
        };
        gaps::refuse_crowded(&lines.iter().map(given).collect::<Vec<_>>())?;
        if is_floor {
            joined::open_outline(lines, gap).map_or(Ok(()), |open| Err(unclosed(&open)))?;
        }
        let joined = joined::joined(lines, gap)?;
        let place = format!("lines on layer \"{layer}\"");
        for area in &joined.areas {
            self.shapes
                .push(Shape::new(place.clone(), rings(area), kind));
        }
        for item in joined.rest {
            match &item.form {
                Form::Line(points) if !is_floor => self.add_line(item, points.clone(), Kind::Wall),
                _ => self.idle.push(item.place.clone()),
            }
        }
        self.gaps.extend(joined.gaps);
        Ok(())
    }

    /// Adds the notes.
    fn note(&mut self) {
        let listed = |places: &[String]| match places {
            [] => None,
            [one] => Some(shown(one)),
            [first, rest @ ..] => Some(format!("{} and {} more", shown(first), rest.len())),
        };
        if let Some(first) = listed(&self.crossing) {
            self.notes.push(format!(
                "{first}: outlines that cross themselves; all that they enclose counts"
            ));
        }
        if let Some(first) = listed(&self.idle) {
            self.notes.push(format!(
                "{first}: left out, because nothing is enclosed; remove it"
            ));
        }
    }
}

/// The error of a floor whose outline does not close.
fn unclosed(open: &Open) -> FloorPlanError {
    let end = shown_point(open.end);
    let next = match open.next {
        Some(next) => format!(
            "the nearest other open end is {}, {} m away",
            shown_point(next),
            to_centimeters(distance(open.end, next))
        ),
        None => "there is no other open end".to_owned(),
    };
    FloorPlanError::Geometry {
        place: open.place.clone(),
        reason: format!(
            "the outline of the floor is open at {end}, where no line continues; {next}; close it, give a larger \
             `plan.gap`, or say in `plan.layers` that the layer is `wall` if its lines are walls"
        ),
    }
}

/// Whether no disk of the diameter [`THIN`] fits between these rings.
fn is_thin(outlines: &[Vec<Point>]) -> bool {
    let oriented = |(k, ring): (usize, &Vec<Point>)| {
        let next = ring.iter().cycle().skip(1);
        let twice: f64 = ring
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum();
        let is_right = (twice > 0.0) == (k == 0);
        match is_right {
            true => ring.clone(),
            false => ring.iter().rev().copied().collect::<Vec<Point>>(),
        }
    };
    let shape: Vec<Vec<Point>> = outlines.iter().enumerate().map(oriented).collect();
    shape.outline(&OutlineStyle::new(-0.5 * THIN)).is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(width: f64, height: f64) -> Vec<Point> {
        vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
    }

    #[test]
    fn walls_and_pillars_are_thin_and_rooms_are_not() {
        let corner = vec![
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 0.3],
            [0.3, 0.3],
            [0.3, 9.0],
            [0.0, 9.0],
        ];
        for thin in [rectangle(20.0, 0.24), rectangle(0.9, 0.9), corner] {
            let back = thin.iter().rev().copied().collect();
            assert!(is_thin(&[thin]) && is_thin(&[back]));
        }
        assert!(!is_thin(&[rectangle(1.2, 1.5)]) && !is_thin(&[rectangle(30.0, 20.0)]));
        let hole = vec![[0.3, 0.3], [9.7, 0.3], [9.7, 9.7], [0.3, 9.7]];
        assert!(is_thin(&[rectangle(10.0, 10.0), hole]));
    }
}

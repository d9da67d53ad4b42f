//! What a plan names: areas, lines and points that a scenario refers to.

use std::collections::BTreeMap;

use engine::math::{Vector, bounds, direction, sides};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::shape::{Form, Shape};
use super::thin::{self, Side};
use engine::geometry::Area;

/// Two sides of an area face each other if the sine of the angle between them is less than this,
const SLANTED: f64 = 0.3;
/// and the shorter one is longer than this part of the longer one.
const FACING: f64 = 0.5;

/// A named area, line or point of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Its name in the plan.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Its form.
    pub form: Form,
    /// Of an area, the outline, then the holes; of a line, its points; of a point, that point. Meters.
    pub rings: Vec<Vec<[f64; 2]>>,
}

impl Place {
    /// The length of a line, meters; the area of an area without its holes, m²; 0 for a point.
    pub fn size(&self) -> f64 {
        let mut rings = self.rings.iter();
        let first: Vec<Vector> = rings
            .next()
            .into_iter()
            .flatten()
            .map(|&p| p.into())
            .collect();
        let length = |(a, b): (Vector, Vector)| (b - a).norm();
        let area = |ring: &[Vector]| {
            let twice: f64 = sides(ring)
                .map(|(a, b)| (a - ring[0]).perp(&(b - ring[0])))
                .sum();
            0.5 * twice.abs()
        };
        match self.form {
            Form::Area => {
                let holes = rings.map(|hole| hole.iter().map(|&p| p.into()).collect::<Vec<_>>());
                area(&first) - holes.map(|hole| area(&hole)).sum::<f64>()
            }
            Form::Line => first
                .windows(2)
                .map(|pair| length((pair[0], pair[1])))
                .sum(),
            Form::Point => 0.0,
        }
    }

    /// The lower left and the upper right corner of the rectangle around it, meters.
    pub fn extent(&self) -> [Vector; 2] {
        bounds(self.rings.iter().flatten().map(|&p| p.into())).unwrap_or_default()
    }
}

/// The line at which people who come from the floor are in the area of a place: the longest part of its outline with
/// floor on both sides; halfway between the two longest, if these face each other; if there is none, the longest part
/// along the edge of the floor. `None` if it is away from the floor.
pub fn across(place: &Place, floor: &[Area]) -> Option<[Vector; 2]> {
    let closed = place.rings.iter().map(|ring| {
        let first = ring.first().copied();
        ring.iter().copied().chain(first).collect::<Vec<_>>()
    });
    let lines: Vec<Vec<[f64; 2]>> = closed.collect();
    let longest_first = |side: Side| {
        let mut parts = thin::parts(&lines, floor, side);
        parts.sort_by(|a, b| length(b).total_cmp(&length(a)));
        parts.into_iter()
    };
    let mut within = longest_first(Side::Within);
    match (within.next(), within.next()) {
        (Some(one), Some(other)) => Some(between(one, other).unwrap_or(one)),
        (Some(one), None) => Some(one),
        (None, _) => longest_first(Side::Edge).next(),
    }
}

fn length([a, b]: &[Vector; 2]) -> f64 {
    (b - a).norm()
}

/// The line halfway between two sides that face each other; `None` if they do not.
fn between(one: [Vector; 2], other: [Vector; 2]) -> Option<[Vector; 2]> {
    let [ahead, back] = [one, other].map(|[a, b]| direction(b - a));
    let faces = ahead.perp(&back).abs() < SLANTED && length(&other) > FACING * length(&one);
    let [c, d] = if ahead.dot(&back) < 0.0 {
        [other[1], other[0]]
    } else {
        other
    };
    faces.then(|| [(one[0] + c) * 0.5, (one[1] + d) * 0.5])
}

/// The named shapes. Those that are no part of the floor plan and have no name are numbered: `exit 1`.
///
/// # Errors
/// An area that crosses itself.
pub fn places(shapes: &[Shape]) -> Result<Vec<Place>, FloorPlanError> {
    let mut unnamed: BTreeMap<&str, usize> = BTreeMap::new();
    let mut places = Vec::new();
    for shape in shapes {
        let numbered = || {
            let number = unnamed.entry(shape.kind.word()).or_default();
            *number += 1;
            format!("{} {number}", shape.kind.word())
        };
        let own = shape.name.clone();
        let Some(name) = own.or_else(|| (!shape.kind.is_built()).then(numbered)) else {
            continue;
        };
        let rings = match shape.form {
            Form::Area => {
                let rings = shape.area()?.rings();
                rings
                    .map(|ring| ring.points().iter().map(|&p| p.into()).collect())
                    .collect()
            }
            Form::Line | Form::Point => shape.rings.clone(),
        };
        places.push(Place {
            name,
            kind: shape.kind,
            form: shape.form,
            rings,
        });
    }
    Ok(places)
}

//! A polygon of a file → an area with valid rings.

use std::cell::OnceCell;

use super::error::FloorPlanError;
use super::kind::Kind;
use engine::geometry::{Area, Polygon, PolygonError, Ring};
use engine::math::{Vector, bounds};

/// Largest |x| and |y|, meters. Beyond this, walls and contacts lose precision.
const FARTHEST: f64 = 1e6;
/// Points closer than this are merged, meters: the engine does not resolve shorter lengths.
pub const SAME: f64 = 1e-6;

/// A text at a point in pictures and recordings.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The text, not empty.
    pub text: String,
    /// Its middle, meters.
    pub at: Vector,
    /// The width of its room, meters; a wider text is left out.
    pub width: Option<f64>,
}

/// The form of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// A polygon.
    #[default]
    Area,
    /// A line through several points.
    Line,
    /// A point.
    Point,
}

/// A geometry of a file, with what it is.
#[derive(Debug, Clone, Default)]
pub struct Shape {
    /// Its name in messages.
    pub place: String,
    /// Its own name in the file.
    pub name: Option<String>,
    /// What it is.
    pub kind: Kind,
    /// Its form.
    pub form: Form,
    /// Of an area, the outline, then the holes; of a line, its points; of a point, that point. Meters.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Its [`area`](Self::area), once it has been asked for: the polygon does not change afterwards.
    pub checked: OnceCell<Result<Area, FloorPlanError>>,
}

/// A geometry of a file.
pub enum Geometry {
    /// The outline, then the holes.
    Area(Vec<Vec<[f64; 2]>>),
    /// The points of a line.
    Line(Vec<[f64; 2]>),
    /// A point.
    Point([f64; 2]),
    /// Several geometries, and the word for one of them.
    Several(&'static str, Vec<Self>),
}

impl Geometry {
    /// Adds its parts to `shapes`, each with its place and kind. Parts without points are left out, if there are
    /// others.
    ///
    /// # Errors
    /// No part has points.
    pub fn shapes(
        self,
        place: &str,
        kind: Kind,
        shapes: &mut Vec<Shape>,
    ) -> Result<(), FloorPlanError> {
        let first = shapes.len();
        let empty = self.collect(place, kind, shapes);
        match empty.filter(|_| shapes.len() == first) {
            Some(place) => Err(FloorPlanError::EmptyGeometry(place)),
            None => Ok(()),
        }
    }

    /// Adds the parts with points, and returns the place of the first part without any.
    fn collect(self, place: &str, kind: Kind, shapes: &mut Vec<Shape>) -> Option<String> {
        let place = place.to_owned();
        let shape = match self {
            Self::Several(_, parts) if parts.is_empty() => return Some(place),
            Self::Several(word, parts) => {
                let parts = parts.into_iter().enumerate();
                let mut empty = None;
                for (k, one) in parts {
                    let found = one.collect(&part(&place, word, k), kind, shapes);
                    empty = empty.or(found);
                }
                return empty;
            }
            Self::Area(rings) if rings.iter().all(Vec::is_empty) => return Some(place),
            Self::Line(points) if points.is_empty() => return Some(place),
            Self::Area(rings) => Shape::new(place, rings, kind),
            Self::Line(points) => Shape::line(place, points, kind),
            Self::Point(point) => Shape {
                form: Form::Point,
                ..Shape::new(place, vec![vec![point]], kind)
            },
        };
        shapes.push(shape);
        None
    }
}

/// The name of part `k` in messages, where it counts from 1.
pub fn part(place: &str, kind: &str, k: usize) -> String {
    let comma = if place.is_empty() { "" } else { ", " };
    format!("{place}{comma}{kind} {}", k + 1)
}

impl Shape {
    /// A polygon without a name of its own.
    pub fn new(place: String, rings: Vec<Vec<[f64; 2]>>, kind: Kind) -> Self {
        Self {
            place,
            kind,
            rings,
            ..Self::default()
        }
    }

    /// A line without a name of its own.
    pub fn line(place: String, points: Vec<[f64; 2]>, kind: Kind) -> Self {
        Self {
            form: Form::Line,
            ..Self::new(place, vec![points], kind)
        }
    }

    /// The area between its rings.
    pub fn area(&self) -> Result<&Area, FloorPlanError> {
        let checked = self.checked.get_or_init(|| self.check());
        checked.as_ref().map_err(Clone::clone)
    }

    /// Checks each ring and, for obstacles, that the holes lie inside the outline.
    fn check(&self) -> Result<Area, FloorPlanError> {
        let is_far = |p: &&[f64; 2]| p.iter().any(|x| x.abs() > FARTHEST);
        if let Some(&[x, y]) = self.rings.iter().flatten().find(is_far) {
            return Err(self.wrong(&format!(
                "({x}, {y}) is out of range: x and y must be at least -1e6 and at most 1e6 m; move the plan \
                 closer to the origin: subtract a point near the site from all coordinates"
            )));
        }
        let mut checked = Vec::with_capacity(self.rings.len());
        for (k, points) in self.rings.iter().enumerate() {
            let name = match k {
                0 => "the outline".to_owned(),
                _ => format!("hole {k}"),
            };
            let ring = ring(points).map_err(|reason| self.wrong(&format!("{name} {reason}")))?;
            checked.push(ring);
        }
        let mut rings = checked.into_iter();
        let Some(exterior) = rings.next() else {
            return Err(FloorPlanError::EmptyGeometry(self.place.clone()));
        };
        let area = Area {
            exterior,
            holes: rings.collect(),
        };
        if self.kind == Kind::Obstacle {
            // Holes of walkable areas are subtracted, wherever they are.
            Polygon::filling(area.clone()).map_err(|error| self.wrong(&error.to_string()))?;
        }
        Ok(area)
    }

    /// The middle of the widest part halfway up, and its width, meters.
    pub fn middle(area: &Area) -> (Vector, f64) {
        let [low, high] = bounds(area.exterior.points().iter().copied()).unwrap_or_default();
        let y = 0.5 * (low.y + high.y);
        let edges = area.rings().flat_map(|ring| {
            let points = ring.points();
            points.iter().zip(points.iter().cycle().skip(1))
        });
        let across = edges.filter(|(a, b)| (a.y > y) != (b.y > y));
        let places = across.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        let mut crossings: Vec<f64> = places.collect();
        crossings.sort_by(f64::total_cmp);
        let width = |side: &&[f64]| side[1] - side[0];
        let pairs = crossings.chunks_exact(2);
        let widest = pairs.max_by(|a, b| width(a).total_cmp(&width(b)));
        let [left, right] = widest.map_or([low.x, high.x], |side| [side[0], side[1]]);
        (Vector::new(0.5 * (left + right), y), right - left)
    }

    /// The area of the rectangle around its outline, m².
    pub fn extent(&self) -> f64 {
        let [low, high] = self.bounds();
        (high.x - low.x) * (high.y - low.y)
    }

    /// The corners of the rectangle around its outline, meters.
    pub fn bounds(&self) -> [Vector; 2] {
        let outline = self.rings.iter().take(1).flatten();
        bounds(outline.map(|&p| p.into())).unwrap_or_default()
    }

    /// Its name, with a place inside.
    pub fn label(&self, area: &Area) -> Option<Label> {
        let text = self.name.clone()?;
        let (at, width) = Self::middle(area);
        Some(Label {
            text,
            at,
            width: Some(width),
        })
    }

    fn wrong(&self, reason: &str) -> FloorPlanError {
        FloorPlanError::Geometry {
            place: self.place.clone(),
            reason: reason.to_owned(),
        }
    }
}

/// A ring without repeated points. The error continues a sentence that begins with the ring's name.
fn ring(points: &[[f64; 2]]) -> Result<Ring, String> {
    if let Some([x, y]) = points.iter().find(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(format!("has a point that is not finite: ({x}, {y})"));
    }
    let points = distinct(points.iter().map(|&p| Vector::from(p)));
    Ring::new(points.clone()).map_err(|error| match error {
        PolygonError::TooFewPoints(count) => {
            format!("has {count} different point(s); it needs at least 3")
        }
        PolygonError::SelfIntersection(i, j) => {
            let edge = |k: usize| {
                let [a, b] = [points[k], points[(k + 1) % points.len()]];
                format!("the edge from ({}, {}) to ({}, {})", a.x, a.y, b.x, b.y)
            };
            let (one, other) = (edge(i), edge(j));
            format!(
                "crosses or touches itself: {one} meets {other}; split it into rings that do not"
            )
        }
        PolygonError::NoArea => format!(
            "encloses no area: all points are on a line, from ({}, {})",
            points[0].x, points[0].y
        ),
        other => other.to_string(),
    })
}

/// Removes points that repeat the previous one, and those at the end that repeat the first.
fn distinct(points: impl Iterator<Item = Vector>) -> Vec<Vector> {
    let mut kept: Vec<Vector> = points.collect();
    let same = |a: &Vector, b: &Vector| (a - b).norm() < SAME;
    kept.dedup_by(|next, last| same(last, next));
    while kept.len() > 1 && kept.last().is_some_and(|last| same(last, &kept[0])) {
        kept.pop();
    }
    kept
}

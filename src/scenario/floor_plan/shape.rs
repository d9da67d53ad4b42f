//! A polygon of a file → an area with valid rings.

use std::cell::OnceCell;

use super::error::FloorPlanError;
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

/// A polygon of a file.
#[derive(Debug, Clone, Default)]
pub struct Shape {
    /// Its name in messages.
    pub place: String,
    /// Its own name in the file.
    pub name: Option<String>,
    /// The outline, then the holes, meters.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Whether it is an obstacle, not walkable area.
    pub is_obstacle: bool,
    /// Its [`area`](Self::area), once it has been asked for: the polygon does not change afterwards.
    pub checked: OnceCell<Result<Area, FloorPlanError>>,
}

/// A geometry of a file.
pub enum Geometry<P> {
    /// A polygon, as its format has it.
    Polygon(P),
    /// Several geometries, and the word for one of them.
    Several(&'static str, Vec<Self>),
    /// A geometry without area: the name of its type.
    Other(&'static str),
}

impl<P> Geometry<P> {
    /// Passes each polygon to `take`, with its place.
    pub fn polygons(
        self,
        place: &str,
        take: &mut dyn FnMut(P, String) -> Result<(), FloorPlanError>,
    ) -> Result<(), FloorPlanError> {
        match self {
            Self::Polygon(polygon) => take(polygon, place.to_owned()),
            Self::Several(_, parts) if parts.is_empty() => {
                Err(FloorPlanError::EmptyGeometry(place.to_owned()))
            }
            Self::Several(kind, parts) => {
                let mut parts = parts.into_iter().enumerate();
                parts.try_for_each(|(k, one)| one.polygons(&part(place, kind, k), take))
            }
            Self::Other(found) => Err(FloorPlanError::Geometry {
                place: place.to_owned(),
                reason: format!("a {found} has no area; a floor plan consists of polygons"),
            }),
        }
    }
}

/// The name of part `k` in messages, where it counts from 1.
pub fn part(place: &str, kind: &str, k: usize) -> String {
    let comma = if place.is_empty() { "" } else { ", " };
    format!("{place}{comma}{kind} {}", k + 1)
}

impl Shape {
    /// A polygon without a name of its own.
    pub fn new(place: String, rings: Vec<Vec<[f64; 2]>>, is_obstacle: bool) -> Self {
        Self {
            place,
            rings,
            is_obstacle,
            ..Self::default()
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
        let mut rings = Vec::with_capacity(self.rings.len());
        for (k, points) in self.rings.iter().enumerate() {
            let name = match k {
                0 => "the outline".to_owned(),
                _ => format!("hole {k}"),
            };
            let ring = ring(points).map_err(|reason| self.wrong(&format!("{name} {reason}")))?;
            rings.push(ring);
        }
        let mut rings = rings.into_iter();
        let Some(exterior) = rings.next() else {
            return Err(FloorPlanError::EmptyGeometry(self.place.clone()));
        };
        let area = Area {
            exterior,
            holes: rings.collect(),
        };
        if self.is_obstacle {
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
        let outline = self.rings.iter().take(1).flatten();
        let [low, high] = bounds(outline.map(|&p| p.into())).unwrap_or_default();
        (high.x - low.x) * (high.y - low.y)
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

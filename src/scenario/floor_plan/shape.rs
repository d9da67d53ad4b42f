//! A polygon as a file has it → an area with valid rings.

use super::error::FloorPlanError;
use crate::engine::geometry::{Area, Polygon, PolygonError, Ring};
use crate::engine::math::Vector;

/// x and y are within ± this, metres: walls and contacts keep their digits up to here.
const FARTHEST: f64 = 1e6;
/// Points nearer to each other are one, metres: the engine tells no smaller lengths.
pub const SAME: f64 = 1e-6;

/// A polygon as given.
#[derive(Debug, Clone)]
pub struct Shape {
    /// What messages call it.
    pub place: String,
    /// The outline, then the holes, metres.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Or walkable area?
    pub is_obstacle: bool,
}

impl Shape {
    /// The rings, checked one by one; holes of obstacles also as to where they are.
    pub fn area(&self) -> Result<Area, FloorPlanError> {
        let points = self.rings.iter().flatten();
        if let Some(&[x, y]) = points
            .clone()
            .find(|p| p.iter().any(|x| x.abs() > FARTHEST))
        {
            let place = self.place.clone();
            return Err(FloorPlanError::TooFar { place, x, y });
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
            // Those of walkable areas are cut out of them, wherever they are.
            Polygon::filling(area.clone()).map_err(|error| self.wrong(&error.to_string()))?;
        }
        Ok(area)
    }

    fn wrong(&self, reason: &str) -> FloorPlanError {
        FloorPlanError::Ring {
            place: self.place.clone(),
            reason: reason.to_owned(),
        }
    }
}

/// A ring without repeated points, or what is wrong with it, after its name.
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
            format!("crosses or touches itself: {one} meets {other}; draw it as rings that do not")
        }
        PolygonError::NoArea => format!(
            "encloses no area: all points are on a line, from ({}, {})",
            points[0].x, points[0].y
        ),
        other => other.to_string(),
    })
}

/// The points without those that repeat the one before, and the last if it repeats the first.
fn distinct(points: impl Iterator<Item = Vector>) -> Vec<Vector> {
    let mut kept: Vec<Vector> = Vec::new();
    let same = |a: &Vector, b: &Vector| (a - b).norm() < SAME;
    for p in points {
        if kept.last().is_none_or(|last| !same(last, &p)) {
            kept.push(p);
        }
    }
    while kept.len() > 1 && kept.last().is_some_and(|last| same(last, &kept[0])) {
        kept.pop();
    }
    kept
}

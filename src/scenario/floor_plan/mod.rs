//! Floor plans: where people can walk, or what is in their way, from WKT and GeoJSON files.
//!
//! | | WKT | GeoJSON |
//! |---|---|---|
//! | read | `POLYGON`, `MULTIPOLYGON`, `GEOMETRYCOLLECTION` of them, one or several | `Polygon`, `MultiPolygon`, `GeometryCollection`; `Feature`, `FeatureCollection` |
//! | are obstacles | none | features with `"properties": {"kind": "obstacle"}` |
//!
//! Everything else is walkable area. Coordinates are metres: degrees are refused. What touches or overlaps
//! becomes one area, and obstacles are taken out of it; so a plan is the same however it was cut in pieces.
//! Orientations, third coordinates, a first point that is repeated at the end and points that are repeated
//! on the way do not matter.

mod error;
mod geojson;
mod shape;
mod unite;
mod wkt;

pub use error::FloorPlanError;
pub use unite::{Rings, free};

use std::path::Path;

use crate::engine::geometry::{Area, Polygon, PolygonError, Ring};
use crate::engine::math::Vector;
use crate::scenario::input;
use shape::Shape;

/// What a person needs to stand, m².
const STANDING_ROOM: f64 = 0.18;
/// A plan without standing room that is shorter than this, metres, must be a mistake.
const SHORT: f64 = 1.0;
/// Obstacles that are all within so many metres are a mistake.
const LEAST_EXTENT: f64 = 0.01;

/// Where people can walk, and what is in their way.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FloorPlan {
    /// Where people can walk, without the plan's obstacles; areas that do not touch, but at points. None:
    /// everywhere but in the obstacles.
    pub walkable: Vec<Area>,
    /// Obstacles of a plan that says no more; they may overlap.
    pub obstacles: Vec<Area>,
}

/// Reads a file: GeoJSON if it begins with `{`, else WKT.
///
/// # Errors
/// The file cannot be read, is neither, or makes no floor plan: what and where, after the file's name.
pub fn read(path: &Path) -> Result<FloorPlan, FloorPlanError> {
    in_file(path, parse)
}

/// Reads a file of which everything is an obstacle.
///
/// # Errors
/// As [`read`].
pub fn read_obstacles(path: &Path) -> Result<FloorPlan, FloorPlanError> {
    in_file(path, |text| {
        let mut shapes = shapes(text)?;
        for shape in &mut shapes {
            shape.is_obstacle = true;
        }
        FloorPlan::of(shapes)
    })
}

/// Reads GeoJSON if `text` begins with `{`, else WKT.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &str) -> Result<FloorPlan, FloorPlanError> {
    FloorPlan::of(shapes(text)?)
}

/// Reads well-known text, all of it walkable area: a file's, or what a trajectory's `geometry` table holds.
///
/// # Errors
/// As [`read`].
pub fn parse_wkt(text: &str) -> Result<FloorPlan, FloorPlanError> {
    FloorPlan::of(wkt::shapes(text)?)
}

/// What `parse` makes of a file's text.
fn in_file(
    path: &Path,
    parse: impl Fn(&str) -> Result<FloorPlan, FloorPlanError>,
) -> Result<FloorPlan, FloorPlanError> {
    let within = |error: FloorPlanError| FloorPlanError::File {
        path: path.to_owned(),
        error: Box::new(error),
    };
    let text =
        input::text(path).map_err(|error| within(FloorPlanError::Unreadable(error.to_string())))?;
    parse(text.trim_start_matches('\u{feff}')).map_err(within)
}

/// The polygons of GeoJSON or WKT.
fn shapes(text: &str) -> Result<Vec<Shape>, FloorPlanError> {
    if text.trim_start().starts_with('{') {
        geojson::shapes(text)
    } else {
        wkt::shapes(text)
    }
}

impl FloorPlan {
    /// A walkable area from polygons as GeoJSON's coordinates have them, each a list of rings of points in
    /// metres: the outline, then the holes.
    ///
    /// # Errors
    /// As [`read`]; places count from 0.
    pub fn walkable(polygons: &[Vec<Vec<[f64; 2]>>]) -> Result<Self, FloorPlanError> {
        let numbered = polygons.iter().enumerate();
        let shapes = numbered.map(|(k, rings)| Shape {
            place: format!("[{k}]"),
            rings: rings.clone(),
            is_obstacle: false,
        });
        Self::of(shapes.collect())
    }

    /// An obstacle from a list of rings of points in metres: the outline, then the holes.
    ///
    /// # Errors
    /// As [`Ring::new`](crate::engine::geometry::Ring::new) and [`Polygon::filling`], with coordinates.
    pub fn obstacle(rings: &[Vec<[f64; 2]>]) -> Result<Area, FloorPlanError> {
        let shape = Shape {
            place: String::new(),
            rings: rings.to_vec(),
            is_obstacle: true,
        };
        shape.area()
    }

    /// The bodies that a scene has because of it: what is round the walkable area, then the obstacles.
    ///
    /// # Errors
    /// Areas or holes that overlap: never of a plan that was read.
    pub fn solids(self) -> Result<Vec<Polygon>, PolygonError> {
        let mut solids = Vec::new();
        if !self.walkable.is_empty() {
            solids.push(Polygon::enclosing(self.walkable)?);
        }
        for obstacle in self.obstacles {
            solids.push(Polygon::filling(obstacle)?);
        }
        Ok(solids)
    }

    fn of(shapes: Vec<Shape>) -> Result<Self, FloorPlanError> {
        if shapes.is_empty() {
            return Err(FloorPlanError::Empty);
        }
        let (mut walkable, mut obstacles) = (Vec::new(), Vec::new());
        for shape in shapes {
            let area = shape.area()?;
            if shape.is_obstacle {
                obstacles.push(area);
            } else {
                walkable.push(area);
            }
        }
        let [width, height] = extent(walkable.iter().chain(&obstacles));
        if walkable.is_empty() {
            if width.max(height) < LEAST_EXTENT {
                return Err(FloorPlanError::TooSmall { width, height });
            }
            return Ok(Self {
                walkable,
                obstacles,
            });
        }
        let largest = |areas: &[Area]| areas.iter().map(Area::area).fold(0.0, f64::max);
        let whole = largest(&walkable);
        let mut walkable = unite::without(&walkable, &obstacles)?;
        // Where less is left, corners are computed on a finer grid.
        let mut before = width.max(height);
        loop {
            let [along, across] = extent(walkable.iter());
            if walkable.is_empty() || 2.0 * along.max(across) > before {
                break;
            }
            before = along.max(across);
            walkable = unite::without(&walkable, &[])?;
        }
        let room = largest(&walkable);
        let [along, across] = extent(walkable.iter());
        let is_short = along.max(across) < SHORT;
        if room < STANDING_ROOM && (is_short || !obstacles.is_empty()) {
            return Err(match whole < STANDING_ROOM {
                true => FloorPlanError::TooSmall { width, height },
                false => FloorPlanError::NoRoom,
            });
        }
        Ok(Self {
            walkable,
            obstacles: Vec::new(),
        })
    }
}

/// Along x and along y, metres; negative without areas.
fn extent<'a>(areas: impl Iterator<Item = &'a Area>) -> [f64; 2] {
    let points = areas.flat_map(Area::rings).flat_map(Ring::points);
    let none = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::repeat);
    let [low, high] = points.fold(none, |[low, high], p| [low.inf(p), high.sup(p)]);
    [high.x - low.x, high.y - low.y]
}

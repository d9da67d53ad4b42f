//! Floor plans: walkable areas, obstacles, walls and named places from WKT, GeoJSON, DXF and JuPedSim's XML files.
//!
//! | | WKT | GeoJSON |
//! |---|---|---|
//! | geometries | one or more of `POLYGON`, `MULTIPOLYGON`, `GEOMETRYCOLLECTION` of these | `Polygon`, `MultiPolygon`, `GeometryCollection`; `Feature`, `FeatureCollection` |
//! | obstacles | none | features with `"properties": {"kind": "obstacle"}` |
//!
//! All other polygons are walkable area: features of the kind `floor`, or without a kind. The property `name` of a
//! feature is its name in pictures. Coordinates are in
//! meters; degrees are rejected. Areas that touch or overlap are united, and obstacles are subtracted, so the result
//! does not depend on how a plan is cut into pieces.
//! Orientation, third coordinates, a closing point and repeated points do not matter.
//!
//! In a DXF, layers say what shapes are, as [`Reading::layers`] or their own names have it. Curves are divided into
//! straight lines that deviate by at most 5 mm. Without layers of the kind `floor`, the walkable area is what walls,
//! exits and entrances enclose: the part around [`Reading::inside`], or the largest. The notes of the plan say which
//! unit was taken, what was left out, and by how much the plan was moved.

use crate::input;
use crate::kinds;
mod boundary;
mod drawn_levels;
mod dxf;
mod error;
mod geojson;
mod idle;
mod imdf;
mod kind;
mod levels;
mod on_floor;
mod places;
mod reading;
mod shape;
mod thin;
mod unite;
mod units;
mod wkt;
mod xml;

pub use error::FloorPlanError;
pub(crate) use idle::notes as without_effect;
pub use kind::Kind;
pub use levels::{LevelForm, PlanJoin, PlanLevel, PlanLevels, read_levels};
pub use on_floor::{is_line_on_floor, is_on_floor, parts_on_floor};
pub use places::{Place, across};
pub use reading::Reading;
pub use shape::Form;
pub use shape::Label;
pub(crate) use shape::Shape;
pub use unite::{Rings, free, outlines, rings};
pub use wkt::to_wkt;

use std::path::Path;

use engine::geometry::{Area, Polygon, PolygonError, Ring};
use engine::math::bounds;
use places::places;
use reading::Drawn;
pub use thin::{THICKNESS, encloses_nothing};

/// The area that a person needs to stand, m².
const STANDING_ROOM: f64 = 0.18;
/// A plan without standing room that is smaller than this is a mistake, meters.
const SHORT: f64 = 1.0;
/// Obstacles that all lie within this extent are a mistake, meters.
const LEAST_EXTENT: f64 = 0.01;

/// A walkable area, or obstacles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FloorPlan {
    /// The walkable area without the plan's obstacles, as areas that touch at points at most. If empty, agents can
    /// walk everywhere except in the obstacles.
    pub walkable: Vec<Area>,
    /// The obstacles of a plan without walkable area; they may overlap.
    pub obstacles: Vec<Area>,
    /// The names of rooms and obstacles.
    pub names: Vec<Label>,
    /// The areas, lines and points that a scenario can refer to by their names.
    pub places: Vec<Place>,
    /// What readers of the results should know: polygons without effect, walls that are lines.
    pub notes: Vec<String>,
}

/// Reads a file: DXF if its content says so, GeoJSON if it begins with `{`, JuPedSim's XML if it begins with `<`, else
/// WKT.
///
/// # Errors
/// The file cannot be read, is in no known format, or is not a valid floor plan. The message has the file and the
/// place.
pub fn read(path: &Path) -> Result<FloorPlan, FloorPlanError> {
    read_as(path, &Reading::default())
}

/// As [`read`]; `reading` has what the file does not say itself.
///
/// # Errors
/// Those of [`read`].
pub fn read_as(path: &Path, reading: &Reading) -> Result<FloorPlan, FloorPlanError> {
    in_file(path, |bytes| {
        FloorPlan::noted(drawn(bytes, Some(path), false, reading)?)
    })
}

/// Whether the name of a file is that of a floor plan.
pub fn is_plan(path: &Path) -> bool {
    let mut plans = ["wkt", "geojson", "xml", "dxf"].into_iter();
    plans.any(|plan| has_ending(path, plan))
}

/// Whether the name of a file ends in `.` and `ending`, in any case.
fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Reads a file in which every polygon is an obstacle.
///
/// # Errors
/// Those of [`read`].
pub fn read_obstacles(path: &Path) -> Result<FloorPlan, FloorPlanError> {
    read_obstacles_as(path, &Reading::default())
}

/// As [`read_obstacles`]; `reading` has what the file does not say itself.
///
/// # Errors
/// Those of [`read`].
pub fn read_obstacles_as(path: &Path, reading: &Reading) -> Result<FloorPlan, FloorPlanError> {
    in_file(path, |bytes| {
        let Drawn {
            mut shapes, notes, ..
        } = drawn(bytes, Some(path), true, reading)?;
        let areas = shapes.iter_mut().filter(|shape| shape.form == Form::Area);
        for shape in areas {
            shape.kind = Kind::Obstacle;
        }
        let mut plan = FloorPlan::of(&shapes)?;
        plan.notes.extend(notes);
        Ok(plan)
    })
}

/// Reads GeoJSON if `text` begins with `{`, JuPedSim's XML if it begins with `<`, else WKT.
///
/// # Errors
/// Those of [`read`].
pub fn parse(text: &str) -> Result<FloorPlan, FloorPlanError> {
    parse_bytes(text.as_bytes(), &Reading::default())
}

/// Reads the content of a file, as [`read_as`] does.
///
/// # Errors
/// Those of [`read`].
pub fn parse_bytes(bytes: &[u8], reading: &Reading) -> Result<FloorPlan, FloorPlanError> {
    FloorPlan::noted(drawn(bytes, None, false, reading)?)
}

/// Reads well-known text, such as that in the `geometry` table of a trajectory file. All of it is walkable area.
///
/// # Errors
/// Those of [`read`].
pub fn parse_wkt(text: &str) -> Result<FloorPlan, FloorPlanError> {
    FloorPlan::noted(wkt::drawn(text)?)
}

/// Applies `parse` to a file's content; errors name the file.
fn in_file<T>(
    path: &Path,
    parse: impl Fn(&[u8]) -> Result<T, FloorPlanError>,
) -> Result<T, FloorPlanError> {
    let within = |error: FloorPlanError| FloorPlanError::File {
        path: path.to_owned(),
        error: Box::new(error),
    };
    // What a name promises explains a failure; a plan may have any name.
    let promised = kinds::of_name(path).filter(|_| path.is_file());
    let explained = |error: FloorPlanError| {
        let what = promised.map(|what| FloorPlanError::Unreadable(what.to_owned()));
        within(what.unwrap_or(error))
    };
    let unreadable = |error: std::io::Error| FloorPlanError::Unreadable(error.to_string());
    let bytes =
        input::bytes(path, input::LONGEST_TEXT).map_err(|error| explained(unreadable(error)))?;
    parse(&bytes).map_err(explained)
}

/// What a file has. If `all_obstacles`, the kinds of features do not matter.
fn drawn(
    bytes: &[u8],
    path: Option<&Path>,
    all_obstacles: bool,
    reading: &Reading,
) -> Result<Drawn, FloorPlanError> {
    if is_drawing(bytes, path) {
        return dxf::drawn(bytes, reading);
    }
    let text = input::text_of(bytes.to_vec())
        .map_err(|error| FloorPlanError::Unreadable(error.to_string()))?;
    if imdf::is_imdf(&text) {
        return imdf::storey(&text, reading);
    }
    let mut drawn = match text.trim_start().bytes().next() {
        Some(b'{') => geojson::drawn(&text, all_obstacles)?,
        Some(b'<') => xml::drawn(text.trim_start(), reading)?,
        _ => wkt::drawn(&text)?,
    };
    drawn.place(reading)?;
    Ok(drawn)
}

/// Whether a file is a drawing: its content says so, or only its name, and it is in no other known format.
fn is_drawing(bytes: &[u8], path: Option<&Path>) -> bool {
    let is_named = path.is_some_and(|path| has_ending(path, "dxf"));
    let first = bytes.trim_ascii_start().first();
    let may_be_other =
        first.is_some_and(|first| first.is_ascii_alphabetic() || b"{<".contains(first));
    dxf::is_dxf(bytes) || dxf::is_dwg(bytes) || is_named && !may_be_other
}

impl FloorPlan {
    /// A walkable area from polygons in the form of GeoJSON's coordinates: each is a list of rings (the outline, then
    /// the holes) of points in meters.
    ///
    /// # Errors
    /// Those of [`read`]; places count from 0.
    pub fn walkable(polygons: &[Vec<Vec<[f64; 2]>>]) -> Result<Self, FloorPlanError> {
        let numbered = polygons.iter().enumerate();
        let shapes =
            numbered.map(|(k, rings)| Shape::new(format!("[{k}]"), rings.clone(), Kind::Floor));
        Self::of(&shapes.collect::<Vec<_>>())
    }

    /// An obstacle from a list of rings (the outline, then the holes) of points in meters.
    ///
    /// # Errors
    /// Those of [`Ring::new`](engine::geometry::Ring::new) and [`Polygon::filling`], with coordinates.
    pub fn obstacle(rings: &[Vec<[f64; 2]>]) -> Result<Area, FloorPlanError> {
        let shape = Shape::new(String::new(), rings.to_vec(), Kind::Obstacle);
        shape.area().cloned()
    }

    /// The bodies of a wall along a line; `None` if `points` enclose an area.
    ///
    /// # Errors
    /// Those of [`free`].
    pub fn wall(points: &[[f64; 2]]) -> Result<Option<Vec<Area>>, FloorPlanError> {
        let line = Shape::line(String::new(), points.to_vec(), Kind::Wall);
        let bodies = thin::encloses_nothing(points).then(|| thin::bodies(&[line], &[]));
        bodies.transpose()
    }

    /// The solid bodies of the plan: the surroundings of the walkable area, then the obstacles.
    ///
    /// # Errors
    /// Overlapping areas or holes, which a plan that was read never has.
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

    /// The plan of these polygons, with notes on those without effect.
    fn noted(Drawn { shapes, notes, .. }: Drawn) -> Result<Self, FloorPlanError> {
        let plan = Self::of(&shapes)?;
        let notes = [notes, plan.notes, idle::notes(&shapes)?].concat();
        Ok(Self { notes, ..plan })
    }

    fn of(shapes: &[Shape]) -> Result<Self, FloorPlanError> {
        if !shapes.iter().any(|shape| shape.kind.is_built()) {
            return Err(FloorPlanError::Empty);
        }
        let areas = |kind: Kind| -> Result<Vec<Area>, FloorPlanError> {
            let shapes = shapes.iter().filter(|shape| shape.form == Form::Area);
            let areas = shapes.filter(|shape| shape.kind == kind).map(Shape::area);
            areas.map(|area| area.cloned()).collect()
        };
        let (given, obstacles) = (areas(Kind::Floor)?, areas(Kind::Obstacle)?);
        let [width, height] = extent(given.iter().chain(&obstacles));
        let plan = Self {
            names: names(shapes)?,
            places: places(shapes)?,
            ..Self::default()
        };
        if given.is_empty() {
            let walls = thin::bodies(shapes, &[])?;
            if walls.is_empty() && width.max(height) < LEAST_EXTENT {
                return Err(FloorPlanError::TooSmall { width, height });
            }
            return Ok(Self {
                obstacles: [obstacles, walls].concat(),
                ..plan
            });
        }
        let mut walkable = unite::without(&given, &obstacles)?;
        let walls = thin::bodies(shapes, &walkable)?;
        let mut notes = Vec::new();
        if !walls.is_empty() {
            let whole: f64 = walkable.iter().map(Area::area).sum();
            walkable = unite::without(&walkable, &walls)?;
            let left: f64 = walkable.iter().map(Area::area).sum();
            notes.push(format!(
                "walls that are lines, {:.1} m in all, stand on the floor {THICKNESS} m thick",
                (whole - left) / THICKNESS
            ));
        }
        // A smaller extent means a finer grid: compute the corners again.
        let mut before = width.max(height);
        loop {
            let [along, across] = extent(walkable.iter());
            if walkable.is_empty() || 2.0 * along.max(across) > before {
                break;
            }
            before = along.max(across);
            walkable = unite::without(&walkable, &[])?;
        }
        let outlines = given.iter().map(|area| area.exterior.area());
        let whole = outlines.fold(0.0, f64::max);
        let room = walkable.iter().map(Area::area).fold(0.0, f64::max);
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
            notes,
            ..plan
        })
    }
}

/// The names of rooms and obstacles.
fn names(shapes: &[Shape]) -> Result<Vec<Label>, FloorPlanError> {
    let areas = shapes.iter().filter(|shape| {
        shape.form == Form::Area && (shape.kind.is_built() || shape.kind == Kind::Place)
    });
    let mut names = Vec::new();
    for shape in areas {
        names.extend(shape.label(shape.area()?));
    }
    Ok(names)
}

/// The extent along x and along y, meters; 0 without areas.
fn extent<'a>(areas: impl Iterator<Item = &'a Area>) -> [f64; 2] {
    let points = areas.flat_map(Area::rings).flat_map(Ring::points);
    let [low, high] = bounds(points.copied()).unwrap_or_default();
    [high.x - low.x, high.y - low.y]
}

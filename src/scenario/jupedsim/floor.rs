//! The walkable area, and the parts of polygons that lie in it.

use serde_json::{Value, json};

use super::fields::Object;
use crate::error::Problem;
use crate::floor_plan::{self, FloorPlan, parts_on_floor};
use crate::keys::shapes::Ring as Corners;
use engine::geometry::{Area, Polygon, Ring, Walls};
use engine::math::{Vector, direction, sides};

/// The distance between the points at which a line is tested, meters.
const STEP: f64 = 0.02;

/// The walkable area.
pub struct Floor {
    areas: Vec<Area>,
    walls: Walls,
}

impl Floor {
    /// The floor of well-known text without the obstacles that have coordinates.
    pub fn new(geometry: &str, obstacles: &[Ring]) -> Result<Self, Problem> {
        let drawn = floor_plan::parse_wkt(geometry)?;
        let solid = |ring: &Ring| ring.points().to_vec();
        let areas = match obstacles.is_empty() {
            true => drawn.walkable,
            false => {
                let solids = obstacles.iter().map(solid).collect();
                floor_plan::free(&[floor_plan::rings(&drawn.walkable)], &solids)?
            }
        };
        let plan = FloorPlan {
            walkable: areas.clone(),
            ..FloorPlan::default()
        };
        let solids: Vec<Polygon> = plan.solids()?;
        let walls = Walls::new(solids);
        Ok(Self { areas, walls })
    }

    /// The rings of its areas, as in a scenario.
    pub fn to_value(&self) -> Value {
        let rings = |area: &Area| area.rings().map(Corners::from).collect::<Vec<_>>();
        json!(self.areas.iter().map(rings).collect::<Vec<_>>())
    }

    /// The outline and holes of its largest area.
    pub fn largest(&self) -> Option<&Area> {
        let areas = self.areas.iter();
        areas.max_by(|a, b| a.area().total_cmp(&b.area()))
    }

    /// Whether a point is on the floor.
    pub fn is_free(&self, p: Vector) -> bool {
        self.walls.obstacle_at(p).is_none()
    }

    /// The part of the polygon of an element that is on the floor; `None` if all of it is off the floor.
    pub fn part(&self, element: &Object) -> Result<Option<Part>, Problem> {
        let ring = element.polygon()?;
        let parts = parts_on_floor(&ring, &self.walls, &Vec::new())
            .map_err(|error| element.problem("coordinates", error.to_string()))?;
        let square_meters = parts.iter().map(Area::area).sum();
        let largest = parts
            .into_iter()
            .max_by(|a, b| a.area().total_cmp(&b.area()));
        Ok(largest.map(|area| Part {
            area,
            square_meters,
            ring,
        }))
    }
}

/// The part of a polygon that is on the floor.
pub struct Part {
    /// Its largest connected area.
    pub area: Area,
    /// The size of all its areas, m².
    pub square_meters: f64,
    /// The whole polygon.
    pub ring: Ring,
}

impl Part {
    /// The corners of the whole polygon, as in a scenario.
    pub fn corners(&self) -> Value {
        json!(Corners::from(&self.ring))
    }

    /// A point inside: the centroid, or else the middle halfway up.
    pub fn center(&self) -> Vector {
        let points = self.area.exterior.points();
        let origin = points[0];
        let parts = sides(points).map(|(a, b)| {
            let twice = (a - origin).perp(&(b - origin));
            (twice, (a + b - 2.0 * origin) * (twice / 3.0))
        });
        let (twice, moment) = parts.fold((0.0, Vector::zeros()), |sum, part| {
            (sum.0 + part.0, sum.1 + part.1)
        });
        let centroid = origin + moment / twice;
        match self.area.contains(centroid) {
            true => centroid,
            false => floor_plan::Shape::middle(&self.area).0,
        }
    }

    /// The distance from its center to its boundary, meters.
    pub fn inner_radius(&self) -> f64 {
        let center = self.center();
        let edges = self.area.rings().flat_map(|ring| sides(ring.points()));
        let distances = edges.map(|(a, b)| {
            let along = ((center - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (center - a - (b - a) * along).norm()
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The length and width of the smallest rectangle around it, meters, and the direction of its length.
    pub fn extent(&self) -> (f64, f64, Vector) {
        let points = self.area.exterior.points();
        let along = |way: Vector| {
            let places = points.iter().map(|p| p.dot(&way));
            let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            high - low
        };
        let rectangles = sides(points).map(|(a, b)| {
            let way = direction(b - a);
            let across = Vector::new(-way.y, way.x);
            let [length, width] = [along(way), along(across)];
            match length >= width {
                true => (length, width, way),
                false => (width, length, across),
            }
        });
        let size = |(length, width, _): &(f64, f64, Vector)| length * width;
        let smallest = rectangles.min_by(|a, b| size(a).total_cmp(&size(b)));
        smallest.unwrap_or((0.0, 0.0, Vector::new(1.0, 0.0)))
    }

    /// The line through its center along its length, up to its boundary.
    pub fn middle_line(&self) -> [Vector; 2] {
        let (length, _, way) = self.extent();
        let center = self.center();
        let end = |way: Vector| {
            let steps = (1..=(length / STEP) as u32).map(|k| center + way * (f64::from(k) * STEP));
            let inside = steps.take_while(|&p| self.area.contains(p));
            inside.last().unwrap_or(center)
        };
        [end(-way), end(way)]
    }
}

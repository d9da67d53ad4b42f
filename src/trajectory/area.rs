//! Where people can walk: a rectangle without the obstacles, or the scenario's own walkable area, as WKT.
//!
//! The rectangle holds the view, everything in the scene and some free space round it, and grows with the
//! crowd. Of what obstacles cut off, only those parts count where somebody enters: nobody gets through a
//! wall. PedPy takes one part only; where people walk in several the text is a `MULTIPOLYGON`, of which
//! its user must choose.

use geo::bool_ops::FillRule;
use geo::{BooleanOps, BoundingRect, Contains, Coord, CoordsIter, LineString};
use geo::{MultiPolygon, Point, Polygon, Rect};

use super::Row;
use crate::floor_plan::restore_corners;
use crate::math::Vector;
use crate::scene::{Goal, Region};
use crate::simulation::Simulation;

/// Free space round everything, metres.
const MARGIN: f64 = 5.0;

/// What the walkable area is cut out of, and by what.
pub struct WalkableArea {
    bounds: Rect,
    /// The rings of what is solid outside.
    floors: Vec<MultiPolygon>,
    /// The rings of what is solid inside.
    obstacles: MultiPolygon,
    entries: Vec<Point>,
}

impl WalkableArea {
    /// Of the scene as it is now.
    pub fn new(simulation: &Simulation, view: Region) -> Self {
        let scene = simulation.scene();
        let agents = simulation.frame().agents;
        let mut entries = agents.position.clone();
        let mut goals = agents.goal.clone();
        for source in &scene.sources {
            let entry = |p| free(simulation, p);
            let positions: Vec<Vector> = source.grid.positions(scene.seed, 0).collect();
            goals.extend(positions.iter().map(|&p| match source.goal {
                Goal::Point(goal) => goal,
                Goal::Offset(offset) => p + offset,
            }));
            entries.extend(positions.into_iter().map(entry));
        }
        let obstacles = scene.walls.obstacles();
        let corners = obstacles.iter().flat_map(|obstacle| obstacle.points());
        let everything = entries.iter().chain(&goals).chain(corners);
        let [min, max] = everything.fold([view.min, view.max], |[low, high], p| {
            [low.inf(p), high.sup(p)]
        });
        let margin = Vector::new(MARGIN, MARGIN);
        let ring = |points: &[Vector]| LineString::from_iter(points.iter().map(|&p| coord(p)));
        let rings = |obstacle: &crate::geometry::Polygon| -> MultiPolygon {
            let rings = obstacle.rings();
            rings.map(|r| Polygon::new(ring(r), Vec::new())).collect()
        };
        let (unbounded, bodies): (Vec<_>, Vec<_>) = obstacles
            .iter()
            .partition(|obstacle| obstacle.is_unbounded());
        Self {
            bounds: Rect::new(coord(min - margin), coord(max + margin)),
            floors: unbounded.into_iter().map(rings).collect(),
            obstacles: bodies.into_iter().flat_map(rings).collect(),
            entries: entries.into_iter().map(|p| coord(p).into()).collect(),
        }
    }

    /// Makes room for everybody; was there none?
    pub fn reach(&mut self, rows: &[Row<'_>]) -> bool {
        let places = rows.iter().map(|row| Coord {
            x: row.pos_x,
            y: row.pos_y,
        });
        let mut grown = false;
        for place in places {
            if !self.bounds.contains(&place) {
                let (low, high) = (self.bounds.min(), self.bounds.max());
                self.bounds = Rect::new(
                    (low.x.min(place.x - MARGIN), low.y.min(place.y - MARGIN)),
                    (high.x.max(place.x + MARGIN), high.y.max(place.y + MARGIN)),
                );
                grown = true;
            }
        }
        grown
    }

    /// The area as WKT, and its lowest and highest x and y.
    pub fn cut_out(&self) -> (String, [f64; 4]) {
        let mut free = MultiPolygon::from(self.bounds.to_polygon());
        for floor in &self.floors {
            free = free.intersection_with_fill_rule(floor, FillRule::EvenOdd);
        }
        // Nonzero: where two obstacles overlap, nobody walks either; the holes of one turn the other way.
        free = free.difference_with_fill_rule(&self.obstacles, FillRule::NonZero);
        self.restore_corners(&mut free);
        let holds_somebody = |part: &Polygon| self.entries.iter().any(|p| part.contains(p));
        let walked: Vec<Polygon> = free
            .iter()
            .filter(|part| holds_somebody(part))
            .cloned()
            .collect();
        if !walked.is_empty() {
            free = MultiPolygon(walked);
        }
        let around = free.bounding_rect().unwrap_or(self.bounds);
        let (min, max) = (around.min(), around.max());
        (wkt(&free), [min.x, min.y, max.x, max.y])
    }

    /// Corners as they were given, to the last bit.
    fn restore_corners(&self, area: &mut MultiPolygon) {
        let extent = self.bounds.width().max(self.bounds.height());
        let floors = self.floors.iter().flat_map(|floor| floor.coords_iter());
        let mut given: Vec<Coord> = self.obstacles.coords_iter().chain(floors).collect();
        given.extend(self.bounds.coords_iter());
        restore_corners(area, given, extent);
    }
}

/// Where somebody who enters at `p` is put.
fn free(simulation: &Simulation, p: Vector) -> Vector {
    let walls = &simulation.scene().walls;
    let inside = walls.obstacle_at(p).is_some();
    let exit = inside.then(|| walls.free_point_near(p)).flatten();
    exit.unwrap_or(p)
}

fn coord(p: Vector) -> Coord {
    Coord { x: p.x, y: p.y }
}

/// Well-known text: one polygon as such, several as a multipolygon.
fn wkt(area: &MultiPolygon) -> String {
    let ring = |ring: &LineString| {
        let points: Vec<String> = ring.coords().map(|c| format!("{} {}", c.x, c.y)).collect();
        format!("({})", points.join(", "))
    };
    let polygon = |polygon: &Polygon| {
        let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
        format!("({})", rings.map(ring).collect::<Vec<_>>().join(", "))
    };
    let polygons: Vec<String> = area.iter().map(polygon).collect();
    match polygons.as_slice() {
        [polygon] => format!("POLYGON {polygon}"),
        polygons => format!("MULTIPOLYGON ({})", polygons.join(", ")),
    }
}

//! Voronoi cells of people on the floor: cut off at a distance, and without the parts behind walls, as in PedPy
//! (`compute_individual_voronoi_polygons`).

use super::options::{CellLimit, MeasureError};
use analysis::site::Site;
use analysis::voronoi::{area, cells, disk, within};
use engine::geometry::{Area, Polygon};
use engine::math::{Vector, bounds};
use engine::scene::Region;
use scenario::floor_plan::{self, Rings};

/// Walls this far beyond a polygon are cut together with it, meters.
const MARGIN: f64 = 0.1;

/// The part of a person's cell in which it can walk.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnCell {
    /// The outline counterclockwise, then holes clockwise, meters.
    pub rings: Rings,
    /// Its area, divided by the number of people who share it, m².
    pub area: f64,
}

impl OwnCell {
    /// The area that it has in common with a region, divided by the number of people who share it, m².
    pub fn inside(&self, region: &Region) -> f64 {
        let corners = region.corners();
        let [low, high] = bounds(self.rings.iter().flatten().copied()).unwrap_or_default();
        let apart = high.x <= region.min.x
            || high.y <= region.min.y
            || low.x >= region.max.x
            || low.y >= region.max.y;
        if apart {
            return 0.0;
        }
        let common = self.rings.iter().map(|ring| area(&within(ring, &corners)));
        let whole: f64 = self.rings.iter().map(|ring| area(ring)).sum();
        common.sum::<f64>() / whole * self.area
    }
}

/// The floor that cells divide.
pub struct Tessellation<'a> {
    site: &'a Site,
    limit: CellLimit,
    /// The area that unbounded obstacles enclose.
    floors: Vec<Rings>,
    /// The bounded obstacles.
    bodies: Rings,
    /// The corners of a rectangle around the floor.
    whole: Vec<Vector>,
}

impl<'a> Tessellation<'a> {
    /// Cells at a site.
    ///
    /// # Errors
    /// Nothing limits the cells.
    pub fn new(site: &'a Site, limit: CellLimit) -> Result<Self, MeasureError> {
        let obstacles = site.walls.obstacles();
        let (floors, bodies) = floor_plan::outlines(obstacles);
        if limit.cut_off.is_none() && floors.is_empty() {
            return Err(MeasureError::Unlimited);
        }
        let points = obstacles.iter().flat_map(Polygon::points);
        let [min, max] = bounds(points.copied()).unwrap_or_default();
        Ok(Self {
            site,
            limit,
            floors,
            bodies,
            whole: Region { min, max }.corners().to_vec(),
        })
    }

    /// The cells of people at `positions`. `eyes` are the nearest points outside of obstacles. Walls can divide a cell;
    /// the part with the eye belongs to the person. `None` for a person too deep inside an obstacle.
    pub fn cells(&self, positions: &[Vector], eyes: &[Vector]) -> Vec<Option<OwnCell>> {
        let limit = |p| match self.limit.cut_off {
            Some(radius) => disk(p, radius, self.limit.quad_segments),
            None => self.whole.clone(),
        };
        let cells = cells(positions, limit).into_iter().zip(eyes);
        let own = cells.map(|(cell, &eye)| {
            let rings = self.own(cell.outline, eye)?;
            let whole: f64 = rings.iter().map(|ring| area(ring)).sum();
            let area = whole / f64::from(cell.people);
            (area > 0.0).then_some(OwnCell { rings, area })
        });
        own.collect()
    }

    /// The walkable area of a region, m².
    ///
    /// # Errors
    /// Those of [`floor_plan::free`].
    pub fn walkable(&self, region: &Region) -> Result<f64, MeasureError> {
        let cut = self.parts(&region.corners());
        let parts = cut.map_err(|error| MeasureError::Floor(error.to_string()))?;
        Ok(parts.iter().map(Area::area).sum())
    }

    /// The rings of the walkable part of a convex outline that holds `eye`.
    fn own(&self, outline: Vec<Vector>, eye: Vector) -> Option<Rings> {
        let reach = outline.iter().map(|p| (p - eye).norm()).fold(0.0, f64::max);
        let mut near = Vec::new();
        self.site.walls.near(eye, reach, &mut near);
        let is_cut = near.iter().any(|&k| {
            let wall = self.site.walls.wall(k);
            !within(&[wall.start, wall.end], &outline).is_empty()
        });
        if !is_cut {
            return (!outline.is_empty() && !self.site.is_inside(eye)).then(|| vec![outline]);
        }
        // A cell that cannot be cut counts as missing.
        let parts = self.parts(&outline).ok()?;
        let distance = |part: &Area| match part.contains(eye) {
            true => 0.0,
            false => distance(part, eye),
        };
        let own = parts
            .into_iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(floor_plan::rings(&[own]))
    }

    /// The walkable parts of a convex outline.
    fn parts(&self, outline: &[Vector]) -> Result<Vec<Area>, floor_plan::FloorPlanError> {
        let [low, high] = bounds(outline.iter().copied()).unwrap_or_default();
        let margin = Vector::repeat(MARGIN);
        let window = Region {
            min: low - margin,
            max: high + margin,
        };
        let nearby = |rings: &Rings| -> Rings {
            let parts = rings.iter().map(|ring| within(ring, &window.corners()));
            parts.filter(|part| part.len() > 2).collect()
        };
        let mut floors: Vec<Rings> = self.floors.iter().map(nearby).collect();
        floors.insert(0, vec![outline.to_vec()]);
        floor_plan::free(&floors, &nearby(&self.bodies))
    }
}

/// The distance from a point to the boundary of an area, meters.
fn distance(part: &Area, p: Vector) -> f64 {
    let edges = part.rings().flat_map(|ring| {
        let points = ring.points();
        points.iter().zip(points.iter().cycle().skip(1))
    });
    let distances = edges.map(|(&start, &end)| {
        let way = end - start;
        let along = ((p - start).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        (p - start - way * along).norm()
    });
    distances.fold(f64::INFINITY, f64::min)
}

//! The densities of regions in a frame, side by side: the mean of the SPH field, the classic density and the Voronoi
//! density, all over the walkable part of the region.

use rayon::prelude::*;
use serde::Serialize;

use super::options::{MOST_CELLS, MeasureError, Options};
use super::person::Person;
use super::tessellation::{OwnCell, Tessellation};
use super::view::View;
use analysis::site::{Kernel, Site};
use engine::kernel;
use engine::math::Vector;
use engine::scene::Region;

/// The densities of a region in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct RegionState {
    /// The mean of the SPH field, P/m².
    pub sph_field: f64,
    /// People in the region / walkable area, P/m².
    pub classic: f64,
    /// Σ |A_i ∩ M| / |A_i| / |M| with the cells A_i, P/m².
    pub voronoi: f64,
    /// Σ |A_i ∩ M| v_i / |M|, m/s; `None` if no cell of known speed reaches into the region.
    pub voronoi_speed: Option<f64>,
    /// Σ |A_i ∩ M| / |M|: the part of the region that cells cover.
    pub voronoi_covered: f64,
}

/// The regions to measure.
pub struct Regions<'a> {
    site: &'a Site,
    tessellation: Tessellation<'a>,
    places: Vec<Walkable>,
}

/// A region with its walkable area.
struct Walkable {
    region: Region,
    /// m².
    walkable: f64,
    field: Nodes,
}

impl<'a> Regions<'a> {
    /// The regions of a measurement.
    ///
    /// # Errors
    /// Nothing limits the Voronoi cells, or a region is outside of the walkable area or too large for `--cell`.
    pub fn new(site: &'a Site, options: &Options) -> Result<Self, MeasureError> {
        let tessellation = Tessellation::new(site, options.cells)?;
        let place = |(k, &region): (usize, &Region)| {
            let walkable = tessellation.walkable(&region)?;
            if walkable <= 0.0 {
                return Err(MeasureError::Unwalkable(k + 1));
            }
            Ok(Walkable {
                region,
                walkable,
                field: Nodes::new(region, site, options)?,
            })
        };
        let places = options.regions.iter().enumerate().map(place);
        Ok(Self {
            places: places.collect::<Result<_, _>>()?,
            site,
            tessellation,
        })
    }

    /// The walkable area of each region, m².
    pub fn walkable(&self) -> Vec<f64> {
        self.places.iter().map(|place| place.walkable).collect()
    }

    /// Measures the regions in a frame, and sets the Voronoi densities of its people.
    pub fn measure(&self, people: &mut [Person]) -> Vec<RegionState> {
        let of = |value: fn(&Person) -> Vector| people.iter().map(value).collect::<Vec<_>>();
        let (positions, eyes) = (of(|person| person.position), of(|person| person.eye));
        let cells = self.tessellation.cells(&positions, &eyes);
        for (person, cell) in people.iter_mut().zip(&cells) {
            person.voronoi = cell.as_ref().map(|cell| 1.0 / cell.area);
        }
        let regions = self.places.iter();
        regions
            .map(|place| place.measure(self.site, people, &cells))
            .collect()
    }
}

impl Walkable {
    fn measure(&self, site: &Site, people: &[Person], cells: &[Option<OwnCell>]) -> RegionState {
        let (mut share, mut covered, mut moved) = (0.0, 0.0, None);
        for (person, cell) in people.iter().zip(cells) {
            let Some(cell) = cell else {
                continue;
            };
            let inside = cell.inside(&self.region);
            share += inside / cell.area;
            covered += inside;
            if let Some(velocity) = person.velocity.filter(|_| inside > 0.0) {
                *moved.get_or_insert(0.0) += inside * velocity.norm();
            }
        }
        let all = people.iter();
        let inside = all.filter(|person| self.region.contains(person.position));
        RegionState {
            sph_field: self.field.mean(site, people),
            classic: inside.count() as f64 / self.walkable,
            voronoi: share / self.walkable,
            voronoi_speed: moved.map(|moved: f64| moved / self.walkable),
            voronoi_covered: covered / self.walkable,
        }
    }
}

/// The centers of equal rectangles that fill a region, at which the field is evaluated.
struct Nodes {
    region: Region,
    /// The sides of a rectangle, meters.
    sides: Vector,
    columns: usize,
    rows: usize,
    /// Row by row from the lower left; `None` inside obstacles.
    views: Vec<Option<View>>,
    kernel: Kernel,
}

impl Nodes {
    fn new(region: Region, site: &Site, options: &Options) -> Result<Self, MeasureError> {
        let size = region.max - region.min;
        let [columns, rows] = [size.x, size.y].map(|side| (side / options.cell).ceil().max(1.0));
        if columns * rows > MOST_CELLS as f64 {
            return Err(MeasureError::Cells(options.cell));
        }
        let mut nodes = Self {
            region,
            sides: Vector::new(size.x / columns, size.y / rows),
            columns: columns as usize,
            rows: rows as usize,
            views: Vec::new(),
            kernel: options.kernel,
        };
        let all = (0..nodes.columns * nodes.rows).into_par_iter();
        nodes.views = all
            .map(|k| View::new(site, &options.kernel, nodes.at(k)))
            .collect();
        Ok(nodes)
    }

    /// The position of a node, meters.
    fn at(&self, k: usize) -> Vector {
        let (column, row) = (k % self.columns, k / self.columns);
        let steps = Vector::new(column as f64 + 0.5, row as f64 + 0.5);
        self.region.min + steps.component_mul(&self.sides)
    }

    /// The mean of the SPH field over all nodes outside of obstacles, P/m².
    fn mean(&self, site: &Site, people: &[Person]) -> f64 {
        let h = self.kernel.support_radius;
        let mut sum = 0.0;
        for person in people {
            let place = (person.position - self.region.min).component_div(&self.sides);
            let reach = Vector::repeat(h).component_div(&self.sides);
            let range = |place: f64, reach: f64, count: usize| {
                let first = (place - reach - 0.5).ceil().max(0.0) as usize;
                first..((place + reach + 0.5).max(0.0) as usize).min(count)
            };
            for row in range(place.y, reach.y, self.rows) {
                for column in range(place.x, reach.x, self.columns) {
                    let k = row * self.columns + column;
                    let Some(view) = &self.views[k] else {
                        continue;
                    };
                    let at = self.at(k);
                    let weight = kernel::density((at - person.position).norm_squared(), h);
                    if weight > 0.0 && view.sees(site, at, person.eye) {
                        sum += person.mass * weight / view.visible();
                    }
                }
            }
        }
        let free = self.views.iter().flatten().count();
        sum / free.max(1) as f64
    }
}

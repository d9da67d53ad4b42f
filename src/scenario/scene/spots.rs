//! Spots to stand in waiting areas.

use engine::geometry::{Ring, Walls};
use engine::math::{Vector, bounds};

/// The first spots are taken at this density, P/m²; more between them if these are taken.
const LOOSE: f64 = 1.5;
/// The densest spots, P/m².
const DENSEST: f64 = 6.0;
/// The most spots of an area.
const MOST_SPOTS: f64 = 20_000.0;
/// Spots keep this distance from walls, meters.
pub const FROM_WALLS: f64 = 0.3;

/// Spots in an area, the first ones to take first: points of a sequence that fills the area evenly however many of
/// them are taken, and those nearest to `facing` before others of the same density.
pub fn spots(area: &Ring, walls: &Walls, facing: Option<Vector>) -> Vec<Vector> {
    let is_free = |p: &Vector| {
        let mut near = Vec::new();
        walls.near(*p, FROM_WALLS, &mut near);
        let reach = |&k: &u32| (walls.wall(k).nearest_point(*p).point - p).norm() < FROM_WALLS;
        area.contains(*p) && walls.obstacle_at(*p).is_none() && !near.iter().any(reach)
    };
    let mut spots: Vec<Vector> = even(area, DENSEST).filter(is_free).collect();
    if let Some(facing) = facing {
        let block = (LOOSE * area.area()).ceil().max(1.0) as usize;
        for spots in spots.chunks_mut(block) {
            let distance = |p: &Vector| (p - facing).norm();
            spots.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
    }
    spots
}

/// Points in the rectangle around an area that fill it evenly up to a density, P/m²: the R2 sequence, multiples of the
/// inverse powers of the plastic number.
pub fn even(area: &Ring, density: f64) -> impl Iterator<Item = Vector> {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let [low, high] = bounds(area.points().iter().copied()).unwrap_or_default();
    let extent = high - low;
    let most = (density * extent.x * extent.y).min(MOST_SPOTS);
    let step = Vector::new(1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC));
    (0..most as u32).map(move |k| {
        let part = (step * f64::from(k)).map(|x| (x + 0.5).fract());
        low + extent.component_mul(&part)
    })
}

//! The union of the shadows of several walls, divided among the walls.

use libm::{atan2, cos};
use std::f64::consts::TAU;

use super::HiddenRegion;

/// Cuts the `regions` of one agent to the parts that do not overlap: in each direction only the nearest wall
/// counts (the lower envelope over the angles). Returns (index into `regions`, part), sorted by angle; a wall may
/// have several parts. Of walls at equal distance the first counts.
pub fn visible_parts(regions: &[HiddenRegion]) -> Vec<(usize, HiddenRegion)> {
    if let [region] = regions {
        return vec![(0, *region)];
    }
    let mut angles: Vec<f64> = regions.iter().flat_map(edges_of).collect();
    for (i, first) in regions.iter().enumerate() {
        angles.extend(
            regions[i + 1..]
                .iter()
                .filter_map(|second| crossing(first, second)),
        );
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let mut parts = Vec::new();
    for (i, &begin) in angles.iter().enumerate() {
        let end = angles
            .get(i + 1)
            .copied()
            .unwrap_or_else(|| angles[0] + TAU);
        let middle = 0.5 * (begin + end);
        let nearest = regions
            .iter()
            .enumerate()
            .filter_map(|(k, region)| Some((k, ray_distance(region, middle)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = nearest {
            let t = local(&regions[k], middle);
            let half = 0.5 * (end - begin);
            let part = regions[k].between(t - half, t + half);
            if part.from < part.to {
                parts.push((k, part));
            }
        }
    }
    parts
}

/// The direction of the region's perpendicular as an angle in the plane, radians.
fn bearing(region: &HiddenRegion) -> f64 {
    atan2(region.towards.y, region.towards.x)
}

/// Both ends of the region, as angles in the plane in [0, 2π).
fn edges_of(region: &HiddenRegion) -> [f64; 2] {
    region
        .angles()
        .map(|t| (bearing(region) + t).rem_euclid(TAU))
}

/// Converts an angle in the plane to an angle from the region's perpendicular, in [−π, π).
fn local(region: &HiddenRegion, angle: f64) -> f64 {
    (angle - bearing(region) + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0
}

/// Distance to the wall along a ray at `angle`, meters; `None` if the ray misses it.
fn ray_distance(region: &HiddenRegion, angle: f64) -> Option<f64> {
    let t = local(region, angle);
    let [t1, t2] = region.angles();
    (t1 <= t && t <= t2).then(|| region.distance / cos(t))
}

/// The angle at which two walls cross each other, as walls of overlapping obstacles do.
fn crossing(first: &HiddenRegion, second: &HiddenRegion) -> Option<f64> {
    let turn = first.towards.perp(&second.towards);
    if turn == 0.0 {
        return None;
    }
    // p with p·n₁ = d₁ and p·n₂ = d₂
    let p = (crate::math::perpendicular(first.towards) * second.distance
        - crate::math::perpendicular(second.towards) * first.distance)
        / turn;
    let inside = |region: &HiddenRegion| {
        let s = p.dot(&region.along);
        region.from < s && s < region.to
    };
    (inside(first) && inside(second)).then(|| atan2(p.y, p.x).rem_euclid(TAU))
}

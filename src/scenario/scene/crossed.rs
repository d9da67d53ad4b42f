//! Notes on crowds whose area lies in two rooms: a wall crosses it, with a door somewhere; or reaches beyond the plan.

use std::collections::BTreeMap;

use crate::error::numbers::brief;
use crate::error::quote::to_centimeters;
use crate::file::File;
use crate::keys::shapes::Outline;
use engine::geometry::{Ring, Walls};
use engine::math::{Vector, bounds};

/// This many people of a crowd are looked at.
const LOOKED_AT: usize = 40;
/// A wall divides a crowd if it lies between this share of the pairs of its people.
const DIVIDED: f64 = 0.2;
/// An area reaches beyond the plan if less than this share of it is inside.
const INSIDE: f64 = 0.9;

/// A note if the area of the crowd `name` reaches beyond the plan.
pub fn beyond(keys: &File, area: &Outline, name: &str) -> Option<String> {
    let corners = corners(area)?;
    let floors = keys.walkable_area.iter().flatten().flatten();
    let [low, high] = bounds(floors.flat_map(|ring| ring.0.iter().map(|&corner| corner.into())))?;
    let [from, to] = bounds(corners)?;
    let inside = to.zip_map(&high, f64::min) - from.zip_map(&low, f64::max);
    let share = inside.component_div(&(to - from));
    let over = (low - from).zip_map(&(to - high), f64::max).max();
    (share.min() > 0.0 && share.product() < INSIDE).then(|| {
        format!(
            "{name}.area: it reaches {} m beyond the plan, and all its agents start in the rest; check that it is \
             where it should be",
            brief(to_centimeters(over))
        )
    })
}

/// A note if a wall that reaches beyond the area of the crowd `name` lies between many of its people, who stand at
/// `places`: not a piece of furniture inside of it.
pub fn note(walls: &Walls, area: &Outline, places: &[Vector], name: &str) -> Option<String> {
    let ring = Ring::new(corners(area)?).ok()?;
    let every = places.len().div_ceil(LOOKED_AT).max(1);
    let some: Vec<Vector> = places.iter().copied().step_by(every).collect();
    let mut reaching = BTreeMap::new();
    let (mut all, mut divided) = (0, 0);
    for (k, &p) in some.iter().enumerate() {
        for &q in &some[k + 1..] {
            // Where the area itself bends between both, the wall does not divide it.
            let is_inside = |share: f64| ring.contains(p + (q - p) * share);
            if !(1..8).all(|k| is_inside(f64::from(k) / 8.0)) {
                continue;
            }
            let candidates = walls.near_any(&[p, q], 0.0);
            let mut crossed = candidates.iter().copied();
            let mut reaches = |k: u32| {
                *reaching
                    .entry(k)
                    .or_insert_with(|| reaches_out(walls, k, &ring))
            };
            all += 1;
            divided +=
                u32::from(crossed.any(|k| walls.wall(k).crossing(p, q).is_some() && reaches(k)));
        }
    }
    (f64::from(divided) > DIVIDED * f64::from(all)).then(|| {
        format!(
            "{name}.area: walls cross it, so its agents start on both sides of them; draw it within one room if they \
             should stand in one"
        )
    })
}

/// Whether the outline of which wall `first` is a part has corners outside of an area.
fn reaches_out(walls: &Walls, first: u32, area: &Ring) -> bool {
    let mut wall = first;
    loop {
        if !area.contains(walls.wall(wall).start) {
            return true;
        }
        wall = walls.wall(wall).previous;
        if wall == first {
            return false;
        }
    }
}

fn corners(area: &Outline) -> Option<Vec<Vector>> {
    let outline = area.rings().first()?;
    Some(outline.0.iter().map(|&corner| corner.into()).collect())
}

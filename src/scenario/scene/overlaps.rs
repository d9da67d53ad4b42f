//! A note on agents that overlap at the start.

use crate::scene::overcrowded::{cell, crowded, near};
use engine::math::Vector;
use engine::packing::Body;

/// Bodies overlap much if they do by more than this part of the smaller radius.
const MUCH: f64 = 0.5;
/// The fewest agents that overlap much in one square meter for which there is a note: more than can stand there. In
/// dense crowds at random places a few agents always overlap.
const CRUSH: usize = 10;

/// A note if many agents overlap much at the start, with the square meter that has the most of them.
pub fn note(bodies: &[Body]) -> Option<String> {
    let all: Vec<Vector> = bodies.iter().map(|body| body.place).collect();
    if crowded(&all).is_some() {
        return None; // it is refused later, and the search would take long
    }
    let mut places = overlapping(bodies);
    places.sort_by_key(cell);
    let cells = places.chunk_by(|a, b| cell(a) == cell(b));
    let fullest = cells.max_by_key(|there| there.len())?;
    if fullest.len() < CRUSH {
        return None;
    }
    Some(format!(
        "{} of {} agents overlap others by more than half a radius at the start, up to {} P/m², {}; give them more \
         room, or check the units",
        places.len(),
        bodies.len(),
        fullest.len(),
        near(fullest[0])
    ))
}

/// The places of the bodies that overlap others much.
fn overlapping(bodies: &[Body]) -> Vec<Vector> {
    let widest = bodies.iter().map(|body| body.radius).fold(0.0, f64::max);
    // Two of the widest bodies overlap much within this distance.
    let reach = (2.0 - MUCH) * widest;
    let row = |body: &Body| (body.place.y / reach).floor() as i64;
    let mut sorted: Vec<(i64, Body)> = bodies.iter().map(|body| (row(body), *body)).collect();
    sorted.sort_by(|(r, a), (s, b)| r.cmp(s).then(a.place.x.total_cmp(&b.place.x)));
    let first = |row: i64, x: f64| sorted.partition_point(|(r, b)| (*r, b.place.x) < (row, x));
    let mut is_found = vec![false; sorted.len()];
    for (k, &(row, one)) in sorted.iter().enumerate() {
        let [low, high] = [one.place.x - reach, one.place.x + reach];
        // The rest of its row, and the next row: earlier bodies have looked this far.
        let rest = k + 1..first(row, high);
        for l in rest.chain(first(row + 1, low)..first(row + 1, high)) {
            if overlap(&one, &sorted[l].1) {
                (is_found[k], is_found[l]) = (true, true);
            }
        }
    }
    let found = sorted.iter().zip(is_found).filter(|(_, found)| *found);
    found.map(|((_, body), _)| body.place).collect()
}

/// Whether two bodies overlap by more than half a radius.
fn overlap(one: &Body, other: &Body) -> bool {
    let allowed = MUCH * one.radius.min(other.radius);
    (one.place - other.place).norm() < one.radius + other.radius - allowed
}

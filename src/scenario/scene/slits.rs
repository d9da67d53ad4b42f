//! Notes on slits between floors: drawings whose rooms nearly touch close the doors between them.

use crate::error::quote::to_centimeters;
use crate::floor_plan::THICKNESS;
use engine::geometry::Walls;
use engine::math::{Vector, direction, perpendicular};

/// Solids between floors that are thinner are slits, not walls, meters.
const SLIT: f64 = 0.02;
/// Rounding of the thickness of walls, meters.
const ROUNDING: f64 = 1e-5;
/// Shorter slits are not named: agents would not fit through, meters.
const SHORTEST: f64 = 0.3;
/// This many slits are named.
const NAMED: usize = 3;
/// The search stops after this many pairs of edges: some 0.1 s.
const MOST_PAIRS: usize = 10_000_000;

/// An edge of a floor: its ends, meters.
type Edge = [Vector; 2];

/// A note on solids thinner than [`SLIT`] between two floors, or two parts of one floor.
pub fn note(walls: &Walls) -> Option<String> {
    let apart = apart(walls)?;
    Some(format!(
        "walkable_area: {apart}, and agents cannot pass there; let them touch or overlap, unless a wall stands between \
         them"
    ))
}

/// Where two floors, or two parts of one floor, end less than [`SLIT`] apart: the widths and the places of the first
/// few slits; `None` without one.
pub fn apart(walls: &Walls) -> Option<String> {
    let found = slits(walls);
    let texts = found.iter().take(NAMED).map(|(middle, width)| {
        let text = format!("{:.1}", 1e3 * width);
        let width = text.trim_end_matches(".0");
        let [x, y] = [middle.x, middle.y].map(to_centimeters);
        format!("{width} mm apart at ({x:.2}, {y:.2})")
    });
    let named: Vec<String> = texts.collect();
    let rest = match found.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!found.is_empty()).then(|| format!("floors end {}{rest}", named.join(", ")))
}

/// The middles and widths of slits, meters, from left to right.
fn slits(walls: &Walls) -> Vec<(Vector, f64)> {
    let floors = walls.obstacles().iter().filter(|one| one.is_unbounded());
    let mut edges: Vec<Edge> = Vec::new();
    for ring in floors.flat_map(|floor| floor.rings()) {
        let ends = ring.iter().cycle().skip(1);
        edges.extend(ring.iter().zip(ends).map(|(&a, &b)| [a, b]));
    }
    let left = |edge: &Edge| edge[0].x.min(edge[1].x);
    edges.sort_by(|one, other| left(one).total_cmp(&left(other)));
    let mut found = Vec::new();
    let mut compared = 0;
    for (k, one) in edges.iter().enumerate() {
        let right = one[0].x.max(one[1].x) + SLIT;
        let others = edges[k + 1..].iter();
        let near = others.take_while(|other| left(other) <= right);
        let between = near
            .inspect(|_| compared += 1)
            .filter_map(|other| between(one, other));
        found.extend(between.filter(|(middle, _)| walls.obstacle_at(*middle).is_some()));
        if compared > MOST_PAIRS {
            break;
        }
    }
    found
}

/// The middle and the width of the strip between two edges, meters, if it is narrow and long enough.
fn between(one: &Edge, other: &Edge) -> Option<(Vector, f64)> {
    let along = direction(one[1] - one[0]);
    let across = perpendicular(along);
    let [from, to] = other.map(|p| (p - one[0]).dot(&along));
    let low = from.min(to).max(0.0);
    let high = from.max(to).min((one[1] - one[0]).norm());
    if high - low < SHORTEST {
        return None;
    }
    // The edges are nearly parallel where they are near each other over such a length.
    let away = |at: f64| {
        let point = other[0] + (other[1] - other[0]) * ((at - from) / (to - from));
        (point - one[0]).dot(&across)
    };
    let ends = [away(low), away(high)];
    // Walls that a plan gives as lines have this thickness.
    let is_wall = ends
        .iter()
        .all(|away| (away.abs() - THICKNESS).abs() < ROUNDING);
    let is_narrow =
        ends.iter().all(|away| away.abs() <= SLIT) && ends[0] * ends[1] > 0.0 && !is_wall;
    let middle = 0.5 * (low + high);
    is_narrow.then(|| {
        let width = away(middle);
        (
            one[0] + along * middle + across * (0.5 * width),
            width.abs(),
        )
    })
}

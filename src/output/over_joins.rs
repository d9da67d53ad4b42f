//! Lines that lead over the joins of a building, level by level.

use engine::breakdown::Breakdown;
use engine::levels::{Join, Levels};
use engine::math::{Vector, direction};

/// A line that bends at the end of a join passes it on the side away from the corner by this, meters.
const ASIDE: f64 = 1e-6;
/// A line this near to a join does not cross it, meters.
const BESIDE: f64 = 1e-4;
/// Joins count as longer by this at both ends, meters.
const LONGER: f64 = 1e-5;

/// Moves the points of an agent's breakdown to their places in the building: its way up to the next join.
pub fn in_building(levels: &Levels, breakdown: &mut Breakdown) {
    let plane = Vector::from(breakdown.position);
    let shift = levels.in_building(plane) - plane;
    let moved = |p: &mut [f64; 2]| *p = (Vector::from(*p) + shift).into();
    if let Some(way) = &mut breakdown.way {
        let corners = way.corners.iter().map(|&corner| corner.into());
        let line: Vec<Vector> = std::iter::once(plane).chain(corners).collect();
        let within = on_levels(levels, &line).into_iter().next();
        let ends = within.into_iter().flatten().skip(1);
        way.corners = ends.map(|p| (p + shift).into()).collect();
        moved(&mut way.next);
    }
    for wall in &mut breakdown.walls {
        moved(&mut wall.nearest_point);
        wall.representative_point.iter_mut().for_each(moved);
    }
    breakdown.position = levels.in_building(plane).into();
    breakdown.goal = levels.in_building(breakdown.goal.into()).into();
}

/// The parts of a line on each level, in the plane. It is given as it is seen from its first point.
pub fn on_levels(levels: &Levels, line: &[Vector]) -> Vec<Vec<Vector>> {
    let Some(&first) = line.first() else {
        return Vec::new();
    };
    let (mut from, mut shift) = (first, Vector::zeros());
    let (mut parts, mut part) = (Vec::new(), vec![first]);
    // The join just crossed, as it is on the level beyond.
    let mut last = None;
    for (&corner, beside) in line.iter().zip(beside_corners(line)).skip(1) {
        while let Some((at, join)) = crossing(levels, [from, beside + shift], last) {
            let way = levels.way(join.to);
            part.push(at);
            parts.push(std::mem::replace(&mut part, vec![at + way]));
            shift += way;
            from = at + way;
            last = Some((from, -join.to));
        }
        part.push(corner + shift);
        from = beside + shift;
    }
    parts.push(part);
    parts
}

/// Where the way from one place of a level to another crosses a join. Around the end of a wall without thickness, as
/// between two flights that touch, it does not go back to where it came from: by the join there to the `last` level.
fn crossing(
    levels: &Levels,
    [from, to]: [Vector; 2],
    last: Option<(Vector, i32)>,
) -> Option<(Vector, Join)> {
    let joins = levels.joins()[levels.joins_at(from)].iter();
    // A way past the mouth of stairs runs along the join.
    let runs_along = |join: &&Join| {
        let [a, b] = join.line;
        let off = |p: Vector| direction(b - a).perp(&(p - a)).abs();
        off(from) < BESIDE && off(to) < BESIDE
    };
    let crossed = joins.filter(|join| !runs_along(join)).filter_map(|join| {
        let at = from + (to - from) * longer(join).crossed(from, to)?;
        let goes_back =
            last.is_some_and(|(entered, back)| join.to == back && (at - entered).norm() < LONGER);
        Some((goes_back, at, *join))
    });
    let first = crossed.min_by(|(back, one, _), (other_back, other, _)| {
        let [one, other] = [one, other].map(|at| (at - from).norm());
        back.cmp(other_back).then(one.total_cmp(&other))
    });
    first.map(|(_, at, join)| (at, join))
}

/// A join that is longer at both ends, so that lines around them cross it in spite of rounding.
fn longer(join: &Join) -> Join {
    let [a, b] = join.line;
    let more = direction(b - a) * LONGER;
    Join {
        line: [a - more, b + more],
        ..*join
    }
}

/// The points of a line, those between its ends moved away from the corners around which it bends.
fn beside_corners(line: &[Vector]) -> Vec<Vector> {
    let aside = |k: usize| {
        let [before, here, next] = [k.checked_sub(1)?, k, k + 1].map(|k| line.get(k));
        let (before, here, next) = (before?, here?, next?);
        let inward = direction(before - here) + direction(next - here);
        (inward.norm() > ASIDE).then(|| direction(inward) * -ASIDE)
    };
    let points = line.iter().enumerate();
    points
        .map(|(k, p)| p + aside(k).unwrap_or_else(Vector::zeros))
        .collect()
}

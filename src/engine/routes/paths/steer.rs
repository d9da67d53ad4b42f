//! Steering toward the next point, with clearance at corners.

use crate::math::{Vector, direction, perpendicular};
use crate::routes::floor::{Bend, Floor, Turn};

/// The heading of an agent at `p` that walks around a corner `distance` meters away: the tangent of the circle around
/// the corner, on the side away from its walls. It stays between `near` and `far`, points on the edges of the corner's
/// visible cone on the side of the walls and on the other side. It keeps `clearance` meters from all of them where
/// there is room.
pub fn around(
    floor: &Floor,
    (p, distance): (Vector, f64),
    (bend, [near, far]): (Bend, [Vector; 2]),
    clearance: f64,
) -> Vector {
    let corner = &floor.corners[bend.corner as usize];
    let ahead = ahead(corner.place - p, distance);
    // Sideways, away from the corner's walls.
    let aside = match bend.turn {
        Turn::First => -perpendicular(ahead),
        Turn::Last => perpendicular(ahead),
    };
    // Directions have a component ahead and one to the side.
    let seen = |point: Vector| Vector::new(ahead.dot(&(point - p)), aside.dot(&(point - p)));
    let (near, far) = (seen(near), seen(far));
    let own = turn(clearance.min(corner.room), distance);
    // In most cases this heading keeps clear of both points.
    let is_past_near = match near.y < 0.0 {
        true => near.perp(&own) >= clearance,
        false => near.norm_squared() * own.y * own.y >= clearance * clearance,
    };
    let is_past_far = far.y > 0.0 && own.perp(&far) >= clearance;
    let way = if is_past_near && is_past_far {
        own
    } else {
        between((own, distance), (near, far), clearance)
    };
    let way = bounded(way);
    ahead * way.x + aside * way.y
}

/// The end of an agent's way.
pub struct End {
    /// The point of the goal nearest to the agent, meters.
    pub point: Vector,
    /// Its distance, meters.
    pub distance: f64,
    /// The ends of the goal's line, meters; `None` if the goal is a point.
    pub line: Option<[Vector; 2]>,
}

/// The heading from `p` to the end of the way that keeps `gap` meters, where there is room, from both edges of the
/// end's visible cone, on which `right` and `left` lie; and the distance to the nearer of the points that it evades,
/// meters. `None` if the agent can walk straight. Agents pass the ends of a line like the jambs of a door.
pub fn between_borders(
    p: Vector,
    end: &End,
    [right, left]: [Vector; 2],
    gap: f64,
) -> Option<(Vector, f64)> {
    let ahead = ahead(end.point - p, end.distance);
    let aside = perpendicular(ahead);
    let seen = |point: Vector| Vector::new(ahead.dot(&(point - p)), aside.dot(&(point - p)));
    // Only points before the end and too near to the straight line count. If the goal is a point, it may itself lie
    // near to them.
    let too_near = |border: Vector| {
        let gap = match end.line {
            None => gap.min((end.point - border).norm()),
            Some(_) => gap,
        };
        let point = seen(border);
        let counts = (0.0..end.distance).contains(&point.x) && point.y.abs() < gap;
        counts.then_some((point, gap))
    };
    // Seen from the agent, right and left are swapped.
    let (on_right, on_left) = (too_near(left), too_near(right));
    let jambs = end.line.map(|line| {
        let [one, other] = line.map(seen);
        let [right, left] = if one.y < other.y {
            [one, other]
        } else {
            [other, one]
        };
        [(right, gap), (left, gap)]
    });
    // The heading past both points that turns farthest to the left (`sign` 1) or to the right (−1).
    let farthest = |points: [Option<(Vector, f64)>; 2], sign: f64| {
        let points = points.into_iter().flatten();
        let headings = points.map(|(point, gap)| (past(point, true, sign * gap), point.norm()));
        headings.reduce(|a, b| if sign * a.0.perp(&b.0) > 0.0 { b } else { a })
    };
    let least = farthest([on_right, jambs.map(|[right, _]| right)], 1.0);
    let most = farthest([on_left, jambs.map(|[_, left]| left)], -1.0);
    let turns_left = least.filter(|(way, _)| way.y > 0.0);
    let turns_right = most.filter(|(way, _)| way.y < 0.0);
    let way = match (turns_left, turns_right) {
        (None, None) => return None,
        (Some(one), Some(other)) => middle(one, other),
        (Some(one), None) | (None, Some(one)) => match (least, most) {
            (Some(least), Some(most)) if least.0.perp(&most.0) < 0.0 => middle(least, most),
            _ => one.0,
        },
    };
    let way = bounded(way);
    let near = [turns_left, turns_right].into_iter().flatten();
    let nearest = near.map(|(_, away)| away).fold(f64::INFINITY, f64::min);
    Some((ahead * way.x + aside * way.y, nearest))
}

/// Clamps the turn of a heading to [`MOST_TURN`].
fn bounded(way: Vector) -> Vector {
    if way.x < MOST_TURN.x {
        Vector::new(MOST_TURN.x, MOST_TURN.y.copysign(way.y))
    } else {
        way
    }
}

/// The heading `own` past a corner at this distance, turned so that it keeps `clearance` meters from the points `near`
/// and `far` on both sides where there is enough room.
fn between(own: (Vector, f64), (near, far): (Vector, Vector), clearance: f64) -> Vector {
    let past_near = past(near, near.y < 0.0, clearance);
    let is_wider = past_near.x.max(past_near.y) > 0.0 && own.0.perp(&past_near) > 0.0;
    let least = if is_wider {
        (past_near, near.norm())
    } else {
        own
    };
    let most = past(far, far.y > 0.0, -clearance);
    if least.0.perp(&most) >= 0.0 {
        least.0
    } else {
        middle(least, (most, far.norm()))
    }
}

/// A heading between two headings past points at these distances: in the middle if the points are equally near,
/// otherwise closer to the heading past the nearer point, which the agent passes first.
fn middle((one, one_away): (Vector, f64), (other, other_away): (Vector, f64)) -> Vector {
    direction(one * other_away.powi(2) + other * one_away.powi(2))
}

/// The direction of a way of this length, meters.
fn ahead(way: Vector, length: f64) -> Vector {
    if length > 0.0 { way / length } else { way }
}

/// The largest angle between the heading and the shortest way, 1.3 radians, as a unit vector. It is below a right
/// angle, so that every step shortens the rest of the way.
const MOST_TURN: Vector = Vector::new(0.267_498_828_624_587_4, 0.963_558_185_417_193);

/// The heading that keeps `gap` meters to the left of a point at `to`. If the point does not count, the same turn from
/// straight ahead.
fn past(to: Vector, counts: bool, gap: f64) -> Vector {
    let distance = to.norm();
    let turn = turn(gap, distance);
    if counts {
        let way = to / distance;
        way * turn.x + perpendicular(way) * turn.y
    } else {
        turn
    }
}

/// The heading that passes a point `distance` meters straight ahead with a gap of `gap` meters.
fn turn(gap: f64, distance: f64) -> Vector {
    let sine = if gap.abs() < distance {
        gap / distance
    } else {
        1.0_f64.copysign(gap)
    };
    Vector::new((1.0 - sine * sine).sqrt(), sine)
}

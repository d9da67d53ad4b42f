//! Steering toward what comes next, with clearance at corners.

use super::corner::Turn;
use super::floor::Floor;
use super::map::Next;
use crate::engine::math::{Vector, direction, perpendicular};

/// The direction in which an agent at `p` walks that keeps `clearance` meters from corners where there is room for
/// it: along the tangent of the circle around the next corner, on the side away from the corner's walls; and past
/// the corners on the way there.
pub fn heading(floor: &Floor, p: Vector, next: &Next, clearance: f64) -> Vector {
    let (corner, turn, [near, far]) = match *next {
        Next::Goal(point) | Next::Out(point) => return direction(point - p),
        Next::Corner { bend, borders } => {
            (&floor.corners[bend.corner as usize], bend.turn, borders)
        }
    };
    let ahead = direction(corner.place - p);
    // To the side away from the corner's walls.
    let aside = match turn {
        Turn::First => -perpendicular(ahead),
        Turn::Last => perpendicular(ahead),
    };
    // Angles to the side, radians.
    let to = |point: Vector| (aside.dot(&(point - p))).atan2(ahead.dot(&(point - p)));
    let around = |point: Vector, gap: f64| (gap / (point - p).norm()).min(1.0).asin();
    let own = around(corner.place, clearance.min(corner.room));
    let least = own.max(to(near).min(0.0) + around(near, clearance));
    let most = to(far).max(0.0) - around(far, clearance);
    let angle = if least <= most {
        least
    } else {
        0.5 * (least + most)
    };
    let angle = angle.clamp(-MOST_TURN, MOST_TURN);
    ahead * angle.cos() + aside * angle.sin()
}

/// The largest angle between the heading and the shortest way, radians. Below a right angle the way left gets shorter
/// with every step.
const MOST_TURN: f64 = 1.3;

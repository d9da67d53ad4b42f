//! The room before walls.

use crate::frame::Frame;
use crate::geometry::Wall;
use crate::math::Vector;

/// How far a disc of this radius at `p` can move in the direction `heading` (of length 1) before it touches the wall,
/// meters: zero if it touches it already and moves closer, infinite if it never does.
pub fn before_wall(wall: &Wall, p: Vector, radius: f64, heading: Vector) -> f64 {
    let distance = wall.signed_distance(p);
    if distance < 0.0 {
        return f64::INFINITY; // seen from behind
    }
    let closing = -heading.dot(&wall.normal);
    let along = (p - wall.start).dot(&wall.tangent);
    let length = wall.length();
    if closing > 0.0 {
        let touching = ((distance - radius) / closing).max(0.0);
        let there = along + touching * heading.dot(&wall.tangent);
        if (0.0..=length).contains(&there) {
            return touching;
        }
    }
    let ends = [wall.start, wall.end].map(|end| before_point(end - p, radius, heading));
    ends[0].min(ends[1])
}

/// How far a disc at the origin can move before it touches a point.
fn before_point(point: Vector, radius: f64, heading: Vector) -> f64 {
    let along = point.dot(&heading);
    let squared = radius * radius - (point.norm_squared() - along * along);
    if along <= 0.0 || squared <= 0.0 {
        return f64::INFINITY;
    }
    (along - squared.sqrt()).max(0.0)
}

/// The wall among those near agent `i` before which the disc has the least way, with this way in meters, if it is
/// less than `far`.
pub fn nearest_wall(
    frame: &Frame,
    i: usize,
    radius: f64,
    heading: Vector,
    far: f64,
) -> (f64, Option<u32>) {
    let p = frame.agents.position[i];
    let mut least = (far, None);
    for &k in frame.neighbors.seen_walls(frame.walls, p) {
        let wall = frame.walls.wall(k);
        if wall.is_beyond(p, far + radius) {
            continue;
        }
        let room = before_wall(wall, p, radius, heading);
        if room < least.0 {
            least = (room, Some(k));
        }
    }
    least
}

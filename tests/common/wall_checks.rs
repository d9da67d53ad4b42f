//! Properties of any obstacles at any points, for tests and for fuzzing.

use std::f64::consts::PI;

use sandbox::engine::boundary::WallMethod;
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::Vector;

/// The rounding error of lengths computed from coordinates up to 10⁶ m, meters.
const ROUNDING: f64 = 1e-8;
/// The distance at which an agent is placed in front of a wall, with some rounding, meters.
const CLEARANCE: f64 = 2e-6;

/// The polygons of the lists of points, without invalid ones.
pub fn obstacles(lists: Vec<Vec<Vector>>) -> Vec<Polygon> {
    let made = lists.into_iter().map(|points| {
        let count = points.len();
        let polygon = Polygon::new(points)?;
        assert_eq!(polygon.points().len(), count);
        assert!(polygon.area() > 0.0);
        Ok::<Polygon, sandbox::engine::geometry::PolygonError>(polygon)
    });
    made.filter_map(Result::ok).collect()
}

/// Checks all queries of `walls` at `p`, within `radius` meters and for a move to `goal`.
pub fn check(walls: &Walls, p: Vector, goal: Vector, radius: f64) {
    let all: Vec<u32> = (0..walls.len() as u32).collect();
    let near = near(walls, p, radius);
    shares(walls, &near, p, radius);
    let inside = walls
        .obstacles()
        .iter()
        .position(|polygon| polygon.contains(p));
    let distance = |k: &u32| (walls.wall(*k).nearest_point(p).point - p).norm();
    let nearest = all.iter().map(distance).fold(f64::INFINITY, f64::min);
    // Within rounding error of a wall, a point may count as inside or outside.
    if nearest > ROUNDING {
        assert_eq!(walls.obstacle_at(p), inside);
    }
    check_free_point(walls, p);
    check_stopped_move(walls, p, goal, &all);
}

/// Checks that the index finds the same walls as brute force, and returns them.
fn near(walls: &Walls, p: Vector, radius: f64) -> Vec<u32> {
    let mut found = Vec::new();
    walls.near(p, radius, &mut found);
    let is_near = |&k: &u32| {
        let nearest = walls.wall(k).nearest_point(p).point;
        (nearest - p).norm_squared() < radius * radius
    };
    let expected: Vec<u32> = (0..walls.len() as u32).filter(is_near).collect();
    assert_eq!(found, expected);
    let maybe = walls.near_any(&[p], radius);
    assert!(maybe.is_sorted() && found.iter().all(|k| maybe.contains(k)));
    found
}

/// Checks that no hidden area or integral exceeds that of the whole disc.
fn shares(walls: &Walls, near: &[u32], p: Vector, h: f64) {
    let disc = PI * h * h;
    for method in [
        WallMethod::Representative,
        WallMethod::Exact,
        WallMethod::Union,
    ] {
        let mut hidden = 0.0;
        method.shares(walls, near, p, h, |share| {
            let slack = 1e-6 * disc;
            assert!(
                (-slack..=disc + slack).contains(&share.hidden_area),
                "{share:?}"
            );
            assert!(share.kernel.is_finite() && share.gradient.norm().is_finite());
            if method != WallMethod::Representative {
                assert!((-1e-6..=1.0 + 1e-6).contains(&share.kernel), "{share:?}");
            }
            hidden += share.hidden_area;
        });
        if method == WallMethod::Union {
            assert!(hidden <= disc * (1.0 + 1e-6), "{hidden} of {disc} m²");
        }
    }
}

/// Checks that the nearest free point is free, and that no wall has a nearer free point.
fn check_free_point(walls: &Walls, p: Vector) {
    let Some(exit) = walls.free_point_near(p) else {
        return;
    };
    assert_eq!(walls.obstacle_at(exit), None);
    let feet = walls
        .iter()
        .map(|wall| wall.nearest_point(p).point + wall.normal * 1e-6);
    let gap = |q: Vector| {
        let gaps = walls
            .iter()
            .map(|wall| (wall.nearest_point(q).point - q).norm());
        gaps.fold(f64::INFINITY, f64::min)
    };
    // Points on the line of another wall count only if there are no others.
    let is_clear = |q: Vector| gap(q) >= 5e-7;
    let free = feet.filter(|&foot| walls.obstacle_at(foot).is_none());
    let free = free.filter(|&foot| !is_clear(exit) || is_clear(foot));
    let nearest = free
        .map(|foot| (foot - p).norm())
        .fold(f64::INFINITY, f64::min);
    assert!(
        (exit - p).norm() <= nearest + ROUNDING,
        "{exit} is farther than {nearest} m"
    );
    // The free point is not nearer than the nearest wall.
    let distance =
        |wall: &sandbox::engine::geometry::Wall| (wall.nearest_point(p).point - p).norm();
    let least = walls.iter().map(distance).fold(f64::INFINITY, f64::min);
    assert!((exit - p).norm() >= least - CLEARANCE);
}

/// Checks that a stopped move ends on its path, on the free side of the wall that stopped it.
fn check_stopped_move(walls: &Walls, from: Vector, to: Vector, all: &[u32]) {
    let Some((end, k)) = walls.stop(from, to, all) else {
        return;
    };
    let rounding = 1e-9 * (1.0 + from.norm() + to.norm());
    assert!((end - from).norm() <= (to - from).norm() + rounding);
    assert!(end.norm().is_finite());
    if (to - from).norm() < f64::MIN_POSITIVE {
        return; // no direction
    }
    let aside = (to - from).perp(&(end - from)) / (to - from).norm();
    assert!(aside.abs() <= rounding, "{aside} m off its way");
    assert!(walls.wall(k).faces(end), "{end} is behind wall {k}");
    assert_eq!(walls.first_crossing(from, end, &[k]), None);
}

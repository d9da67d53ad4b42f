//! The hidden regions P_k and their integrals, compared with quadrature in two dimensions.

use std::f64::consts::{PI, TAU};

use crate::common::quadrature::{cross, swept};
use crate::common::wall_integrals::{Integrals, Region};
use crate::common::{polygon, rectangle, room, vector};
use proptest::prelude::*;
use sandbox::engine::boundary::{WallMethod, WallShare};
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::Vector;

fn shares(method: WallMethod, walls: &Walls, r_i: Vector, h: f64) -> Vec<WallShare> {
    let all: Vec<u32> = (0..walls.len() as u32).collect();
    let mut shares = Vec::new();
    method.shares(walls, &all, r_i, h, |share| shares.push(share));
    shares
}

fn sum(shares: &[WallShare]) -> Integrals {
    shares.iter().map(Integrals::from).sum()
}

/// A triangle whose first edge is the wall from `start` to `end`; its third corner lies behind.
fn triangle(start: Vector, end: Vector) -> Polygon {
    let behind = 0.5 * (start + end) + vector(start.y - end.y, end.x - start.x);
    Polygon::new(vec![start, end, behind]).unwrap()
}

#[test]
fn an_infinite_wall_gives_the_printed_values() {
    let walls = Walls::new(vec![rectangle([-50.0, 50.0], [-1.0, 0.0])]);
    for (d, exact, representative) in [
        (0.24, [0.23860, 0.94868], [0.32538, 1.51053]),
        (0.5, [0.05865, 0.27759], [0.06549, 0.36656]),
    ] {
        let cases = [
            (WallMethod::Exact, exact),
            (WallMethod::Union, exact),
            (WallMethod::Representative, representative),
        ];
        for (method, [kernel, gradient]) in cases {
            let found = sum(&shares(method, &walls, vector(3.0, d), 1.0));
            assert!((found.kernel - kernel).abs() < 5e-6, "{method:?} {found:?}");
            // ∇W points to where W grows, here into the wall.
            assert!(
                (found.gradient.norm() - gradient).abs() < 5.1e-6,
                "{found:?}"
            );
            assert!(found.gradient.y < 0.0 && found.gradient.x.abs() < 1e-12);
        }
    }
    let area = sum(&shares(WallMethod::Exact, &walls, vector(0.0, 0.5), 1.0)).area;
    assert!((area - 0.61418).abs() < 5e-6);
}

#[test]
fn a_wall_hides_the_points_whose_line_of_sight_crosses_it() {
    let (start, end, r_i, h) = (vector(0.7, -0.1), vector(-0.3, 0.2), vector(0.1, 0.35), 1.0);
    let walls = Walls::new(vec![triangle(start, end)]);
    let steps = 1000;
    let cell = 2.0 * h / f64::from(steps);
    let mut seen = Integrals::none();
    for i in 0..steps * steps {
        let x =
            vector(f64::from(i % steps) + 0.5, f64::from(i / steps) + 0.5) * cell - vector(h, h);
        let p = r_i + x;
        let sides = |a: Vector, b: Vector, c: Vector| cross(b - a, c - a) > 0.0;
        let crosses = sides(start, end, r_i) != sides(start, end, p)
            && sides(r_i, p, start) != sides(r_i, p, end);
        if x.norm() < h && crosses {
            seen = seen + Integrals::of_piece(x, cell * cell, h);
        }
    }
    let found: Vec<WallShare> = shares(WallMethod::Exact, &walls, r_i, h);
    assert_eq!(found.len(), 1, "the other faces look away");
    assert!(sum(&found).distance(&seen) < 1e-3);
    assert!(swept(walls.wall(found[0].wall), r_i, h).distance(&seen) < 1e-3);
}

/// A wall in any direction near an agent at `r_i`, which is `d` meters in front of its line. The foot of the
/// perpendicular is `foot` meters from the start of the wall.
fn facing_wall(r_i: Vector, angle: f64, d: f64, foot: f64, length: f64) -> Walls {
    let (towards, along) = (
        vector(angle.cos(), angle.sin()),
        vector(-angle.sin(), angle.cos()),
    );
    let start = r_i + towards * d + along * foot;
    Walls::new(vec![triangle(start, start - along * length)])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_exact_integrals_agree_with_quadrature_for_every_wall(
        angle in 0.0..TAU,
        d in 0.003..1.1_f64,
        foot in -1.2..2.2_f64,
        length in 0.01..4.0_f64,
        h in 0.5..1.5_f64,
    ) {
        let r_i = vector(3.0, -2.0);
        let walls = facing_wall(r_i, angle, d, foot, length);
        let found = shares(WallMethod::Exact, &walls, r_i, h);
        let found: Vec<WallShare> = found.into_iter().filter(|share| share.wall == 0).collect();
        let expected = swept(walls.wall(0), r_i, h);
        prop_assert!(
            sum(&found).distance(&expected) < 1e-9,
            "{:?} {expected:?}", sum(&found)
        );
        prop_assert_eq!(found.is_empty(), expected.area == 0.0);
    }

    #[test]
    fn the_integrals_follow_rotations_and_large_translations(
        angle in 0.0..TAU,
        x in -1e6..1e6_f64,
        y in -1e6..1e6_f64,
        d in 0.0..1.0_f64,
        foot in 0.1..1.0_f64,
    ) {
        for method in [WallMethod::Representative, WallMethod::Exact, WallMethod::Union] {
            let near = facing_wall(Vector::zeros(), 0.0, d, foot, 2.0);
            let far = facing_wall(vector(x, y), angle, d.max(1e-8), foot, 2.0);
            let before = sum(&shares(method, &near, Vector::zeros(), 1.0)[..1]);
            let mut after = sum(&shares(method, &far, vector(x, y), 1.0)[..1]);
            let (sine, cosine) = angle.sin_cos();
            let g = after.gradient;
            after.gradient = vector(cosine * g.x + sine * g.y, cosine * g.y - sine * g.x);
            prop_assert!(before.distance(&after) < 1e-6);
        }
    }

    #[test]
    fn the_integrals_stay_finite_and_continuous_down_to_the_wall(
        // At smaller distances, squares are subnormal numbers.
        exponent in -150..-9_i32,
        foot in -0.5..2.5_f64,
    ) {
        prop_assume!(foot.abs() > 1e-3 && (foot - 2.0).abs() > 1e-3);
        let d = 10.0_f64.powi(exponent);
        // The wall lies on y = 0, so that the distance is exactly d.
        let walls = Walls::new(vec![rectangle([0.0, 2.0], [-1.0, 0.0])]);
        for method in [WallMethod::Representative, WallMethod::Exact, WallMethod::Union] {
            let at = |d: f64| {
                let shares = shares(method, &walls, vector(foot, d), 1.0);
                let top: Vec<WallShare> = shares
                    .into_iter()
                    .filter(|share| walls.wall(share.wall).normal.y > 0.5)
                    .collect();
                sum(&top)
            };
            let difference = at(d).distance(&at(0.0));
            prop_assert!(difference < 1e-5, "{method:?} {d:e} {:?} {:?}", at(d), at(0.0));
        }
    }

    #[test]
    fn the_representative_point_carries_the_area_of_the_region(
        angle in 0.0..TAU,
        d in 0.001..0.99_f64,
        foot in -0.9..2.9_f64,
    ) {
        let r_i = vector(-4.0, 1.0);
        let walls = facing_wall(r_i, angle, d, foot, 2.0);
        for share in shares(WallMethod::Representative, &walls, r_i, 1.0) {
            let wall = walls.wall(share.wall);
            let nearest = wall.nearest_point(r_i).point - r_i;
            let point = share.representative_point.unwrap() - r_i;
            prop_assert!((point.norm() - 0.5 * (nearest.norm() + 1.0)).abs() < 1e-12);
            prop_assert!(cross(point, nearest).abs() < 1e-12 && point.dot(&nearest) >= 0.0);
            let area = swept(wall, r_i, 1.0).area;
            let expected = Integrals::of_piece(point, area, 1.0);
            prop_assert!(sum(&[share]).distance(&expected) < 1e-9);
        }
    }
}

#[test]
fn a_distance_too_small_to_be_squared_gives_no_nan() {
    let walls = Walls::new(vec![rectangle([0.0, 2.0], [-1.0, 0.0])]);
    for d in [5e-324, 1e-310, 1e-300, 1e-200, 1e-162, 1e-160] {
        for method in [
            WallMethod::Representative,
            WallMethod::Exact,
            WallMethod::Union,
        ] {
            for share in shares(method, &walls, vector(0.7, d), 1.0) {
                assert!(share.kernel.is_finite(), "{method:?} {d:e}");
                assert!(share.gradient.norm().is_finite(), "{method:?} {d:e}");
            }
        }
    }
}

/// Obstacles with overlapping shadows, and a box of places for an agent.
fn tight_places() -> Vec<(&'static str, Vec<Polygon>, [f64; 4])> {
    vec![
        (
            "slab",
            vec![rectangle([0.0, 0.1], [-3.0, 0.4])],
            [-0.9, 1.0, -1.0, 1.2],
        ),
        (
            "two slabs",
            vec![
                rectangle([0.0, 0.05], [-0.5, 0.4]),
                rectangle([0.3, 0.35], [-1.0, 0.9]),
            ],
            [-0.6, 0.9, -1.0, 1.0],
        ),
        ("doorway", vec![room(6.0, 0.8)], [5.2, 7.8, 2.0, 4.0]),
        ("corner", vec![room(6.0, 0.8)], [0.0, 0.9, 0.0, 0.9]),
        (
            "two bodies in reach",
            vec![
                polygon(&[[0.3, -0.2], [0.8, 0.1], [0.4, 0.5]]),
                rectangle([-0.7, -0.35], [-0.6, 0.6]),
                rectangle([-0.2, 0.6], [0.7, 0.75]),
            ],
            [-1.2, 1.2, -1.0, 1.2],
        ),
        (
            "overlapping bodies",
            vec![
                rectangle([-0.4, 0.4], [-0.1, 0.1]),
                polygon(&[[-0.1, -0.5], [0.2, -0.4], [0.1, 0.45], [-0.15, 0.4]]),
                polygon(&[[-0.5, -0.4], [0.5, 0.35], [0.45, 0.42]]),
            ],
            [-1.0, 1.0, -1.0, 1.0],
        ),
    ]
}

#[test]
fn the_union_of_shadows_agrees_with_quadrature_over_visible_walls() {
    for (name, obstacles, [x0, x1, y0, y1]) in tight_places() {
        let walls = Walls::new(obstacles);
        for k in 1..150 {
            // Low-discrepancy points in the box.
            let u = vector(
                (f64::from(k) * 0.754_877_67).fract(),
                (f64::from(k) * 0.569_840_29).fract(),
            );
            let r_i = vector(x0 + (x1 - x0) * u.x, y0 + (y1 - y0) * u.y);
            if walls.obstacle_at(r_i).is_some() {
                continue;
            }
            let union = sum(&shares(WallMethod::Union, &walls, r_i, 1.0));
            let expected = Integrals::over(Region::Hidden, &walls, r_i, 1.0, 1e-9);
            let difference = union.distance(&expected);
            assert!(
                difference < 1e-6,
                "{name} {r_i:?}: {difference:e} {union:?} {expected:?}"
            );
            let sum = sum(&shares(WallMethod::Exact, &walls, r_i, 1.0));
            assert!(union.kernel <= sum.kernel + 1e-12 && union.area <= sum.area + 1e-12);
            assert!(union.kernel < 1.0 && union.area < PI);
        }
    }
}

#[test]
fn the_faces_of_one_convex_body_hide_different_points() {
    let hexagon: Vec<[f64; 2]> = (0..6)
        .map(|k| f64::from(k) * TAU / 6.0)
        .map(|t| [0.4 * t.cos(), 0.3 * t.sin()])
        .collect();
    let walls = Walls::new(vec![polygon(&hexagon)]);
    for k in 0..500 {
        let t = f64::from(k) * 0.777;
        let r_i = vector(t.cos(), t.sin()) * (0.42 + 0.001 * f64::from(k));
        let exact = sum(&shares(WallMethod::Exact, &walls, r_i, 1.0));
        let union = sum(&shares(WallMethod::Union, &walls, r_i, 1.0));
        assert!(exact.distance(&union) < 1e-11);
    }
}

#[test]
fn the_union_next_to_a_wall_is_continuous_down_to_it() {
    let walls = Walls::new(vec![room(6.0, 0.8)]);
    for along in [0.05, 0.4, 2.35, 2.59, 3.0] {
        let at = |d: f64| sum(&shares(WallMethod::Union, &walls, vector(d, along), 1.0));
        let limit = at(1e-6);
        for d in [0.0, 1e-300, 1e-17, 1e-14, 1e-12, 1e-10, 1e-8] {
            let difference = at(d).distance(&limit);
            assert!(difference < 1e-4, "along {along}, d {d:e}: {difference:e}");
        }
    }
}

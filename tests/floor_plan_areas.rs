//! The area of a floor plan is that of the points with positive winding numbers, on coarse grids where many corners
//! and edges coincide.

use crate::common::bounded::cases;
use crate::common::plans::{Ring, edges};
use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::geometry::Area;
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError, Rings};
use serde_json::json;

/// Walkable area, a second floor, or obstacles.
type Kind = usize;
const OBSTACLE: Kind = 2;

/// A polygon with its holes.
#[derive(Clone)]
struct Shape {
    rings: Vec<Ring>,
    kind: Kind,
}

impl Shape {
    /// The rings, outlines counterclockwise and holes clockwise.
    fn oriented(&self) -> impl Iterator<Item = Ring> {
        let numbered = self.rings.iter().cloned().enumerate();
        numbered.map(|(k, mut ring)| {
            let twice_area: f64 = edges(&ring).map(|[a, b]| a.perp(&b)).sum();
            if (twice_area > 0.0) != (k == 0) {
                ring.reverse();
            }
            ring
        })
    }
}

/// The x coordinates between which no two edges cross, in ascending order.
fn slabs(edges: &[([Vector; 2], Kind)]) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for (i, &([a, b], _)) in edges.iter().enumerate() {
        found.push(a.x);
        for &([c, d], _) in &edges[..i] {
            let along = (c - a).perp(&(d - c)) / (b - a).perp(&(d - c));
            if (0.0..=1.0).contains(&along) {
                found.push(a.x + along * (b.x - a.x));
            }
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

/// The area of the points that are free by the winding numbers of each kind, from lines parallel to y.
fn area(plan: &[Shape], is_free: impl Fn([i32; 3]) -> bool) -> f64 {
    let rings = plan
        .iter()
        .flat_map(|shape| shape.oriented().map(|ring| (ring, shape.kind)));
    let all: Vec<_> = rings
        .flat_map(|(ring, kind)| {
            edges(&ring)
                .map(|edge| (edge, kind))
                .collect::<Vec<([Vector; 2], Kind)>>()
        })
        .collect();
    let between = |ends: &[f64]| {
        let middle = 0.5 * (ends[0] + ends[1]);
        let crossing = all
            .iter()
            .filter(|([a, b], _)| (a.x > middle) != (b.x > middle));
        let mut crossing: Vec<(f64, i32, Kind)> = crossing
            .map(|&([a, b], kind)| {
                let along = (middle - a.x) / (b.x - a.x);
                let turn = if b.x > a.x { 1 } else { -1 };
                (a.y + along * (b.y - a.y), turn, kind)
            })
            .collect();
        crossing.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut winding, mut length) = ([0; 3], 0.0);
        for pair in crossing.windows(2) {
            let (y, turn, kind) = pair[0];
            winding[kind] += turn;
            if is_free(winding) {
                length += pair[1].0 - y;
            }
        }
        length * (ends[1] - ends[0])
    };
    slabs(&all).windows(2).map(between).sum()
}

fn size(areas: &[Area]) -> f64 {
    areas.iter().map(Area::area).sum()
}

/// Reads the plan and checks its area.
fn check_plan(plan: &[Shape]) {
    let feature = |shape: &Shape| {
        let kind = if shape.kind == OBSTACLE {
            "obstacle"
        } else {
            "floor"
        };
        json!({"type": "Feature", "properties": {"kind": kind},
               "geometry": {"type": "Polygon", "coordinates": shape.rings}})
    };
    let features: Vec<_> = plan.iter().map(feature).collect();
    let text = json!({"type": "FeatureCollection", "features": features}).to_string();
    let found = match floor_plan::parse(&text) {
        Err(FloorPlanError::TooSmall { .. } | FloorPlanError::NoRoom) => return,
        found => found.unwrap_or_else(|error| panic!("{text}: {error}")),
    };
    let (found, expected) = (
        size(&found.walkable),
        area(plan, |[floor, _, body]| floor > 0 && body <= 0),
    );
    assert!(
        (found - expected).abs() < 1e-6,
        "{found} m², not {expected} m²: {text}"
    );
}

/// Intersects the two floors of a plan and checks the area.
fn check_intersection(plan: &[Shape]) {
    let rings = |kind: Kind| -> Rings {
        let shapes = plan.iter().filter(|shape| shape.kind == kind);
        let points = |ring: Ring| ring.into_iter().map(Vector::from).collect();
        shapes.flat_map(Shape::oriented).map(points).collect()
    };
    let [one, other, bodies] = [0, 1, OBSTACLE].map(rings);
    let found = size(&floor_plan::free(&[one, other], &bodies).unwrap());
    let expected = area(plan, |[one, other, body]| one > 0 && other > 0 && body <= 0);
    assert!(
        (found - expected).abs() < 1e-6,
        "{found} m², not {expected} m²"
    );
}

/// A simple polygon with 3 to 5 corners on a grid of `unit`.
fn ring(random: &mut ChaCha8Rng, unit: f64) -> Ring {
    loop {
        let count = random.random_range(3..6);
        let mut up_to_6 = || f64::from(random.random_range(0..7)) * unit;
        let ring: Ring = (0..count).map(|_| [up_to_6(), up_to_6()]).collect();
        if FloorPlan::obstacle(std::slice::from_ref(&ring)).is_ok() {
            return ring;
        }
    }
}

/// Two to eleven polygons, some with a hole; the first is walkable area.
fn plan(random: &mut ChaCha8Rng, kinds: &[Kind]) -> Vec<Shape> {
    let unit = [1.0, 0.5, 0.1][random.random_range(0..3)];
    let count = random.random_range(2..12);
    let shape = |k| {
        let kind = if k == 0 {
            0
        } else {
            kinds[random.random_range(0..kinds.len())]
        };
        let has_hole = kind != OBSTACLE && random.random_range(0..3) == 0;
        let rings = (0..1 + usize::from(has_hole)).map(|_| ring(random, unit));
        Shape {
            rings: rings.collect(),
            kind,
        }
    };
    (0..count).map(shape).collect()
}

#[test]
fn a_plan_has_the_area_that_its_winding_numbers_say() {
    cases(1_000, any::<u64>, |seed| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        check_plan(&plan(&mut random, &[0, 0, 0, OBSTACLE]));
        check_intersection(&plan(&mut random, &[0, 1, 1, OBSTACLE]));
        1 << 22
    });
}

/// Walkable areas and obstacles: for each its kind and rings.
fn shapes(given: &[(Kind, &[&str])]) -> Vec<Shape> {
    let shape = |&(kind, rings): &(Kind, &[&str])| {
        let ring = |points: &&str| crate::common::plans::rings(&format!("({points})")).remove(0);
        let rings = rings.iter().map(ring).collect();
        Shape { rings, kind }
    };
    given.iter().map(shape).collect()
}

#[test]
fn areas_that_touch_at_points_are_all_kept() {
    let gap = shapes(&[
        (
            0,
            &[
                "-2 5, -1 1.5, -1 0, -.6 0, -.6 .1, -.5 0, 0 -2, 0 -1, -.1 0, 0 0, -.2 1, -.6 5, -2 5",
                "-.6 5, -.6 3, -.333 1.667, -.6 5",
            ],
        ),
        (0, &["0 5, -.6 5, 0 0, 0 5"]),
        (0, &["0 0, 0 -1, 1 -1, 1 0, 0 0"]),
    ]);
    // An overlap of two areas, one with a hole.
    let overlap = shapes(&[
        (0, &["5 1, 6 3, 1 6, 5 1"]),
        (0, &["6 2, 2 6, 6 0, 6 2", "3 5, 6 3, 2 5, 3 5"]),
    ]);
    // A hole that i_overlay puts into no outline.
    let lost = shapes(&[
        (0, &["1 6, 2 4, 5 2, 1 6", "2 0, 5 2, 5 6, 2 0"]),
        (OBSTACLE, &["4 5, 5 2, 4 6, 4 5"]),
        (0, &["5 5, 3 6, 2 6, 5 5"]),
        (0, &["5 6, 2 5, 3 4, 5 6"]),
        (0, &["0 0, 5 6, 6 2, 5 3, 0 0"]),
    ]);
    for plan in [gap, overlap, lost] {
        check_plan(&plan);
    }
}

//! Floor plans of many overlapping pieces: a point is free if a piece covers it and no obstacle does.

use proptest::prelude::*;
use sandbox::engine::geometry::{Polygon, Ring, Walls};
use sandbox::engine::math::{Vector, perpendicular};
use sandbox::scenario::floor_plan::{self, FloorPlanError};
use serde_json::{Value, json};

/// The corners of a rotated rectangle, and whether it is an obstacle.
type Piece = ([[f64; 2]; 4], bool);

/// Rectangles at any angle, or on a grid, where they touch and share edges.
fn piece() -> impl Strategy<Value = Piece> {
    let turned = (
        (0.0..20.0_f64, 0.0..20.0_f64),
        (0.5..12.0_f64, 0.5..12.0_f64),
        0.0..6.3_f64,
    );
    let on_grid = (0..10_i32, 0..10_i32, 1..6_i32, 1..6_i32).prop_map(|(x, y, w, h)| {
        (
            (f64::from(x), f64::from(y)),
            (f64::from(w), f64::from(h)),
            0.0,
        )
    });
    let at = prop_oneof![turned, on_grid];
    (at, any::<bool>()).prop_map(|(((x, y), (width, height), angle), is_obstacle)| {
        let (sine, cosine) = f64::sin_cos(angle);
        let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        let place = |[a, b]: [f64; 2]| [x + cosine * a - sine * b, y + sine * a + cosine * b];
        (corners.map(place), is_obstacle)
    })
}

fn geojson(pieces: &[Piece], shift: [f64; 2]) -> String {
    let feature = |(corners, is_obstacle): &Piece| -> Value {
        let ring = corners.map(|[x, y]| [x + shift[0], y + shift[1]]);
        let kind = if *is_obstacle { "obstacle" } else { "floor" };
        json!({"type": "Feature", "properties": {"kind": kind},
               "geometry": {"type": "Polygon", "coordinates": [ring]}})
    };
    let features: Vec<Value> = pieces.iter().map(feature).collect();
    json!({"type": "FeatureCollection", "features": features}).to_string()
}

fn read(text: &str) -> Result<floor_plan::FloorPlan, FloorPlanError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.geojson");
    std::fs::write(&path, text).unwrap();
    floor_plan::read(&path)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn a_point_is_free_if_a_piece_covers_it_and_no_obstacle_does(
        mut pieces in prop::collection::vec(piece(), 1..9),
        places in prop::collection::vec((-3.0..25.0_f64, -3.0..25.0_f64), 60),
        shift in prop::sample::select(vec![[0.0, 0.0], [432_100.3, -987_654.1]]),
    ) {
        pieces[0].1 = false;
        let plan = match read(&geojson(&pieces, shift)) {
            Err(FloorPlanError::File { error, .. }) if *error == FloorPlanError::NoRoom => return Ok(()),
            plan => plan.unwrap(),
        };
        let shift = Vector::from(shift);
        let rings: Vec<(Ring, bool)> = pieces
            .iter()
            .map(|(corners, is_obstacle)| {
                let points = corners.map(|p| Vector::from(p) + shift).to_vec();
                (Ring::new(points).unwrap(), *is_obstacle)
            })
            .collect();
        let bodies = rings.iter().map(|(ring, _)| Polygon::new(ring.points().to_vec()).unwrap());
        let edges = Walls::new(bodies.collect());
        let walls = Walls::new(plan.solids().unwrap());
        for (x, y) in places {
            let p = Vector::new(x, y) + shift;
            let within = |obstacle| rings.iter().any(|(ring, is)| *is == obstacle && ring.contains(p));
            // Within rounding error of an edge, a point may count as free or not.
            let nearest = edges
                .iter()
                .map(|edge| (edge.nearest_point(p).point - p).norm())
                .fold(f64::INFINITY, f64::min);
            if nearest > 1e-5 {
                let free = within(false) && !within(true);
                prop_assert_eq!(walls.obstacle_at(p).is_none(), free, "{}", p);
            }
        }
        // Every wall has the floor on its right and the solid on its left.
        for wall in walls.iter().filter(|wall| wall.length() > 0.1) {
            let middle = (wall.start + wall.end) * 0.5;
            let left = perpendicular(wall.tangent) * 1e-5;
            let solid = walls.obstacle_at(middle + left).is_some();
            let free = walls.obstacle_at(middle - left).is_none();
            prop_assert!(solid && free, "{middle}");
        }
    }
}

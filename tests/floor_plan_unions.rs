//! Floor plans of pieces that touch at corners, along edges and in several places, on coarse grids and turned.

use geo::{Contains, LineString, MultiPolygon, Point, Polygon};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::floor_plan::{FloorPlan, FloorPlanError, parse_wkt};
use sandbox::geometry::Walls;
use sandbox::math::Vector;

type Ring = Vec<[f64; 2]>;

/// Three rooms of which one has a corner on the diagonal of another.
const ON_A_DIAGONAL: &str = "MULTIPOLYGON (((.8 .8,.9 .8,.9 1,.8 1,.8 .8)),\
    ((.7000000000000001 .7000000000000001,.9 .7000000000000001,.7000000000000001 .9,\
    .7000000000000001 .7000000000000001)),\
    ((.5 0,.7000000000000001 0,.5 .2,.5 0)))";

/// Eleven rooms whose union has a hole that touches its outline.
const ELEVEN: &str = "MULTIPOLYGON (((5 5,7 5,5 7,5 5)),((5 3,7 3,7 4,5 4,5 3)),\
    ((5.5 2,6 2.5,5.5 3,5 2.5,5.5 2)),((4 2,5 2,5 3,4 3,4 2)),((4 3,6 3,4 5,4 3)),((4 4,6 4,4 6,4 4)),\
    ((4 1,6 1,4 3,4 1)),((4 5,5 5,5 7,4 7,4 5)),((6 2,8 2,6 4,6 2)),((6 0,7 0,7 2,6 2,6 0)),\
    ((6 3,8 3,8 5,6 5,6 3)))";

/// The walls of a plan, after it has been written out and read again.
fn walls(plan: &FloorPlan) -> Result<Walls, FloorPlanError> {
    let points =
        |ring: &sandbox::geometry::Ring| ring.points().iter().map(|p| [p.x, p.y]).collect();
    let rings = plan
        .walkable
        .iter()
        .map(|area| area.rings().map(points).collect());
    let again = FloorPlan::walkable(&rings.collect::<Vec<_>>())?;
    assert_eq!(again.walkable.len(), plan.walkable.len());
    let areas = |plan: &FloorPlan| plan.walkable.iter().map(|area| area.area()).sum::<f64>();
    assert!((areas(&again) - areas(plan)).abs() < 1e-6);
    Ok(Walls::new(again.solids().unwrap()))
}

#[test]
fn rooms_that_touch_at_a_corner_on_a_diagonal_are_one_plan() {
    for (text, area) in [(ON_A_DIAGONAL, 0.02 + 0.02 + 0.02), (ELEVEN, 0.0)] {
        let plan = parse_wkt(text).unwrap();
        let found: f64 = plan.walkable.iter().map(|area| area.area()).sum();
        if area > 0.0 {
            assert!((found - area).abs() < 1e-9, "{found}");
        }
        walls(&plan).unwrap();
    }
}

/// A simple polygon: a rectangle, a triangle or a diamond, on a grid of `unit`.
fn piece(random: &mut ChaCha8Rng, unit: f64) -> Ring {
    let [x, y, w, h]: [i32; 4] =
        std::array::from_fn(|k| random.random_range(if k < 2 { 0..7 } else { 1..4 }));
    let corners = match random.random_range(0..5) {
        0 | 1 => vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]],
        2 => vec![[x, y], [x + w, y], [x, y + w]],
        3 => vec![[x + w, y + w], [x, y + w], [x + w, y]],
        _ => vec![
            [x + w, y],
            [x + 2 * w, y + w],
            [x + w, y + 2 * w],
            [x, y + w],
        ],
    };
    // 7 × 0.1 = 0.7000000000000001.
    corners
        .into_iter()
        .map(|p| p.map(|c| f64::from(c) * unit))
        .collect()
}

fn multipolygon(rings: &[Ring]) -> String {
    let point = |[x, y]: &[f64; 2]| format!("{x} {y}");
    let ring = |ring: &Ring| {
        format!(
            "(({}))",
            ring.iter().map(point).collect::<Vec<_>>().join(",")
        )
    };
    format!(
        "MULTIPOLYGON ({})",
        rings.iter().map(ring).collect::<Vec<_>>().join(",")
    )
}

fn to_geo(ring: &Ring) -> Polygon {
    Polygon::new(LineString::from(ring.clone()), Vec::new())
}

/// How far `p` is from the nearest edge of `rings`.
fn margin(rings: &[Ring], p: Vector) -> f64 {
    let edges = rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let distance = |(&a, &b): (&[f64; 2], &[f64; 2])| {
        let [a, b] = [a, b].map(Vector::from);
        let along = (b - a).dot(&(p - a)) / (b - a).norm_squared();
        (a + (b - a) * along.clamp(0.0, 1.0) - p).norm()
    };
    edges.map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn unions_of_rooms_on_a_coarse_grid_are_read_and_are_what_the_rooms_cover() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for case in 0..2000 {
        let unit = [1.0, 0.5, 0.1][case % 3];
        let count = random.random_range(1..13);
        let rings: Vec<Ring> = (0..count).map(|_| piece(&mut random, unit)).collect();
        let given = MultiPolygon::from_iter(rings.iter().map(to_geo));
        let text = multipolygon(&rings);
        let plan = match parse_wkt(&text) {
            Err(FloorPlanError::TooSmall { .. } | FloorPlanError::NoRoom) => continue,
            plan => plan.unwrap_or_else(|error| panic!("{text}: {error}")),
        };
        let walls = walls(&plan).unwrap_or_else(|error| panic!("{text}: {error}"));
        for _ in 0..40 {
            let p = Vector::new(
                random.random_range(-1.0..12.0),
                random.random_range(-1.0..12.0),
            ) * unit;
            if margin(&rings, p) > 1e-5 {
                let covered = given
                    .iter()
                    .any(|piece| piece.contains(&Point::new(p.x, p.y)));
                assert_eq!(walls.obstacle_at(p).is_none(), covered, "{text}: {p}");
            }
        }
    }
}

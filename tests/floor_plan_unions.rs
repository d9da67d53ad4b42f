//! Floor plans of pieces on coarse grids, which touch at corners, along edges and in several places, and floor
//! plans of very many pieces.

use crate::common::plans::{Ring, contains, margin, multipolygon, rings};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robust::{Coord, orient2d};
use sandbox::engine::geometry::{Area, Walls};
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError};
use serde_json::json;

/// Three rooms; one has a corner on the diagonal of another.
const ON_A_DIAGONAL: &str = "MULTIPOLYGON (((.8 .8,.9 .8,.9 1,.8 1,.8 .8)),\
    ((.7000000000000001 .7000000000000001,.9 .7000000000000001,.7000000000000001 .9,\
    .7000000000000001 .7000000000000001)),\
    ((.5 0,.7000000000000001 0,.5 .2,.5 0)))";

/// Eleven rooms whose union has a hole that touches its outline.
const ELEVEN: &str = "MULTIPOLYGON (((5 5,7 5,5 7,5 5)),((5 3,7 3,7 4,5 4,5 3)),\
    ((5.5 2,6 2.5,5.5 3,5 2.5,5.5 2)),((4 2,5 2,5 3,4 3,4 2)),((4 3,6 3,4 5,4 3)),((4 4,6 4,4 6,4 4)),\
    ((4 1,6 1,4 3,4 1)),((4 5,5 5,5 7,4 7,4 5)),((6 2,8 2,6 4,6 2)),((6 0,7 0,7 2,6 2,6 0)),\
    ((6 3,8 3,8 5,6 5,6 3)))";

/// The rings of an area.
fn given(area: &Area) -> Vec<Ring> {
    let rings = area.rings().map(|ring| ring.points().iter());
    rings
        .map(|points| points.map(|p| [p.x, p.y]).collect())
        .collect()
}

/// Whether two closed segments have a point in common, by exact predicates.
fn meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let coord = |[x, y]: [f64; 2]| Coord { x, y };
    let side = |a, b, p| orient2d(coord(a), coord(b), coord(p));
    let sides = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    let within = |[a, b]: [[f64; 2]; 2], p: [f64; 2]| {
        (0..2).all(|k| (a[k].min(b[k])..=a[k].max(b[k])).contains(&p[k]))
    };
    let ends = [([a, b], c), ([a, b], d), ([c, d], a), ([c, d], b)];
    let touches = |(side, (edge, p)): (f64, _)| side == 0.0 && within(edge, p);
    sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0
        || sides.into_iter().zip(ends).any(touches)
}

/// Whether the edges of a ring meet at their common ends only.
fn is_simple(ring: &Ring) -> bool {
    let mut corners = ring.clone();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let n = corners.len();
    let edge = |k: usize| [corners[k % n], corners[(k + 1) % n]];
    let folds = |k: usize| {
        let [[a, b], [_, c]] = [edge(k), edge(k + 1)];
        meet([a, b], [c, c]) || meet([b, c], [a, a])
    };
    let crosses = |k: usize| (k + 2..n).any(|l| (k > 0 || l < n - 1) && meet(edge(k), edge(l)));
    n > 2 && !(0..n).any(|k| folds(k) || crosses(k))
}

/// The walls of a plan after writing and reading it. Checks that all its rings are simple.
fn walls(plan: &FloorPlan, text: &str) -> Walls {
    let written: Vec<Vec<Ring>> = plan.walkable.iter().map(given).collect();
    for rings in &written {
        for ring in rings {
            assert!(is_simple(ring), "{text}: {ring:?}");
        }
    }
    let again = FloorPlan::walkable(&written).unwrap_or_else(|error| panic!("{text}: {error}"));
    let size = |plan: &FloorPlan| plan.walkable.iter().map(Area::area).sum::<f64>();
    assert!((size(&again) - size(plan)).abs() < 1e-6, "{text}");
    Walls::new(again.solids().unwrap())
}

/// Reads rooms and checks, at random points up to `reach` meters, that a point is free if a room covers it.
fn check(random: &mut ChaCha8Rng, rooms: &[Ring], text: &str, reach: f64) {
    let plan = match floor_plan::parse(text) {
        Err(FloorPlanError::TooSmall { .. }) => return assert!(reach < 7.0, "{text}"),
        plan => plan.unwrap_or_else(|error| panic!("{text}: {error}")),
    };
    let walls = walls(&plan, text);
    for _ in 0..40 {
        let p = Vector::new(
            random.random_range(-0.1..1.0),
            random.random_range(-0.1..1.0),
        ) * reach;
        if margin(rooms, p) > 1e-5 {
            let covered = rooms.iter().any(|room| contains(room, p));
            assert_eq!(walls.obstacle_at(p).is_none(), covered, "{text}: {p}");
        }
    }
}

#[test]
fn rooms_that_touch_up_to_rounding_are_read_as_one_plan() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for (text, reach) in [(ON_A_DIAGONAL, 1.5), (ELEVEN, 9.0)] {
        check(&mut random, &rings(text), text, reach);
    }
}

/// A simple polygon: a rectangle, a triangle or a diamond, on a grid of `unit`.
fn room(random: &mut ChaCha8Rng, unit: f64) -> Ring {
    let mut up_to = |low: i32, high: i32| random.random_range(low..high);
    let [x, y, w, h, kind] = [
        up_to(0, 7),
        up_to(0, 7),
        up_to(1, 4),
        up_to(1, 4),
        up_to(0, 5),
    ];
    let corners = match kind {
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
    // Products are rounded: 7 × 0.1 is 0.7000000000000001.
    let place = |p: [i32; 2]| p.map(|c| f64::from(c) * unit);
    corners.into_iter().map(place).collect()
}

#[test]
fn unions_of_rooms_on_a_coarse_grid_cover_exactly_the_rooms() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for case in 0..2000 {
        let unit = [1.0, 0.5, 0.1][case % 3];
        let count = random.random_range(1..13);
        let rooms: Vec<Ring> = (0..count).map(|_| room(&mut random, unit)).collect();
        let polygons: Vec<Vec<Ring>> = rooms.iter().map(|room| vec![room.clone()]).collect();
        check(&mut random, &rooms, &multipolygon(&polygons), 13.0 * unit);
    }
}

fn square(k: usize, columns: usize) -> Ring {
    let [x, y] = [k % columns, k / columns].map(|c| 2.0 * c as f64);
    vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]]
}

/// Allocations of a reading: the same on every machine.
fn allocations(read: impl FnOnce()) -> u64 {
    allocation_counter::measure(read).count_total
}

#[test]
fn work_is_not_quadratic_in_the_number_of_pieces() {
    let lines = |n: usize| {
        let squares = (0..n).map(|k| multipolygon(&[vec![square(k, 50)]]));
        let text = squares.collect::<Vec<_>>().join("\n");
        allocations(|| assert_eq!(floor_plan::parse(&text).unwrap().solids().unwrap().len(), 1))
    };
    let features = |n: usize| {
        let feature = |k| {
            json!({"type": "Feature", "properties": null,
            "geometry": {"type": "Polygon", "coordinates": [square(k, n)]}})
        };
        let features: Vec<_> = (0..n).map(feature).collect();
        let text = json!({"type": "FeatureCollection", "features": features}).to_string();
        allocations(|| assert_eq!(floor_plan::parse(&text).unwrap().walkable.len(), n))
    };
    let holes = |n: usize| {
        let side = 2.0 * n as f64;
        let outline = vec![[-1.0, -1.0], [side, -1.0], [side, side], [-1.0, side]];
        let mut rings = vec![outline];
        rings.extend((0..n).map(|k| square(k, 50)));
        allocations(|| {
            let plan = FloorPlan::walkable(std::slice::from_ref(&rings)).unwrap();
            assert_eq!(plan.walkable[0].holes.len(), n);
            plan.solids().unwrap();
            FloorPlan::obstacle(&rings).unwrap();
        })
    };
    let kinds: [(&str, &dyn Fn(usize) -> u64); 3] = [
        ("lines", &lines),
        ("features", &features),
        ("holes", &holes),
    ];
    // With 20,000 pieces, work that grows as their square would take a minute.
    for (kind, work) in kinds {
        let [few, many] = [5_000, 20_000].map(work);
        assert!(many < 6 * few, "{kind}: {few}, {many} allocations");
    }
}

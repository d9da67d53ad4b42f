//! Path maps: far and narrow places, goals of several kinds, and walkers that follow the routes.

use nalgebra::Rotation2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::geometry::{Area, Ring};
use sandbox::engine::math::{Vector, direction};
use sandbox::engine::routes::{Floor, Goal, Next, PathMap, Way, WayError, around, nearest_on};

/// The direction of the next step, `clearance` meters from corners.
fn heading(floor: &Floor, p: Vector, way: &Way, clearance: f64) -> Vector {
    match way.next {
        Next::Corner(bend) => {
            let distance = (floor.place(bend) - p).norm();
            around(
                floor,
                (p, distance),
                (bend, way.borders.unwrap()),
                clearance,
            )
        }
        Next::Goal(point) | Next::Out(point) => direction(point - p),
    }
}

const SIZE: Vector = Vector::new(60.0, 40.0);

fn ring(points: &[(f64, f64)]) -> Ring {
    Ring::new(points.iter().map(|&(x, y)| Vector::new(x, y)).collect()).unwrap()
}

fn block(x0: f64, y0: f64, x1: f64, y1: f64) -> Ring {
    ring(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
}

/// A room of 60 × 40 m with up to `bodies` bodies of four or five corners that do not touch, shifted by `far`.
fn room(rng: &mut ChaCha8Rng, bodies: usize, far: Vector) -> Area {
    let mut circles: Vec<(Vector, f64)> = Vec::new();
    let mut holes = Vec::new();
    for _ in 0..100 * bodies {
        let half = Vector::new(rng.random_range(0.05..4.0), rng.random_range(0.05..2.0));
        let radius = half.norm() + 0.01;
        let [x, y] = [SIZE.x, SIZE.y].map(|most| rng.random_range(radius..most - radius));
        let center = Vector::new(x, y);
        let is_apart = |(c, r): &(Vector, f64)| (c - center).norm() > r + radius;
        if holes.len() == bodies || !circles.iter().all(is_apart) {
            continue;
        }
        let turn = Rotation2::new(if rng.random_bool(0.3) {
            0.0
        } else {
            rng.random_range(0.0..3.0)
        });
        let mut corners = vec![(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        if rng.random_bool(0.4) {
            corners.insert(3, (0.0, 0.2)); // a notch
        }
        let place = |(x, y): (f64, f64)| far + center + turn * Vector::new(x * half.x, y * half.y);
        holes.push(Ring::new(corners.into_iter().map(place).collect()).unwrap());
        circles.push((center, radius));
    }
    let outline = [(0.0, 0.0), (SIZE.x, 0.0), (SIZE.x, SIZE.y), (0.0, SIZE.y)];
    let outline = outline.map(|(x, y)| far + Vector::new(x, y)).to_vec();
    Area {
        exterior: Ring::new(outline).unwrap(),
        holes,
    }
}

fn edges(area: &Area) -> Vec<[Vector; 2]> {
    let edges = |ring: &Ring| {
        let points = ring.points().to_vec();
        let ends = points.clone().into_iter().cycle().skip(1);
        points
            .into_iter()
            .zip(ends)
            .map(|(a, b)| [a, b])
            .collect::<Vec<_>>()
    };
    area.rings().flat_map(edges).collect()
}

/// A point of the floor at least `gap` meters from all walls.
fn free(rng: &mut ChaCha8Rng, area: &Area, far: Vector, gap: f64) -> Vector {
    let walls = edges(area);
    loop {
        let p = far + Vector::new(rng.random_range(0.0..SIZE.x), rng.random_range(0.0..SIZE.y));
        let is_clear = |[a, b]: &[Vector; 2]| (nearest_on(p, *a, *b) - p).norm() >= gap;
        if area.contains(p) && walls.iter().all(is_clear) {
            return p;
        }
    }
}

fn length(floor: &Floor, map: &PathMap, p: Vector) -> Option<f64> {
    Some(map.way(floor, p, floor.locate(p)?, None)?.length)
}

#[test]
fn far_from_the_origin_routes_have_the_same_lengths() {
    let far = Vector::new(1e6, -2e6);
    let [(here, starts), (there, _)] = [Vector::zeros(), far].map(|far| {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let area = room(&mut rng, 30, far);
        let floor = Floor::new(std::slice::from_ref(&area), 0.4).unwrap();
        let goal = far + Vector::new(1.0, 1.0);
        let map = PathMap::new(&floor, &[Goal::Point(goal)], 0.3).unwrap();
        let starts: Vec<Vector> = (0..200).map(|_| free(&mut rng, &area, far, 0.0)).collect();
        let lengths: Vec<_> = starts.iter().map(|&p| length(&floor, &map, p)).collect();
        (lengths, starts)
    });
    for ((here, there), p) in here.into_iter().zip(there).zip(starts) {
        assert!(
            (here.unwrap() - there.unwrap()).abs() < 1e-5,
            "{p:?}: {here:?} and {there:?}"
        );
    }
}

/// A room of 20 × 10 m with two blocks, one above the other, `gap` meters apart.
fn with_a_slit(gap: f64) -> Area {
    Area {
        exterior: block(0.0, 0.0, 20.0, 10.0),
        holes: vec![block(9.0, 2.0, 11.0, 5.0), block(9.0, 5.0 + gap, 11.0, 8.0)],
    }
}

#[test]
fn a_passage_is_open_from_the_least_width_on() {
    let goal = Vector::new(19.0, 5.1);
    for (gap, is_open) in [(0.01, false), (0.39, false), (0.41, true), (1.0, true)] {
        let floor = Floor::new(&[with_a_slit(gap)], 0.4).unwrap();
        let map = PathMap::new(&floor, &[Goal::Point(goal)], 0.0).unwrap();
        let p = Vector::new(1.0, 5.0 + 0.5 * gap);
        let found = length(&floor, &map, p).unwrap();
        let straight = (goal - p).norm();
        assert_eq!(found < straight + 0.1, is_open, "{gap} m: {found} m");
    }
}

#[test]
fn an_agent_in_a_passage_too_narrow_finds_the_way_out() {
    let floor = Floor::new(&[with_a_slit(0.3)], 0.4).unwrap();
    let map = PathMap::new(&floor, &[Goal::Point(Vector::new(19.0, 5.1))], 0.0).unwrap();
    for x in [9.3, 9.9, 10.2, 10.7] {
        let mut p = Vector::new(x, 5.15);
        let mut held = None;
        for _ in 0..2000 {
            let t = floor.locate(p).unwrap();
            let way = map.way(&floor, p, t, held).unwrap();
            held = way.next.bend();
            p += heading(&floor, p, &way, 0.1) * 0.02;
        }
        assert!(
            (p - Vector::new(19.0, 5.1)).norm() < 0.1,
            "from x = {x} to {p:?}"
        );
    }
}

#[test]
fn walls_that_touch_at_a_point_leave_no_way_between() {
    let area = Area {
        exterior: block(0.0, 0.0, 20.0, 10.0),
        holes: vec![block(8.0, 2.0, 10.0, 5.0), block(10.0, 5.0, 12.0, 8.0)],
    };
    let floor = Floor::new(&[area], 0.0).unwrap();
    let map = PathMap::new(&floor, &[Goal::Point(Vector::new(11.0, 4.0))], 0.0).unwrap();
    let p = Vector::new(9.0, 6.0);
    // Around the lower block: over (8, 5), (8, 2) and (10, 2).
    let around = 2.0_f64.sqrt() + 3.0 + 2.0 + 5.0_f64.sqrt();
    let found = length(&floor, &map, p).unwrap();
    assert!((found - around).abs() < 1e-9, "{found} instead of {around}");
}

/// Points that divide a straight wall turn it by a rounding error. Those that stand out by 1e-16 m were no corners to
/// walk around, but hid the corner behind them: routes led around the other side of the body.
#[test]
fn points_on_a_straight_wall_hide_nothing_behind_them() {
    for seed in 0..100 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let turn = Rotation2::new(rng.random_range(0.0..6.3));
        let place = |x: f64, y: f64| turn * Vector::new(x, y);
        // A wall of 6 × 1 m with many points on its long sides, off the line by rounding or by less than a micrometer.
        let off = [0.0, 1e-12, 1e-9, 1e-7][seed as usize % 4];
        let mut along = |y: f64| -> Vec<Vector> {
            let points = (0..=12).map(|k| 2.0 + 0.5 * f64::from(k));
            let mut y = |x: f64| {
                if x == 2.0 || x == 8.0 {
                    y
                } else {
                    y + rng.random_range(-1.0..=1.0) * off
                }
            };
            points
                .map(|x| (x, y(x)))
                .map(|(x, y)| place(x, y))
                .collect()
        };
        let (lower, upper) = (along(4.0), along(5.0));
        let body = lower.into_iter().chain(upper.into_iter().rev()).collect();
        let outline = [(0.0, 0.0), (10.0, 0.0), (10.0, 9.0), (0.0, 9.0)].map(|(x, y)| place(x, y));
        let area = Area {
            exterior: Ring::new(outline.to_vec()).unwrap(),
            holes: vec![Ring::new(body).unwrap()],
        };
        let floor = Floor::new(&[area], 0.4).unwrap();
        let map = PathMap::new(&floor, &[Goal::Point(place(9.0, 4.3))], 0.0).unwrap();
        let below = 1.04_f64.sqrt() + 6.0 + 1.09_f64.sqrt();
        let above = 1.01_f64.sqrt() + 6.0 + 1.49_f64.sqrt();
        for (y, expected) in [(4.2, below), (4.9, above)] {
            let found = length(&floor, &map, place(1.0, y)).unwrap();
            let agrees = (found - expected).abs() < 1e-5;
            assert!(agrees, "seed {seed}: {found} instead of {expected}");
        }
    }
}

#[test]
fn other_rooms_and_pockets_have_no_way() {
    let rooms = [
        Area {
            exterior: block(0.0, 0.0, 5.0, 5.0),
            holes: vec![],
        },
        Area {
            exterior: block(6.0, 0.0, 9.0, 5.0),
            holes: vec![],
        },
    ];
    let floor = Floor::new(&rooms, 0.4).unwrap();
    let map = PathMap::new(&floor, &[Goal::Point(Vector::new(1.0, 1.0))], 0.0).unwrap();
    assert!(length(&floor, &map, Vector::new(4.0, 4.0)).is_some());
    assert_eq!(length(&floor, &map, Vector::new(7.0, 4.0)), None);
    assert_eq!(floor.locate(Vector::new(5.5, 2.0)), None);
    let goal = Vector::new(5.5, 1.0);
    let error = PathMap::new(&floor, &[Goal::Point(goal)], 0.0).unwrap_err();
    assert_eq!(error, WayError::NotOnFloor(goal));
}

#[test]
fn the_nearest_of_several_goals_is_taken_and_a_line_at_its_nearest_point() {
    let area = Area {
        exterior: block(0.0, 0.0, 20.0, 10.0),
        holes: vec![],
    };
    let floor = Floor::new(&[area], 0.4).unwrap();
    let line = |x: f64| Goal::Line([Vector::new(x, 2.0), Vector::new(x, 6.0)]);
    let map = PathMap::new(&floor, &[line(0.0), line(20.0)], 0.25).unwrap();
    let next = |x: f64, y: f64| {
        let p = Vector::new(x, y);
        map.way(&floor, p, floor.locate(p).unwrap(), None)
            .unwrap()
            .next
    };
    assert_eq!(next(4.0, 3.0), Next::Goal(Vector::new(0.0, 3.0)));
    assert_eq!(next(15.0, 4.5), Next::Goal(Vector::new(20.0, 4.5)));
    // Beyond its ends, the line is shorter by the margin.
    assert_eq!(next(1.0, 9.0), Next::Goal(Vector::new(0.0, 5.75)));
}

#[test]
fn a_lone_walker_arrives_and_hardly_leaves_the_shortest_way() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let area = room(&mut rng, 40, Vector::zeros());
        let floor = Floor::new(std::slice::from_ref(&area), 0.4).unwrap();
        let goal = free(&mut rng, &area, Vector::zeros(), 0.3);
        let map = PathMap::new(&floor, &[Goal::Point(goal)], 0.3).unwrap();
        for _ in 0..10 {
            let mut p = free(&mut rng, &area, Vector::zeros(), 0.3);
            let Some(shortest) = length(&floor, &map, p) else {
                continue;
            };
            let (mut v, mut walked, mut frame) = (Vector::zeros(), 0.0, 0);
            let mut way = map.way_from(&floor, p).unwrap();
            while (goal - p).norm() > 0.3 {
                if frame % 5 == 0 {
                    let t = floor.locate(p).unwrap();
                    way = map.way(&floor, p, t, way.next.bend()).unwrap();
                }
                let preferred = heading(&floor, p, &way, 0.24) * 1.4;
                v += (preferred - v) * (0.02 / 0.5);
                match floor.locate(p + v * 0.02) {
                    Some(_) => p += v * 0.02,
                    None => v = Vector::zeros(),
                }
                walked += v.norm() * 0.02;
                frame += 1;
                assert!(frame < 20_000, "seed {seed}: still at {p:?}");
            }
            assert!(
                walked < 1.05 * shortest + 0.3,
                "seed {seed}: {walked} m instead of {shortest} m"
            );
        }
    }
}

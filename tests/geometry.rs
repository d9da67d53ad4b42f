//! Rings, polygons with holes, walls, and the queries on them.

use crate::common::{rectangle, room, vector};
use proptest::prelude::*;
use sandbox::engine::geometry::{Area, Polygon, PolygonError, Ring, Wall, WallPart, Walls};
use sandbox::engine::math::{Vector, perpendicular};

fn checked(points: &[[f64; 2]]) -> Result<Ring, PolygonError> {
    Ring::new(points.iter().map(|&[x, y]| vector(x, y)).collect())
}

#[test]
fn a_clockwise_ring_is_turned_and_keeps_its_first_point() {
    let square = checked(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]).unwrap();
    assert_eq!(square.area(), 1.0);
    assert_eq!(square.points()[0], vector(0.0, 0.0));
    assert_eq!(square.points()[1], vector(1.0, 0.0));
}

#[test]
fn a_bow_tie_names_the_edges_that_cross() {
    let bow_tie = checked(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(bow_tie, Err(PolygonError::SelfIntersection(0, 2)));
}

#[test]
fn a_spike_and_a_corner_on_another_edge_are_refused() {
    let spike = checked(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    assert!(matches!(spike, Err(PolygonError::SelfIntersection(..))));
    let touching = checked(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]]);
    assert!(matches!(touching, Err(PolygonError::SelfIntersection(..))));
}

#[test]
fn degenerate_lists_are_refused_with_their_reason() {
    assert_eq!(
        checked(&[[0.0, 0.0], [1.0, 0.0]]),
        Err(PolygonError::TooFewPoints(2))
    );
    assert_eq!(
        checked(&[[0.0, 0.0], [1.0, 0.0], [1.0, f64::NAN]]),
        Err(PolygonError::NotFinite(2))
    );
    assert_eq!(
        checked(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]),
        Err(PolygonError::RepeatedPoint(3, 0))
    );
    assert_eq!(
        checked(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1e-200, 0.0]]),
        Err(PolygonError::RepeatedPoint(3, 0))
    );
    assert!(checked(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).is_err());
}

#[test]
fn the_wall_of_the_evacuation_room_contains_neither_room_nor_doorway() {
    let wall = room(20.0, 0.8);
    assert!(wall.contains(vector(-0.5, 10.0)));
    assert!(wall.contains(vector(20.5, 3.0)));
    assert!(!wall.contains(vector(10.0, 10.0)));
    assert!(!wall.contains(vector(20.5, 10.0)));
    assert!((wall.area() - (22.0 * 22.0 - 400.0 - 0.8)).abs() < 1e-12);
}

fn square(low: f64, high: f64) -> Ring {
    ring(&[[low, low], [high, low], [high, high], [low, high]])
}

fn ring(points: &[[f64; 2]]) -> Ring {
    Ring::new(points.iter().map(|&p| Vector::from(p)).collect()).unwrap()
}

fn area(exterior: Ring, holes: Vec<Ring>) -> Area {
    Area { exterior, holes }
}

fn at(x: f64) -> Vector {
    vector(x, x)
}

#[test]
fn a_body_is_solid_inside_but_for_its_holes() {
    let wall = Polygon::filling(area(square(-1.0, 4.0), vec![square(0.0, 3.0)])).unwrap();
    for (x, solid) in [(-2.0, false), (-0.5, true), (1.0, false), (3.5, true)] {
        assert_eq!(wall.contains(at(x)), solid, "{x}");
    }
    assert!(!wall.is_unbounded());
}

#[test]
fn an_enclosure_is_solid_outside_of_all_areas_also_of_those_in_holes_of_others() {
    let ring = area(square(0.0, 9.0), vec![square(1.0, 8.0)]);
    let areas = vec![
        ring,
        area(square(3.0, 5.0), vec![]),
        area(square(10.0, 11.0), vec![]),
    ];
    let walls = Polygon::enclosing(areas).unwrap();
    assert!(walls.is_unbounded());
    for free in [0.5, 8.5, 4.0, 10.5] {
        assert!(!walls.contains(at(free)), "{free}");
    }
    for solid in [-1.0, 2.0, 6.0, 9.5, 12.0, 1e6] {
        assert!(walls.contains(at(solid)), "{solid}");
    }
}

#[test]
fn every_edge_has_the_solid_on_its_left() {
    let floor = area(square(0.0, 9.0), vec![square(1.0, 2.0), square(3.0, 8.0)]);
    let walls = Polygon::enclosing(vec![floor.clone(), area(square(4.0, 5.0), vec![])]);
    for body in [walls.unwrap(), Polygon::filling(floor).unwrap()] {
        assert_eq!(body.edges().count(), body.points().len());
        for (a, b) in body.edges() {
            let left = perpendicular(b - a) / (b - a).norm() * 1e-3;
            assert!(body.contains((a + b) * 0.5 + left));
            assert!(!body.contains((a + b) * 0.5 - left));
        }
    }
}

#[test]
fn rings_may_touch_but_not_cross_stray_or_overlap() {
    let floor = |holes| Polygon::enclosing(vec![area(square(0.0, 9.0), holes)]);
    let touching = ring(&[[0.0, 4.0], [3.0, 3.0], [3.0, 5.0]]);
    let beside = ring(&[[3.0, 3.0], [4.0, 3.0], [4.0, 2.0]]);
    assert!(floor(vec![touching, beside]).is_ok());
    let crossing = ring(&[[-1.0, 4.0], [3.0, 3.0], [3.0, 5.0]]);
    assert!(matches!(
        floor(vec![crossing]),
        Err(PolygonError::Crossing(..))
    ));
    for stray in [
        vec![square(10.0, 11.0)],
        vec![square(1.0, 5.0), square(2.0, 3.0)],
    ] {
        assert!(matches!(floor(stray), Err(PolygonError::StrayHole(_))));
    }
    let twice = vec![
        area(square(0.0, 9.0), vec![]),
        area(square(2.0, 3.0), vec![]),
    ];
    assert!(matches!(
        Polygon::enclosing(twice),
        Err(PolygonError::Overlap(_))
    ));
    assert_eq!(Polygon::enclosing(vec![]), Err(PolygonError::NoFloor));
}

fn wall() -> Wall {
    Wall::new(vector(4.0, 0.0), vector(0.0, 0.0), 0, 0)
}

#[test]
fn the_free_side_lies_right_of_the_edge() {
    assert_eq!(wall().signed_distance(vector(1.0, 2.0)), 2.0);
    assert!(wall().faces(vector(9.0, 0.5)));
    assert!(!wall().faces(vector(1.0, -0.5)));
}

#[test]
fn the_nearest_point_knows_its_part_of_the_wall() {
    let part = |x: f64| wall().nearest_point(vector(x, 1.0)).part;
    assert_eq!(part(5.0), WallPart::Start);
    assert_eq!(part(1.0), WallPart::Interior);
    assert_eq!(part(-1.0), WallPart::End);
    assert_eq!(
        wall().nearest_point(vector(1.0, 1.0)).point,
        vector(1.0, 0.0)
    );
}

#[test]
fn only_inward_moves_across_the_edge_cross_it() {
    let (above, below) = (vector(1.0, 1.0), vector(1.0, -3.0));
    assert_eq!(wall().crossing(above, below), Some(0.25));
    assert_eq!(wall().crossing(below, above), None);
    assert_eq!(wall().crossing(vector(5.0, 1.0), vector(5.0, -1.0)), None);
}

#[test]
fn walls_are_numbered_by_obstacle_and_point_and_know_the_previous_wall() {
    let walls = Walls::new(vec![
        rectangle([0.0, 1.0], [0.0, 1.0]),
        rectangle([2.0, 3.0], [0.0, 1.0]),
    ]);
    assert_eq!(walls.len(), 8);
    for (k, wall) in walls.iter().enumerate() {
        assert_eq!(wall.obstacle as usize, k / 4);
        assert_eq!(walls.wall(wall.previous).end, wall.start);
    }
}

#[test]
fn the_index_finds_what_brute_force_finds() {
    let boxes = (0..40)
        .map(|i| {
            let (x, y) = ((i % 8) as f64 * 1.7, (i / 8) as f64 * 2.3);
            rectangle([x, x + 0.9], [y, y + 0.4])
        })
        .collect();
    let walls = Walls::new(boxes);
    for step in 0..200 {
        let p = vector((step % 20) as f64 * 0.7, (step / 20) as f64 * 1.1);
        let mut found = Vec::new();
        walls.near(p, 1.0, &mut found);
        let expected: Vec<u32> = (0..walls.len() as u32)
            .filter(|&k| (walls.wall(k).nearest_point(p).point - p).norm() < 1.0)
            .collect();
        assert_eq!(found, expected);
    }
}

#[test]
fn a_move_through_a_wall_ends_before_it() {
    let walls = Walls::new(vec![rectangle([0.0, 0.01], [-5.0, 5.0])]);
    let all: Vec<u32> = (0..4).collect();
    let from = vector(-1.0, 0.0);
    let (stopped, k) = walls.stop(from, vector(1.0, 0.5), &all).unwrap();
    assert!(stopped.x < 0.0 && stopped.x > -1e-5);
    assert_eq!(walls.wall(k).normal, vector(-1.0, 0.0));
    assert_eq!(walls.stop(from, vector(-0.5, 3.0), &all), None);
}

#[test]
fn no_move_slips_between_two_walls_at_their_corner() {
    // A convex and a reentrant corner, rotated and translated. All moves aim at the corner itself, where
    // rounding can place the crossing beyond the ends of both walls.
    let solid = vec![[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0], [-1.0, 0.0]];
    let (long, short) = ([5.0, -1.0], [-1.0, 5.0]);
    let inner = vec![
        [-1.0, -1.0],
        long,
        [5.0, 0.0],
        [0.0, 0.0],
        [0.0, 5.0],
        short,
    ];
    for points in [solid, inner] {
        for turn in 0..40 {
            let (sine, cosine) = (0.17 * f64::from(turn)).sin_cos();
            let place = |[x, y]: [f64; 2]| {
                let corner = vector(17.1 / 3.0, -2.0 / 7.0);
                corner + vector(cosine * x - sine * y, sine * x + cosine * y)
            };
            let placed = points.iter().map(|&p| place(p)).collect();
            let walls = Walls::new(vec![Polygon::new(placed).unwrap()]);
            let all: Vec<u32> = (0..walls.len() as u32).collect();
            for k in 1..500 {
                let x = 1e-4 * f64::from(k);
                let from = place([x, x * f64::from(1 + k % 12)]);
                let to = from + (place([0.0, 0.0]) - from) * 1.7;
                let (stopped, _) = walls.stop(from, to, &all).unwrap();
                assert!(
                    walls
                        .iter()
                        .all(|wall| wall.faces(stopped) || !wall.faces(from))
                );
            }
        }
    }
}

#[test]
fn the_way_out_of_an_obstacle_is_the_nearest_free_point() {
    // Two boxes side by side: the nearest edge of the first leads into the second.
    let walls = Walls::new(vec![
        rectangle([0.0, 2.0], [0.0, 3.0]),
        rectangle([2.0, 4.0], [0.0, 3.0]),
    ]);
    let inside = vector(1.9, 1.0);
    assert_eq!(walls.obstacle_at(inside), Some(0));
    let free = walls.free_point_near(inside).unwrap();
    assert!((free - vector(1.9, 0.0)).norm() < 1e-5);
    assert_eq!(walls.obstacle_at(free), None);
}

#[test]
fn where_obstacles_overlap_the_nearest_free_point_may_be_a_corner_between_two() {
    // A cross of two bars: on all walls but the far ends, the point nearest to the middle lies in the other
    // bar. Agents used to be moved to a far end, 10 m away, although a free corner is 1.41 m away.
    let cross = Walls::new(vec![
        rectangle([-10.0, 10.0], [-1.0, 1.0]),
        rectangle([-1.0, 1.0], [-10.0, 10.0]),
    ]);
    let free = cross.free_point_near(vector(0.1, 0.2)).unwrap();
    assert!((free - vector(1.0, 1.0)).norm() < 1e-5, "{free}");
    assert_eq!(cross.obstacle_at(free), None);
}

/// In front of one wall of a corner, the way out was on the line of the other wall; by rounding it could be behind
/// that, and an agent that was moved there walked out of the room.
#[test]
fn the_way_out_into_a_corner_keeps_clear_of_both_walls() {
    for k in 0..1000 {
        let turn = nalgebra::Rotation2::new(0.0062 * f64::from(k));
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Vector::from);
        let exterior = Ring::new(corners.map(|p| turn * p).to_vec()).unwrap();
        let area = Area {
            exterior,
            holes: vec![],
        };
        let walls = Walls::new(vec![Polygon::enclosing(vec![area]).unwrap()]);
        let free = walls.free_point_near(turn * vector(-0.2, -0.1)).unwrap();
        for wall in walls.iter() {
            let gap = wall.signed_distance(free);
            assert!(gap > 0.9e-6, "turn {k}: {gap} m in front of a wall");
        }
    }
}

proptest! {
    #[test]
    fn a_wall_beyond_a_radius_has_no_point_within_it(
        corner in -1e6..1e6_f64,
        ends in prop::array::uniform4(-9.0..9.0_f64),
        p in prop::array::uniform2(-9.0..9.0_f64),
        radius in 0.0..9.0_f64,
    ) {
        let at = |x: f64, y: f64| vector(corner + x, corner - y);
        prop_assume!(at(ends[0], ends[1]) != at(ends[2], ends[3]));
        let wall = Wall::new(at(ends[0], ends[1]), at(ends[2], ends[3]), 0, 0);
        let p = at(p[0], p[1]);
        let distance = (wall.nearest_point(p).point - p).norm();
        prop_assert!(!wall.is_beyond(p, radius) || distance > radius);
        // The line is never farther than the wall.
        prop_assert!(!wall.is_beyond(p, distance));
    }
}

//! Voronoi cells: areas of lattices, sums over rooms, and the nearest person by brute force.

use crate::common::vector;
use proptest::prelude::*;
use sandbox::analysis::voronoi::{area, cells, disk, within};
use sandbox::engine::math::Vector;

/// The corners of [0, side]².
fn room(side: f64) -> Vec<Vector> {
    [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]]
        .map(Vector::from)
        .to_vec()
}

#[test]
fn the_cells_of_a_lattice_have_the_area_per_person() {
    let places = (-4..=4).flat_map(|i| (-4..=4).map(move |j| (f64::from(i), f64::from(j))));
    let skewed = places.map(|(i, j)| vector(0.7 * i + 0.35 * j, 0.6 * j) + vector(1e6, -3e5));
    let people: Vec<Vector> = skewed.collect();
    let found = cells(&people, |p| disk(p, 3.0, 8));
    let middle = area(&found[people.len() / 2].outline);
    assert!((middle - 0.7 * 0.6).abs() < 1e-9, "{middle}");
    // At the rim the circle limits cells.
    assert!(area(&found[0].outline) > 2.0);
}

#[test]
fn a_lone_person_has_the_polygon_that_approximates_the_circle() {
    for (segments, part) in [(1, 2.0), (3, 3.0), (100, std::f64::consts::PI)] {
        let [cell] = &cells(&[vector(3.0, -1.0)], |p| disk(p, 2.0, segments))[..] else {
            panic!("one person, one cell");
        };
        assert_eq!(cell.outline.len(), 4 * segments as usize);
        let off = area(&cell.outline) / (4.0 * part) - 1.0;
        assert!(off.abs() < 1e-3, "{segments}: {off}");
    }
}

#[test]
fn people_at_the_same_place_and_in_a_row_share_the_room() {
    let p = vector(1.0, 2.0);
    let tiny = f64::MIN_POSITIVE;
    let people = [p, vector(3.0, 2.0), p, vector(2.0, 2.0 + tiny), p];
    let found = cells(&people, |_| room(4.0));
    let shared: Vec<u32> = found.iter().map(|cell| cell.people).collect();
    assert_eq!(shared, [3, 1, 3, 1, 3]);
    let areas = found
        .iter()
        .map(|cell| area(&cell.outline) / f64::from(cell.people));
    let areas: Vec<f64> = areas.collect();
    assert!(
        (areas.iter().sum::<f64>() - 16.0).abs() < 1e-12,
        "{areas:?}"
    );
    assert!((areas[0] - 2.0).abs() < 1e-12 && (areas[3] - 4.0).abs() < 1e-12);
    assert!(cells(&[], |_| room(4.0)).is_empty());
}

#[test]
fn the_part_of_a_ring_in_a_window_has_the_area_of_both() {
    // A U around the window's middle: two arms of 1 m by 1 m are inside.
    let u = [
        [0.0, 0.0],
        [5.0, 0.0],
        [5.0, 3.0],
        [4.0, 3.0],
        [4.0, 1.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [0.0, 3.0],
    ];
    let u = u.map(Vector::from);
    let window = [[-1.0, 1.5], [6.0, 1.5], [6.0, 2.5], [-1.0, 2.5]].map(Vector::from);
    assert!((area(&within(&u, &window)) - 2.0).abs() < 1e-12);
    let reversed: Vec<Vector> = u.iter().rev().copied().collect();
    assert!((area(&within(&reversed, &window)) + 2.0).abs() < 1e-12);
    let apart = room(1.0)
        .iter()
        .map(|p| p + vector(9.0, 9.0))
        .collect::<Vec<_>>();
    assert!(within(&u, &apart).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// For any crowd, cells fill the room, and a point in a cell is nearer to its person than to all others.
    #[test]
    fn cells_fill_the_room_and_hold_what_is_nearest(
        places in prop::collection::vec((0.0..5.0_f64, 0.0..5.0_f64), 1..40),
        probes in prop::collection::vec((0.0..5.0_f64, 0.0..5.0_f64), 20),
    ) {
        let people: Vec<Vector> = places.iter().map(|&(x, y)| vector(x, y)).collect();
        let found = cells(&people, |_| room(5.0));
        let whole: f64 = found.iter().map(|cell| area(&cell.outline)).sum();
        prop_assert!((whole - 25.0).abs() < 1e-9, "{}", whole);
        for (x, y) in probes {
            let p = vector(x, y);
            let nearest = people.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
            for (cell, person) in found.iter().zip(&people) {
                let ends = cell.outline.iter().cycle().skip(1);
                let mut sides = cell.outline.iter().zip(ends);
                if sides.all(|(a, b)| (b - a).perp(&(p - a)) > 0.0) {
                    prop_assert!((person - p).norm() < nearest + 1e-9);
                }
            }
        }
    }
}

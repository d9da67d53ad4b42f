//! Velocities, crossings and fundamental diagrams of known motions.

use crate::common::tracks::{self, tracks};
use crate::common::vector;
use proptest::prelude::*;
use sandbox::analysis::crossing::{Line, Passages};
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Region;
use sandbox::lab::measure::{
    CLASS, Classes, Crossings, Density, MeasureError, Measured, Options, Site, measure, speed,
};
use sandbox::scenario::trajectories::Tracks;

const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const PART: Passages = Passages::Parts([0.1, 0.9]);

fn line(start: [f64; 2], end: [f64; 2]) -> Line {
    Line {
        start: Vector::from(start),
        end: Vector::from(end),
    }
}

/// A line upward along x = 0: forward is to the right.
fn gate() -> Line {
    line([0.0, -1.0], [0.0, 1.0])
}

fn measured(tracks: &Tracks, regions: Vec<Region>, lines: Vec<Line>) -> Measured {
    let options = Options {
        regions,
        lines,
        ..tracks::options()
    };
    measure(tracks, &Site::new(Vec::new()), &options, |_| {
        Ok::<(), MeasureError>(())
    })
    .unwrap()
}

/// A column of `people`, `spacing` apart, that walks to the right at `speed`; the first starts at x = −0.3.
fn column(people: i64, spacing: f64, speed: f64, frames: i64) -> Tracks {
    let rows: Vec<_> = (0..people)
        .flat_map(|id| {
            (0..frames).map(move |frame| {
                let x = -0.3 - spacing * id as f64 + speed * frame as f64 / 25.0;
                (id, frame, x, 0.1)
            })
        })
        .collect();
    tracks(25.0, &rows)
}

#[test]
fn a_column_has_the_flow_of_its_line_density_times_its_speed() {
    let (spacing, v) = (0.7, 1.3);
    let tracks = column(40, spacing, v, 500);
    let crossings = Crossings::of(&tracks, 1, gate(), ALWAYS);
    let passed = ((v * 499.0 / 25.0 - 0.3) / spacing).floor() as usize + 1;
    assert_eq!((crossings.list.len(), passed), (37, 37));
    for (k, crossing) in crossings.list.iter().enumerate() {
        let time = (0.3 + spacing * k as f64) / v;
        assert!((crossing.time - time).abs() < 1e-12 && crossing.id == k as i64);
        assert!(crossing.frame as f64 / 25.0 >= crossing.time);
        assert!(crossing.x.abs() < 1e-12 && (crossing.y - 0.1).abs() < 1e-12);
        assert_eq!((crossing.direction, crossing.forward), (1, k as u64 + 1));
    }
    assert!((crossings.way(1, PART).flow_per_s.unwrap() - v / spacing).abs() < 1e-12);
    assert_eq!(crossings.way(-1, PART).flow_per_s, None);
    let between = crossings.way(1, Passages::Ranks([11, 31])).part.unwrap();
    assert!((between.flow_per_s - v / spacing).abs() < 1e-12);
    // Only crossings in the given time interval count.
    let later = Crossings::of(&tracks, 1, gate(), [10.0, 15.0]);
    let within = crossings
        .list
        .iter()
        .filter(|c| (10.0..=15.0).contains(&c.time));
    assert_eq!(later.list.len(), within.count());
    // With the line reversed, the same crossings are backward.
    let turned = Crossings::of(&tracks, 1, line([0.0, 1.0], [0.0, -1.0]), ALWAYS);
    assert_eq!(turned.passages(-1).count(), 37);
}

#[test]
fn velocities_of_uniform_motion_are_exact_and_one_sided_at_the_ends() {
    let v = vector(0.8, -0.5);
    let rows: Vec<_> = (0..30)
        .map(|frame| {
            let p = vector(3.0, 2.0) + v * (frame as f64 / 16.0);
            (9, frame, p.x, p.y)
        })
        .collect();
    for reach in [1, 5, 12] {
        for velocity in speed::velocities(&tracks(16.0, &rows), reach) {
            assert!((velocity.unwrap() - v).norm() < 1e-12);
        }
    }
    // Without a full window in either direction, the velocity is unknown.
    let short = speed::velocities(&tracks(16.0, &rows[..6]), 5);
    let known: Vec<bool> = short.iter().map(Option::is_some).collect();
    assert_eq!(known, [true, false, false, false, false, true]);
}

#[test]
fn accelerating_people_have_the_mean_velocity_of_the_window() {
    let rows: Vec<_> = (0..21)
        .map(|f| (1, f, (f * f) as f64 * 0.01, 0.0))
        .collect();
    let velocities = speed::velocities(&tracks(10.0, &rows), 5);
    for (f, velocity) in velocities.iter().enumerate() {
        let (from, to) = (f.saturating_sub(5), (f + 5).min(20));
        let (from, to) = if f < 5 {
            (f, to)
        } else if f > 15 {
            (from, f)
        } else {
            (from, to)
        };
        let mean = 0.01 * (to * to - from * from) as f64 / ((to - from) as f64 / 10.0);
        assert!((velocity.unwrap().x - mean).abs() < 1e-12, "{f}");
    }
}

#[test]
fn no_motion_is_measured_across_a_gap() {
    // The person is missing from frame 10 to 19, while crossing the line.
    let rows: Vec<_> = (0..30)
        .filter(|frame| !(10..20).contains(frame))
        .map(|frame| (1, frame, frame as f64 * 0.1 - 1.45, 0.0))
        .collect();
    let tracks = tracks(10.0, &rows);
    let crossings = Crossings::of(&tracks, 1, gate(), ALWAYS);
    assert_eq!((crossings.list.len(), crossings.across_gaps), (0, 1));
    for (k, velocity) in speed::velocities(&tracks, 3).into_iter().enumerate() {
        assert!((velocity.unwrap().x - 1.0).abs() < 1e-12, "{k}");
    }
    // With a window wider than either part, no velocity is known.
    let wide = speed::velocities(&tracks, 10);
    assert!(wide.iter().all(Option::is_none));
}

#[test]
fn a_person_who_oscillates_across_a_line_passes_it_once() {
    let way = [-1.0, 0.1, -0.1, 0.0, 0.2, -0.2, 0.3, 1.0];
    let rows: Vec<_> = (0..8).map(|k| (1, k as i64, way[k], 0.0)).collect();
    let crossings = Crossings::of(&tracks(10.0, &rows), 1, gate(), ALWAYS);
    let directions: Vec<i8> = crossings.list.iter().map(|c| c.direction).collect();
    // 0.0 is on the line, which counts as its right side.
    assert_eq!(directions, [1, -1, 1, -1, 1]);
    assert_eq!(
        (
            crossings.passages(1).count(),
            crossings.passages(-1).count()
        ),
        (1, 0)
    );
    assert_eq!(crossings.list.last().unwrap().net, 1);
}

#[test]
fn a_crossing_where_two_lines_join_counts_once() {
    let rows = [
        (1, 0, -1.0, 0.0),
        (1, 1, 1.0, 0.0),
        (2, 0, -1.0, 1.5),
        (2, 1, 1.0, 1.5),
    ];
    let tracks = tracks(10.0, &rows);
    let ids = |line| -> Vec<i64> {
        let crossings = Crossings::of(&tracks, 1, line, ALWAYS);
        crossings.list.iter().map(|c| c.id).collect()
    };
    assert!(ids(line([0.0, -1.0], [0.0, 0.0])).is_empty());
    assert_eq!(ids(line([0.0, 0.0], [0.0, 1.0])), [1]);
}

#[test]
fn a_region_has_the_density_and_speed_of_the_people_in_it() {
    let rows: Vec<_> = (0..40)
        .flat_map(|frame| {
            let x = frame as f64 * 0.1;
            [
                (1, frame, x, 0.0),
                (2, frame, x + 0.3, 0.0),
                (3, frame, 50.0, 0.0),
            ]
        })
        .collect();
    let region = |x: [f64; 2]| Region {
        min: vector(x[0], -1.0),
        max: vector(x[1], 1.0),
    };
    let tracks = tracks(10.0, &rows);
    let regions = vec![
        region([1.0, 3.0]),
        region([49.0, 51.0]),
        region([90.0, 91.0]),
    ];
    let found = measured(&tracks, regions, Vec::new());
    let [walking, standing, empty] = found.diagrams.as_slice() else {
        panic!("three regions");
    };
    assert!(empty.frames.iter().all(|frame| frame.people == 0));
    assert!(empty.of_persons.is_empty());
    for frame in standing.frames.iter().filter(|frame| frame.people > 0) {
        assert_eq!((frame.people, frame.speed), (1, Some(0.0)));
        assert_eq!(frame.sph_at_people, Some(0.0), "no other agent is near");
        assert_eq!(frame.classic, Some(1.0 / 4.0));
    }
    for frame in walking.frames.iter().filter(|frame| frame.people > 0) {
        let (speed, flow) = (frame.speed.unwrap(), frame.flow(Density::Classic).unwrap());
        assert!((speed - 1.0).abs() < 1e-12 && (flow - frame.people as f64 / 4.0).abs() < 1e-12);
    }
    for diagram in &found.diagrams {
        let count = |classes: Option<&Classes>| -> usize {
            let classes = classes.into_iter().flat_map(|classes| classes.values());
            classes.map(|class| class.density.count).sum()
        };
        let people: usize = diagram.frames.iter().map(|frame| frame.people).sum();
        for kind in [Density::SphAtPeople, Density::Voronoi] {
            assert_eq!(count(diagram.of_persons.get(&kind)), people);
        }
        let with_people = diagram.frames.iter().filter(|frame| frame.people > 0);
        let with_people = with_people.count();
        for kind in [Density::SphAtPeople, Density::SphField, Density::Classic] {
            assert_eq!(count(diagram.of_frames.get(&kind)), with_people);
        }
        for (&k, class) in diagram.of_persons.values().flatten() {
            let within = k as f64 * CLASS..(k + 1) as f64 * CLASS;
            assert!(class.density.count == 0 || within.contains(&class.density.mean));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// For any motion, counts never decrease, the net count is the number of people that changed sides, and every
    /// person passes at most once.
    #[test]
    fn counts_add_up(steps in prop::collection::vec((0_i64..6, -1.0..1.0_f64), 60)) {
        let mut x = [0.5; 6];
        let mut rows: Vec<_> = (0..6).map(|id| (id, 0, 0.5, 0.0)).collect();
        for (frame, &(walker, dx)) in steps.iter().enumerate() {
            x[walker as usize] += dx;
            rows.extend((0..6).map(|id| (id, frame as i64 + 1, x[id as usize], 0.0)));
        }
        let crossings = Crossings::of(&tracks(10.0, &rows), 1, gate(), ALWAYS);
        let behind = x.iter().filter(|&&x| x < 0.0).count() as i64;
        prop_assert_eq!(crossings.list.last().map_or(0, |last| last.net), -behind);
        let counts = crossings.list.iter().map(|c| (c.forward, c.backward));
        let pairs = counts.clone().zip(counts.skip(1));
        for ((forward, backward), (next_forward, next_backward)) in pairs {
            prop_assert!(forward <= next_forward && backward <= next_backward);
        }
        prop_assert!(crossings.list.iter().is_sorted_by(|a, b| a.time <= b.time));
        prop_assert!(crossings.passages(-1).count() <= 6 && crossings.passages(1).count() == 0);
    }
}

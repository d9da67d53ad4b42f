//! Densities of regions side by side: people per area, Voronoi cells between walls, the mean of the SPH field.

use crate::common::tracks::{measured, options, tracks};
use crate::common::vector;
use sandbox::analysis::crossing::Passages;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Region;
use sandbox::lab::measure::{
    CellLimit, Density, MeasureError, Measured, Moment, Options, Site, Tessellation, measure,
};
use sandbox::scenario::floor_plan::parse_wkt;
use sandbox::scenario::trajectories::Tracks;

fn site(plan: &str) -> Site {
    Site::new(parse_wkt(plan).unwrap().solids().unwrap())
}

fn square(side: f64) -> Site {
    site(&format!(
        "POLYGON ((0 0, {side} 0, {side} {side}, 0 {side}, 0 0))"
    ))
}

fn region(min: [f64; 2], max: [f64; 2]) -> Region {
    let [min, max] = [min, max].map(|p| p.into());
    Region { min, max }
}

/// The areas of the cells of people, limited by walls alone.
fn areas(site: &Site, people: &[[f64; 2]]) -> Vec<f64> {
    let limit = CellLimit {
        cut_off: None,
        ..CellLimit::default()
    };
    let people: Vec<Vector> = people.iter().map(|&p| p.into()).collect();
    let cells = Tessellation::new(site, limit)
        .unwrap()
        .cells(&people, &people);
    cells
        .iter()
        .map(|cell| cell.as_ref().map_or(0.0, |cell| cell.area))
        .collect()
}

#[test]
fn cells_fill_the_floor_between_obstacles() {
    let pillar =
        "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1.5 1.5, 2.5 1.5, 2.5 2.5, 1.5 2.5, 1.5 1.5))";
    let people = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
    for area in areas(&site(pillar), &people) {
        assert!((area - 15.0 / 4.0).abs() < 1e-5, "{area}");
    }
    // A pillar inside the cell of the only person is a hole in it.
    let [area] = areas(&site(pillar), &[[0.5, 0.5]])[..] else {
        panic!("one person, one cell");
    };
    assert!((area - 15.0).abs() < 1e-5, "{area}");
}

#[test]
fn a_cell_ends_at_a_wall_and_does_not_continue_behind_it() {
    // A room of 4 m by 4 m, cut from above by a thin wall down to y = 1.
    let plan = "POLYGON ((0 0, 4 0, 4 4, 2.1 4, 2.1 1, 2 1, 2 4, 0 4, 0 0))";
    let people = [[1.8, 3.0], [3.5, 0.2]];
    let [left, right] = areas(&site(plan), &people)[..] else {
        panic!("two people, two cells");
    };
    // The bisector passes right of the wall's end: behind the wall, above it, a triangle is lost to both.
    let whole = 16.0 - 0.1 * 3.0;
    assert!(
        left > 0.0 && right > 0.0 && left + right < whole - 0.5,
        "{left} {right}"
    );
    let open = areas(&square(4.0), &people);
    assert!((open.iter().sum::<f64>() - 16.0).abs() < 1e-9);
    // A person in the wall counts where it can stand; one deep inside has no cell.
    let solid =
        site("MULTIPOLYGON (((0 0, 2 0, 2 4, 0 4, 0 0)), ((30 0, 34 0, 34 4, 30 4, 30 0)))");
    let cut_off = CellLimit {
        cut_off: Some(1.0),
        quad_segments: 100,
    };
    let cells = Tessellation::new(&solid, cut_off).unwrap();
    let [in_wall, deep] = [vector(2.05, 2.0), vector(16.0, 2.0)];
    let cells = cells.cells(&[in_wall, deep], &[vector(2.0, 2.0), deep]);
    let area = cells[0].as_ref().unwrap().area;
    let half = std::f64::consts::PI / 2.0 - 2.0 * 0.05;
    assert!((area - half).abs() < 1e-3, "{area}");
    assert_eq!(cells[1], None);
}

/// People at the centers of squares of side `spacing` in a room of 4 m by 4 m, in `frames` frames.
fn lattice(spacing: f64, frames: std::ops::Range<i64>) -> Tracks {
    let side = (4.0 / spacing).round() as i64;
    let places = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    let rows = places.flat_map(|(i, j)| {
        let [x, y] = [i, j].map(|k| (k as f64 + 0.5) * spacing);
        frames.clone().map(move |frame| (side * i + j, frame, x, y))
    });
    tracks(10.0, &rows.collect::<Vec<_>>())
}

#[test]
fn all_densities_of_a_region_in_a_uniform_crowd_are_people_per_area() {
    let mut options = options();
    options.regions = vec![
        region([1.0, 1.0], [3.0, 3.0]),
        region([3.0, -1.0], [5.0, 3.0]),
    ];
    options.cell = 0.1;
    let (found, moments) = measured(&lattice(0.25, 0..1), &square(4.0), &options);
    let walkable: Vec<f64> = found
        .diagrams
        .iter()
        .filter_map(|all| all.walkable)
        .collect();
    assert!((walkable[0] - 4.0).abs() < 1e-6 && (walkable[1] - 3.0).abs() < 1e-6);
    for state in &moments[0].regions {
        assert!((state.classic - 16.0).abs() < 1e-5, "{state:?}");
        assert!((state.voronoi - 16.0).abs() < 1e-4, "{state:?}");
        assert!((state.voronoi_covered - 1.0).abs() < 1e-5, "{state:?}");
        assert!((state.sph_field / 16.0 - 1.0).abs() < 0.02, "{state:?}");
    }
    for person in &moments[0].people {
        assert!((person.voronoi.unwrap() - 16.0).abs() < 1e-3, "{person:?}");
    }
}

#[test]
fn sparse_walkers_are_not_shown_at_the_density_of_their_own_kernel() {
    // 27 people on 100 m², everywhere with the same probability.
    let places = (0..27).map(|k| {
        (
            10.0 * (f64::from(k) * 0.618).fract(),
            f64::from(k) / 2.7 + 0.1,
        )
    });
    let rows = places.enumerate().map(|(id, (x, y))| (id as i64, 0, x, y));
    let mut options = options();
    options.regions = vec![region([0.0, 0.0], [10.0, 10.0])];
    options.cell = 0.1;
    let tracks = tracks(10.0, &rows.collect::<Vec<_>>());
    let (found, moments) = measured(&tracks, &square(10.0), &options);
    let state = moments[0].regions[0];
    assert!((state.classic - 0.27).abs() < 1e-6);
    assert!((state.sph_field - 0.27).abs() < 0.01, "{state:?}");
    assert!((state.voronoi - 0.27).abs() < 1e-6, "{state:?}");
    let others = found.overview.density_of_others.mean;
    assert!(
        others < 0.27 && found.overview.density.mean > 1.27,
        "{others}"
    );
    for person in &moments[0].people {
        let own = 4.0 / std::f64::consts::PI;
        let without = person.density - person.density_of_others;
        assert!(
            without > own - 1e-9,
            "near walls, what is behind them includes it, too"
        );
    }
}

#[test]
fn means_over_time_include_frames_in_which_a_region_is_empty() {
    let mut options = options();
    options.regions = vec![region([0.0, 0.0], [4.0, 4.0])];
    let (full, _) = measured(&lattice(0.5, 0..4), &square(4.0), &options);
    let mean = |found: &Measured, kind| {
        let count = found.overview.frames;
        found.diagrams[0].means(kind, count).unwrap().density.mean
    };
    for kind in [Density::Classic, Density::Voronoi] {
        assert!((mean(&full, kind) - 4.0).abs() < 1e-4, "{kind:?}");
    }
    // Four frames with people, four without, then one person far away.
    let mut rows: Vec<(i64, i64, f64, f64)> = Vec::new();
    for frame in (0..4).chain([8]) {
        rows.push((1, frame, if frame == 8 { 40.0 } else { 2.0 }, 2.0));
    }
    let (found, _) = measured(&tracks(10.0, &rows), &Site::new(Vec::new()), &options);
    assert_eq!(found.overview.frames, 9);
    for kind in [Density::Classic, Density::SphField, Density::Voronoi] {
        let mean = mean(&found, kind);
        assert!((mean - 4.0 / 9.0 / 16.0).abs() < 2e-4, "{kind:?}: {mean}");
    }
}

#[test]
fn the_flow_between_two_passages_is_their_number_over_their_time() {
    let times: Vec<f64> = (0..11).map(|k| f64::from(k * k)).collect();
    let flow = |passages: Passages| passages.flow(&times);
    let parts = flow(Passages::Parts([0.1, 0.9])).unwrap();
    assert_eq!((parts.passages, parts.secs), ([2, 10], [1.0, 81.0]));
    assert!((parts.flow_per_s - 8.0 / 80.0).abs() < 1e-12);
    let ranks = flow(Passages::Ranks([3, 5])).unwrap();
    assert!((ranks.flow_per_s - 2.0 / 12.0).abs() < 1e-12);
    assert_eq!(flow(Passages::Ranks([3, 12])), None, "there are 11");
    assert_eq!(Passages::Parts([0.1, 0.9]).flow(&[1.0]), None);
}

#[test]
fn what_cannot_be_measured_is_an_error() {
    let mut options = options();
    let tracks = tracks(10.0, &[(1, 0, 2.0, 2.0)]);
    let refused = |site: &Site, options: &Options| {
        let ignore = |_: &[Moment]| Ok::<(), MeasureError>(());
        measure(&tracks, site, options, ignore)
            .err()
            .unwrap()
            .to_string()
    };
    options.regions = vec![
        region([0.0, 0.0], [1.0, 1.0]),
        region([5.0, 0.0], [6.0, 1.0]),
    ];
    assert!(refused(&square(4.0), &options).starts_with("region 2 is outside"));
    options.regions.clear();
    options.cells.cut_off = None;
    let open = Site::new(Vec::new());
    assert!(refused(&open, &options).contains("--voronoi-cutoff"));
}

//! Measured densities: those of the engine and of lattices, and fields that contain all people.

use std::collections::BTreeMap;

use crate::common::tracks::{measured, options, tracks};
use crate::common::{blend, block, rectangle, room, scene, vector};
use rusqlite::Connection;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::kernel;
use sandbox::engine::scene::Region;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::measure::{Behind, Measured, Options, Site};
use sandbox::output::trajectory::Trajectory;
use sandbox::scenario::floor_plan::parse_wkt;
use sandbox::scenario::trajectories::{ReadOptions, Tracks, read};

/// Runs a crowd through a door, writes every frame, and measures the file with its walls and masses and with the
/// engine's rest density.
#[test]
fn densities_measured_in_a_trajectory_are_those_of_the_engine() {
    for walls in [
        WallMethod::Representative,
        WallMethod::Exact,
        WallMethod::Union,
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.sqlite");
        let mut scene = scene(vec![room(4.0, 0.8)], blend("sph"));
        scene.wall_method = walls;
        scene.groups[0].removal_radius = Some(0.5);
        scene.agents = block(vector(0.3, 0.3), 8, 8, 0.45, vector(6.0, 2.0));
        let mut simulation = Simulation::new(scene).unwrap();
        let view = Region {
            min: vector(0.0, 0.0),
            max: vector(4.0, 4.0),
        };
        let mut file = Trajectory::create(&path, &mut simulation, view, 50.0).unwrap();
        for _ in 0..150 {
            simulation.evaluate().unwrap();
            file.log(&simulation).unwrap();
            simulation.integrate().unwrap();
        }
        file.finish().unwrap();
        assert!(simulation.frame().agents.len() < 64, "some have left");

        let tracks = read(&path, &ReadOptions::default()).unwrap();
        let site = Site::new(parse_wkt(&tracks.walkable[0]).unwrap().solids().unwrap());
        let mut as_engine = options();
        as_engine.kernel.walls = walls;
        as_engine.behind = Behind::Rest(5.0);
        let (_, moments) = measured(&tracks, &site, &as_engine);

        let connection = Connection::open(&path).unwrap();
        let mut query = connection
            .prepare("SELECT frame, id, density FROM trajectory_data")
            .unwrap();
        let own = query.query_map([], |row| Ok(((row.get(0)?, row.get(1)?), row.get(2)?)));
        let mut own: BTreeMap<(i64, i64), f64> = own.unwrap().map(Result::unwrap).collect();
        let mut from_walls: f64 = 0.0;
        for moment in &moments {
            for person in &moment.people {
                let own = own.remove(&(moment.frame, person.id)).unwrap();
                let off = (person.density - own).abs();
                assert!(
                    off < 1e-9 * own,
                    "{walls:?}, {} in {}: {off}",
                    person.id,
                    moment.frame
                );
                from_walls = from_walls.max(person.density_from_walls);
            }
        }
        assert!(own.is_empty() && from_walls > 1.0);
    }
}

/// A square lattice centered at the origin, as one frame.
fn lattice(spacing: f64, half: i32) -> Vec<(i64, i64, f64, f64)> {
    let places = (-half..=half).flat_map(|i| (-half..=half).map(move |j| (i, j)));
    let rows = places.enumerate();
    rows.map(|(id, (i, j))| {
        let [x, y] = [i, j].map(|k| f64::from(k) * spacing);
        (id as i64, 0, x, y)
    })
    .collect()
}

#[test]
fn the_density_of_a_lattice_is_its_kernel_sum_for_any_radius() {
    for (spacing, h) in [(0.5, 1.0), (0.37, 1.3), (1.2, 1.0)] {
        let rows = lattice(spacing, 6);
        let sum: f64 = rows
            .iter()
            .map(|&(_, _, x, y)| kernel::density(x * x + y * y, h))
            .sum();
        let mut options = options();
        options.kernel.support_radius = h;
        let (_, moments) = measured(&tracks(10.0, &rows), &Site::new(Vec::new()), &options);
        let center = moments[0].people[rows.len() / 2];
        assert_eq!(center.position, vector(0.0, 0.0));
        assert!((center.density - sum).abs() < 1e-12 * sum);
        assert_eq!(center.density_from_walls, 0.0);
    }
}

/// A walkable room [0, 4]² with people at the centers of squares of side `spacing`.
fn full_room(spacing: f64) -> (Site, Tracks) {
    let plan = parse_wkt("POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))").unwrap();
    let side = (4.0 / spacing).round() as i64;
    let places = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    let rows: Vec<_> = places
        .map(|(i, j)| {
            let [x, y] = [i, j].map(|k| (k as f64 + 0.5) * spacing);
            (side * i + j, 0, x, y)
        })
        .collect();
    (Site::new(plan.solids().unwrap()), tracks(10.0, &rows))
}

#[test]
fn a_uniform_crowd_is_as_dense_at_walls_and_in_corners_as_elsewhere() {
    for spacing in [0.25, 0.4] {
        let (site, tracks) = full_room(spacing);
        let uniform = 1.0 / (spacing * spacing);
        let (whole, moments) = measured(&tracks, &site, &options());
        for person in &moments[0].people {
            let off = person.density / uniform - 1.0;
            assert!(off.abs() < 0.04, "{}: {off}", person.position);
        }
        let (mean, count) = (whole.overview.density.mean, whole.overview.rows);
        assert!((mean / uniform - 1.0).abs() < 0.01, "{mean} of {count}");
        // Without walls, the density in a corner is lower.
        let (_, open) = measured(&tracks, &Site::new(Vec::new()), &options());
        assert!(open[0].people[0].density < 0.7 * uniform);
    }
}

#[test]
fn people_behind_a_thin_wall_count_only_with_the_method_of_the_engine() {
    // Two rooms [0, 2] × [0, 4] m and [2.1, 4.1] × [0, 4] m, both full.
    let plan = "MULTIPOLYGON (((0 0, 2 0, 2 4, 0 4, 0 0)), ((2.1 0, 4.1 0, 4.1 4, 2.1 4, 2.1 0)))";
    let site = Site::new(parse_wkt(plan).unwrap().solids().unwrap());
    let (spacing, uniform) = (0.25, 16.0);
    let places = (0..16).flat_map(|i| (0..16).map(move |j| (i, j)));
    let rows: Vec<_> = places
        .map(|(i, j)| {
            let x = (i as f64 + 0.5) * spacing + if i < 8 { 0.0 } else { 0.1 };
            (16 * i + j, 0, x, (j as f64 + 0.5) * spacing)
        })
        .collect();
    let tracks = tracks(10.0, &rows);
    let (fields, moments) = measured(&tracks, &site, &options());
    for person in &moments[0].people {
        let off = person.density / uniform - 1.0;
        assert!(off.abs() < 0.04, "{}: {off}", person.position);
    }
    let densest = fields.fields.means(1).flatten().map(|mean| mean.density);
    let densest = densest.fold(0.0, f64::max);
    assert!((uniform..1.1 * uniform).contains(&densest), "{densest}");
    let engine = Options {
        behind: Behind::Rest(f64::INFINITY),
        ..options()
    };
    let (_, moments) = measured(&tracks, &site, &engine);
    let densest = moments[0].people.iter().map(|person| person.density);
    assert!(densest.fold(0.0, f64::max) > 1.15 * uniform);
}

/// ∫ρ over all cells.
fn mass(measured: &Measured) -> f64 {
    let cell = measured.fields.grid.cell;
    let means = measured.fields.means(measured.overview.frames).flatten();
    means.map(|mean| mean.density * cell * cell).sum()
}

#[test]
fn the_field_integrates_to_the_number_of_people() {
    // People spread over several meters with all kernels inside the grid. Half of the people are present only half
    // of the time.
    let places = (0..60).map(|k| {
        let k = f64::from(k);
        (7.0 * (k * 0.618).fract(), 5.0 * (k * 0.7548).fract())
    });
    let rows: Vec<_> = places
        .enumerate()
        .flat_map(|(id, (x, y))| {
            let frames = if id % 2 == 0 { 0..4 } else { 0..2 };
            frames.map(move |frame| (id as i64, frame, x, y))
        })
        .collect();
    let tracks = tracks(10.0, &rows);
    let mut errors = Vec::new();
    for cell in [0.5, 0.25, 0.125] {
        let options = Options { cell, ..options() };
        let (open, _) = measured(&tracks, &Site::new(Vec::new()), &options);
        errors.push((mass(&open) / 45.0 - 1.0).abs());
        let people: f64 = open.fields.means(4).flatten().map(|mean| mean.people).sum();
        assert!((people - 45.0).abs() < 1e-9);
    }
    assert!(
        errors[0] < 0.02 && errors[1] < 1e-3 && errors[2] < 1e-4,
        "{errors:?}"
    );
    // In a full room, hidden parts of the kernels count too, so that the integral is still the number of people.
    let (site, tracks) = full_room(0.25);
    let (walled, _) = measured(
        &tracks,
        &site,
        &Options {
            cell: 0.125,
            ..options()
        },
    );
    assert!(
        (mass(&walled) / 256.0 - 1.0).abs() < 0.01,
        "{}",
        mass(&walled)
    );
}

#[test]
fn the_field_at_a_person_is_the_persons_density() {
    // Only the first person stands at the center of a cell; a wall is near.
    let rows = [(1, 0, 0.125, 0.125), (2, 0, 0.6, 0.3), (3, 0, -0.4, 0.9)];
    let site = Site::new(vec![rectangle([-5.0, 5.0], [-1.0, 0.0])]);
    let (measured, moments) = measured(&tracks(10.0, &rows), &site, &options());
    let grid = &measured.fields.grid;
    let at = (0..grid.len()).find(|&k| (grid.center(k) - vector(0.125, 0.125)).norm() < 1e-9);
    let means: Vec<_> = measured.fields.means(1).collect();
    let field = means[at.unwrap()].unwrap().density;
    assert!((field - moments[0].people[0].density).abs() < 1e-12 * field);
    let inside = (0..grid.len()).filter(|&k| site.is_inside(grid.center(k)));
    assert!(inside.clone().count() > 0 && inside.clone().all(|k| means[k].is_none()));
}

#[test]
fn people_inside_a_wall_are_counted_and_measured_at_its_face() {
    let site = Site::new(vec![rectangle([-5.0, 5.0], [-3.0, 0.0])]);
    let (measured, moments) = measured(&tracks(10.0, &[(1, 0, 0.0, -0.05)]), &site, &options());
    let alone = kernel::density(0.0, 1.0);
    // Half of the kernel is hidden at the face.
    assert!((moments[0].people[0].density - 2.0 * alone).abs() < 1e-4);
    let (rows, depth) = measured.overview.inside;
    assert!(rows == 1 && (depth - 0.05).abs() < 1e-5);
}

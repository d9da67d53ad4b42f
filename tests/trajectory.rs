//! Trajectories are written, read back and compared with the simulation, bit for bit.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common;
use crate::common::{bits, blend, block, person, polygon, rectangle, room, scene, vector};
use rusqlite::Connection;
use sandbox::engine::clock::Clock;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::{Region, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::output::trajectory::Trajectory;
use sandbox::scenario::{SHIPPED, Scenario};

const VIEW: Region = Region {
    min: Vector::new(0.0, 0.0),
    max: Vector::new(1.0, 1.0),
};

/// A crowd with social forces only, so that only the trajectory requests densities. Some agents leave.
fn small_crowd() -> Scene {
    let mut scene = scene(vec![room(4.0, 0.8)], blend("sf"));
    scene.groups[0].removal_radius = Some(0.5);
    scene.agents = block(vector(0.4, 0.4), 6, 6, 0.6, vector(3.5, 2.0));
    scene
}

/// Runs `scene` for `frames` frames and writes them to all of `paths`.
fn written(scene: Scene, frames: u64, paths: &[PathBuf], fps: f64) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    let create = |path: &PathBuf| Trajectory::create(path, &mut simulation, VIEW, fps).unwrap();
    let mut files: Vec<Trajectory> = paths.iter().map(create).collect();
    for _ in 0..frames {
        simulation.evaluate().unwrap();
        files
            .iter_mut()
            .for_each(|file| file.log(&simulation).unwrap());
        simulation.integrate().unwrap();
    }
    files.into_iter().for_each(|file| file.finish().unwrap());
    simulation
}

/// The expected contents of a file by frame and id: the quantities in `NAMES`.
type Truth = BTreeMap<(u64, u32), [f64; 9]>;

const NAMES: [&str; 9] = [
    "pos_x",
    "pos_y",
    "speed",
    "density",
    "pressure",
    "mean_density",
    "acc_x",
    "goal_y",
    "radius",
];

fn truth(scene: Scene, frames: u64, every: u64) -> Truth {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.request_density_until(u64::MAX);
    let mut truth = Truth::new();
    for k in 0..frames {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        for i in (0..agents.len()).filter(|_| k % every == 0) {
            let numbers = [
                agents.position[i].x,
                agents.position[i].y,
                agents.velocity[i].norm(),
                fields.density[i],
                fields.pressure[i],
                fields.mean_density[i],
                fields.acceleration[i].x,
                agents.goal[i].y,
                agents.radius[i],
            ];
            truth.insert((k / every, agents.id[i]), numbers);
        }
        simulation.integrate().unwrap();
    }
    truth
}

/// A folder, and the path of a file in it for each name.
fn files<const N: usize>(names: [&str; N]) -> (tempfile::TempDir, [PathBuf; N]) {
    let folder = tempfile::tempdir().unwrap();
    let paths = names.map(|name| folder.path().join(name));
    (folder, paths)
}

fn one_text(path: &Path, query: &str) -> String {
    let connection = Connection::open(path).unwrap();
    connection.query_row(query, [], |row| row.get(0)).unwrap()
}

fn one_count(path: &Path, query: &str) -> u64 {
    one_text(path, &format!("SELECT CAST(({query}) AS TEXT)"))
        .parse()
        .unwrap()
}

#[test]
fn sqlite_holds_the_simulation_bit_for_bit() {
    let (_folder, paths) = files(["crowd.sqlite"]);
    written(small_crowd(), 101, &paths, 10.0);
    let connection = Connection::open(&paths[0]).unwrap();
    let query = "SELECT frame, id, pos_x, pos_y, speed, density, pressure, ori_x, ori_y FROM trajectory_data";
    let mut query = connection.prepare(query).unwrap();
    let mut rows = query.query([]).unwrap();
    let mut truth = truth(small_crowd(), 101, 5);
    let all = truth.len();
    assert!((36 * 10..36 * 21).contains(&all), "some leave: {all}");
    while let Some(row) = rows.next().unwrap() {
        let frame: i64 = row.get(0).unwrap();
        let place = (frame.cast_unsigned(), row.get(1).unwrap());
        let expected = truth.remove(&place).unwrap();
        for (k, expected) in expected.iter().take(5).enumerate() {
            let found: f64 = row.get(k + 2).unwrap();
            assert_eq!(
                found.to_bits(),
                expected.to_bits(),
                "{place:?} {}",
                NAMES[k]
            );
        }
        let (x, y): (f64, f64) = (row.get(7).unwrap(), row.get(8).unwrap());
        assert!((x.hypot(y) - 1.0).abs() < 1e-12);
    }
    assert!(truth.is_empty());
    let path = &paths[0];
    assert_eq!(one_count(path, "SELECT count(*) FROM frame_data"), 21);
    assert_eq!(one_count(path, "SELECT max(frame) FROM frame_data"), 20);
    let joined = "SELECT count(*) FROM frame_data JOIN geometry ON hash = geometry_hash";
    assert_eq!(one_count(path, joined), 21);
    let metadata = |key: &str| {
        one_text(
            path,
            &format!("SELECT value FROM metadata WHERE key = '{key}'"),
        )
    };
    assert_eq!(metadata("version"), "2");
    assert_eq!(metadata("fps"), "10.0");
    assert_eq!(metadata("xmin"), "-6");
}

#[test]
fn text_and_csv_hold_the_simulation_bit_for_bit() {
    let (_folder, paths) = files(["crowd.txt", "crowd.csv"]);
    written(small_crowd(), 101, &paths, 25.0);
    let truth = truth(small_crowd(), 101, 2);

    let text = fs::read_to_string(&paths[0]).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("# framerate: 25.00"));
    assert_eq!(lines.next(), Some("# id frame x/m y/m z/m"));
    let mut count = 0;
    for line in lines {
        let cells: Vec<&str> = line.split('\t').collect();
        let expected = truth[&(cells[1].parse().unwrap(), cells[0].parse().unwrap())];
        let [x, y] = [cells[2], cells[3]].map(|cell| cell.parse::<f64>().unwrap());
        assert_eq!(
            [x, y].map(f64::to_bits),
            [expected[0], expected[1]].map(f64::to_bits)
        );
        assert_eq!(&cells[4..], ["0"]);
        count += 1;
    }
    assert_eq!(count, truth.len());

    let mut count = 0;
    for row in csv::Reader::from_path(&paths[1]).unwrap().deserialize() {
        let row: BTreeMap<String, String> = row.unwrap();
        let frame: u64 = row["frame"].parse().unwrap();
        let expected = truth[&(frame, row["id"].parse().unwrap())];
        for (name, expected) in NAMES.iter().zip(expected) {
            let found: f64 = row[*name].parse().unwrap();
            assert_eq!(found.to_bits(), expected.to_bits(), "{name}");
        }
        assert_eq!(row["time"].parse(), Ok(frame as f64 * 2.0 * 0.02));
        assert_eq!((&*row["group"], &*row["push"]), ("all", ""));
        count += 1;
    }
    assert_eq!(count, truth.len());
}

#[test]
fn writing_trajectories_does_not_change_the_motion() {
    for profile in ["sf", "sf->sph"] {
        let (_folder, paths) = files(["crowd.db", "crowd.txt", "crowd.csv"]);
        let mut scene = small_crowd();
        scene.groups[0].blend = blend(profile);
        let mut alone = Simulation::new(scene.clone()).unwrap();
        common::run(&mut alone, 60);
        let watched = written(scene, 60, &paths, 10.0);
        let motion = |simulation: &Simulation| -> Vec<_> {
            let without_mean = |(id, [x, y, u, v, _]): &(u32, [u64; 5])| (*id, [*x, *y, *u, *v]);
            bits(simulation).iter().map(without_mean).collect()
        };
        assert_eq!(motion(&watched), motion(&alone));
    }
}

#[test]
fn a_frame_rate_with_many_digits_is_written_in_full() {
    let (_folder, paths) = files(["crowd.txt", "crowd.sqlite"]);
    let mut scene = small_crowd();
    scene.clock = Clock::new(0.03, 3);
    written(scene, 10, &paths, 11.111111);
    let text = fs::read_to_string(&paths[0]).unwrap();
    let rate = text
        .split_whitespace()
        .nth(2)
        .unwrap()
        .parse::<f64>()
        .unwrap();
    assert_eq!(rate, 1.0 / 0.09);
    let fps = one_text(&paths[1], "SELECT value FROM metadata WHERE key = 'fps'");
    assert_eq!(fps.parse(), Ok(rate));
    assert_eq!(one_count(&paths[1], "SELECT count(*) FROM frame_data"), 4);
}

#[test]
fn an_aborted_run_leaves_whole_frames() {
    let (_folder, paths) = files(["crowd.txt", "crowd.db"]);
    let mut scene = small_crowd();
    scene.groups[0].removal_radius = None;
    let mut simulation = Simulation::new(scene).unwrap();
    let create = |path: &PathBuf| Trajectory::create(path, &mut simulation, VIEW, 50.0).unwrap();
    let mut files: Vec<Trajectory> = paths.iter().map(create).collect();
    // Databases store their rows once a second.
    for wait in [0, 1100, 0, 0] {
        simulation.evaluate().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(wait));
        files
            .iter_mut()
            .for_each(|file| file.log(&simulation).unwrap());
        simulation.integrate().unwrap();
    }
    drop(files);
    let lines = fs::read_to_string(&paths[0]).unwrap().lines().count();
    assert_eq!(lines, 2 + 4 * 36);
    let frames = one_count(&paths[1], "SELECT count(*) FROM frame_data");
    assert!((2..=4).contains(&frames), "{frames}");
    let rows = one_count(&paths[1], "SELECT count(*) FROM trajectory_data");
    assert_eq!(rows, frames * 36);
}

/// The rings of a polygon in well-known text: the outline, then the holes.
fn rings(wkt: &str) -> Vec<Polygon> {
    let inside = wkt
        .strip_prefix("POLYGON((")
        .unwrap()
        .strip_suffix("))")
        .unwrap();
    let point = |text: &str| {
        let (x, y) = text.split_once(' ').unwrap();
        vector(x.parse().unwrap(), y.parse().unwrap())
    };
    let ring = |text: &str| {
        let mut points: Vec<Vector> = text.split(',').map(point).collect();
        assert_eq!(points.pop(), points.first().copied());
        Polygon::new(points).unwrap()
    };
    inside.split("),(").map(ring).collect()
}

fn contains(rings: &[Polygon], p: Vector) -> bool {
    rings[0].contains(p) && !rings[1..].iter().any(|hole| hole.contains(p))
}

/// The walkable area of a scene after some frames, as well-known text.
fn area(scene: Scene, frames: u64) -> String {
    let (_folder, paths) = files(["area.sqlite"]);
    written(scene, frames, &paths, 10.0);
    one_text(&paths[0], "SELECT wkt FROM geometry")
}

#[test]
fn all_agents_stay_in_the_walkable_area_of_every_shipped_scenario() {
    for shipped in SHIPPED {
        let (_folder, [path]) = files(["run.sqlite"]);
        let scenario = Scenario::shipped(shipped.name, &[]).unwrap();
        let frames = if shipped.name == "plaza" { 11 } else { 151 };
        let obstacles = scenario.scene.walls.obstacles().to_vec();
        let mut simulation = Simulation::new(scenario.scene).unwrap();
        let view = scenario.view.region;
        let mut file = Trajectory::create(&path, &mut simulation, view, 10.0).unwrap();
        for _ in 0..frames {
            simulation.evaluate().unwrap();
            file.log(&simulation).unwrap();
            simulation.integrate().unwrap();
        }
        file.finish().unwrap();
        let rings = rings(&one_text(&path, "SELECT wkt FROM geometry"));
        assert_eq!(rings.len(), 1 + obstacles.len(), "{}", shipped.name);
        let corners: Vec<Vector> = rings
            .iter()
            .flat_map(|ring| ring.points().to_vec())
            .collect();
        let given = obstacles.iter().flat_map(|obstacle| obstacle.points());
        assert!(given.clone().all(|corner| corners.contains(corner)));
        let connection = Connection::open(&path).unwrap();
        let mut query = connection
            .prepare("SELECT pos_x, pos_y FROM trajectory_data")
            .unwrap();
        let mut rows = query.query([]).unwrap();
        while let Some(row) = rows.next().unwrap() {
            let p = vector(row.get(0).unwrap(), row.get(1).unwrap());
            assert!(contains(&rings, p), "{}: {p}", shipped.name);
        }
        for p in [view.min, view.max] {
            assert!(rings[0].contains(p));
        }
    }
}

#[test]
fn closed_rooms_are_walkable_only_if_an_agent_is_inside() {
    let ring = |x: f64| {
        let side = |dx: [f64; 2], y: [f64; 2]| rectangle([x + dx[0], x + dx[1]], y);
        // Some sides overlap at the corners, others only touch.
        [
            side([-1.0, 5.0], [-1.0, 0.0]),
            side([-1.0, 5.0], [4.0, 5.0]),
            side([-1.0, 0.0], [-0.3, 4.3]),
            side([4.0, 5.0], [0.0, 4.0]),
        ]
    };
    let mut rooms = scene([ring(0.0), ring(10.0)].concat(), blend("sph"));
    rooms.agents = vec![person(vector(1.0, 1.0), vector(3.0, 3.0))];
    let one = rings(&area(rooms.clone(), 1));
    assert_eq!(
        one,
        [rectangle([0.0, 4.0], [0.0, 4.0])].map(|room| rotated(&room, &one[0]))
    );
    rooms
        .agents
        .push(person(vector(11.0, 1.0), vector(13.0, 3.0)));
    let both = area(rooms, 1);
    assert!(
        both.starts_with("MULTIPOLYGON(((") && both.matches("((").count() == 2,
        "{both}"
    );
}

/// The same polygon, beginning at the first point of `other`.
fn rotated(polygon: &Polygon, other: &Polygon) -> Polygon {
    let mut points = polygon.points().to_vec();
    let first = points.iter().position(|p| *p == other.points()[0]).unwrap();
    points.rotate_left(first);
    Polygon::new(points).unwrap()
}

#[test]
fn the_area_grows_with_agents_that_walk_out_of_it() {
    let mut open = scene(Vec::new(), blend("sph"));
    open.agents = vec![person(vector(0.0, 0.0), vector(0.0, 0.0))];
    let start = rings(&area(open.clone(), 1));
    assert_eq!(start[0].area(), 11.0 * 11.0);
    // An agent in the same open plane, but outside of the walkable area.
    let (_folder, [path]) = files(["open.sqlite"]);
    let mut simulation = Simulation::new(open.clone()).unwrap();
    let mut file = Trajectory::create(&path, &mut simulation, VIEW, 10.0).unwrap();
    open.agents[0].position = vector(-7.5, 0.5);
    let mut elsewhere = Simulation::new(open).unwrap();
    elsewhere.request_density_until(1);
    elsewhere.evaluate().unwrap();
    file.log(&elsewhere).unwrap();
    file.finish().unwrap();
    let grown = rings(&one_text(&path, "SELECT wkt FROM geometry"));
    let expected = polygon(&[[-12.5, -5.0], [6.0, -5.0], [6.0, 6.0], [-12.5, 6.0]]);
    assert_eq!(grown, [rotated(&expected, &grown[0])]);
    assert_eq!(
        one_text(&path, "SELECT value FROM metadata WHERE key = 'xmin'"),
        "-12.5"
    );
}

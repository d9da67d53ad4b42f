//! Scenarios whose walls come from floor plans.

use crate::common;
use std::fs;
use std::path::{Path, PathBuf};

use sandbox::engine::simulation::Simulation;
use sandbox::output::trajectory::Trajectory;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::scenario::floor_plan;
use sandbox::scenario::measurements::Metrics;
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

const ROOM: &str = "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0), (2 2, 2 3, 3 3, 3 2, 2 2))";

/// A folder with a scenario, and plans next to it.
fn folder(scenario: &Value) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("plans")).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("plans/room.wkt", ROOM);
    write("plans/point.wkt", "POINT (0 0)");
    write("plans/kiosk.wkt", "POLYGON ((6 6, 7 6, 7 7, 6 7))");
    let kiosk = json!({"type": "Feature", "properties": {"kind": "obstacle"}, "geometry":
        {"type": "Polygon", "coordinates": [[[6, 6], [7, 6], [7, 7], [6, 7], [6, 6]]]}});
    write("plans/kiosk.geojson", &kiosk.to_string());
    write("room.json", &scenario.to_string());
    let path = folder.path().join("room.json");
    (folder, path)
}

fn people() -> Value {
    json!([{"min": [1, 4], "max": [9, 9], "columns": 10, "rows": 6, "goal": [9.5, 0.5], "remove_within": 1}])
}

fn station() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/station.json")
}

fn state_after(scenario: &Scenario, frames: u64) -> String {
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    common::run(&mut simulation, frames);
    simulation.digest()
}

#[test]
fn plans_are_found_next_to_the_scenario_and_inlined_in_its_document() {
    let document = json!({"walkable_area": "plans/room.wkt", "obstacles": "plans/kiosk.wkt",
                          "grids": people()});
    let (_folder, path) = folder(&document);
    let scenario = Scenario::load(&path, &[]).unwrap();
    let walls = &scenario.scene.walls;
    for (place, obstacle) in [
        ([6.5, 6.5], Some(0)),
        ([2.5, 2.5], Some(1)),
        ([-1.0, 5.0], Some(1)),
        ([5.0, 5.0], None),
    ] {
        assert_eq!(walls.obstacle_at(place.into()), obstacle, "{place:?}");
    }
    assert_eq!(
        scenario.document["obstacles"],
        json!([[[6.0, 6.0], [7.0, 6.0], [7.0, 7.0], [6.0, 7.0]]])
    );
    assert!(scenario.document["walkable_area"].is_array());
    // In another folder, without the plans, the scenario is bit-identical.
    let again = Scenario::parse(&scenario.to_text(), "elsewhere/room.json", &[]).unwrap();
    assert_eq!(again.document, scenario.document);
    assert_eq!(again.scene.walls.obstacles(), walls.obstacles());
    assert_eq!(state_after(&again, 50), state_after(&scenario, 50));
}

#[test]
fn mistakes_in_a_plan_are_reported_with_the_scenario_the_key_and_the_file() {
    for (changes, said) in [
        (
            json!({"walkable_area": "plans/point.wkt"}),
            vec!["room.json: walkable_area: ", "plans/point.wkt: a POINT"],
        ),
        (
            json!({"obstacles": "no.wkt"}),
            vec!["room.json: obstacles: ", "no.wkt: cannot be read"],
        ),
        (
            json!({"walkable_area": "plans/kiosk.geojson"}),
            vec!["walkable_area: plans/kiosk.geojson: contains only obstacles"],
        ),
        (
            json!({"walkable_area": 5}),
            vec!["walkable_area: must be a list of polygons, or the name of a file"],
        ),
        (
            json!({"obstacles": {}}),
            vec!["obstacles: must be a list of polygons, or the name of a file"],
        ),
        (
            json!({"walkable_area": [[[[0, 0], [4, 4], [4, 0], [0, 4]]]]}),
            vec![
                "walkable_area[0]: the outline crosses or touches itself: the edge from (0, 0) to (4, 4)",
            ],
        ),
        (
            json!({"walkable_area": [[[[0, 0], [4, 4], [4, 2e6]]]]}),
            vec!["walkable_area[0][0][2][1]: must be at least -1e6"],
        ),
        (
            json!({"walkable_area": [[]]}),
            vec!["walkable_area[0]: must not be empty"],
        ),
        (
            json!({"walkable_area": [[[[0, 0], [0.1, 0], [0, 0.1]]]]}),
            vec!["walkable_area: too small for a person", "degrees"],
        ),
        (
            json!({"obstacles": [[[[0, 0], [4, 0], [4, 4]], [[5, 5], [6, 6], [5, 6]]]]}),
            vec!["obstacles[0]: the hole that begins at (5, 5)"],
        ),
        (
            json!({"obstacles": [[[[0, 0], [4, 0], [4, 4]], 5]]}),
            vec!["obstacles[0][1]: must be a ring"],
        ),
        (
            json!({"obstacles": [[[0, 0], [4, 0, 1], [4, 4]]]}),
            vec!["obstacles[0][1]: must be a point [x, y]"],
        ),
    ] {
        let (_folder, path) = folder(&changes);
        let error = Scenario::load(&path, &[]).unwrap_err().to_string();
        for part in said {
            assert!(error.contains(part), "{changes}: {error}");
        }
    }
}

#[test]
fn a_plan_on_the_command_line_replaces_the_walls_of_the_scenario() {
    let document = json!({"walkable_area": "plans/room.wkt", "obstacles": "plans/kiosk.wkt",
                          "grids": people()});
    let (folder, path) = folder(&document);
    let plan = |name: &str| {
        let plan = floor_plan::read(&folder.path().join("plans").join(name)).unwrap();
        let settings = Setting::floor_plan(&plan, "--geometry plan");
        Scenario::load(&path, &settings).unwrap().scene.walls
    };
    assert_eq!(plan("room.wkt").obstacles().len(), 1);
    assert_eq!(plan("room.wkt").obstacle_at([6.5, 6.5].into()), None);
    let kiosk = plan("kiosk.geojson");
    assert_eq!(kiosk.obstacle_at([6.5, 6.5].into()), Some(0));
    assert_eq!(
        kiosk.obstacle_at([-100.0, 0.0].into()),
        None,
        "an open plane"
    );
    // Like a scenario, settings may name a file. The goals lie outside of this one.
    let set = [
        "walkable_area=plans/kiosk.wkt",
        "obstacles=[]",
        "navigation=straight",
    ]
    .map(|set| set.parse::<Setting>().unwrap());
    let walls = Scenario::load(&path, &set).unwrap().scene.walls;
    assert_eq!(walls.obstacle_at([5.0, 5.0].into()), Some(0));
}

#[test]
fn passengers_cross_the_station_and_its_checkpoint_needs_no_floor_plan() {
    let scenario = Scenario::load(&station(), &[]).unwrap();
    let walls = &scenario.scene.walls;
    // The hall, the stairs and the exits form one area; the bakery at the wall is cut out.
    assert_eq!(walls.obstacles().len(), 1);
    for (place, solid) in [
        ([-1.0, 12.0], false),
        ([0.0, 12.0], false),
        ([44.0, 5.5], false),
        ([40.0, 18.0], false),
        ([12.0, 1.5], true),
        ([21.0, 12.0], true),
        ([6.0, 6.5], true),
        ([44.0, 12.0], true),
        ([1.0, 23.0], true),
    ] {
        assert_eq!(
            walls.obstacle_at(place.into()).is_some(),
            solid,
            "{place:?}"
        );
    }
    let at_the_bakery = walls
        .iter()
        .filter(|wall| wall.start.y == 0.0 && wall.end.y == 0.0);
    assert!(at_the_bakery.count() == 2, "no wall runs behind the bakery");
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    let metrics = Metrics::new(&scenario.measurements, &mut simulation);
    common::run(&mut simulation, 250);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("station.checkpoint");
    Checkpoint::of(&scenario, &simulation, &metrics)
        .write(&file)
        .unwrap();
    let checkpoint = Checkpoint::read(&file).unwrap();
    let kept = checkpoint.scenario(&[]).unwrap();
    let mut resumed = checkpoint.resume(kept).unwrap().simulation;
    common::run(&mut simulation, 2000);
    common::run(&mut resumed, 2000);
    assert_eq!(simulation.digest(), resumed.digest());
    let arrived = simulation.frame().agents.entered() as usize - simulation.frame().agents.len();
    assert!(arrived > 30, "{arrived} have left by the exits");
    let inside = |p: &sandbox::engine::math::Vector| walls.obstacle_at(*p).is_none();
    assert!(simulation.frame().agents.position.iter().all(inside));
}

#[test]
fn the_walkable_area_of_a_trajectory_can_be_used_as_a_floor_plan() {
    let evacuation = Scenario::shipped("evacuation", &[]).unwrap();
    for scenario in [Scenario::load(&station(), &[]).unwrap(), evacuation] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("run.sqlite");
        let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
        let view = scenario.view.region;
        let mut trajectory = Trajectory::create(&file, &mut simulation, view, 10.0).unwrap();
        simulation.evaluate().unwrap();
        trajectory.log(&simulation).unwrap();
        trajectory.finish().unwrap();
        let database = rusqlite::Connection::open(&file).unwrap();
        let text: String = database
            .query_row("SELECT wkt FROM geometry", [], |row| row.get(0))
            .unwrap();
        let plan = floor_plan::parse_wkt(&text).unwrap();
        let settings = Setting::floor_plan(&plan, "--geometry run.wkt");
        let path = folder.path().join("again.json");
        fs::write(&path, scenario.to_text()).unwrap();
        let again = Scenario::load(&path, &settings).unwrap();
        let own = &scenario.scene.walls;
        let (count, reach) = (150, view.max - view.min);
        for k in 0..count * count {
            let part = [k % count, k / count].map(|n| (f64::from(n) + 0.5) / f64::from(count));
            let p = view.min + reach.component_mul(&sandbox::engine::math::Vector::from(part));
            let solid = again.scene.walls.obstacle_at(p).is_some();
            assert_eq!(
                solid,
                own.obstacle_at(p).is_some(),
                "{}: {p}",
                scenario.name
            );
        }
        assert_eq!(
            state_after(&again, 150),
            state_after(&scenario, 150),
            "{}",
            scenario.name
        );
    }
}

//! Trajectories of a periodic scene: each lap of an agent is a trajectory of its own.

use std::collections::BTreeMap;

use sandbox::analysis::crossing::Line;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::measure::Crossings;
use sandbox::output::trajectory::Trajectory;
use sandbox::scenario::Scenario;
use sandbox::scenario::trajectories::{ReadOptions, read};
use serde_json::json;

#[test]
fn each_lap_is_a_trajectory_and_crosses_a_line_once() {
    let agent = |x: f64, way: f64| json!({"position": [x, 1], "goal": {"direction": [way, 0]}});
    // Far enough apart that they do not meet.
    let agents = [agent(1.0, 1.0), agent(7.0, 1.0)];
    let back = json!({"position": [4, 40], "goal": {"direction": [-1, 0]}});
    let document = json!({"profile": "sph", "periodic": {"axis": "x", "length": 12},
        "agents": [agents[0], agents[1], back]});
    let scenario = Scenario::parse(&document.to_string(), "f", &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("laps.sqlite");
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    let view = scenario.view.region;
    let mut file = Trajectory::create(&path, &mut simulation, view, 10.0).unwrap();
    let mut laps = [0; 3];
    for _ in 0..2000 {
        simulation.evaluate().unwrap();
        file.log(&simulation).unwrap();
        let agents = simulation.frame().agents;
        for (&id, &count) in agents.id.iter().zip(&agents.laps) {
            laps[id as usize] = count;
        }
        simulation.integrate().unwrap();
    }
    file.finish().unwrap();
    // 40 s at 1.4 m/s are 56 m, less the start.
    assert_eq!(laps, [4, 5, -5]);

    let connection = rusqlite::Connection::open(&path).unwrap();
    let text: String = connection
        .query_row("SELECT wkt FROM geometry", [], |row| row.get(0))
        .unwrap();
    let corners = ["(0 ", " 0 ", "(12 ", " 12 "];
    assert!(corners.iter().any(|x| text.contains(x)), "{text}");
    let mut rows = connection
        .prepare("SELECT frame, id, pos_x FROM trajectory_data ORDER BY id, frame")
        .unwrap();
    let rows = rows.query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)));
    let mut last: BTreeMap<u32, (i64, f64)> = BTreeMap::new();
    for row in rows.unwrap() {
        let (frame, id, x): (i64, u32, f64) = row.unwrap();
        assert!((0.0..12.0).contains(&x));
        if let Some((before, from)) = last.insert(id, (frame, x)) {
            assert_eq!(frame, before + 1);
            assert!((x - from).abs() < 0.181, "{id}: {from} {x}");
        }
    }
    // Laps of agent `id` are `id` + 3 k.
    let of = |agent: u32| last.keys().filter(|&&id| id % 3 == agent).count();
    assert_eq!([of(0), of(1), of(2)], [5, 6, 6]);

    let tracks = read(&path, &ReadOptions::default()).unwrap();
    let line = Line {
        start: Vector::new(6.0, -1.0),
        end: Vector::new(6.0, 50.0),
    };
    let crossings = Crossings::of(&tracks, 1, line, [f64::NEG_INFINITY, f64::INFINITY]);
    // From 1 m to 6, 18, … m; from 7 m to 18, …; from 4 m back to -6, -18, ….
    assert_eq!(crossings.list.len(), 5 + 4 + 4);
}

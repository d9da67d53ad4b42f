//! Runs that begin where another run was, and where people of real data were.

use std::fs;

use crate::common::go_to;
use crate::common::program::{refused, run, stderr, text};
use sandbox::engine::simulation::Simulation;
use sandbox::output::trajectory::Trajectory;
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::{Measurement, Metrics};
use sandbox::scenario::trajectories::{ReadOptions, read};
use serde_json::{Value, json};

/// A room with a crowd, an entrance and a door.
fn room() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 8], [0, 8]]]],
        "exits": [{"name": "door", "line": [[10, 3.5], [10, 4.5]]}],
        "crowds": [{"area": [[1, 1], [6, 1], [6, 7], [1, 7]], "number": 40}],
        "entrances": [{"line": [[0, 2], [0, 6]], "per_sec": 2}]
    })
}

#[test]
fn a_run_restarts_from_its_trajectories_where_everyone_was() {
    let scenario = Scenario::parse(&room().to_string(), "f", &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["run.sqlite", "run.txt", "run.csv"] {
        let path = folder.path().join(name);
        let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
        let view = scenario.view.region;
        let mut file = Trajectory::create(&path, &mut simulation, view, 10.0).unwrap();
        for _ in 0..400 {
            simulation.evaluate().unwrap();
            file.log(&simulation).unwrap();
            simulation.integrate().unwrap();
        }
        file.finish().unwrap();
        // The 4th second: 10 frames per second, 50 in the simulation.
        let mut there = Simulation::new(scenario.scene.clone()).unwrap();
        go_to(&mut there, 200);
        there.evaluate().unwrap();
        let agents = there.frame().agents;
        let mut order: Vec<usize> = agents.present().collect();
        order.sort_by_key(|&i| agents.id[i]);
        let mut document = room();
        for key in ["crowds", "entrances"] {
            document.as_object_mut().unwrap().remove(key);
        }
        document["from"] = json!({"trajectory": path, "at_secs": 4});
        let again = Scenario::parse(&document.to_string(), "f", &[]).unwrap();
        let starts = &again.scene.agents;
        assert_eq!(starts.len(), order.len(), "{name}");
        for (start, &i) in starts.iter().zip(&order) {
            let off = (start.position - agents.position[i]).norm();
            assert!(off < 1e-9, "{name}: {off}");
            // Accelerations are a few m/s², and the velocity is a mean over 0.4 s.
            let off = (start.velocity - agents.velocity[i]).norm();
            assert!(off < 1.0, "{name}: {off}");
        }
        // Two per second come in later.
        assert_eq!(again.scene.scheduled.len(), 7, "{name}");
        let mut simulation = Simulation::new(again.scene).unwrap();
        go_to(&mut simulation, 200);
        let entered = simulation.frame().agents.entered() as usize;
        let waiting = simulation.backlogs().next().unwrap().waiting as usize;
        assert_eq!(entered + waiting, order.len() + 7);
        assert!(waiting < 4, "{waiting}");
    }
}

#[test]
fn a_run_does_not_replace_the_data_that_it_begins_from() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("people.txt");
    fs::write(
        &data,
        "# framerate: 10\n# id frame x/m y/m\n1 0 0 0\n1 10 1 0\n",
    )
    .unwrap();
    let scene = folder.path().join("scene.json");
    let document =
        json!({"goal": [9, 0], "from": {"trajectory": "people.txt"}, "duration_secs": 1});
    fs::write(&scene, document.to_string()).unwrap();
    let typed = ["run", text(&scene), "--trajectory", text(&data), "--force"];
    refused(&typed, 2, &["from.trajectory", "people.txt"]);
    let checkpoint = folder.path().join("run.checkpoint");
    let whole = run(&["run", text(&scene), "--json"]);
    assert_eq!(whole.status.code(), Some(0), "{}", stderr(&whole));
    let half = [
        "run",
        text(&scene),
        "--until",
        "0.4",
        "--checkpoint",
        text(&checkpoint),
    ];
    assert_eq!(run(&half).status.code(), Some(0));
    fs::write(&data, "changed").unwrap();
    let resumed = run(&["resume", text(&checkpoint), "--until", "1", "--json"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    let digest = |output: &[u8]| -> Value {
        let summary: Value = serde_json::from_slice(output).unwrap();
        summary["state_sha256"].clone()
    };
    assert_eq!(digest(&resumed.stdout), digest(&whole.stdout));
}

#[test]
fn a_line_measures_the_same_in_a_run_and_in_its_trajectories() {
    let mut document = room();
    let line = json!({"line": [[8, 0], [8, 8]], "region": [[6, 2], [8, 6]], "part": [0.2, 0.8]});
    document["measurements"] = json!([{ "line_flow": line }]);
    document["duration_secs"] = json!(12);
    let scenario = Scenario::parse(&document.to_string(), "f", &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    let mut metrics = Metrics::new(&scenario.measurements, &mut simulation);
    let mut file = Trajectory::create(&path, &mut simulation, scenario.view.region, 50.0).unwrap();
    for frame in 0..=600 {
        simulation.evaluate().unwrap();
        metrics.observe(&simulation);
        file.log(&simulation).unwrap();
        if frame < 600 {
            simulation.integrate().unwrap();
        }
    }
    file.finish().unwrap();
    let tracks = read(&path, &ReadOptions::default()).unwrap();
    let Measurement::LineFlow(line) = &scenario.measurements[0] else {
        panic!("{:?}", scenario.measurements)
    };
    let (values, (_, passages)) = line.of_tracks(&tracks, 0.0, &scenario.scene);
    let own = metrics.results(&simulation);
    assert_eq!(own.len(), values.len());
    for (of_run, (name, of_data)) in own.iter().zip(values) {
        assert_eq!(of_run.name, name);
        let off = of_run.value.unwrap() - of_data.unwrap();
        assert!(off.abs() < 1e-6, "{name}: {off}");
    }
    assert!(passages.as_array().unwrap().len() > 20);
}

#[test]
fn people_of_data_wait_for_their_premovement_time() {
    let document = json!({
        "goal": [50, 0], "profile": "sph",
        "from": {"people": [[1, 0, 0, 0, 0, 0], [2, 1, 0, 3, 0, 0]], "premovement_secs": 1.5},
    });
    let scenario = Scenario::parse(&document.to_string(), "f", &[]).unwrap();
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    // Agent 1 may walk from 1.5 s on. Agent 2 enters at 1 s and may walk from 2.5 s on. A frame is 0.02 s.
    for (frame, expected) in [
        (70, [false, false]),
        (115, [true, false]),
        (170, [true, true]),
    ] {
        go_to(&mut simulation, frame);
        let velocity = &simulation.frame().agents.velocity;
        let walks = [0, 1].map(|k| velocity[k].x > 0.1);
        assert_eq!(walks, expected, "{frame}");
    }
}

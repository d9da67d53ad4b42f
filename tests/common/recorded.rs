//! A small run that is recorded and read back.

use std::collections::BTreeMap;

use super::recording::Recording;
use super::rectangle;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::{Vector, direction};
use sandbox::engine::scene::{Group, Region, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::output::recording::{DebugAgents, Recorder, RecordingOptions};
use sandbox::scenario::catalog::{self, Parameters};

/// 49 agents close together, the first of them at a wall; some reach the goal at once.
pub fn scene(profile: &str) -> Scene {
    let mut scene = Scene::with_obstacles(vec![rectangle([-1.0, 8.0], [-1.0, 0.0])]);
    let group = scene.add_group(Group {
        removal_radius: Some(0.5),
        ..Group::new(
            "people",
            catalog::named(profile, &Parameters::default()).unwrap(),
        )
    });
    for k in 0..49 {
        let (column, row) = (f64::from(k % 7), f64::from(k / 7));
        let start = Vector::new(0.3 + 0.5 * column, 0.3 + 0.5 * row);
        let goal = Vector::new(4.0, 1.3);
        scene.agents.push(NewAgent::at(start, goal, group));
    }
    scene
}

pub fn options(debug: DebugAgents) -> RecordingOptions {
    RecordingOptions {
        id: "a-test".to_owned(),
        application: "test".to_owned(),
        title: "a test".to_owned(),
        description: "Small".to_owned(),
        document: "A test".to_owned(),
        view: Region {
            min: Vector::new(-1.0, -1.0),
            max: Vector::new(8.0, 5.0),
        },
        density_range: [0.0, 8.0],
        speed_range: [0.0, 1.8],
        opens_at: Some(0.1),
        begins_at: 0.0,
        ends_at: 1.0,
        debug,
        body_mass: None,
        measured: Vec::new(),
        labels: Vec::new(),
        entering: 49,
    }
}

/// The position and density of every agent in one frame of the simulation, by id.
pub type Truth = BTreeMap<u32, (Vector, Option<f64>)>;

/// Records `frames` frames; returns the file as read back, and the truth.
pub fn record(
    profile: &str,
    debug: DebugAgents,
    density: bool,
    frames: u64,
) -> (Recording, Vec<Truth>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.rrd");
    let mut simulation = Simulation::new(scene(profile)).unwrap();
    if density {
        simulation.request_density_until(u64::MAX);
    }
    let mut recorder = Recorder::create(path.as_path(), &simulation, &options(debug)).unwrap();
    let mut truth = Vec::new();
    for _ in 0..frames {
        simulation.evaluate().unwrap();
        recorder.log(&simulation, 1.0).unwrap();
        let frame = simulation.frame();
        let agents = 0..frame.agents.len();
        truth.push(
            agents
                .map(|i| {
                    let density = frame.fields.density.get(i).copied();
                    (frame.agents.id[i], (frame.agents.position[i], density))
                })
                .collect(),
        );
        simulation.integrate().unwrap();
    }
    recorder.finish().unwrap();
    (Recording::read(&path), truth)
}

/// Records frames of a dense crowd with these options; the file as read back, and the simulation in its last frame.
pub fn recorded(options: &RecordingOptions, frames: u64) -> (Recording, Simulation) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.rrd");
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    simulation.request_density_until(u64::MAX);
    let mut recorder = Recorder::create(path.as_path(), &simulation, options).unwrap();
    for frame in 0..frames {
        simulation.evaluate().unwrap();
        recorder.log(&simulation, 1.0).unwrap();
        if frame + 1 < frames {
            simulation.integrate().unwrap();
        }
    }
    recorder.note(simulation.frame().clock, "The end.").unwrap();
    recorder.finish().unwrap();
    (Recording::read(&path), simulation)
}

/// The acceleration whose arrow this is: the inverse of the documented law of lengths.
pub fn acceleration(arrow: Vector) -> Vector {
    direction(arrow) * 0.1 * (10_f64.powf(arrow.norm() / 0.6) - 1.0)
}

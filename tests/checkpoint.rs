//! A run resumed from a checkpoint is bit-identical to an uninterrupted run.

use std::fs;
use std::path::Path;

use crate::common::program;
use crate::common::{blend, block, go_to, on_threads, room, scene, vector};
use sandbox::engine::neighbors::ListPolicy;
use sandbox::engine::pairs::Precision;
use sandbox::engine::placement::Grid;
use sandbox::engine::profile::Override;
use sandbox::engine::scene::{Goal, Integrator, Push, Region, Scene, Source};
use sandbox::engine::simulation::Simulation;
use sandbox::runs::checkpoint::{Checkpoint, CheckpointError};
use sandbox::scenario::catalog::NAMES;
use sandbox::scenario::measurements::Metrics;
use sandbox::scenario::{Scenario, Setting};

/// A crowd that leaves a room through a door, with a source and a push.
fn busy_room(profile: &str) -> Scene {
    let mut scene = scene(vec![room(8.0, 1.2)], blend(profile));
    scene.precision = Precision::Mixed;
    scene.groups[0].removal_radius = Some(0.5);
    let exit = vector(9.5, 4.0);
    scene.agents = block(vector(1.0, 0.5), 15, 16, 0.45, exit);
    scene.sources = vec![Source {
        name: "late".to_owned(),
        grid: Grid {
            min: vector(0.3, 7.0),
            max: vector(7.5, 7.7),
            columns: 8,
            rows: 1,
            jitter: 0.2,
        },
        group: 0,
        goal: Goal::Point(exit),
        start: 0.3,
        every: 0.4,
        times: Some(3),
    }];
    scene.pushes = vec![Push {
        name: "push".to_owned(),
        at: 0.5,
        lasting: 0.4,
        region: Region {
            min: vector(2.0, 2.0),
            max: vector(6.0, 6.0),
        },
        change: Override {
            goal_scale: Some(3.0),
            ignore_contact: true,
            ignore_sph: true,
        },
    }];
    scene
}

/// Saves and resumes a run at each frame of `stops`, each time on another number of threads. Returns the digests at
/// frame `end` of this run and of an uninterrupted one.
fn digests(scene: &Scene, stops: &[u64], end: u64) -> [String; 2] {
    let without = on_threads(2, || {
        let mut simulation = Simulation::new(scene.clone()).unwrap();
        go_to(&mut simulation, end);
        assert!(!simulation.outcome().arrivals.is_empty());
        simulation.digest()
    });
    let mut simulation = Simulation::new(scene.clone()).unwrap();
    for (k, &stop) in stops.iter().enumerate() {
        simulation = on_threads(1 + k % 3, || {
            go_to(&mut simulation, stop);
            let written = postcard::to_stdvec(&simulation.state()).unwrap();
            let read = postcard::from_bytes(&written).unwrap();
            Simulation::resumed(scene.clone(), read).unwrap()
        });
    }
    go_to(&mut simulation, end);
    [simulation.digest(), without]
}

#[test]
fn all_profiles_resume_bit_identically() {
    for profile in NAMES {
        let mut scene = busy_room(profile);
        // At the start, between coarse frames, during the push and after it.
        let stops = [0, 1, 13, 27, 30, 31, 48, 90];
        let [resumed, without] = digests(&scene, &stops, 150);
        assert_eq!(resumed, without, "{profile}");
        scene.precision = Precision::Double;
        let [resumed, without] = digests(&scene, &[33], 120);
        assert_eq!(resumed, without, "{profile}, double");
    }
}

#[test]
fn all_integrators_and_neighbor_lists_resume_bit_identically() {
    for integrator in Integrator::ALL {
        for neighbor_lists in [ListPolicy::Complete, ListPolicy::Coarse] {
            let scene = Scene {
                integrator,
                neighbor_lists,
                ..busy_room("sf->sph")
            };
            let [resumed, without] = digests(&scene, &[7, 32, 61], 150);
            assert_eq!(resumed, without, "{integrator:?} {neighbor_lists:?}");
        }
    }
}

#[test]
fn a_run_can_be_resumed_at_every_frame() {
    let scene = busy_room("rvo->sph");
    let stops: Vec<u64> = (0..120).collect();
    let [resumed, without] = digests(&scene, &stops, 121);
    assert_eq!(resumed, without);
}

fn evacuation() -> (Scenario, Simulation, Metrics) {
    let settings: [Setting; 1] = ["duration_secs=16".parse().unwrap()];
    let scenario = Scenario::shipped("evacuation", &settings).unwrap();
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    let metrics = Metrics::new(&scenario.measurements, &mut simulation);
    (scenario, simulation, metrics)
}

#[test]
fn measurements_are_resumed_too() {
    let (scenario, mut simulation, mut metrics) = evacuation();
    go_to(&mut simulation, 750);
    metrics.observe(&simulation);
    go_to(&mut simulation, 760);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("evacuation.checkpoint");
    Checkpoint::of(&scenario, &simulation, &metrics)
        .write(&file)
        .unwrap();
    let read = Checkpoint::read(&file).unwrap();
    assert!(read.is_of_this_engine());
    let scenario = read.scenario(&[]).unwrap();
    let again = read.resume(scenario).unwrap();
    let measured = again.metrics.results(&again.simulation);
    assert_eq!(measured, metrics.results(&simulation));
    assert!(measured[0].value.is_some());
    assert_eq!(again.simulation.digest(), simulation.digest());
}

#[test]
fn damaged_and_foreign_checkpoints_are_refused_with_the_reason() {
    let (scenario, mut simulation, metrics) = evacuation();
    simulation.evaluate().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("c");
    Checkpoint::of(&scenario, &simulation, &metrics)
        .write(&file)
        .unwrap();
    let whole = fs::read(&file).unwrap();
    let refused = |bytes: &[u8]| {
        fs::write(&file, bytes).unwrap();
        Checkpoint::read(&file).unwrap_err().to_string()
    };
    for length in [0, 5, 19, 22, 30, 60, whole.len() / 2, whole.len() - 1] {
        let error = refused(&whole[..length]);
        let expected = error.contains("is damaged: ") || error.ends_with("is not a checkpoint");
        assert!(expected, "{length}: {error}");
    }
    for place in [40, 100, whole.len() / 2, whole.len() - 1] {
        let mut changed = whole.clone();
        changed[place] ^= 1;
        assert!(refused(&changed).contains("is damaged: "), "{place}");
    }
    let mut newer = whole.clone();
    let version = std::mem::replace(&mut newer[19], 99);
    let expected = format!("is a checkpoint of version 99; this program reads version {version}");
    assert!(refused(&newer).ends_with(&expected));
    assert!(refused(b"{\"name\": \"x\"}").ends_with("is not a checkpoint"));
    let nowhere = Checkpoint::read(Path::new("/nowhere/c")).unwrap_err();
    assert!(
        nowhere
            .to_string()
            .starts_with("/nowhere/c: cannot be read: ")
    );
}

#[test]
fn failed_and_repeated_writes_of_a_checkpoint_leave_no_other_files() {
    let (scenario, mut simulation, metrics) = evacuation();
    simulation.evaluate().unwrap();
    let checkpoint = Checkpoint::of(&scenario, &simulation, &metrics);
    let error = checkpoint.write(Path::new("/dev/null/c")).unwrap_err();
    assert!(
        matches!(error, CheckpointError::Unwritable { .. }),
        "{error}"
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("c");
    checkpoint.write(&file).unwrap();
    checkpoint.write(&file).unwrap();
    let names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|f| f.unwrap().file_name())
        .collect();
    assert_eq!(names, ["c"], "nothing else is left in the folder");
}

#[test]
fn a_state_of_another_scene_is_refused() {
    let (_, mut simulation, _) = evacuation();
    simulation.evaluate().unwrap();
    let state = simulation.state();
    assert!(Simulation::resumed(Scene::default(), state.clone()).is_err());
    let mut other = busy_room("sph");
    other.groups.clear();
    assert!(Simulation::resumed(other, state).is_err());
}

/// Bits of the densities, mean densities and pressures of the evaluated frame, sorted by id.
fn observed(simulation: &Simulation) -> Vec<(u32, [u64; 3])> {
    let frame = simulation.frame();
    let fields = frame.fields;
    let ids = frame.agents.id.iter().enumerate();
    let mut rows: Vec<_> = ids
        .map(|(i, &id)| {
            let values = [
                fields.density[i],
                fields.mean_density[i],
                fields.pressure[i],
            ];
            (id, values.map(f64::to_bits))
        })
        .collect();
    rows.sort_unstable();
    rows
}

#[test]
fn a_resumed_run_has_the_densities_of_an_uninterrupted_run() {
    for profile in NAMES {
        let scene = busy_room(profile);
        let mut whole = Simulation::new(scene.clone()).unwrap();
        whole.request_density_until(u64::MAX);
        // As with `--checkpoint`, every frame has densities.
        let mut stopped = Simulation::new(scene.clone()).unwrap();
        stopped.request_density_until(u64::MAX);
        go_to(&mut stopped, 37);
        let mut resumed = Simulation::resumed(scene, stopped.state()).unwrap();
        resumed.request_density_until(u64::MAX);
        for frame in [37, 38, 60, 110] {
            go_to(&mut whole, frame);
            go_to(&mut resumed, frame);
            assert!(
                observed(&whole) == observed(&resumed),
                "{profile}, frame {frame}"
            );
        }
    }
}

#[test]
fn digests_and_resumed_trajectories_do_not_depend_on_the_outputs() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let digest = |arguments: &[&str]| {
        let report = program::run_json(&[arguments, &["--json"]].concat());
        report["state_sha256"].as_str().unwrap().to_owned()
    };
    let (checkpoint, resumed, whole) = (file("c"), file("resumed.csv"), file("whole.csv"));
    // The scenario measures the density at 15 s. Here it does so at 2 s, before the checkpoint.
    let run = [
        "evacuation",
        "--profile",
        "sf",
        "--set",
        "measurements.0.density.at_secs=2",
    ];
    let plain = digest(&[&run[..], &["--until", "4"]].concat());
    let watched = [
        "--until",
        "4",
        "--trajectory",
        &whole,
        "--trajectory-fps",
        "50",
    ];
    assert_eq!(digest(&[&run[..], &watched].concat()), plain);
    let stopped = [
        "--until",
        "3.5",
        "--checkpoint",
        &checkpoint,
        "--checkpoint-every",
        "3",
    ];
    digest(&[&run[..], &stopped].concat());
    let rest = [
        "resume",
        &checkpoint,
        "--until",
        "4",
        "--trajectory",
        &resumed,
        "--trajectory-fps",
        "50",
    ];
    assert_eq!(digest(&rest), plain);
    let lines = |path: &str| -> Vec<String> {
        fs::read_to_string(path)
            .unwrap()
            .lines()
            .map(str::to_owned)
            .collect()
    };
    let (whole, resumed) = (lines(&whole), lines(&resumed));
    assert!(resumed.len() > 400 * 50);
    assert_eq!(resumed[1..], whole[whole.len() - resumed.len() + 1..]);
}

#[test]
fn the_program_resumes_from_a_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("c");
    let path = file.to_str().unwrap();
    let profile = "rvo->sph";
    let whole = program::run_json(&["evacuation", "--profile", profile, "--until", "8", "--json"]);
    let first = [
        "evacuation",
        "--profile",
        profile,
        "--until",
        "5",
        "--json",
        "--checkpoint",
        path,
        "--checkpoint-every",
        "2",
    ];
    assert_ne!(
        program::run_json(&first)["state_sha256"],
        whole["state_sha256"]
    );
    let rest = program::run_json(&["resume", path, "--until", "8", "--json", "--threads", "1"]);
    for key in [
        "state_sha256",
        "metrics",
        "frames",
        "contained_moves",
        "clamped_speeds",
    ] {
        assert_eq!(rest[key], whole[key], "{key}");
    }
    // Without `--until` it goes to the scenario's own end, past the end of the first run.
    let to_the_end = program::run_json(&["resume", path, "--json"]);
    assert!(to_the_end["time_secs"].as_f64().unwrap() > 20.0);
    let taken = program::run(&first);
    assert_eq!(taken.status.code(), Some(2));
    assert!(program::stderr(&taken).contains("already exists; use --force"));
    let nothing = program::run(&["resume", "/nowhere"]);
    assert_eq!(nothing.status.code(), Some(2));
}

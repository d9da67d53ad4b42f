//! What a trajectory's file and its options mean: its format, its frame rate, and where agents face.

use std::collections::BTreeMap;
use std::path::Path;

use crate::common::program::{run, stderr};
use crate::common::{blend, scene, vector, walker};
use sandbox::engine::clock::Clock;
use sandbox::engine::scene::Region;
use sandbox::engine::simulation::Simulation;
use sandbox::output::trajectory::{Format, Trajectory, TrajectoryError, frames_between};
use sandbox::scenario::kinds::of_name;
use sandbox::scenario::trajectories::ENDINGS;

#[test]
fn a_rate_that_is_no_whole_part_names_the_nearest_that_is() {
    let refused = |time_step, fps| match frames_between(&Clock::new(time_step, 1), fps) {
        Err(TrajectoryError::FrameRate { nearest, .. }) => nearest,
        other => panic!("{other:?}"),
    };
    for (fps, every) in [(50.0, 1), (25.0, 2), (12.5, 4), (10.0, 5), (0.1, 500)] {
        assert_eq!(frames_between(&Clock::default(), fps), Ok(every));
    }
    assert_eq!(refused(0.02, 11.0), 10.0);
    assert_eq!(refused(0.02, 24.0), 25.0);
    assert_eq!(refused(0.02, 1000.0), 50.0);
    let third = refused(0.03, 10.0);
    assert!((third - 100.0 / 9.0).abs() < 1e-12);
    assert_eq!(frames_between(&Clock::new(0.03, 1), 11.111111), Ok(3));
}

#[test]
fn the_format_is_in_the_extension() {
    let format = |name: &str| Format::of(Path::new(name));
    assert_eq!(format("a/run.sqlite"), Ok(Format::Sqlite));
    assert_eq!(format("run.DB"), Ok(Format::Sqlite));
    assert_eq!(format("run.1.txt"), Ok(Format::Text));
    assert_eq!(format("run.csv"), Ok(Format::Csv));
    for name in ["run.h5", "run", "run.csv.gz", "csv"] {
        assert!(format(name).is_err(), "{name}");
    }
}

#[test]
fn every_command_takes_a_file_with_a_known_ending_for_trajectories() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [picture, page, measured] = ["a.svg", "a.html", "measured"].map(path);
    for ending in ENDINGS {
        let missing = path(&format!("missing.{ending}"));
        for typed in [
            &["draw", &missing, "--out", &picture][..],
            &["draw", &missing, "--egress", "--out", &picture],
            &["draw", &missing, "--out", &page],
            &["measure", &missing, "--out", &measured],
        ] {
            let output = run(typed);
            let said = stderr(&output);
            let begins = format!("error: {missing}: cannot be read: ");
            assert_eq!(output.status.code(), Some(2), "{typed:?}: {said}");
            assert!(said.starts_with(&begins), "{typed:?}: {said}");
            assert!(!said.contains("`sandbox"), "{typed:?}: {said}");
        }
    }
}

#[test]
fn trajectories_in_place_of_a_scenario_are_known_by_their_ending() {
    for ending in ENDINGS {
        let what = of_name(&Path::new("run").with_extension(ending));
        match ending {
            "txt" => assert_eq!(what, None), // may be a scenario or a plan
            _ => assert!(what.is_some_and(|what| what.contains("a run that is over"))),
        }
    }
}

#[test]
fn walking_agents_face_their_way_and_standing_ones_their_goal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crowd.csv");
    let mut scene = scene(Vec::new(), blend("sf"));
    scene.groups[0].removal_radius = None;
    let agent = |x, velocity, goal| walker(vector(x, 1.0), velocity, vector(x, goal));
    scene.agents = vec![
        agent(1.0, vector(-0.5, 0.0), 4.0),
        agent(3.0, vector(-0.005, 0.0), 4.0),
        agent(5.0, vector(0.0, 0.0), 1.0),
    ];
    let mut simulation = Simulation::new(scene).unwrap();
    let view = Region {
        min: vector(0.0, 0.0),
        max: vector(1.0, 1.0),
    };
    let mut trajectory = Trajectory::create(&path, &mut simulation, view, 50.0).unwrap();
    simulation.evaluate().unwrap();
    trajectory.log(&simulation).unwrap();
    trajectory.finish().unwrap();
    let rows = csv::Reader::from_path(&path).unwrap().into_deserialize();
    let facing = rows.map(|row: Result<BTreeMap<String, String>, _>| {
        let row = row.unwrap();
        ["ori_x", "ori_y"].map(|name| row[name].parse::<f64>().unwrap())
    });
    let facing: Vec<[f64; 2]> = facing.collect();
    assert_eq!(facing, [[-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
}

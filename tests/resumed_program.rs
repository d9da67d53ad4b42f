//! The program resumes a run to the same results and files, cut anywhere, also twice in a row.

use std::fs;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::Metrics;
use serde_json::Value;

use crate::common::busy::hall;
use crate::common::program::{refused, run_json, text};

/// What `--json` says, apart from how long it took.
fn report(arguments: &[&str]) -> Value {
    let mut report = run_json(&[arguments, &["--json"]].concat());
    for key in ["threads", "ms_per_frame", "real_time_factor", "stages_ms"] {
        report.as_object_mut().unwrap().remove(key).unwrap();
    }
    report
}

/// Runs a scenario in one piece and in three, which end at these times, and compares reports and trajectories.
fn check(scenario: &str, ends: [&str; 3]) {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| text(&folder.path().join(name)).to_owned();
    let files = ["whole.csv", "1.csv", "2.csv", "3.csv", "1.ck", "2.ck"].map(file);
    let [whole, parts @ .., first, second] = &files;
    let kept = |path| ["--trajectory", path, "--trajectory-fps", "10"];
    let cut = |path| ["--checkpoint", path, "--checkpoint-every", "1000"];
    let until = |k: usize| ["--until", ends[k], "--threads", ["1", "3", "2"][k]];
    let in_one = report(&[&["run", scenario], &until(2)[..], &kept(whole)].concat());
    report(
        &[
            &["run", scenario],
            &until(0)[..],
            &kept(&parts[0]),
            &cut(first),
        ]
        .concat(),
    );
    report(
        &[
            &["resume", first],
            &until(1)[..],
            &kept(&parts[1]),
            &cut(second),
        ]
        .concat(),
    );
    let in_three = report(&[&["resume", second], &until(2)[..], &kept(&parts[2])].concat());
    assert_eq!(in_three, in_one, "{scenario} cut at {ends:?}");
    let lines = |path: &String| -> Vec<String> {
        let read = fs::read_to_string(path).unwrap();
        read.lines().map(str::to_owned).collect()
    };
    let whole = lines(whole);
    assert!(whole.len() > 100);
    for part in &parts[1..] {
        let part = lines(part);
        let begin = whole.iter().position(|line| *line == part[1]).unwrap();
        assert!(part.len() > 1 && part[1..] == whole[begin..begin + part.len() - 1]);
    }
    assert_eq!(lines(&parts[2]).last(), whole.last());
}

#[test]
fn people_who_enter_a_station_enter_at_the_same_time_in_a_resumed_run() {
    check("scenarios/platforms.json", ["30", "40", "60"]);
}

#[test]
fn a_queue_with_corners_moves_up_at_the_same_time_in_a_resumed_run() {
    check("tests/data/resume_queue.json", ["10", "10.5", "20"]);
}

#[test]
fn busy_halls_are_resumed_with_the_same_files() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..3 {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let path = folder.path().join(format!("{seed}.json"));
        fs::write(&path, hall(rng, 100).to_string()).unwrap();
        let first = rng.random_range(5..30);
        let ends =
            [first, first + rng.random_range(1..9), 40].map(|k| (f64::from(k) * 0.1).to_string());
        check(text(&path), [&ends[0], &ends[1], &ends[2]]);
    }
}

fn written(path: &Path, scenario: &Scenario, simulation: &mut Simulation) {
    simulation.evaluate().unwrap();
    let metrics = Metrics::new(&scenario.measurements, simulation);
    let checkpoint = Checkpoint::of(scenario, simulation, &metrics);
    checkpoint.write(path).unwrap();
}

#[test]
fn a_checkpoint_whose_state_does_not_fit_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.ck");
    let [small, large] = [
        r#"{"agents": []}"#,
        r#"{"goal": [9, 1], "agents": [{"position": [1, 1]}, {"position": [3, 1]}]}"#,
    ]
    .map(|text| Scenario::parse(text, "f.json", &[]).unwrap());
    let mut simulation = Simulation::new(large.scene.clone()).unwrap();
    written(&path, &small, &mut simulation);
    let name = text(&path);
    let said =
        format!("{name}: the state does not belong to this scenario; run the scenario again");
    refused(&["resume", name], 2, &[&said]);
    written(&path, &large, &mut simulation);
    run_json(&["resume", name, "--until", "0.1", "--json"]);
}

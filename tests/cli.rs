//! The program as a user runs it: exit codes, what goes where, and the shape of its JSON.
#![cfg(feature = "cli")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn sandbox(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sandbox"))
        .args(arguments)
        .output()
        .unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let output = sandbox(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Fails with `code`, says something about `words` on stderr and nothing on stdout.
fn refused(arguments: &[&str], code: i32, words: &[&str]) {
    let output = sandbox(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    for word in words {
        assert!(
            stderr.contains(word),
            "{arguments:?}: no {word:?} in {stderr}"
        );
    }
    assert!(output.stdout.is_empty());
}

fn scenario_file(folder: &Path) -> String {
    let path = folder.join("three.json");
    let text = r#"{"name": "three", "goal": [10, 0], "profile": "sf->sph",
        "obstacles": [[[-1, -2], [9, -2], [9, -0.5], [-1, -0.5]]],
        "agents": [{"position": [0, 0], "mean_density": 3}, {"position": [0.3, 0.1]},
                   {"position": [0.5, -0.2], "velocity": [-0.5, 0]}]}"#;
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn a_run_reports_its_metrics_and_only_the_stages_it_needed() {
    let report = json(&[
        "evacuation",
        "--until",
        "1",
        "--seed",
        "5",
        "--threads",
        "2",
        "--json",
    ]);
    assert_eq!(report["scenario"], "evacuation");
    assert_eq!(report["profile"], "sph");
    assert_eq!(report["seed"], 5);
    assert_eq!(report["threads"], 2);
    assert_eq!(report["frames"], 50);
    assert_eq!(report["agents"], 400);
    assert_eq!(report["metrics"]["evacuated"], 0.0);
    assert!(report["metrics"]["density_mean_15s"].is_null());
    assert!(report["ms_per_frame"].as_f64().unwrap() > 0.0);
    assert!(report["stages_ms"]["density_and_pressure"].is_number());
    assert!(report["stages_ms"].get("rvo").is_none());
}

#[test]
fn a_crowd_without_sph_has_a_density_only_while_a_metric_reads_it() {
    let measured = json(&["evacuation", "--profile", "sf", "--until", "0.2", "--json"]);
    assert!(measured["stages_ms"]["density_and_pressure"].is_number());
    let folder = tempfile::tempdir().unwrap();
    let file = scenario_file(folder.path());
    let unmeasured = json(&["run", &file, "--profile", "sf", "--until", "0.2", "--json"]);
    assert!(
        unmeasured["stages_ms"]
            .get("density_and_pressure")
            .is_none()
    );
}

#[test]
fn an_inspection_at_zero_lays_open_the_state_as_given() {
    let folder = tempfile::tempdir().unwrap();
    let file = scenario_file(folder.path());
    let moment = json(&["inspect", &file, "--all", "--at", "0", "--json"]);
    assert_eq!(moment["frame"], 0);
    let agents = moment["agents"].as_array().unwrap();
    assert_eq!(agents.len(), 3);
    assert_eq!(agents[2]["position"], serde_json::json!([0.5, -0.2]));
    assert_eq!(agents[2]["velocity"], serde_json::json!([-0.5, 0.0]));
    for agent in agents {
        let mut sum = [0.0, 0.0];
        for profile in agent["profiles"].as_array().unwrap() {
            let weight = profile["weight"].as_f64().unwrap();
            for term in profile["accelerations"].as_object().unwrap().values() {
                sum[0] += weight * term[0].as_f64().unwrap();
                sum[1] += weight * term[1].as_f64().unwrap();
            }
        }
        for (axis, sum) in sum.into_iter().enumerate() {
            let total = agent["acceleration"][axis].as_f64().unwrap();
            assert!((sum - total).abs() <= 1e-12 * (1.0 + total.abs()));
        }
        assert!(!agent["walls"].as_array().unwrap().is_empty());
        assert_eq!(agent["neighbors"].as_array().unwrap().len(), 2);
    }
}

#[test]
fn bad_input_is_refused_with_its_place_and_exit_code_2() {
    refused(&["run", "no/such/file.json"], 2, &["no/such/file.json"]);
    refused(
        &["evacuation", "--set", "viscocity=1"],
        2,
        &["viscocity", "viscosity"],
    );
    refused(&["evacuation", "--set", "viscosity=-1"], 2, &["viscosity"]);
    refused(&["evacuation", "--profile", "fs"], 2, &["profile"]);
    refused(&["evacuation", "--until=-3"], 2, &["--until"]);
    refused(&["evacuation", "--threads", "0"], 2, &["--threads"]);
    refused(
        &["inspect", "evacuation", "--agent", "400"],
        2,
        &["--agent 400"],
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("broken.json");
    std::fs::write(
        &file,
        r#"{"obstacles": [[[0, 0], [1, 1], [1, 0], [0, 1]]]}"#,
    )
    .unwrap();
    refused(
        &["run", file.to_str().unwrap()],
        2,
        &["broken.json", "obstacles[0]"],
    );
}

#[cfg(feature = "recording")]
#[test]
fn an_existing_file_is_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kept.rrd");
    std::fs::write(&file, "precious").unwrap();
    let path = file.to_str().unwrap();
    refused(
        &["evacuation", "--until", "0.1", "--save", path],
        1,
        &[path, "--force"],
    );
    assert_eq!(std::fs::read(&file).unwrap(), b"precious");
    json(&[
        "evacuation",
        "--until",
        "0.1",
        "--save",
        path,
        "--force",
        "--json",
    ]);
    assert!(std::fs::metadata(&file).unwrap().len() > 10_000);
    let nowhere = folder.path().join("no/folder.rrd");
    refused(
        &[
            "evacuation",
            "--until",
            "0.1",
            "--save",
            nowhere.to_str().unwrap(),
        ],
        1,
        &["folder.rrd"],
    );
}

#[test]
fn what_cannot_be_reproduced_is_told_in_plain_words() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let out = file.to_str().unwrap();
    refused(&["reproduce", "table3"], 2, &["table3", "table1"]);
    refused(&["reproduce"], 2, &["WHAT"]);
    refused(&["reproduce", "table1", "--seeds", "0"], 2, &["--seeds"]);
    refused(&["reproduce", "table1", "--out", out], 1, &[out]);
}

//! The command line: exit codes, contents of stdout and stderr, and the shape of the JSON.

use std::path::Path;
use std::process::Command;

use crate::common::program::{self, PROGRAM, refused, run_json, stderr};

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
    let report = run_json(&[
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
    assert_eq!(report["interrupted"], false);
    assert_eq!(report["agents"], 400);
    assert_eq!(report["metrics"]["evacuated"], 0);
    assert!(report["metrics"]["density_mean_15s"].is_null());
    assert!(report["ms_per_frame"].as_f64().unwrap() > 0.0);
    assert!(report["stages_ms"]["density_and_pressure"].is_number());
    assert!(report["stages_ms"].get("rvo").is_none());
}

#[test]
fn a_crowd_without_sph_has_a_density_only_while_a_metric_reads_it() {
    let measured = run_json(&["evacuation", "--profile", "sf", "--until", "0.2", "--json"]);
    assert!(measured["stages_ms"]["density_and_pressure"].is_number());
    let folder = tempfile::tempdir().unwrap();
    let file = scenario_file(folder.path());
    let unmeasured = run_json(&["run", &file, "--profile", "sf", "--until", "0.2", "--json"]);
    assert!(
        unmeasured["stages_ms"]
            .get("density_and_pressure")
            .is_none()
    );
}

#[test]
fn an_inspection_at_zero_shows_the_initial_state() {
    let folder = tempfile::tempdir().unwrap();
    let file = scenario_file(folder.path());
    let moment = run_json(&["inspect", &file, "--all", "--at", "0", "--json"]);
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
fn an_inspection_may_go_beyond_the_end_of_the_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("idle.json");
    let text = r#"{"goal": [10, 0], "stop": {"idle_secs": 0.5}, "agents": [{"position": [0, 0]}]}"#;
    std::fs::write(&path, text).unwrap();
    let file = path.to_str().unwrap();
    assert_eq!(run_json(&["run", file, "--json"])["frames"], 26);
    let moment = run_json(&["inspect", file, "--agent", "0", "--at", "2", "--json"]);
    assert_eq!(moment["time_secs"], 2.0);
    assert_eq!(moment["frame"], 100);
}

#[test]
fn help_and_lists_name_commands_profiles_and_settings() {
    let text = |arguments: &[&str]| String::from_utf8(program::run(arguments).stdout).unwrap();
    for command in [
        "evacuation",
        "crossing",
        "concert",
        "run",
        "inspect",
        "list",
    ] {
        let example = format!("sandbox {command} ");
        assert!(text(&["--help"]).contains(&example));
        let help = text(&[command, "--help"]);
        let shown = ["Example: ", "Examples:\n  "].map(|head| format!("{head}{example}"));
        assert!(shown.iter().any(|one| help.contains(one)), "{help}");
    }
    assert!(text(&["list"]).contains("rvo->sph"));
    assert!(text(&["list", "--settings"]).contains("remove_within"));
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
    refused(&["evacuation", "--profile", "fs"], 2, &["--profile fs: "]);
    refused(&["evacuation", "--until=-3"], 2, &["--until"]);
    refused(
        &["evacuation", "--until", "1e8"],
        2,
        &["--until 100000000: "],
    );
    refused(&["evacuation", "--debug-agents", "all"], 2, &["--save"]);
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

#[test]
fn a_recording_has_all_agents_and_the_details_of_twelve() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.rrd");
    let path = file.to_str().unwrap();
    let run = ["evacuation", "--until", "0.2", "--save", path, "--json"];
    assert_eq!(run_json(&run)["frames"], 10);
    let recording = crate::common::recording::Recording::read(&file);
    let crowd = recording.pairs("/world/agents", "Points2D:positions");
    let frames: Vec<_> = crowd
        .iter()
        .map(|(frame, all)| (*frame, all.len()))
        .collect();
    assert_eq!(frames, [(0, 400), (5, 400), (10, 400)]);
    let kernels = recording.pairs("/world/debug/kernels", "Ellipses2D:centers");
    assert!(kernels.iter().all(|(_, circles)| circles.len() == 12));
    for entity in [
        "/world/geometry/walls",
        "/world/geometry/obstacles",
        "/world/geometry/goals",
        "/world/debug/forces/total",
        "/stats/density/mean",
        "/info/scenario",
    ] {
        assert!(recording.entities().contains(entity), "{entity}");
    }
}

#[test]
fn an_existing_file_is_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kept.rrd");
    std::fs::write(&file, "precious").unwrap();
    let path = file.to_str().unwrap();
    refused(
        &["evacuation", "--until", "0.1", "--save", path],
        2,
        &[path, "--force"],
    );
    assert_eq!(std::fs::read(&file).unwrap(), b"precious");
    run_json(&[
        "evacuation",
        "--until",
        "0.1",
        "--save",
        path,
        "--force",
        "--json",
    ]);
    let recording = crate::common::recording::Recording::read(&file);
    let crowd = recording.pairs("world/agents", "Points2D:positions");
    assert!(!crowd.is_empty() && crowd.iter().all(|(_, people)| people.len() == 400));
    let nowhere = folder.path().join("no/folder.rrd");
    refused(
        &[
            "evacuation",
            "--until",
            "0.1",
            "--save",
            nowhere.to_str().unwrap(),
        ],
        2,
        &["folder.rrd", "does not exist: make it"],
    );
}

#[test]
fn several_trajectories_are_written_without_changing_the_results() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let files = ["a.sqlite", "b.txt", "c.csv"].map(path);
    let mut run = vec!["evacuation", "--profile", "sf", "--until", "1", "--json"];
    let alone = run_json(&run);
    run.extend(
        files
            .iter()
            .flat_map(|file| ["--trajectory", file.as_str()]),
    );
    assert_eq!(run_json(&run)["metrics"], alone["metrics"]);
    let lines = |file: &str| std::fs::read_to_string(file).unwrap().lines().count();
    assert_eq!(lines(&files[1]), 2 + 11 * 400);
    assert_eq!(lines(&files[2]), 1 + 11 * 400);
    refused(&run, 2, &["--trajectory", "a.sqlite", "--force"]);
    run.extend(["--force", "--trajectory-fps", "2"]);
    run_json(&run);
    assert_eq!(lines(&files[1]), 2 + 3 * 400);
}

#[test]
fn an_impossible_trajectory_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [csv, hdf5, nowhere] = ["a.csv", "a.h5", "no/folder.txt"].map(path);
    let run = ["evacuation", "--until", "0.1", "--trajectory", &csv];
    let with = |more: &[&str], code, words: &[&str]| refused(&[&run, more].concat(), code, words);
    with(
        &["--trajectory", &hdf5],
        2,
        &["a.h5", ".sqlite", ".txt", ".csv"],
    );
    with(&["--trajectory", &csv], 2, &["a.csv", "are the same file"]);
    with(&["--trajectory-fps", "11"], 2, &["--trajectory-fps", " 10"]);
    with(&["--trajectory-fps", "0"], 2, &["--trajectory-fps"]);
    assert!(!folder.path().join("a.csv").exists());
    refused(
        &["evacuation", "--trajectory-fps", "5"],
        2,
        &["--trajectory"],
    );
    refused(
        &["evacuation", "--trajectory", &nowhere],
        2,
        &["folder.txt", "does not exist: make it"],
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("full.csv");
    std::os::unix::fs::symlink("/dev/full", &file).unwrap();
    let path = file.to_str().unwrap();
    let run = [
        "evacuation",
        "--until",
        "0.1",
        "--force",
        "--trajectory",
        path,
    ];
    refused(&run, 1, &["full.csv", "No space", "nothing is in it"]);
}

#[test]
fn invalid_reproduce_commands_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let out = file.to_str().unwrap();
    refused(&["reproduce", "table3"], 2, &["table3", "table1"]);
    refused(&["reproduce"], 2, &["WHAT"]);
    refused(&["reproduce", "table1", "--seeds", "0"], 2, &["--seeds"]);
    refused(&["reproduce", "table1", "--out", out], 1, &[out]);
    let missing = folder.path().join("missing.md");
    let missing = missing.to_str().unwrap();
    refused(&["reproduce", "table1", "--update", missing], 1, &[missing]);
}

#[test]
fn thread_counts_in_the_environment_have_the_bounds_of_the_option() {
    let run = |name: &str, text: &str, more: &[&str]| {
        let mut program = Command::new(PROGRAM);
        let program = program.args(["evacuation", "--until", "0", "--json"]);
        program.args(more).env(name, text).output().unwrap()
    };
    for name in ["RAYON_NUM_THREADS", "RAYON_RS_NUM_CPUS"] {
        for text in ["0", "1025", "100000", "many"] {
            let output = run(name, text, &[]);
            assert_eq!(output.status.code(), Some(2), "{name}={text}");
            assert_eq!(
                stderr(&output),
                format!(
                    "error: {name}={text} in the environment: not a number of threads between 1 and 1024\n"
                )
            );
            assert!(output.stdout.is_empty());
        }
        for (text, more, threads) in [("3", &[][..], 3), ("100000", &["--threads", "2"], 2)] {
            let output = run(name, text, more);
            let report = program::json(&output);
            assert_eq!(report["threads"], threads, "{name}={text}");
        }
    }
}

/// Breakdowns of 10,000 packed agents, all held at once, would take 350 MB.
#[cfg(target_os = "linux")]
#[test]
fn an_inspection_of_all_agents_holds_one_breakdown_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("packed.json");
    let text = r#"{"goal": [50, 50], "grids": [{"min": [0, 0], "max": [29, 29], "columns": 100, "rows": 100}]}"#;
    std::fs::write(&file, text).unwrap();
    let within = "ulimit -v 300000; exec \"$0\" inspect \"$1\" --all --json --threads 1";
    let output = Command::new("sh")
        .args(["-c", within, PROGRAM, file.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(
        program::json(&output)["agents"].as_array().unwrap().len(),
        10_000
    );
}

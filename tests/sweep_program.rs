//! `sandbox sweep` on the command line: exit codes, outputs, two processes at once.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::common::program::{PROGRAM, run_in};
use crate::common::sweep::{cases, column, folder, number, rows};
use serde_json::Value;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).current_dir(folder);
    command
}

/// Exit code, stdout and stderr.
fn parts(output: Output) -> (Option<i32>, String, String) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    parts(run_in(folder, arguments))
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let (code, stdout, stderr) = run(folder, arguments);
    assert_eq!(code, Some(0), "{arguments:?}: {stderr}");
    serde_json::from_str(&stdout).unwrap()
}

#[test]
fn a_cell_equals_a_run_with_its_settings() {
    let (folder, _) = folder(
        r#"{"scenario": "room.json", "seeds": [5, 6], "settings": {"duration_secs": 0.3},
            "grid": {"gas_constant": [300, 400], "grids.0.columns": [4]}}"#,
    );
    let study = json(folder.path(), &["sweep", "study.json", "--json"]);
    let cell = &study["cells"][3];
    assert_eq!(cell["settings"]["gas_constant"], 400);
    let set = [
        "--set",
        "gas_constant=400",
        "--set",
        "grids.0.columns=4",
        "--set",
        "duration_secs=0.3",
    ];
    let alone = [&["run", "room.json", "--seed", "6", "--json"], &set[..]].concat();
    let alone = json(folder.path(), &alone);
    // All reported values, except those about the computation itself.
    let how = [
        "interrupted",
        "threads",
        "ms_per_frame",
        "real_time_factor",
        "stages_ms",
        "version",
        "identity",
        "settings",
    ];
    let keys = alone.as_object().unwrap().keys();
    let keys: Vec<&String> = keys.filter(|key| !how.contains(&key.as_str())).collect();
    assert!(keys.len() >= 12);
    for key in keys {
        assert_eq!(cell["result"][key], alone[key], "{key}");
    }
    let table = rows(&folder.path().join("study/study.csv"));
    assert_eq!(
        column(&table, "state_sha256")[3],
        alone["state_sha256"].as_str().unwrap()
    );
}

#[test]
fn a_failed_cell_is_reported_at_the_end_with_exit_code_1() {
    let (folder, _) =
        folder(r#"{"scenario": "crack.json", "grid": {"sources.0.jitter": [1, 0, 1e-8]}}"#);
    let (code, stdout, stderr) = run(folder.path(), &["sweep", "study.json", "--out", "out"]);
    assert_eq!(code, Some(1));
    assert!(stderr.contains("error: 1 of 3 cells failed"), "{stderr}");
    assert!(
        stderr.contains("cell 1: sources.0.jitter=1 seed=1: agent 0"),
        "{stderr}"
    );
    assert!(
        stdout.contains("evacuated"),
        "the others are reported: {stdout}"
    );
    let table = rows(&folder.path().join("out/study.csv"));
    assert_eq!(column(&table, "status"), ["failed", "finished", "finished"]);
    let (code, stdout, _) = run(
        folder.path(),
        &[
            "sweep",
            "study.json",
            "--out",
            "out",
            "--shard",
            "2/3",
            "--json",
        ],
    );
    assert_eq!(code, Some(0), "a shard answers for its own cells");
    let told: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!([number(&told, "kept"), number(&told, "finished")], [1, 0]);
}

#[test]
fn two_processes_at_once_run_every_cell_once() {
    let (folder, _) = folder(r#"{"scenario": "room.json", "seeds": 40}"#);
    let begin = || {
        let arguments = ["sweep", "study.json", "--shard", "1/1", "--json"];
        let mut command = command(folder.path(), &arguments);
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    };
    let both = [begin(), begin()].map(|child| {
        let (code, stdout, stderr) = parts(child.wait_with_output().unwrap());
        assert_eq!(code, Some(0), "{stderr}");
        serde_json::from_str::<Value>(&stdout).unwrap()
    });
    assert_eq!(
        both.each_ref()
            .map(|told| number(told, "finished"))
            .iter()
            .sum::<u64>(),
        40
    );
    for told in &both {
        assert_eq!(number(told, "finished") + number(told, "kept"), 40);
    }
    assert_eq!(cases(&folder.path().join("study"), ".json").len(), 40);
    let (code, ..) = run(folder.path(), &["sweep", "study.json", "--merge"]);
    assert_eq!(code, Some(0));
}

#[test]
fn cells_finished_before_a_kill_are_kept() {
    let (folder, _) =
        folder(r#"{"scenario": "room.json", "grid": {"duration_secs": [0.1, 10000000]}}"#);
    let arguments = ["sweep", "study.json", "--threads", "2"];
    let mut child = command(folder.path(), &arguments)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let out = folder.path().join("study");
    while !out.join("cases").is_dir() || cases(&out, ".json").is_empty() {
        assert_eq!(child.try_wait().unwrap(), None, "it goes on for long");
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let (code, stdout, _) = run(folder.path(), &["sweep", "study.json", "--list"]);
    assert_eq!(code, Some(0));
    let last = |line: &str| {
        line.split_whitespace()
            .last()
            .unwrap_or_default()
            .to_owned()
    };
    assert_eq!(
        stdout.lines().map(last).collect::<Vec<_>>(),
        ["status", "finished", "missing"]
    );
    let (code, _, stderr) = run(folder.path(), &["sweep", "study.json", "--shard", "1/2"]);
    assert_eq!(code, Some(0));
    assert!(stderr.contains("0 case(s) to run, 1 kept"), "{stderr}");
}

#[test]
fn listing_runs_and_writes_nothing() {
    let (folder, _) =
        folder(r#"{"scenario": "room.json", "grid": {"viscosity": [0, 2.5]}, "seeds": 2}"#);
    let (code, stdout, _) = run(folder.path(), &["sweep", "study.json", "--list"]);
    assert_eq!(code, Some(0));
    assert_eq!(stdout.lines().count(), 5);
    assert_eq!(stdout.lines().next(), Some("cell  viscosity  seed  status"));
    assert_eq!(
        stdout.lines().nth(3),
        Some("3     2.5        1     missing")
    );
    let part = json(
        folder.path(),
        &["sweep", "study.json", "--list", "--shard", "2/3", "--json"],
    );
    assert_eq!(part["cells"].as_array().unwrap().len(), 1);
    assert_eq!(part["cells"][0]["cell"], 2);
    assert!(!folder.path().join("study").exists());
}

#[test]
fn merging_writes_finished_cells_and_names_missing_ones() {
    let (folder, _) = folder(r#"{"scenario": "room.json", "seeds": 5}"#);
    let merge = ["sweep", "study.json", "--merge"];
    let (code, _, stderr) = run(folder.path(), &merge);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("study: contains no study"), "{stderr}");
    let (code, stdout, _) = run(folder.path(), &["sweep", "study.json", "--shard", "1/3"]);
    assert_eq!(code, Some(0));
    assert_eq!(
        stdout,
        "shard 1/3: 2 cell(s); 2 finished now, 0 before, 0 failed\n"
    );
    assert!(
        !folder.path().join("study/study.csv").exists(),
        "shards write only their cells"
    );
    let (code, _, stderr) = run(folder.path(), &merge);
    assert_eq!(code, Some(1));
    assert!(
        stderr.contains("3 of 5 cells are missing: 2–3, 5"),
        "{stderr}"
    );
    let table = rows(&folder.path().join("study/study.csv"));
    assert_eq!(
        column(&table, "status")
            .iter()
            .filter(|s| *s == "finished")
            .count(),
        2
    );
}

#[test]
fn bad_input_is_refused_with_exit_code_2() {
    let (folder, path) = folder(r#"{"scenario": "room.json", "grid": {"viscosity": [0, -1]}}"#);
    let refused = |arguments: &[&str], words: &str| {
        let (code, stdout, stderr) = run(folder.path(), arguments);
        assert_eq!(code, Some(2), "{stderr}");
        assert!(stderr.contains(words), "{words} in {stderr}");
        assert_eq!(stdout, "");
    };
    refused(
        &["sweep", "study.json"],
        "study.json: cell 2: grid.viscosity[1]=-1: must be",
    );
    refused(&["sweep", "study.json", "--shard", "4/3"], "1 ≤ i ≤ n");
    refused(
        &["sweep", "study.json", "--shard", "1/3", "--merge"],
        "--merge",
    );
    refused(&["sweep", "study.json", "--list", "--merge"], "--merge");
    refused(&["sweep"], "FILE");
    std::fs::write(path, r#"{"scenario": "room.json"}"#).unwrap();
    std::fs::write(folder.path().join("study.csv"), "precious").unwrap();
    refused(&["sweep", "study.json", "--out", "."], "--force");
    assert_eq!(
        std::fs::read(folder.path().join("study.csv")).unwrap(),
        b"precious"
    );
    let (code, ..) = run(
        folder.path(),
        &["sweep", "study.json", "--out", ".", "--force"],
    );
    assert_eq!(code, Some(0));
    assert_eq!(rows(&folder.path().join("study.csv")).len(), 1);
    let help = run(folder.path(), &["sweep", "--help"]).1;
    assert!(help.contains("sandbox sweep study.json --shard 2/8"));
}

#[test]
fn a_mean_of_the_runs_that_have_a_value_says_how_many_they_are() {
    let (folder, _) = folder(
        r#"{"scenario": "part.json", "seeds": 6, "measurements": [{"egress": {}}],
            "grid": {"duration_secs": [8.2, 30]}}"#,
    );
    let part = r#"{"profile": "steer+sph", "motivation": 1, "duration_secs": 8.2,
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[12, 4], [12, 6]]}],
        "crowds": [{"area": [[1, 1], [6, 1], [6, 9], [1, 9]], "number": 10},
                   {"area": [[7, 1], [10, 1], [10, 9], [7, 9]], "number": 10}],
        "stop": {"when_empty": true}}"#;
    std::fs::write(folder.path().join("part.json"), part).unwrap();
    let (code, stdout, stderr) = run(folder.path(), &["sweep", "study.json", "--out", "out"]);
    assert_eq!(code, Some(0), "{stderr}");
    let rows = rows(&folder.path().join("out/study.csv"));
    let short = &rows[..6];
    let times = |name: &str| -> Vec<f64> {
        let values = column(short, name).into_iter();
        values.filter_map(|value| value.parse().ok()).collect()
    };
    let [all, most] = ["t100_secs", "t95_secs"].map(times);
    assert!(
        !all.is_empty() && all.len() < most.len() && most.len() < 6,
        "{all:?} {most:?}"
    );
    for times in [&all, &most] {
        assert!(
            stdout.contains(&format!(" [{} of 6]", times.len())),
            "{stdout}"
        );
    }
    assert!(stdout.contains("[n of m]: the mean of the n runs that have a value"));
    // The longer runs all end.
    assert_eq!(stdout.matches(" of 6]").count(), 2, "{stdout}");
    // So does the report.
    let (code, _, stderr) = run(
        folder.path(),
        &[
            "report",
            "study.json",
            "--results",
            "out",
            "-o",
            "study.html",
        ],
    );
    assert_eq!(code, Some(0), "{stderr}");
    let html = std::fs::read_to_string(folder.path().join("study.html")).unwrap();
    let (_, row) = html.split_once("all out [s]</td>").unwrap();
    let (row, _) = row.split_once("</tr>").unwrap();
    assert_eq!(
        row.matches(&format!("[{} of 6]", all.len())).count(),
        1,
        "{row}"
    );
}

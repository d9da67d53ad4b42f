//! Estimates that are interrupted, impossible or without chance.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::SystemTime;

use serde_json::Value;

use crate::common::program::{json, run_in, stderr};

/// A small evacuation.
const SMALL: [&str; 6] = [
    "--set",
    "grids.0.columns=7",
    "--set",
    "grids.0.rows=7",
    "--set",
    "measurements.1.flow_of_first.arrivals=30",
];

fn estimate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["estimate", "evacuation"], more, &SMALL[..]].concat()
}

/// The finished runs of a folder, with the times at which they were written.
fn finished(out: &Path) -> BTreeMap<String, SystemTime> {
    let entries = fs::read_dir(out.join("cases")).into_iter().flatten();
    let files = entries.map(|entry| entry.unwrap());
    let files = files.map(|file| (file.file_name().into_string().unwrap(), file));
    files
        .filter(|(name, _)| name.ends_with(".json"))
        .map(|(name, file)| (name, file.metadata().unwrap().modified().unwrap()))
        .collect()
}

/// All files of an answer without computing times.
fn tables(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(out)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let tables = entries.filter(|path| path.extension().is_some_and(|end| end == "csv"));
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    tables
        .map(|path| (name(&path), fs::read(&path).unwrap()))
        .collect()
}

#[cfg(unix)]
#[test]
fn an_interrupted_estimate_goes_on_with_its_runs_to_the_same_tables() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use crate::common::program::{PROGRAM, stop_with};

    let folder = tempfile::tempdir().unwrap();
    // Some seconds of computing, so that the signal arrives in the middle.
    let command = |out| {
        let wanted = ["estimate", "evacuation", "--error", "flow_per_s=1.2%"];
        let larger = [
            "--set",
            "grids.0.columns=16",
            "--set",
            "grids.0.rows=16",
            "--set",
            "measurements.1.flow_of_first.arrivals=150",
        ];
        [&wanted[..], &["--threads", "1", "--out", out], &larger].concat()
    };
    let output = run_in(folder.path(), &command("whole"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let expected = tables(&folder.path().join("whole"));
    assert_eq!(expected.len(), 2);
    // A program that a script starts in the background ignores SIGINT.
    for signal in ["TERM", "KILL"] {
        let out = folder.path().join(signal);
        let command = command(signal);
        let child = Command::new(PROGRAM)
            .args(&command)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while finished(&out).len() < 3 {
            assert!(start.elapsed() < Duration::from_secs(120), "it hangs");
            std::thread::sleep(Duration::from_millis(2));
        }
        let stopped = stop_with(child, &format!("kill -{signal} $1"));
        assert!(!stopped.status.success());
        let before = finished(&out);
        assert!(before.len() < finished(&folder.path().join("whole")).len());
        let output = run_in(folder.path(), &command);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let kept = format!("{} kept from before", before.len());
        assert!(
            stderr(&output).contains(&kept) || before.len() > 10,
            "{}",
            stderr(&output)
        );
        let after = finished(&out);
        for (name, time) in &before {
            assert_eq!(after[name], *time, "{name} was computed again");
        }
        assert_eq!(tables(&out), expected, "{signal}");
    }
}

#[test]
fn a_plan_for_an_impossible_error_ends_and_says_what_can_be_reached() {
    let folder = tempfile::tempdir().unwrap();
    let plan = ["--error", "time_secs=0.000000001%", "--plan", "--json"];
    let before = json(&run_in(folder.path(), &estimate(&plan)));
    assert_eq!(before["expected"]["short"][0][0], "time_secs");
    run_in(folder.path(), &estimate(&["--error", "time_secs=5%"]));
    let mut errors = Vec::new();
    for runs in ["40", "400"] {
        let more = [&plan[..], &["--most-runs", runs]].concat();
        let expected = &json(&run_in(folder.path(), &estimate(&more)))["expected"];
        let made = expected["runs"].as_array().unwrap().iter();
        let made: u64 = made.map(|of| of[1].as_u64().unwrap()).sum();
        assert_eq!(made.to_string(), runs);
        let short = &expected["short"][0];
        assert_eq!(short[0], "time_secs");
        let percent = short[1].as_str().unwrap().strip_suffix(" %").unwrap();
        errors.push(percent.parse::<f64>().unwrap());
    }
    assert!(errors[1] < errors[0] && errors[1] > 0.0, "{errors:?}");
    let said = run_in(folder.path(), &estimate(&plan[..3]));
    let said = String::from_utf8(said.stdout).unwrap();
    assert!(said.contains("time_secs reaches ± "), "{said}");
}

#[test]
fn a_scene_without_chance_has_the_error_of_the_step_alone() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/verification/speed.json");
    let scene = scene.to_str().unwrap();
    let command = [
        "estimate",
        scene,
        "--error",
        "t100_secs=0.5%",
        "--set",
        "population_seed=1",
        "--json",
    ];
    let output = run_in(folder.path(), &command);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let row = &json(&output)["estimate"]["results"][0];
    assert_eq!(row["is_reached"], true, "{row}");
    for at in row["steps"].as_array().unwrap() {
        assert!(at["deviation"].as_f64().unwrap() < 1e-9, "{row}");
    }
    assert!(row["seeds"].as_f64().unwrap() < 1e-3 * row["value"].as_f64().unwrap());
    // 41 m at 1.33 m/s, and less than the relaxation time to start.
    let value = row["value"].as_f64().unwrap();
    assert!((30.0..31.5).contains(&value), "{value}");
}

#[test]
fn steps_that_cannot_be_doubled_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let midpoint = [
        "--error",
        "time_secs=10%",
        "--set",
        "integrator=midpoint",
        "--time-step",
        "0.02",
    ];
    let output = run_in(folder.path(), &estimate(&midpoint));
    let said = stderr(&output);
    assert!(
        said.contains("longer time steps than 0.02 s are not known to be stable"),
        "{said}"
    );
    assert_eq!(output.status.code(), Some(0), "{said}");
    let tiny = [
        "--error",
        "time_secs=10%",
        "--set",
        "integrator=midpoint",
        "--time-step",
        "0.000001",
    ];
    let refused = run_in(folder.path(), &estimate(&tiny));
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        stderr(&refused).contains("--time-step"),
        "{}",
        stderr(&refused)
    );
}

#[test]
fn a_row_of_a_study_without_the_result_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let study =
        r#"{"grid": {"scenario": ["evacuation", "crossing"]}, "settings": {"duration_secs": 1}}"#;
    fs::write(folder.path().join("study.json"), study).unwrap();
    for option in [["--error", "flow_per_s=5%"], ["--bound", "flow_per_s=95%"]] {
        let refused = run_in(
            folder.path(),
            &[&["sweep", "study.json"][..], &option].concat(),
        );
        let said = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        let words = ["cell 2: scenario=crossing", option[0], "no such result"];
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
}

#[test]
fn compared_answers_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for (name, viscosity) in [("a.json", "viscosity=0"), ("b.json", "viscosity=5")] {
        let command = estimate(&["--error", "time_secs=10%", "--set", viscosity, "--json"]);
        let output = run_in(folder.path(), &command);
        fs::write(folder.path().join(name), output.stdout).unwrap();
    }
    let compared = run_in(folder.path(), &["compare", "a.json", "b.json"]);
    let said = String::from_utf8(compared.stdout).unwrap();
    assert!(
        said.starts_with("A: evacuation (sph, viscosity=0"),
        "{said}"
    );
    assert!(said.contains("\nB: evacuation (sph, viscosity=5"), "{said}");
    let compared = json(&run_in(
        folder.path(),
        &["compare", "a.json", "b.json", "--json"],
    ));
    let titles: Vec<&Value> = compared["compared"]["titles"]
        .as_array()
        .unwrap()
        .iter()
        .collect();
    assert_eq!(titles.len(), 2);
}

#[test]
fn a_row_of_a_study_without_a_value_leaves_the_others_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let study = serde_json::json!({
        "scenario": "evacuation", "name": "rows", "seeds": 2,
        "settings": {
            "grids.0.columns": 7, "grids.0.rows": 7, "measurements.1.flow_of_first.arrivals": 30
        },
        "list": [{"label": "whole"}, {"label": "too short", "duration_secs": 1}]
    });
    fs::write(folder.path().join("rows.json"), study.to_string()).unwrap();
    let wanted = ["--error", "flow_per_s=40%", "--error", "time_secs=40%"];
    let typed = [
        &["sweep", "rows.json", "--json", "--out", "out"],
        &wanted[..],
    ]
    .concat();
    let output = run_in(folder.path(), &typed);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stderr(&output);
    assert!(
        said.contains("too short") && said.contains("flow_per_s: too few of"),
        "{said}"
    );
    let rows = &json(&output)["rows"];
    let names = |row: usize| -> Vec<&str> {
        let results = rows[row]["estimate"]["results"].as_array().unwrap();
        results
            .iter()
            .map(|one| one["name"].as_str().unwrap())
            .collect()
    };
    assert_eq!(names(0), ["flow_per_s", "time_secs"]);
    assert_eq!(names(1), ["time_secs"]);
    assert_eq!(rows[1]["estimate"]["without"].as_array().unwrap().len(), 1);
    // The table has the value of the one row, and the time of both.
    let table = fs::read_to_string(folder.path().join("out/rows-estimate.csv")).unwrap();
    let lines: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let column = |name: &str| lines[0].iter().position(|cell| *cell == name).unwrap();
    let value = |row: usize, name: &str| lines[row][column(name)].parse::<f64>().ok();
    let flow = rows[0]["estimate"]["results"][0]["value"].as_f64();
    assert!(flow.is_some() && value(1, "flow_per_s") == flow, "{table}");
    assert_eq!(
        (value(2, "flow_per_s"), value(2, "flow_per_s_n")),
        (None, None)
    );
    assert!(
        (value(2, "time_secs").unwrap() - 1.0).abs() < 1e-9,
        "{table}"
    );
}

#[test]
fn a_bound_of_a_result_that_runs_lack_is_an_error_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let typed = [
        "--bound",
        "flow_per_s=80%",
        "--set",
        "duration_secs=1",
        "--out",
        "out",
    ];
    let output = run_in(folder.path(), &estimate(&typed));
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    let why = "have no value and count as above all others, so no bound holds for 80 % of runs";
    assert!(
        said.contains("not everything that was asked for has a value"),
        "{said}"
    );
    assert!(said.contains(why), "{said}");
}

#[test]
fn what_a_run_prints_first_can_be_estimated_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["t95_secs", "highest_density", "longest_queue", "arrived"];
    let errors: Vec<String> = names.iter().map(|name| format!("{name}=60%")).collect();
    let mut typed: Vec<&str> = errors.iter().flat_map(|error| ["--error", error]).collect();
    typed.extend(["--json", "--out", "out"]);
    let output = run_in(folder.path(), &estimate(&typed));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let results = &json(&output)["estimate"]["results"];
    // A run by itself has the values that the answer lists for its step and the first seed.
    let step = &results[0]["steps"][0];
    let secs = step["step"].as_f64().unwrap();
    let [step, every] = [
        ("time_step_secs", secs),
        ("coarse_every", (0.1 / secs).round()),
    ]
    .map(|(key, value)| format!("{key}={value}"));
    let alone = [
        "evacuation",
        "--preset",
        "fast",
        "--seed",
        "1",
        "--json",
        "--set",
        &step,
        "--set",
        &every,
    ];
    let alone = json(&run_in(folder.path(), &[&alone[..], &SMALL[..4]].concat()));
    let queues = alone["longest_queues"].as_array();
    let queue = queues
        .and_then(|all| all.first())
        .map_or(0.0, |one| one["agents"].as_f64().unwrap());
    let expected = [
        alone["t95_secs"].as_f64().unwrap(),
        alone["highest_density"]["density_per_m2"].as_f64().unwrap(),
        queue,
        49.0,
    ];
    for (k, expected) in expected.into_iter().enumerate() {
        let name = results[k]["name"].as_str().unwrap();
        let steps = results[k]["steps"].as_array().unwrap();
        let at = steps
            .iter()
            .find(|at| at["step"].as_f64() == Some(secs))
            .unwrap();
        assert_eq!((name, at["values"][0].as_f64()), (names[k], Some(expected)));
    }
}

/// The probability of at most `count` of `of` draws that are each right with this probability.
fn at_most(count: u32, of: u32, probability: f64) -> f64 {
    let ways = |k: u32| {
        (0..k)
            .map(|j| f64::from(of - j) / f64::from(j + 1))
            .product::<f64>()
    };
    let one =
        |k: u32| ways(k) * probability.powi(k as i32) * (1.0 - probability).powi((of - k) as i32);
    (0..=count).map(one).sum()
}

#[test]
fn a_result_that_some_runs_lack_is_not_reached() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/intervals/narrow_door.json");
    let scene = ["estimate", scene.to_str().unwrap()];
    let whole = run_in(
        folder.path(),
        &[&scene[..], &["--error", "t100_secs=20%", "--json"]].concat(),
    );
    // The last of the first four runs, which are those of the longest step, ends after this duration.
    let whole = json(&whole);
    let steps = whole["estimate"]["results"][0]["steps"].as_array().unwrap();
    let values = &steps.last().unwrap()["values"];
    let mut first: Vec<f64> = (0..4).map(|k| values[k].as_f64().unwrap()).collect();
    first.sort_by(f64::total_cmp);
    let duration = format!("duration_secs={}", 0.5 * (first[2] + first[3]));
    let ask = ["--error", "t100_secs=20%", "--set", &duration];
    let typed = [&scene[..], &ask[..]].concat();
    let output = run_in(folder.path(), &typed);
    assert_eq!(output.status.code(), Some(1));
    let again = run_in(folder.path(), &[&typed[..], &["--json"]].concat());
    let row = &json(&again)["estimate"]["results"][0];
    assert_eq!(row["is_reached"], false);
    // The share is that of the values, with the interval of Clopper and Pearson.
    let steps = row["steps"].as_array().unwrap().iter();
    let values = steps.flat_map(|at| at["values"].as_array().unwrap());
    let with = values.filter(|value| !value.is_null()).count() as u32;
    let share = &row["with_value"];
    let of = share["of"].as_u64().unwrap() as u32;
    assert_eq!(share["count"], with);
    assert!(with > 1 && with < of);
    let [low, high] = [0, 1].map(|k| share["interval"][k].as_f64().unwrap());
    assert!((at_most(with, of, high) - 0.025).abs() < 1e-6);
    assert!((1.0 - at_most(with - 1, of, low) - 0.025).abs() < 1e-6);
    // The text says the same.
    let said = String::from_utf8(output.stdout).unwrap();
    let sentence = format!("t100_secs: {with} of {of} runs have a value");
    assert!(said.contains(&sentence), "{said}");
    let line = said
        .lines()
        .find(|line| line.starts_with("t100_secs  "))
        .unwrap();
    assert!(line.contains("  no  ") && line.contains(" to "), "{line}");
}

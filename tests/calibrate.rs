//! `sandbox calibrate`: the search, its results, interruptions, shards and failures.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Stdio;

use proptest::prelude::*;
use proptest::sample::Index;
use sandbox::lab::calibrate::Calibration;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::bounded;
use crate::common::documents::{count, invalid_value, replace};
use crate::common::program::{PROGRAM, run, run_in, stderr};
use crate::common::sweep::cases;

/// Eight people on a ring who do not meet: their speed is the preferred speed.
const RING: &str = r#"{"duration_secs": 6, "profile": "sph", "periodic": {"axis": "x", "length": 20},
    "walkable_area": [[[[0, 0], [20, 0], [20, 1.8], [0, 1.8]]]],
    "grids": [{"min": [0, 0], "max": [20, 1.8], "columns": 8, "rows": 1}],
    "measurements": [{"walks": {"name": "ring", "region": [[0, 0], [20, 1.8]], "from_secs": 4}}]}"#;

/// Three people before an exit.
const ROOM: &str = r#"{"duration_secs": 20, "profile": "sph", "stop": {"when_empty": true},
    "walkable_area": [[[[0, 0], [6, 0], [6, 3], [0, 3]]]],
    "exits": [{"name": "out", "line": [[6, 0], [6, 3]]}],
    "grids": [{"min": [0, 0], "max": [3, 3], "columns": 1, "rows": 3}],
    "measurements": [{"line_flow": {"name": "room", "line": [[4, 0], [4, 3]]}}, {"egress": {}}]}"#;

/// Fits the preferred speed to 1.1 m/s. The gas constant has no effect on people who do not meet.
fn study() -> Value {
    json!({
        "parameters": [
            {"name": "preferred_speed", "bounds": [0.5, 2], "start": 1.6},
            {"name": "gas_constant", "bounds": [50, 800], "scale": "log"}
        ],
        "fit": [{"scenario": "ring.json", "name": "ring",
                 "values": [{"quantity": "ring_speed_m_per_s", "value": 1.1, "tolerance": 0.05}]}],
        "hold_out": [{"scenario": "ring.json", "settings": {"grids.*.columns": 5},
                      "values": [{"quantity": "ring_speed_m_per_s", "value": 1.1, "tolerance": 0.05}]}],
        "seeds": 2,
        "final_seeds": [7, 8],
        "screening": {"trajectories": 2},
        "search": {"population": 6, "generations": 10, "spread": 0.2}
    })
}

fn folder(study: &Value) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ring.json"), RING).unwrap();
    fs::write(folder.path().join("room.json"), ROOM).unwrap();
    fs::write(folder.path().join("study.json"), study.to_string()).unwrap();
    folder
}

fn calibrate(folder: &Path, more: &[&str]) -> String {
    let typed = [&["calibrate", "study.json"], more].concat();
    let output = run_in(folder, &typed);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{more:?}: {}",
        stderr(&output)
    );
    String::from_utf8(output.stdout).unwrap()
}

/// The contents of the result files.
fn results(folder: &Path) -> Vec<Vec<u8>> {
    let names = [
        "result.json",
        "result.md",
        "evaluations.csv",
        "convergence.svg",
        "errors.svg",
        "screening.svg",
    ];
    names
        .map(|name| fs::read(folder.join("study").join(name)).unwrap())
        .to_vec()
}

#[test]
fn the_fitted_parameter_is_found_and_the_idle_one_is_not_identified() {
    let folder = folder(&study());
    let found: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    let [speed, idle] = [0, 1].map(|k| &found["parameters"][k]);
    let best = speed["best"].as_f64().unwrap();
    assert!((best - 1.1).abs() < 0.03, "{speed}");
    let interval = [0, 1].map(|k| speed["interval"][k].as_f64().unwrap());
    // One tolerance is 5 %: the slope is 1/(1.1 ln 1.05) tolerances per m/s.
    let expected = 1.96 * 1.1 * 1.05_f64.ln();
    assert!(
        ((interval[1] - interval[0]) / 2.0 / expected - 1.0).abs() < 0.1,
        "{interval:?}"
    );
    assert_eq!([&speed["identified"], &idle["identified"]], [true, false]);
    assert!(idle["covers"].as_f64().unwrap() > 0.5, "{idle}");
    for set in found["misfits"].as_array().unwrap() {
        assert!(set["best"].as_f64().unwrap() < 0.6, "{set}");
        // The start is ln(1.6/1.1)/ln(1.05) tolerances off.
        let start = (1.6_f64 / 1.1).ln() / 1.05_f64.ln();
        assert!(
            (set["start"].as_f64().unwrap() / start - 1.0).abs() < 0.02,
            "{set}"
        );
    }
    let effects = &found["screening"]["values"][0];
    assert!(effects[0]["mean_absolute"].as_f64().unwrap() > 10.0);
    assert!(effects[1]["mean_absolute"].as_f64().unwrap() < 1e-6);
    assert_eq!(found["settings"]["preferred_speed"], speed["best"]);
    let text = fs::read_to_string(folder.path().join("study/result.md")).unwrap();
    assert!(
        text.contains("| gas_constant |") && text.contains("not identified"),
        "{text}"
    );
    let table = fs::read_to_string(folder.path().join("study/evaluations.csv")).unwrap();
    let generations: BTreeSet<&str> = table
        .lines()
        .filter_map(|line| line.split(',').nth(1))
        .collect();
    assert!(generations.contains("10") && table.lines().count() == 1 + 1 + 6 + 60 + 4);
}

#[test]
fn a_frozen_parameter_keeps_its_start_and_the_generations_are_those_asked_for() {
    let mut study = study();
    study["screening"].take();
    study["parameters"][1]["frozen"] = true.into();
    study["parameters"][1]["start"] = 321.into();
    let folder = folder(&study);
    let listed = calibrate(folder.path(), &["--list", "--generations", "2"]);
    assert!(
        listed.lines().any(|line| line.ends_with("frozen")),
        "{listed}"
    );
    let found = calibrate(folder.path(), &["--json", "--generations", "2"]);
    let found: Value = serde_json::from_str(&found).unwrap();
    assert_eq!(found["searched"], json!(["preferred_speed"]));
    assert_eq!(found["parameters"][1]["best"], 321.0);
    assert!(found["parameters"][1]["interval"].is_null());
    assert_eq!(found["generations"].as_array().unwrap().len(), 2);
    // The start, two generations of six points, and both sides of the best point.
    let table = fs::read_to_string(folder.path().join("study/evaluations.csv")).unwrap();
    let constants: Vec<&str> = table
        .lines()
        .filter_map(|line| line.split(',').nth(5))
        .collect();
    assert_eq!(constants[0], "gas_constant");
    assert_eq!(constants[1..], ["321"; 1 + 12 + 2]);
}

#[test]
fn an_interrupted_search_goes_on_to_the_same_bytes() {
    let folder = folder(&study());
    let whole = calibrate(folder.path(), &[]);
    let expected = results(folder.path());
    let out = folder.path().join("study");
    let count = cases(&out, ".json").len();

    // Everything that the results follow from is the finished cells.
    fs::remove_file(out.join("result.json")).unwrap();
    let mut kept = cases(&out, ".json");
    kept.sort();
    kept.iter()
        .step_by(3)
        .for_each(|file| fs::remove_file(file).unwrap());
    assert_eq!(calibrate(folder.path(), &["--threads", "1"]), whole);
    assert_eq!(results(folder.path()), expected);
    assert_eq!(cases(&out, ".json").len(), count);

    // Killed in the middle.
    fs::remove_dir_all(&out).unwrap();
    let mut child = std::process::Command::new(PROGRAM)
        .args(["calibrate", "study.json", "--threads", "1"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !out.join("cases").is_dir() || cases(&out, ".json").len() < count / 2 {
        assert_eq!(
            child.try_wait().unwrap(),
            None,
            "the search is not over yet"
        );
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!out.join("result.json").exists());
    assert_eq!(calibrate(folder.path(), &[]), whole);
    assert_eq!(results(folder.path()), expected);

    // A finished one runs nothing.
    let output = run_in(folder.path(), &["calibrate", "study.json"]);
    assert!(
        !stderr(&output).contains("case(s) to run"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn two_shards_at_once_compute_every_cell_once() {
    let alone = folder(&study());
    let expected = calibrate(alone.path(), &["--json"]);
    let count = cases(&alone.path().join("study"), ".json").len();
    let shared = folder(&study());
    let begin = |shard: &str| {
        let mut command = std::process::Command::new(PROGRAM);
        command.args([
            "calibrate",
            "study.json",
            "--json",
            "--threads",
            "1",
            "--shard",
            shard,
        ]);
        let command = command.current_dir(shared.path());
        command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    let both = [begin("1/2"), begin("2/2")].map(|child| child.wait_with_output().unwrap());
    // A line for every finished cell: `12 %, 3 s left; cell 5: …`.
    let finished = both
        .each_ref()
        .map(|output| stderr(output).matches(" s left; cell ").count());
    for output in &both {
        assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
        assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
    }
    assert_eq!(finished[0] + finished[1], count);
}

#[test]
fn more_generations_go_on_from_those_that_are_there() {
    let mut study = study();
    study["search"]["generations"] = json!(4);
    let folder = folder(&study);
    let few: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    study["search"]["generations"] = json!(6);
    fs::write(folder.path().join("study.json"), study.to_string()).unwrap();
    let more: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    let generations = |found: &Value| found["generations"].as_array().unwrap().clone();
    assert_eq!(generations(&more)[..4], generations(&few)[..]);
    assert_eq!(generations(&more).len(), 6);
}

#[test]
fn stuck_runs_are_failures_with_the_penalty() {
    // At 0.01 m/s no one leaves within 20 s; the fitted flow would be found at about 1.3 m/s.
    let study = json!({
        "parameters": [{"name": "preferred_speed", "bounds": [0.01, 2], "start": 0.01}],
        "fit": [{"scenario": "room.json", "values": [{"quantity": "t100_secs", "value": 3, "tolerance": 0.1}]}],
        "residual": {"penalty": 25},
        "search": {"population": 5, "generations": 6, "spread": 0.4}
    });
    let folder = folder(&study);
    let found: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    let value = &found["values"][0];
    assert_eq!(value["start"]["mean"], Value::Null);
    assert_eq!(
        value["start"]["failures"],
        json!(["stuck: 3 people are left"])
    );
    assert_eq!(found["misfits"][0]["start"], 25.0);
    assert_eq!(value["best"]["failures"], json!([]));
    assert!(
        found["misfits"][0]["best"].as_f64().unwrap() < 3.0,
        "{found}"
    );
}

#[test]
fn parameters_without_effect_are_not_searched_if_the_study_says_so() {
    let mut study = study();
    study["screening"]["drop_below"] = json!(0.5);
    study["search"]["generations"] = json!(3);
    let folder = folder(&study);
    let found: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    assert_eq!(found["searched"], json!(["preferred_speed"]));
    let idle = &found["parameters"][1];
    assert_eq!(
        [&idle["interval"], &idle["identified"]],
        [&Value::Null, &json!(false)]
    );
    assert_eq!(idle["best"], idle["start"], "{idle}");
}

#[test]
fn a_parameter_can_be_several_keys_of_groups_of_people() {
    let mut study = study();
    study["parameters"][1] = json!({"name": "radius", "keys": ["grids.*.radius", "crowds.*.radius"],
                                    "bounds": [0.1, 0.3], "half_width": 0.05});
    study["search"]["generations"] = json!(1);
    let folder = folder(&study);
    let found: Value = serde_json::from_str(&calibrate(folder.path(), &["--json"])).unwrap();
    let best = found["parameters"][1]["best"].as_f64().unwrap();
    let drawn = &found["settings"]["grids.*.radius"]["uniform"];
    assert!(
        (drawn[0].as_f64().unwrap() - (best - 0.05)).abs() < 1e-6,
        "{drawn}"
    );
    assert!(
        (drawn[1].as_f64().unwrap() - (best + 0.05)).abs() < 1e-6,
        "{drawn}"
    );
}

#[test]
fn the_built_in_study_has_the_values_of_the_validation() {
    let output = run(&["calibrate", "headway", "--list", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let listed: Value = serde_json::from_slice(&output.stdout).unwrap();
    let values = listed["values"].as_array().unwrap();
    let gap = values
        .iter()
        .find(|value| value["run"] == "gap 2.4 m")
        .unwrap();
    assert_eq!(gap["quantity"], "flow [P/s]");
    assert_eq!(
        [&gap["measured"], &gap["tolerance"]],
        [&json!(6.07), &json!(0.06)]
    );
    let sets: BTreeSet<&str> = values
        .iter()
        .filter_map(|value| value["set"].as_str())
        .collect();
    assert_eq!(sets, BTreeSet::from(["fit", "hold_out", "transfer"]));
    let runs: BTreeSet<&str> = values
        .iter()
        .filter_map(|value| value["run"].as_str())
        .collect();
    assert_eq!(runs.len(), 14, "all runs of the validation");
}

#[test]
fn broken_studies_are_refused_by_name() {
    let broken: Vec<Value> =
        serde_json::from_str(include_str!("data/broken_calibrations.json")).unwrap();
    assert!(broken.len() >= 30);
    let place = folder(&Value::Null);
    for case in &broken {
        let mut document = study();
        for (pointer, value) in case["change"].as_object().unwrap() {
            match document.pointer_mut(pointer) {
                Some(old) => *old = value.clone(),
                None => {
                    let (parent, key) = pointer.rsplit_once('/').unwrap();
                    document.pointer_mut(parent).unwrap()[key] = value.clone();
                }
            }
        }
        fs::write(place.path().join("study.json"), document.to_string()).unwrap();
        let output = run_in(place.path(), &["calibrate", "study.json"]);
        let expected = format!("error: study.json: {}", case["message"].as_str().unwrap());
        assert_eq!(stderr(&output).trim_end(), expected, "{case}");
        assert_eq!(output.status.code(), Some(2), "{case}");
    }
    assert!(!place.path().join("study").exists());
}

#[test]
fn a_study_with_changed_values_is_read_or_refused() {
    let place = folder(&Value::Null);
    let path = place.path().join("study.json");
    let read = |document: &Value| match Calibration::parse(&document.to_string(), &path) {
        Ok(read) => read.targets.len(),
        Err(error) => {
            let said = error.to_string();
            let is_short = said.len() < 3000 && !said.contains(char::is_control);
            assert!(said.contains("study.json: ") && is_short, "{said:?}");
            0
        }
    };
    assert_eq!(read(&study()), 2);
    let changes = || prop::collection::vec((any::<Index>(), invalid_value()), 1..3);
    bounded::cases(2_000, changes, |changes| {
        let mut document = study();
        for (at, by) in changes {
            let mut k = at.index(count(&document));
            replace(&mut document, &mut k, &by);
        }
        read(&document);
        1 << 24
    });
}

//! `sandbox estimate` on the command line.

use std::fs;
use std::path::Path;

use sandbox::lab::estimate::{Prior, Series};
use sandbox::lab::model::Quantity;
use serde_json::Value;

use crate::common::pictures;
use crate::common::program::{json, refused, run, run_in, stderr};

/// A small evacuation; `more` follows.
fn estimate<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let small = [
        "estimate",
        "evacuation",
        "--out",
        out,
        "--json",
        "--set",
        "grids.0.columns=7",
        "--set",
        "grids.0.rows=7",
        "--set",
        "measurements.1.flow_of_first.arrivals=30",
    ];
    [&small[..], more].concat()
}

/// The answer without times.
fn answer(output: &std::process::Output) -> Value {
    let mut answer = json(output);
    answer["estimate"]["secs"] = Value::Null;
    for row in answer["estimate"]["results"].as_array_mut().unwrap() {
        row["default"]["secs"] = Value::Null;
    }
    answer
}

fn cases(folder: &Path) -> usize {
    fs::read_dir(folder.join("cases")).unwrap().count()
}

#[test]
fn an_estimate_is_the_same_on_any_number_of_threads_and_goes_on_where_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let wanted = ["--error", "flow_per_s=4%", "--error", "time_secs=4%"];
    let mut answers = Vec::new();
    for (out, threads) in [("one", "1"), ("two", "2")] {
        let more = [&wanted[..], &["--threads", threads]].concat();
        let output = run_in(folder.path(), &estimate(out, &more));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        answers.push(answer(&output));
    }
    assert_eq!(answers[0], answers[1]);
    // Interrupted after a few runs by a limit, it keeps them and goes on to the same answer.
    let more = [&wanted[..], &["--most-runs", "7"]].concat();
    let cut = run_in(folder.path(), &estimate("cut", &more));
    assert_eq!(cut.status.code(), Some(1));
    assert!(
        stderr(&cut).contains("at most 7 runs were allowed"),
        "{}",
        stderr(&cut)
    );
    assert!(cases(&folder.path().join("cut")) == 7);
    let output = run_in(folder.path(), &estimate("cut", &wanted));
    assert_eq!(answer(&output), answers[0]);
    assert!(
        stderr(&output).contains("4 kept from before"),
        "{}",
        stderr(&output)
    );
    let all = answers[0]["estimate"]["runs"]["all"].as_u64().unwrap();
    assert_eq!(cases(&folder.path().join("cut")), all as usize);
}

#[test]
fn an_answer_is_that_of_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    let output = run_in(
        folder.path(),
        &estimate("out", &["--error", "time_secs=3%"]),
    );
    let answer = &answer(&output)["estimate"];
    let row = &answer["results"][0];
    assert_eq!(row["is_reached"], true);
    // A run by itself has the value that the answer lists for its seed and step.
    let mut found = Series {
        steps: Vec::new(),
        values: Vec::new(),
    };
    for at in row["steps"].as_array().unwrap() {
        let step = at["step"].as_f64().unwrap();
        let values: Vec<f64> = at["values"]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect();
        found.steps.push(step);
        found
            .values
            .push(values.iter().copied().map(Some).collect());
        let every = (0.1 / step).round().to_string();
        let settings = [
            format!("time_step_secs={step}"),
            format!("coarse_every={every}"),
            "grids.0.columns=7".to_owned(),
            "grids.0.rows=7".to_owned(),
        ];
        let set: Vec<&str> = settings
            .iter()
            .flat_map(|setting| ["--set", setting])
            .collect();
        let seed = values.len().to_string();
        let alone = run(&[
            &["evacuation", "--preset", "fast", "--seed", &seed, "--json"],
            &set[..],
        ]
        .concat());
        assert_eq!(
            json(&alone)["time_secs"].as_f64(),
            values.last().copied(),
            "{}",
            stderr(&alone)
        );
    }
    let known = Prior::of(["sph", "time_secs"], Some(Quantity::Time), &[], None);
    let reached = found.means(&known).unwrap().reached(0.95);
    for (name, expected) in [("value", reached.value), ("error", reached.error)] {
        let said = row[name].as_f64().unwrap();
        assert!((said - expected).abs() < 1e-9 * expected, "{name}: {said}");
    }
}

#[test]
fn the_text_says_what_the_default_step_alone_would_give() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["--error", "time_secs=3%", "--error", "flow_per_s=8%"];
    let found = json(&run_in(folder.path(), &estimate("out", &asked)));
    let typed = estimate("out", &asked);
    let typed: Vec<&str> = typed.into_iter().filter(|one| *one != "--json").collect();
    let text = String::from_utf8(run_in(folder.path(), &typed).stdout).unwrap();
    let rows = found["estimate"]["results"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for row in rows {
        let name = row["name"].as_str().unwrap();
        let number = |value: &Value| value.as_f64().unwrap();
        let of_step = number(&row["default"]["error_of_step"]);
        let about = match of_step.abs() < number(&row["error"]) {
            true => format!("No error of the default step of 0.02 s was found in {name} (± "),
            false => "The default step of 0.02 s has an error of ".to_owned(),
        };
        let (_, said) = text
            .split_once(&about)
            .unwrap_or_else(|| panic!("{about}: {text}"));
        let said = said.split(" s.").next().unwrap();
        let runs = row["default"]["runs"].as_f64().unwrap().ceil();
        let takes = format!(": the same ± takes {runs} runs at this step alone, ");
        assert!(said.contains(name) || about.contains(name), "{said}");
        assert!(said.contains(&takes), "{takes}: {said}");
    }
}

#[test]
fn a_result_without_spread_is_exact() {
    let folder = tempfile::tempdir().unwrap();
    let output = run_in(
        folder.path(),
        &estimate("out", &["--error", "evacuated=0.001"]),
    );
    let row = &answer(&output)["estimate"]["results"][0];
    assert_eq!(row["value"], 49.0);
    assert!(row["error"].as_f64().unwrap() < 1e-6, "{row}");
}

#[test]
fn impossible_questions_are_refused_before_the_first_run() {
    let unknown = ["no such result", "flow_per_s", "did you mean"];
    refused(
        &["estimate", "evacuation", "--error", "flow_pers=1%"],
        2,
        &unknown,
    );
    refused(
        &["estimate", "evacuation", "--error", "flow_per_s=0%"],
        2,
        &["must be above 0"],
    );
    refused(
        &["estimate", "evacuation", "--error", "flow_per_s"],
        2,
        &["such as flow_per_s=1%"],
    );
    refused(&["estimate", "evacuation"], 2, &["--error"]);
    refused(
        &["estimate", "evacuasion", "--error", "flow_per_s=1%"],
        2,
        &["evacuasion"],
    );
    let twice = [
        "estimate",
        "evacuation",
        "--error",
        "flow_per_s=1%",
        "--error",
        "flow_per_s=2%",
    ];
    refused(&twice, 2, &["given twice"]);
    let few = [
        "estimate",
        "evacuation",
        "--error",
        "flow_per_s=1%",
        "--most-runs",
        "3",
    ];
    refused(&few, 2, &["between 4 and 100000"]);
    let sure = [
        "estimate",
        "evacuation",
        "--error",
        "flow_per_s=1%",
        "--confidence",
        "100",
    ];
    refused(&sure, 2, &["between 50 and 99.99"]);
}

#[test]
fn an_error_that_cannot_be_reached_is_named_with_what_was_reached() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--error", "flow_per_s=0.000000001%", "--most-runs", "12"];
    let output = run_in(folder.path(), &estimate("out", &more));
    assert_eq!(output.status.code(), Some(1));
    let answer = &answer(&output)["estimate"];
    assert_eq!(answer["runs"]["all"], 12);
    assert_eq!(answer["results"][0]["is_reached"], false);
    assert!(answer["results"][0]["error"].as_f64().unwrap() > 0.0);
}

#[test]
fn runs_without_a_value_are_counted_apart() {
    let folder = tempfile::tempdir().unwrap();
    // 49 people: no run has 60 arrivals.
    let more = [
        "--error",
        "flow_per_s=2%",
        "--set",
        "measurements.1.flow_of_first.arrivals=60",
    ];
    let output = run_in(folder.path(), &estimate("out", &more));
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("flow_per_s: too few of 4 runs have a value"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn the_number_of_runs_is_predicted_from_earlier_ones() {
    let folder = tempfile::tempdir().unwrap();
    let plan = ["--error", "time_secs=3%", "--plan"];
    let before = json(&run_in(folder.path(), &estimate("out", &plan)));
    // Before the first run, from similar results in other scenes.
    assert!(before["expected"]["based_on"].is_null());
    assert!(before["expected"]["known"].as_u64().unwrap() > 0);
    assert!(!before["expected"]["runs"].as_array().unwrap().is_empty());
    // An error in the unit of a result says nothing about other scenes.
    let absolute = json(&run_in(
        folder.path(),
        &estimate("out", &["--error", "time_secs=2", "--plan"]),
    ));
    assert!(absolute["expected"].is_null());
    let made = run_in(folder.path(), &estimate("out", &plan[..2]));
    let made = answer(&made)["estimate"]["runs"]["all"].as_f64().unwrap();
    let after = json(&run_in(folder.path(), &estimate("out", &plan)));
    assert_eq!(after["expected"]["based_on"], "evacuation");
    let runs = after["expected"]["runs"].as_array().unwrap();
    let runs: f64 = runs.iter().map(|of| of[1].as_f64().unwrap()).sum();
    assert!((0.5..2.0).contains(&(runs / made)), "{runs} of {made}");
}

#[test]
fn every_row_of_a_study_has_the_error_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let study = r#"{"scenario": "evacuation", "settings": {"grids.0.columns": 7, "grids.0.rows": 7},
        "grid": {"profile": ["sph", "walk+sph"]}, "seeds": 2}"#;
    fs::write(folder.path().join("study.json"), study).unwrap();
    let arguments = [
        "estimate",
        "study.json",
        "--error",
        "time_secs=5%",
        "--json",
    ];
    let output = run_in(folder.path(), &arguments);
    let answers = json(&output);
    let rows = answers["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for (row, profile) in rows.iter().zip(["sph", "walk+sph"]) {
        assert_eq!(row["settings"]["profile"], profile);
        let result = &row["estimate"]["results"][0];
        assert_eq!(result["is_reached"], true);
        assert!(result["error"].as_f64().unwrap() <= 0.05 * result["value"].as_f64().unwrap());
        // The same question by itself has the same answer.
        let more = ["--error", "time_secs=5%", "--profile", profile];
        let small = ["--set", "grids.0.columns=7", "--set", "grids.0.rows=7"];
        let own = [&["estimate", "evacuation", "--json"], &small[..], &more[..]].concat();
        let own = answer(&run_in(folder.path(), &own));
        assert_eq!(own["estimate"]["results"][0]["value"], result["value"]);
    }
    let table = fs::read_to_string(folder.path().join("study/study-estimate.csv")).unwrap();
    let head = "profile,time_secs,time_secs_error,time_secs_seeds,time_secs_step,time_secs_n";
    assert_eq!(table.lines().next(), Some(head));
    let texts = ["sph", "walk+sph", "profile", "time_secs"];
    pictures::assert_has(&folder.path().join("study/study-estimate"), &texts);
    // The old spelling makes no runs of its own.
    let swept = run_in(folder.path(), &[&["sweep"], &arguments[1..]].concat());
    assert_eq!(json(&swept)["rows"], answers["rows"]);
    let note = "note: `sandbox sweep STUDY --error …` is `sandbox estimate STUDY --error …` now";
    assert!(stderr(&swept).contains(note), "{}", stderr(&swept));
}

#[test]
fn two_answers_are_compared_with_their_errors() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, more: &[&str]| {
        let more = [&["--error", "time_secs=5%"], more].concat();
        let output = run_in(folder.path(), &estimate("out", &more));
        fs::write(folder.path().join(name), output.stdout).unwrap();
    };
    write("a.json", &[]);
    write("b.json", &["--set", "grids.0.columns=12"]);
    let compared = json(&run_in(
        folder.path(),
        &["compare", "a.json", "b.json", "--json"],
    ));
    let change = &compared["compared"]["results"][0];
    assert_eq!(change["is_clear"], true, "{change}");
    assert!(change["change"].as_f64().unwrap() > change["error"].as_f64().unwrap());
    // An answer does not differ from itself.
    let same = json(&run_in(
        folder.path(),
        &["compare", "a.json", "a.json", "--json"],
    ));
    let change = &same["compared"]["results"][0];
    assert_eq!(
        (&change["change"], &change["is_clear"]),
        (&0.0.into(), &false.into())
    );
    write("c.json", &["--confidence", "90"]);
    let refused = run_in(folder.path(), &["compare", "a.json", "c.json"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        stderr(&refused).contains("90 % cannot be compared"),
        "{}",
        stderr(&refused)
    );
}

#[test]
fn files_have_names_of_their_own_that_stay_in_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"{"name": "../a/b", "duration_secs": 2, "navigation": "straight", "goal": [8, 1],
        "grids": [{"min": [0, 0], "max": [4, 4], "columns": 4, "rows": 4, "jitter": 0.1}],
        "walkable_area": [[[[-1, -1], [9, -1], [9, 9], [-1, 9]]]],
        "obstacles": [[[20, 20], [21, 20], [20.5, 21]]],
        "measurements": [{"density": {"at_secs": 1, "region": [[0, 0], [4, 4]]}}]}"#;
    fs::write(folder.path().join("room.json"), text).unwrap();
    for viscosity in ["viscosity=0", "viscosity=5"] {
        let typed = ["estimate", "room.json", "--error", "density_mean_1s=20%"];
        let output = run_in(folder.path(), &[&typed[..], &["--set", viscosity]].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{said}");
        // What a run notes about the scenario is noted here, too.
        let alone = run_in(folder.path(), &["run", "room.json", "--until", "0"]);
        let notes = stderr(&alone);
        let notes: Vec<&str> = notes
            .lines()
            .filter(|line| line.contains("obstacles[0]"))
            .collect();
        assert!(
            !notes.is_empty() && notes.iter().all(|note| said.contains(note)),
            "{said}"
        );
        let name = format!("estimate/a-b-sph-{viscosity}.json");
        assert!(folder.path().join(&name).exists(), "{name}: {said}");
    }
    assert!(!folder.path().join("a").exists());
}

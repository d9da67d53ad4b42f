//! Suites: the cases of the built-in ones and their runs, and suites of users.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use proptest::prelude::*;
use proptest::sample::Index;
use sandbox::lab::suite::{Case, Chosen, Suite};
use sandbox::scenario::{built_in, calibrated};
use serde_json::{Value, json};

use crate::common::bounded;
use crate::common::documents::{count, invalid_value, replace};
use crate::common::program::{run_in, stderr};
use crate::common::suite::{changed, example};
use crate::common::tracks::file_of_a_row;

/// People who enter one by one at `x` meters and walk toward smaller y. Lengths are in units of `unit` meters.
fn people(head: &str, x: f64, unit: f64) -> String {
    let mut text = head.to_owned();
    for person in 0..5 {
        for frame in 0..=60 {
            let y = (3.0 - f64::from(frame) / 25.0) / unit;
            text += &format!("{person} {} {} {y} 0\n", 25 * person + frame, x / unit);
        }
    }
    text
}

#[test]
fn checks_name_the_calibrated_profiles_that_were_fitted_to_them() {
    let suite = Suite::built_in("validation").unwrap();
    let mut found = 0;
    for profile in calibrated::all() {
        let path = format!("calibration/{}.json", profile.study);
        let study: Value = serde_json::from_str(built_in(Path::new(&path)).unwrap()).unwrap();
        let fit = study["fit"].as_array().unwrap();
        for case in &suite.cases {
            for check in &case.checks {
                let is_fitted = fit.iter().any(|scene| {
                    let begins = |value: &Value| check.name.starts_with(value.as_str().unwrap());
                    let values = scene["values"].as_array();
                    scene["case"] == case.name.as_str()
                        && values.is_none_or(|values| values.iter().any(begins))
                });
                let says = check.fitted.iter().any(|name| name == profile.name);
                assert_eq!(
                    says, is_fitted,
                    "{}: {}, {}",
                    case.name, check.name, profile.name
                );
                found += usize::from(says);
            }
        }
    }
    assert!(found > 30, "{found}");
}

#[test]
fn checks_of_the_built_in_suites_name_all_runs_and_no_unknown_quantities() {
    let data = tempfile::tempdir().unwrap();
    let bottleneck = people("# framerate: 25 fps\n# id frame x/m y/m z/m\n", 0.3, 1.0);
    let in_centimeters = people("# id frame x y z\n", 0.3, 0.01);
    let corner = people("# framerate: 16\n# id frame x y z\n", -1.5, 1.0);
    let force = "0 0\n0.4 20\n0.6 0\n".to_owned();
    for (file, text) in [
        ("040_c_56_h-.txt", &bottleneck),
        ("uo-180-180-180.txt", &in_centimeters),
        ("uo-180-180-120.txt", &in_centimeters),
        ("uo-180-180-095.txt", &in_centimeters),
        ("bo-360-090-090.txt", &in_centimeters),
        ("bo-360-160-160.txt", &in_centimeters),
        ("corner.txt", &corner),
        ("push_tue_15.csv", &file_of_a_row([0.8, 3.37])),
        ("push_tue_15.txt", &force),
        ("push_wed_03.csv", &file_of_a_row([-0.1, -1.9])),
        ("push_wed_03.txt", &force),
    ] {
        fs::write(data.path().join(file), text).unwrap();
    }
    for name in ["verification", "validation"] {
        let suite = Suite::built_in(name).unwrap();
        assert!(suite.cases.len() > 20, "{name}");
        let chosen = Chosen {
            cases: suite.cases.iter().collect(),
            data: Some(data.path()),
            ..Chosen::default()
        };
        let planned = suite.planned(&chosen).map_err(|error| error.to_string());
        let planned = planned.unwrap();
        assert_eq!(planned.skipped.len(), 0);
        let cells = planned.study.cells.iter();
        let known: BTreeSet<&str> = cells.filter_map(|cell| cell.label()).collect();
        let used: BTreeSet<&str> = suite.cases.iter().flat_map(Case::runs).collect();
        assert_eq!(used, known, "{name}");
        for case in &suite.cases {
            assert!(case.picture.is_some(), "{}", case.name);
        }
    }
}

#[test]
fn the_suite_of_the_documentation_passes() {
    let folder = example();
    for (command, seeds) in [("validate", ""), ("verify", "1")] {
        let output = run_in(folder.path(), &[command, "my_suite.json", "--out", command]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(
            printed.starts_with("Passed by sph: 1 of 1 cases")
                && printed.contains("12 people leave by a door of 1 m or 2 m (our drill of May)"),
            "{printed}"
        );
        let out = folder.path().join(command);
        let csv = fs::read_to_string(out.join("my_suite.csv")).unwrap();
        let row = format!("room,sf->sph,{seeds},people out,12,12,12,true");
        assert!(csv.lines().any(|line| line == row), "{csv}");
        let findings = fs::read_to_string(out.join("my_suite.json")).unwrap();
        let findings: Value = serde_json::from_str(&findings).unwrap();
        for finding in findings.as_array().unwrap() {
            assert_eq!(
                (&finding["case"], &finding["passed"]),
                (&"room".into(), &true.into())
            );
            assert_eq!(finding["checks"][0]["value"], 12.0);
        }
        // The room with its people, who have colors.
        let picture = image::open(out.join("room.png")).unwrap().to_rgb8();
        let is_colored = |pixel: &&image::Rgb<u8>| pixel.0.iter().max() > pixel.0.iter().min();
        let colored = picture.pixels().filter(is_colored).count();
        assert!(colored > 500, "{colored} pixels");
    }
}

#[test]
fn a_suite_with_a_passing_and_a_failing_check_fails_and_says_which() {
    let folder = example();
    let checks = json!([
        {"name": "people out", "quantity": "finished", "of": "door 1 m", "expected": {"between": [12, 12]}},
        {"name": "people left", "quantity": "remaining", "of": "door 2 m", "expected": {"between": [1, null]}}
    ]);
    changed(folder.path(), "/cases/0/checks", checks);
    let typed = ["validate", "my_suite.json", "room", "--profile", "sph"];
    let output = run_in(folder.path(), &typed);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stderr(&output);
    let said = said.lines().last().unwrap();
    assert_eq!(
        said,
        "error: case room, sph: people left is 0, expected at least 1"
    );
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("Passed by sph: 0 of 1 cases"), "{printed}");
    let rows: Vec<Vec<&str>> = printed
        .lines()
        .map(|line| line.split("  ").collect())
        .collect();
    let row = |cells: &[&str]| {
        let has = |row: &&Vec<&str>| {
            cells
                .iter()
                .all(|cell| row.iter().any(|own| own.trim() == *cell))
        };
        rows.iter().any(|row| has(&row))
    };
    assert!(
        row(&["people out", "12"]) && row(&["people left", "at least 1", "**0**"]),
        "{printed}"
    );

    changed(
        folder.path(),
        "/cases/0/known_misses",
        json!({"sph": "no agent is locked in"}),
    );
    let output = run_in(folder.path(), &typed);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(
        printed.contains("- **room**, sph: no agent is locked in."),
        "{printed}"
    );
}

#[test]
fn a_suite_without_a_list_needs_no_labels_and_without_profiles_has_the_scenarios() {
    let folder = example();
    let suite = json!({
        "scenario": "room.json",
        "cases": [{"name": "out", "about": "all leave", "checks": [
            {"name": "people out", "quantity": "finished", "expected": {"between": [13, null]}}
        ]}]
    });
    changed(folder.path(), "", suite);
    let output = run_in(folder.path(), &["verify", "my_suite.json", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stderr(&output);
    assert!(
        said.ends_with("people out is 12, expected at least 13\n"),
        "{said}"
    );
}

#[test]
fn broken_suites_are_refused_by_place_with_what_would_be_right() {
    let broken: Vec<Value> = serde_json::from_str(include_str!("data/broken_suites.json")).unwrap();
    assert!(broken.len() >= 25);
    for case in &broken {
        let folder = example();
        for (pointer, value) in case["change"].as_object().unwrap() {
            changed(folder.path(), pointer, value.clone());
        }
        let output = run_in(folder.path(), &["validate", "my_suite.json"]);
        let expected = format!(
            "error: my_suite.json: {}",
            case["message"].as_str().unwrap()
        );
        assert_eq!(stderr(&output).trim_end(), expected, "{case}");
        assert_eq!(output.status.code(), Some(2), "{case}");
        assert!(!folder.path().join("validation").exists());
    }
}

#[test]
fn a_suite_with_changed_values_is_planned_or_refused() {
    let folder = example();
    let path = folder.path().join("my_suite.json");
    let suite: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    let planned = |document: &Value| {
        fs::write(&path, document.to_string()).unwrap();
        let suite = Suite::read(&path).map_err(|error| error.to_string())?;
        let chosen = Chosen {
            cases: suite.cases.iter().collect(),
            ..Chosen::default()
        };
        let planned = suite.planned(&chosen);
        planned.map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(planned(&suite), Ok(()));
    let changes = || prop::collection::vec((any::<Index>(), invalid_value()), 1..3);
    bounded::cases(500, changes, |changes| {
        let mut document = suite.clone();
        for (at, by) in changes {
            let mut k = at.index(count(&document));
            replace(&mut document, &mut k, &by);
        }
        if let Err(said) = planned(&document) {
            let is_short = said.len() < 3000 && !said.contains(char::is_control);
            assert!(said.contains("my_suite.json: ") && is_short, "{said:?}");
        }
        1 << 24
    });
}

#[test]
fn update_also_writes_the_status_beside_the_document() {
    let folder = example();
    let path = |name: &str| folder.path().join(name);
    let document = "<!-- my_suite -->\n<!-- /my_suite -->\n";
    let other = r#"{"cases": 1, "passed": 0, "missed": ["room"], "values": [0, 1]}"#;
    let status =
        format!(r#"{{"suite": "my_suite", "profiles": {{"rvo": {other}, "sph": {other}}}}}"#);
    fs::write(path("doc.md"), document).unwrap();
    fs::write(path("doc.json"), status).unwrap();
    let verify = |more: &str| {
        let typed = format!("verify my_suite.json --out verified --update doc.md{more}");
        let output = run_in(folder.path(), &typed.split(' ').collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let status: Value =
            serde_json::from_str(&fs::read_to_string(path("doc.json")).unwrap()).unwrap();
        status["profiles"].clone()
    };
    // Of one profile: the document stays.
    let profiles = verify(" --profile sph");
    // The ratio of the simulated value to the expected one is kept, too: errors of the model come from it.
    let passed = |profile: &Value| {
        let ratio = &profile["ratios"]["room"]["time [s]"];
        let counts = [&profile["cases"], &profile["passed"]].map(Value::as_u64);
        counts == [Some(1), Some(1)]
            && profile["missed"] == serde_json::json!([])
            && profile["values"] == serde_json::json!([2, 2])
            && ratio
                .as_f64()
                .is_some_and(|ratio| ratio > 0.5 && ratio < 2.0)
    };
    assert!(passed(&profiles["sph"]), "{profiles}");
    assert_eq!(profiles["rvo"]["missed"][0], "room");
    assert!(profiles.get("sf->sph").is_none());
    assert_eq!(fs::read_to_string(path("doc.md")).unwrap(), document);
    let profiles = verify("");
    assert!(passed(&profiles["sf->sph"]), "{profiles}");
    assert!(
        fs::read_to_string(path("doc.md"))
            .unwrap()
            .contains("Passed by sph: 1 of 1 cases")
    );
}

//! `--seed`, `--set` and `--force` of suites: every run is changed, and all results say so.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::program::{json as json_of, run_in, stderr};
use crate::common::suite::{changed, example};

/// The exit code of a command line in a folder, and what it printed.
fn said(folder: &Path, typed: &str) -> (Option<i32>, String) {
    let output = run_in(folder, &typed.split(' ').collect::<Vec<_>>());
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.code(), printed + &stderr(&output))
}

/// The example, whose only case reports the time of the run with a door of 1 m, by `sph`.
fn timed() -> tempfile::TempDir {
    let folder = example();
    let time = json!([{"name": "time [s]", "quantity": "t100_secs", "of": "door 1 m"}]);
    changed(folder.path(), "/cases/0/checks", time);
    changed(folder.path(), "/grid/profile", json!(["sph"]));
    folder
}

#[test]
fn settings_and_seeds_change_every_run_and_all_results_say_so() {
    let folder = timed();
    let folder = folder.path();
    let mut times = Vec::new();
    for seed in ["5", "6"] {
        let typed = [
            "run",
            "room.json",
            "--profile",
            "sph",
            "--set",
            "crowds.0.number=20",
        ];
        let output = run_in(folder, &[&typed[..], &["--seed", seed, "--json"]].concat());
        let door = json_of(&output)["metrics"]["t100_secs"].as_f64().unwrap();
        times.push(door);
    }
    assert_ne!(times[0], times[1]);
    // The room of the scenario has the door of 1 m, too.
    let typed = "my_suite.json --set crowds.0.number=20 --seed 5 --out";
    let says = "`crowds.0.number=20` in every scene; seeds 5 to 6";
    for (command, expected) in [
        ("verify", times.clone()),
        ("validate", vec![(times[0] + times[1]) / 2.0]),
    ] {
        let (code, printed) = said(folder, &format!("{command} {typed} {command}"));
        assert_eq!(code, Some(0), "{printed}");
        let first = format!("**Not the suite as it is**: {says}.\n\nPassed by sph: 1 of 1 cases");
        assert!(printed.starts_with(&first), "{printed}");
        let out = folder.join(command);
        assert!(
            fs::read_to_string(out.join("my_suite.md"))
                .unwrap()
                .contains(&format!("\n\n{first}"))
        );
        let csv = fs::read_to_string(out.join("my_suite.csv")).unwrap();
        let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows[0].last(), Some(&"changed"));
        let rows = rows.iter().filter(|row| row[3] == "time [s]");
        let rows: Vec<(f64, &str)> = rows.map(|row| (row[4].parse().unwrap(), row[8])).collect();
        assert_eq!(rows.len(), expected.len());
        for ((value, changed), expected) in rows.into_iter().zip(expected) {
            assert!((value - expected).abs() < 1e-9, "{value}, {expected}");
            assert_eq!(changed, says);
        }
        let findings = fs::read_to_string(out.join("my_suite.json")).unwrap();
        let findings: Value = serde_json::from_str(&findings).unwrap();
        let changes = json!({"settings": ["crowds.0.number=20"], "seeds": [5, 6]});
        let findings = findings.as_array().unwrap();
        assert!(
            findings.iter().all(|one| one["changed"] == changes),
            "{findings:?}"
        );
    }
    // Without changes, nothing is said.
    let (_, printed) = said(folder, "verify my_suite.json --out verify");
    assert!(printed.starts_with("Passed by sph"), "{printed}");
    assert!(
        !fs::read_to_string(folder.join("verify/my_suite.csv"))
            .unwrap()
            .contains("changed")
    );
}

#[test]
fn one_changed_seed_is_said_alone() {
    let folder = timed();
    let (_, printed) = said(
        folder.path(),
        "verify my_suite.json --seed 9 --seeds 1 --out v",
    );
    assert!(
        printed.starts_with("**Not the suite as it is**: seed 9.\n"),
        "{printed}"
    );
    // The seed after the largest one is 0.
    let last = u64::MAX.to_string();
    let (code, printed) = said(
        folder.path(),
        &format!("verify my_suite.json --seed {last} --out v"),
    );
    assert_eq!(code, Some(0), "{printed}");
    assert!(printed.contains(&format!("seeds {last} to 0")), "{printed}");
}

#[test]
fn changed_results_enter_no_document_and_no_status() {
    let folder = timed();
    let folder = folder.path();
    let document = "<!-- my_suite -->\n<!-- /my_suite -->\n";
    let status = r#"{"suite": "my_suite", "profiles": {}}"#;
    fs::write(folder.join("doc.md"), document).unwrap();
    fs::write(folder.join("doc.json"), status).unwrap();
    for change in ["--seed 1", "--set crowds.0.number=20"] {
        let typed = format!("validate my_suite.json --out v --update doc.md {change}");
        let (code, printed) = said(folder, &typed);
        assert_eq!(code, Some(2), "{printed}");
        assert!(
            printed.contains("--update needs the suite as it is"),
            "{printed}"
        );
        assert_eq!(fs::read_to_string(folder.join("doc.md")).unwrap(), document);
        assert_eq!(fs::read_to_string(folder.join("doc.json")).unwrap(), status);
        assert!(!folder.join("v").exists());
    }
}

#[test]
fn settings_that_the_suite_varies_or_that_a_scene_lacks_are_refused() {
    let folder = timed();
    let folder = folder.path();
    changed(folder, "/grid/gas_constant", json!([200, 400]));
    for (change, reason) in [
        (
            "profile=sf",
            "--set profile=sf: give --profile NAME instead",
        ),
        ("seed=4", "--set seed=4: give --seed N instead"),
        (
            "gas_constant=100",
            "my_suite.json: --set gas_constant=100: varies in grid.gas_constant, which has other values",
        ),
        (
            "gas_constnat=100",
            "--set gas_constnat=100: unknown setting",
        ),
        (
            "grids.0.rows=4",
            "my_suite.json: cell 1: --set grids.0.rows=4: ",
        ),
        (
            "viscosity",
            "--set viscosity: a setting has the form key=value",
        ),
    ] {
        let (code, printed) = said(folder, &format!("verify my_suite.json --set {change}"));
        assert_eq!(code, Some(2), "{printed}");
        assert!(
            printed.starts_with(&format!("error: {reason}")),
            "{printed}"
        );
        assert!(!folder.join("verification").exists());
    }
}

#[test]
fn results_replace_other_files_only_by_force_and_the_suite_never() {
    let folder = timed();
    let folder = folder.path();
    fs::create_dir(folder.join("v")).unwrap();
    fs::write(folder.join("v/my_suite.md"), "notes").unwrap();
    let (code, printed) = said(folder, "validate my_suite.json --out v");
    assert_eq!(code, Some(2), "{printed}");
    assert!(
        printed.contains("v/my_suite.md: already exists; use --force"),
        "{printed}"
    );
    assert_eq!(
        fs::read_to_string(folder.join("v/my_suite.md")).unwrap(),
        "notes"
    );
    let (code, printed) = said(folder, "validate my_suite.json --out v --force");
    assert_eq!(code, Some(0), "{printed}");
    assert!(
        fs::read_to_string(folder.join("v/my_suite.md"))
            .unwrap()
            .starts_with("# Results of the suite my_suite\n\nPassed")
    );
    // Now the folder belongs to the suite.
    assert_eq!(said(folder, "validate my_suite.json --out v").0, Some(0));
    let suite = fs::read(folder.join("my_suite.json")).unwrap();
    let (code, printed) = said(folder, "validate my_suite.json --out . --force");
    assert_eq!(code, Some(2), "{printed}");
    assert!(printed.contains("an input is never replaced"), "{printed}");
    assert_eq!(fs::read(folder.join("my_suite.json")).unwrap(), suite);
}

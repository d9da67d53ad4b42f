//! The comparison of engines: what the engines get, and what they are compared with.
//!
//! No test here checks how long something takes.

use std::path::{Path, PathBuf};

use crate::reports::{assert_is_complete, quick, rows};
use experiments::compare;
use sandbox::lab::bench::{Plan, Report};
use serde_json::Value;

/// No Python interpreter.
const MISSING: &str = "no/such/python";

fn measure(plan: &Plan, python: &Path) -> Report {
    compare::measure(plan, python, &|_| ()).unwrap()
}

fn number(row: &Value, key: &str, which: &str) -> f64 {
    row[key][which].as_f64().unwrap()
}

#[test]
fn the_report_has_the_machine_and_the_spread_of_every_time() {
    let report = measure(&quick(), Path::new(MISSING));
    let keys = [
        "agents",
        "engine",
        "family",
        "model",
        "radius",
        "precision",
        "time_step",
        "threads",
        "steps",
        "mean_speed",
    ];
    let times = ["ms_per_step", "ms_per_simulated_second", "ratio"];
    assert_is_complete(&report, compare::NAME, &keys, &times);
}

#[test]
fn the_cost_is_that_of_a_simulated_second_and_our_ratio_to_ourselves_is_1() {
    let rows = rows(&measure(&quick(), Path::new(MISSING)));
    let ours = |row: &&Value| row["engine"] == "sandbox";
    let families: Vec<&Value> = rows.iter().filter(ours).map(|row| &row["family"]).collect();
    for family in ["social-force", "velocity-obstacles"] {
        assert!(families.contains(&&family.into()), "{family}");
    }
    for row in &rows {
        let time_step = row["time_step"].as_f64().unwrap();
        let cost = number(row, "ms_per_step", "median") / time_step;
        let stated = number(row, "ms_per_simulated_second", "median");
        assert!((stated / cost - 1.0).abs() < 1e-12, "{row}");
        assert!(row["mean_speed"].as_f64().unwrap() > 0.0, "{row}");
    }
    for row in rows.iter().filter(ours) {
        for which in ["minimum", "median", "maximum"] {
            assert_eq!(number(row, "ratio", which), 1.0, "{row}");
        }
        // Velocities are chosen in every fifth frame only.
        assert_eq!(row["steps"].as_u64().unwrap() % 5, 0, "{row}");
    }
}

#[test]
fn the_main_crowd_comes_first_and_no_crowd_is_larger_than_asked_for() {
    let agents = |largest: u32| -> Vec<u64> {
        let plan = Plan { largest, ..quick() };
        let rows = rows(&measure(&plan, Path::new(MISSING)));
        rows.iter()
            .map(|row| row["agents"].as_u64().unwrap())
            .collect()
    };
    let mut both = agents(1_000);
    assert_eq!(both[0], 400);
    both.dedup();
    assert_eq!(both, [400, 100]);
    assert!(agents(100).iter().all(|&agents| agents == 100));
}

#[test]
fn a_missing_engine_is_named_with_how_to_install_it() {
    let report = measure(&quick(), Path::new(MISSING));
    let text = report.findings().unwrap().document.text();
    for words in [
        "JuPedSim is missing",
        "RVO2 is missing",
        "no/such/python",
        "pip install jupedsim pyrvo",
        "--python",
    ] {
        assert!(text.contains(words), "no {words:?} in {text}");
    }
    let engines: Vec<String> = rows(&report)
        .iter()
        .map(|row| row["engine"].as_str().unwrap().to_owned())
        .collect();
    assert!(engines.contains(&"sandbox".to_owned()));
    let with_rustsim = engines
        .iter()
        .any(|engine| engine.contains("rustsim-crowd"));
    assert_eq!(with_rustsim, cfg!(feature = "compare"));
    assert_eq!(text.contains("--features compare"), !with_rustsim);
}

/// A fake Python with version 9.9 of every package. It writes the number of agents of each start to the file `people`,
/// and gives `answer` to each request for steps: seconds, and meters moved.
#[cfg(unix)]
fn fake_python(folder: &Path, answer: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("python");
    let script = format!(
        "#!/bin/sh\n[ $# -gt 2 ] || {{ echo 9.9; exit 0; }}\nwc -l < \"$3\" >> \"$(dirname \"$0\")/people\"\n\
         echo ready\nwhile read -r steps; do echo {answer}; done\n"
    );
    std::fs::write(&path, script).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[cfg(unix)]
#[test]
fn python_engines_get_all_agents_and_are_compared_with_the_same_family_and_radius_on_one_thread() {
    let folder = tempfile::tempdir().unwrap();
    let python = fake_python(folder.path(), "0.5 0.7");
    let rows = rows(&measure(&quick(), &python));
    let people = std::fs::read_to_string(folder.path().join("people")).unwrap();
    let people: Vec<&str> = people.lines().map(str::trim).collect();
    assert_eq!(people, [["100"; 4].as_slice(), &["400"; 5]].concat());
    let found = |engine: &str, family: &str, radius: f64| {
        let same = |row: &&Value| {
            (&row["engine"], &row["family"]) == (&engine.into(), &family.into())
                && row["radius"] == radius
        };
        rows.iter().find(same).unwrap()
    };
    for (engine, family, radius, time_step) in [
        ("JuPedSim (jupedsim 9.9)", "social-force", 2.5, 0.01),
        ("RVO2 (pyrvo 9.9)", "velocity-obstacles", 5.0, 0.25),
    ] {
        let theirs = found(engine, family, radius);
        assert_eq!(theirs["time_step"], time_step);
        // The first step takes half a second, so that two fit into a turn.
        assert_eq!(theirs["steps"], 2);
        assert_eq!(number(theirs, "ms_per_step", "median"), 250.0);
        let cost = 250.0 / time_step;
        assert_eq!(number(theirs, "ms_per_simulated_second", "maximum"), cost);
        let simulated = (1.0 + 3.0 * 2.0) * time_step;
        let speed = theirs["mean_speed"].as_f64().unwrap();
        assert!((speed * simulated / 0.7 - 1.0).abs() < 1e-12, "{speed}");
        let ours = found("sandbox", family, radius);
        assert_eq!(ours["threads"], 1);
        let least = number(ours, "ms_per_simulated_second", "minimum");
        let ratio = number(theirs, "ratio", "maximum");
        assert!((ratio * least / cost - 1.0).abs() < 1e-12);
    }
    let alone = found("JuPedSim (jupedsim 9.9)", "collision-free-speed", 3.0);
    assert!(alone["ratio"].is_null(), "no model of ours is like it");
}

#[cfg(unix)]
#[test]
fn a_crowd_that_would_take_too_long_is_left_out_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let python = fake_python(folder.path(), "3 0.7");
    let report = measure(&quick(), &python);
    let reason =
        "RVO2 (pyrvo 9.9), ORCA, all neighbors: no crowd of 400, as a step would take 12 s";
    let text = report.findings().unwrap().document.text();
    assert!(text.contains(reason), "{text}");
    for row in rows(&report) {
        let fake = row["engine"].as_str().unwrap().contains("9.9");
        // The anticipation velocity model takes part only with the main crowd, so that nothing is known before.
        let known = row["model"] != "anticipation velocity";
        assert!(!(fake && known && row["agents"] == 400), "{row}");
    }
}

#[cfg(unix)]
#[test]
fn a_python_engine_that_answers_nonsense_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let python = fake_python(folder.path(), "Warning");
    let output = crate::run(&["compare", "--quick", "--python", python.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("JuPedSim stopped") && said.contains("Warning"),
        "{said}"
    );
}

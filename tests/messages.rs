//! Messages and results quote files shortened and without control characters.

use std::fs;
use std::process::Output;

use crate::common::program::run_in;
use serde_json::{Value, json};

/// Terminal escape sequences, then 100,000 letters.
fn hostile() -> String {
    format!(
        "\u{1b}[31m\u{1b}]0;title\u{7}\u{9b}2J\r\n\u{202e}{}",
        "x".repeat(100_000)
    )
}

/// Checks that all output is short and without control characters, and contains `words`.
fn assert_harmless(output: &Output, code: i32, words: &str) {
    for bytes in [&output.stdout, &output.stderr] {
        let said = String::from_utf8_lossy(bytes);
        let start: String = said.chars().take(3000).collect();
        assert!(said.chars().count() < 3000, "{start}");
        let obeyed = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
        assert!(!said.contains(obeyed), "{start:?}");
    }
    let said = [output.stdout.as_slice(), &output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    assert!(said.contains(words), "no {words:?} in {said}");
    assert_eq!(output.status.code(), Some(code), "{said}");
}

fn scenario() -> Value {
    json!({"goal": [9, 5], "duration_secs": 0.1, "agents": [{"position": [2, 2]}]})
}

#[test]
fn text_from_a_scenario_is_shortened_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let long = hostile();
    let shown = "\\u{1b}[31m\\u{1b}]0;title\\u{7}\\u{9b}2J\\r\\n\\u{202e}xxx";
    for (key, value, code) in [
        ("name", json!(long), 0),
        ("profile", json!({"base": "sf", "name": long}), 0),
        ("profile", json!(long), 2),
        ("profile", json!({"base": long}), 2),
        ("seed", json!(long), 2),
        ("integrator", json!(long), 2),
        ("walkable_area", json!(long.replace('/', "")), 2),
        ("parameters", json!({ long.as_str(): 1 }), 2),
        (
            "agents",
            json!([{ "position": [0, 0], long.as_str(): 1 }]),
            2,
        ),
        (long.as_str(), json!(1), 2),
        (
            "events",
            json!([{"name": long, "at_secs": 0, "for_secs": 1, "region": [[50, 50], [51, 51]]}]),
            0,
        ),
    ] {
        let mut document = scenario();
        document[key] = value;
        fs::write(folder.join("s.json"), document.to_string()).unwrap();
        assert_harmless(&run_in(folder, &["run", "s.json"]), code, shown);
    }
    let twice = format!("{{{0}: 1, {0}: 2}}", json!(long));
    fs::write(folder.join("s.json"), twice).unwrap();
    assert_harmless(&run_in(folder, &["run", "s.json"]), 2, shown);
}

#[test]
fn text_from_the_command_line_is_shortened_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let long = hostile();
    for setting in [
        format!("profile={long}"),
        format!("viscosity={long}"),
        format!("{long}=1"),
        format!("stop.{long}=1"),
        long.clone(),
    ] {
        let typed = ["evacuation", "--until", "0.1", "--set", &setting];
        assert_harmless(&run_in(folder.path(), &typed), 2, "--set ");
    }
    let typed = ["evacuation", "--profile", &long];
    assert_harmless(&run_in(folder.path(), &typed), 2, "--profile \\u{1b}[31m");
    let name = "\u{1b}[31m.json";
    fs::write(folder.path().join(name), "[]").unwrap();
    let said = "\\u{1b}[31m.json: invalid type";
    assert_harmless(&run_in(folder.path(), &["run", name]), 2, said);
}

#[test]
fn text_from_a_study_is_shortened_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("walk.json"), scenario().to_string()).unwrap();
    let long = hostile();
    let shown = "\\u{1b}[31m";
    for (key, value, code) in [
        ("name", json!(format!("{long}/")), 2),
        ("scenario", json!(long.replace('/', "")), 2),
        ("settings", json!({ long.as_str(): 1 }), 2),
        ("settings", json!({ "viscosity": long }), 2),
        ("grid", json!({ "profile": [long] }), 2),
        ("grid", json!({ "description": ["a", long] }), 0),
        ("list", json!([{ format!("stop.{long}"): 1 }]), 2),
        (long.as_str(), json!(1), 2),
    ] {
        let mut document = json!({"scenario": "walk.json"});
        document[key] = value;
        fs::write(folder.join("study.json"), document.to_string()).unwrap();
        let output = run_in(folder, &["sweep", "study.json", "--list"]);
        assert_harmless(&output, code, shown);
    }
}

#[test]
fn text_from_plans_and_trajectories_is_shortened_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let long = hostile().replace(['\r', '\n'], "");
    let feature = json!({"type": "Feature", "properties": {"name": long},
                         "geometry": {"type": "Point", "coordinates": [0, 0]}});
    let plan = json!({"type": "FeatureCollection", "features": [feature]});
    fs::write(folder.join("plan.geojson"), plan.to_string()).unwrap();
    let degrees = json!({"type": "Polygon", "coordinates": [],
                         "crs": {"properties": {"name": format!("CRS84{long}")}}});
    fs::write(folder.join("degrees.geojson"), degrees.to_string()).unwrap();
    for plan in ["plan.geojson", "degrees.geojson"] {
        let typed = ["evacuation", "--geometry", plan];
        assert_harmless(&run_in(folder, &typed), 2, "\\u{1b}[31m");
    }
    let word = long.replace(' ', "");
    for (name, contents) in [
        ("a.txt", format!("# framerate: 10\n1 {word} 0 0\n")),
        ("a.txt", format!("# framerate: 10\n1 0 {word} 0\n")),
        ("a.txt", format!("# id frame x/{word} y\n1 0 0 0\n")),
        ("a.csv", format!("id,frame,x,y\n1,0,{word},0\n")),
    ] {
        fs::write(folder.join(name), contents).unwrap();
        let place = format!("{name}:");
        assert_harmless(&run_in(folder, &["measure", name]), 2, &place);
        assert!(!folder.join("a-measured").exists());
    }
}

#[test]
fn files_above_the_size_limit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let long = folder.path().join("long.json");
    // A sparse file.
    fs::File::create(&long).unwrap().set_len(1 << 40).unwrap();
    let reason = "longer than 268435456 bytes";
    for typed in [
        &["run", "long.json"][..],
        &["sweep", "long.json"],
        &["evacuation", "--geometry", "long.json"],
        &["resume", "long.json"],
    ] {
        let reason = if typed[0] == "resume" {
            "do not fit into this machine's"
        } else {
            reason
        };
        assert_harmless(&run_in(folder.path(), typed), 2, reason);
    }
}

#[test]
fn an_agent_that_starts_outside_is_moved_with_a_note_that_says_from_where_and_how_far() {
    let folder = tempfile::tempdir().unwrap();
    let outside = json!({
        "duration_secs": 0.1, "goal": [9, 5], "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]],
        "agents": [{"position": [2, 2]}, {"position": [11.5, 5]}]
    });
    fs::write(folder.path().join("f.json"), outside.to_string()).unwrap();
    let output = run_in(folder.path(), &["run", "f.json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    let note = "to the nearest free point (the first: agent 1, from (11.5, 5) by 1.50 m)";
    assert!(said.contains(note), "{said}");
}

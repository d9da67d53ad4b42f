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

/// A room of which all names are hostile, but short.
fn room() -> Value {
    let name = |kind: &str| format!("{kind}\u{1b}[31m\u{7}\u{9b}2J\u{202e}");
    json!({
        "name": name("room"), "description": name("about"), "duration_secs": 20, "profile": "sph",
        "stop": {"when_empty": true}, "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "exits": [{"name": name("east"), "line": [[8, 2], [8, 4]]}],
        "queues": [{"name": name("desk"), "path": [[4, 3], [2, 3]], "service_secs": 1}],
        "journeys": [{"name": name("out"), "stages": [name("desk"), name("east")]}],
        "zones": [{"name": name("zone"), "area": [[5, 1], [6, 1], [6, 5], [5, 5]], "speed_factor": 0.5}],
        "crowds": [{"name": name("crowd"), "area": [[1, 1], [3, 1], [3, 2], [1, 2]], "number": 3,
                    "journey": name("out")}],
        "measurements": [{"egress": {}}, {"line_flow": {"name": name("line"), "line": [[7.5, 2], [7.5, 4]]}}]
    })
}

#[test]
fn no_command_prints_control_characters_of_names() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("room.json"), room().to_string()).unwrap();
    let label = "\u{1b}[31m";
    let study = json!({"scenario": "room.json", "list": [{"description": label}, {"description": "b"}], "seeds": 2});
    fs::write(folder.join("study.json"), study.to_string()).unwrap();
    let suite = json!({
        "scenario": "room.json", "grid": {"profile": ["sph"]}, "list": [{"label": label}],
        "cases": [{"name": label, "about": label, "kind": "openings",
                   "checks": [{"quantity": label, "run": label, "value": "arrived", "expected": {"exactly": 3}}]}]
    });
    fs::write(folder.join("suite.json"), suite.to_string()).unwrap();
    for typed in [
        "run room.json --verbose",
        "run room.json --trajectory room.csv --save room.rrd --save room.html --checkpoint room.check",
        "resume room.check",
        "report room.json --out report.html",
        "draw room.json --out room.svg",
        "draw room.json --egress --out egress.svg",
        "draw room.rrd --out recorded.svg",
        "page room.rrd --out page.html",
        "inspect room.json --all",
        "measure room.csv --line 5,0,5,6",
        "compare room.csv room.csv",
        "sweep study.json --list",
        "sweep study.json",
        "estimate study.json --error time_secs=50%",
        "estimate room.json --error time_secs=50%",
        "verify suite.json --out verified",
        "validate suite.json --out validated",
    ] {
        let output = run_in(folder, &typed.split(' ').collect::<Vec<_>>());
        let said = [output.stdout.as_slice(), &output.stderr].concat();
        let said = String::from_utf8_lossy(&said);
        let is_obeyed = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
        assert!(!said.contains(is_obeyed), "{typed}: {said:?}");
        assert!(!said.is_empty(), "{typed}");
    }
}

#[test]
fn letters_that_the_font_lacks_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut plan = room();
    plan["exits"][0]["name"] = json!("东出口");
    plan["journeys"][0]["stages"][1] = json!("东出口");
    fs::write(folder.path().join("room.json"), plan.to_string()).unwrap();
    for (typed, is_named) in [
        ("draw room.json --out a.png", true),
        ("draw room.json --out a.pdf", true),
        ("draw room.json --out a.svg", false),
        ("report room.json --out r.pdf", true),
        ("report room.json --out r.html", false),
        (
            "draw room.json --from 0 --to 0.2 --fps 10 --out a.gif",
            true,
        ),
    ] {
        let output = run_in(folder.path(), &typed.split(' ').collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0));
        let said = String::from_utf8_lossy(&output.stderr);
        let note = "the font of PNG and PDF files lacks 东出口: boxes stand for these letters; SVG and HTML files";
        let expected = if is_named { 1 } else { 0 };
        assert_eq!(said.matches("lacks").count(), expected, "{typed}: {said}");
        assert_eq!(said.matches(note).count(), expected, "{typed}: {said}");
    }
    let pages = crate::common::pdf::pages(&fs::read(folder.path().join("r.pdf")).unwrap());
    let text: String = pages.iter().map(crate::common::pdf::Page::words).collect();
    assert!(!text.contains('东') && text.contains('\u{fffd}'), "{text}");
    let html = fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert!(html.contains("东出口"));
}

#[test]
fn text_from_plans_and_trajectories_is_shortened_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let long = hostile().replace(['\r', '\n'], "");
    let feature = json!({"type": "Feature", "properties": {"name": long, "kind": "floor"},
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

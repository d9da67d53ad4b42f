//! Routes and journeys can be seen: in pictures, in recordings and by inspecting an agent.

use std::fs;
use std::path::PathBuf;

use serde_json::Value;

use crate::common::program::{refused, run, run_in, run_json, stderr, text};
use crate::common::recording::Recording;

/// A room with every kind of place.
const ROOM: &str = r#"{"duration_secs": 40, "profile": "sph",
    "walkable_area": [[[[0,0],[20,0],[20,10],[0,10]], [[9,0],[9.5,0],[9.5,6],[9,6]]]],
    "exits": [{"name": "east", "line": [[20,4],[20,6]]},
              {"name": "west", "line": [[0,4],[0,6]], "closed_secs": [[0,30]]}],
    "waypoints": [{"name": "kiosk", "at": [3,8], "within": 0.8}],
    "queues": [{"name": "till", "path": [[15,8],[12,8]], "service_secs": 2}],
    "waiting_areas": [{"name": "pit", "area": [[11,1],[15,1],[15,4],[11,4]], "for_secs": 3}],
    "zones": [{"name": "ramp", "area": [[2,1],[6,1],[6,3],[2,3]], "speed_factor": 0.5}],
    "journeys": [{"name": "guest", "stages": ["kiosk", "pit", "till", {"quickest": ["east", "west"]}]},
                 {"name": "staff", "stages": [{"quickest": ["east", "west"]}]}],
    "grids": [{"name": "guests", "min": [1,4], "max": [3,7], "columns": 3, "rows": 3, "journey": "guest"},
              {"name": "workers", "min": [5,4], "max": [7,7], "columns": 3, "rows": 3, "journey": "staff"}],
    "sources": [{"name": "bus", "min": [12,5], "max": [14,6], "columns": 2, "rows": 1, "every_secs": 15,
                 "start_secs": 5, "journey": "staff"}]}"#;

fn room(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("room.json");
    fs::write(&path, ROOM).unwrap();
    path
}

#[test]
fn a_picture_names_all_places_and_its_default_name_is_the_scenarios() {
    let folder = tempfile::tempdir().unwrap();
    room(&folder);
    let output = run_in(folder.path(), &["draw", "room.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let picture = fs::read_to_string(folder.path().join("room.svg")).unwrap();
    for name in [
        "exit east",
        "exit west (closed)",
        "waypoint kiosk",
        "queue till",
        "waiting area pit",
        "zone ramp: speed × 0.5",
        "source bus",
        "18 agents",
        "5 m",
        "x [m]",
    ] {
        assert!(picture.contains(name), "{name}");
    }
    assert!(picture.matches("<circle").count() >= 18, "agents");
    assert!(
        !picture.contains("<image"),
        "few shapes are drawn as shapes"
    );
    // It exists now.
    let again = run_in(folder.path(), &["draw", "room.json"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--force"));
}

#[test]
fn a_picture_of_routes_has_a_panel_for_each_destination() {
    let folder = tempfile::tempdir().unwrap();
    let (file, svg) = (room(&folder), folder.path().join("routes.svg"));
    let draw = [
        "draw",
        text(&file),
        "--paths",
        "east",
        "--paths",
        "3,2",
        "--out",
    ];
    let output = run(&[&draw[..], &[text(&svg)]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let picture = fs::read_to_string(&svg).unwrap();
    for words in [
        "Routes to exit east",
        "Routes to (3, 2)",
        "length of the", // in two lines where the panel is low
        "shortest",
        "next corner",
    ] {
        assert!(picture.contains(words), "{words}");
    }
    assert_eq!(picture.matches("<image").count(), 2, "a field for each");
}

#[test]
fn a_picture_of_a_later_moment_shows_what_agents_do() {
    let folder = tempfile::tempdir().unwrap();
    let (file, png) = (room(&folder), folder.path().join("later.png"));
    let drawn = run_json(&[
        "draw",
        text(&file),
        "--at",
        "12",
        "--json",
        "--out",
        text(&png),
    ]);
    assert_eq!(drawn["time_secs"], 12.0);
    assert!(drawn["agents"].as_u64().unwrap() >= 9);
    assert!(fs::read(&png).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn routes_that_cannot_be_drawn_are_refused_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (room(&folder), folder.path().join("no.svg"));
    let (file, out) = (text(&file), text(&out));
    let draw = |more: &[&str], words: &[&str]| {
        refused(&[&["draw", "--out", out], more].concat(), 2, words);
        assert!(!folder.path().join("no.svg").exists());
    };
    draw(
        &[file, "--paths", "eest"],
        &[
            "did you mean `east`?",
            "`east`, `west`, `kiosk`, `pit`, `till`",
        ],
    );
    draw(
        &[file, "--paths", "9.2,3"],
        &["(9.2, 3) is not on the floor"],
    );
    let straight = ["--set", "navigation=straight", "--paths", "21,10"];
    draw(
        &[&["evacuation"], &straight[..]].concat(),
        &["`navigation` is `straight`"],
    );
    refused(
        &["draw", file, "--out", "picture.jpg"],
        2,
        &["must end in .svg, .png or .pdf"],
    );
}

#[test]
fn a_recording_has_places_routes_and_time_series() {
    let folder = tempfile::tempdir().unwrap();
    let (file, rrd) = (room(&folder), folder.path().join("room.rrd"));
    let run = [
        "run",
        text(&file),
        "--until",
        "20",
        "--record-every",
        "10",
        "--save",
        text(&rrd),
    ];
    run_json(&[&run[..], &["--debug-agents", "0,9", "--json"]].concat());
    let recording = Recording::read(&rrd);
    let entities = recording.entities();
    for name in [
        "exits",
        "waypoints",
        "waiting_areas",
        "queues",
        "queue_spots",
        "zones",
        "names",
    ] {
        let entity = format!("/world/geometry/{name}");
        assert!(entities.contains(&entity), "{entity}");
    }
    for entity in [
        "/world/routes/east",
        "/world/routes/till",
        "/world/debug/routes",
    ] {
        assert!(entities.contains(entity), "{entity}: {entities:?}");
    }
    let series = |entity: &str| -> Vec<f64> {
        let rows = recording.numbers(entity, "Scalars:scalars").into_iter();
        rows.flat_map(|(_, values)| values).collect()
    };
    let passed = series("/stats/places/passed/east");
    assert!(passed.is_sorted() && passed[0] == 0.0 && *passed.last().unwrap() >= 9.0);
    let waiting = series("/stats/places/present/pit");
    assert!(waiting.iter().any(|&count| count > 0.0), "{waiting:?}");
    let queued = series("/stats/places/present/till");
    assert!(queued.iter().any(|&count| count > 0.0), "{queued:?}");
    let agents = recording.numbers("/stats/crowd/agents", "Scalars:scalars");
    let colors = recording.numbers("/world/agents", "agent:stage_colors");
    assert_eq!(colors.len(), agents.len());
    assert!(
        colors
            .iter()
            .zip(&agents)
            .all(|((_, colors), (_, count))| colors.len() as f64 == count[0])
    );
}

#[test]
fn a_recording_has_sources_measurements_color_ranges_and_the_end_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let (file, rrd) = (
        folder.path().join("room.json"),
        folder.path().join("room.rrd"),
    );
    let measurements = r#""duration_secs": 6, "measurements": [
        {"density": {"at_secs": 2, "region": [[1,1],[5,5]]}},
        {"line_flow": {"name": "door", "line": [[9.2,6],[9.2,10]]}}],"#;
    fs::write(&file, ROOM.replace("\"duration_secs\": 40,", measurements)).unwrap();
    let run = ["run", text(&file), "--save", text(&rrd), "--json"];
    run_json(&[&run[..], &["--set", "view.speed_range=[0,0.5]"]].concat());
    let recording = Recording::read(&rrd);
    let names = |entity: &str| recording.static_texts(entity, "Points2D:labels");
    assert_eq!(names("/world/geometry/sources/names"), ["source bus"]);
    let measured = names("/world/geometry/measured/names");
    assert_eq!(measured, ["measured: density", "measured: door"]);
    let layout = Recording::layout(&rrd);
    for name in [
        "Speed 0–0.5 m/s",
        "Forces on agent 0",
        "Agent 0",
        "All debug agents",
        "Events",
    ] {
        assert!(layout.contains(name), "{name}: {layout:?}");
    }
    let lines = recording.texts("/log", "TextLog:text");
    let last = &lines.last().unwrap().1[0];
    assert_eq!(last, "The run ends: its duration of 6 s is over.");
    assert!(
        lines
            .iter()
            .any(|(_, line)| line[0].contains("bus: 2 agents enter"))
    );
}

fn agent(file: &str, id: &str, at: &str) -> Value {
    let moment = run_json(&["inspect", file, "--agent", id, "--at", at, "--json"]);
    moment["agents"][0].clone()
}

#[test]
fn an_inspection_shows_the_way_and_why_an_agent_takes_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = room(&folder);
    let worker = agent(text(&file), "9", "1");
    let (way, visit) = (&worker["way"], &worker["visit"]);
    assert_eq!(visit["journey"], "staff");
    assert_eq!((&visit["stage"], &visit["stages"]), (&1.into(), &1.into()));
    assert_eq!(
        (&visit["place"], &visit["status"]),
        (&"east".into(), &"walking".into())
    );
    assert_eq!(
        visit["why"]["reason"],
        "no other place is open and can be reached"
    );
    let alternatives = visit["why"]["alternatives"].as_array().unwrap();
    let names = alternatives
        .iter()
        .map(|a| (a["place"].as_str().unwrap(), a["open"].as_bool().unwrap()));
    assert_eq!(names.collect::<Vec<_>>(), [("east", true), ("west", false)]);
    let expected = &alternatives[0]["expected"];
    let secs = |key: &str| expected[key].as_f64().unwrap();
    let total = secs("walking_secs").max(secs("waiting_secs")) + secs("onward_secs");
    assert!((total - secs("total_secs")).abs() < 1e-9);
    let length = alternatives[0]["length"].as_f64().unwrap();
    assert!((length - way["length"].as_f64().unwrap()).abs() < 0.2);
    assert!((secs("walking_secs") - length / 1.4).abs() < 1e-9);
    // Around the upper end of the wall between the two halves of the room.
    let corners = way["corners"].as_array().unwrap();
    assert!(corners.len() >= 2 && corners[0] == way["next"], "{way}");
    assert_eq!(corners[0][1], 6.0);
}

#[test]
fn an_inspection_shows_what_an_agent_at_a_place_does() {
    let folder = tempfile::tempdir().unwrap();
    let file = room(&folder);
    let moment = run_json(&["inspect", text(&file), "--all", "--at", "16", "--json"]);
    let agents = moment["agents"].as_array().unwrap();
    let visits: Vec<&Value> = agents.iter().map(|agent| &agent["visit"]).collect();
    let all = |status: &str| {
        visits
            .iter()
            .filter(|visit| visit["status"] == status)
            .count()
    };
    assert!(
        all("waiting") + all("queued") + all("served") > 0,
        "{visits:?}"
    );
    for visit in visits.iter().filter(|visit| visit["status"] != "walking") {
        assert!(visit["since_secs"].as_f64().unwrap() <= 16.0);
        assert!(visit.get("why").is_none());
    }
    let output = run(&["inspect", text(&file), "--all", "--at", "16"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("journey `guest`, stage "), "{said}");
}

//! What the page of `sandbox studio` draws: checks, examples, and files that it opens.

use serde_json::{Value, json};

use crate::common::program::run_json;
use crate::common::studio::{Studio, room};

#[test]
fn drawings_are_checked_with_the_places_of_their_problems() {
    let studio = Studio::start(&[]);
    let fine = studio.ask("check", &room());
    assert_eq!(fine["problem"], Value::Null);
    assert_eq!(fine["people"], 40);
    let changed = |path: &str, value: Value| {
        let mut document = room();
        *document.pointer_mut(path).unwrap() = value;
        document
    };
    let with = |key: &str, value: Value| {
        let mut document = room();
        document[key] = value;
        document
    };
    let line = |a: [f64; 2], b: [f64; 2]| json!([a, b]);
    let wrong: [(Value, &str); 22] = [
        (changed("/crowds/0/number", json!(0)), "crowds[0].number"),
        (changed("/crowds/0/number", json!(4000)), "crowds[0]"),
        (
            changed("/crowds/0/number", json!("many")),
            "crowds[0].number",
        ),
        (
            changed("/crowds/0/area", json!([[0, 0], [1, 1]])),
            "crowds[0].area",
        ),
        (
            changed("/crowds/0/area", json!([[50, 50], [51, 50], [51, 51]])),
            "crowds[0]",
        ),
        (
            changed("/exits/0/line", line([30.0, 2.0], [30.0, 4.0])),
            "exits[0]",
        ),
        (
            changed("/exits/0/line", line([12.0, 2.0], [12.0, 2.0])),
            "exits[0].line",
        ),
        (changed("/exits/0/line", json!([[1, 2]])), "exits[0].line"),
        (changed("/exits/0/name", json!("")), "exits[0].name"),
        (
            changed("/doors/0/line", line([50.0, 2.5], [50.0, 3.5])),
            "doors[0]",
        ),
        (changed("/doors/0/name", json!("out")), "doors[0]"),
        (
            changed(
                "/walkable_area",
                json!([[[[0, 0], [8, 6], [8, 0], [0, 6]]]]),
            ),
            "walkable_area[0]",
        ),
        (
            changed("/walkable_area", json!([[[[0, 0], [8, 6]]]])),
            "walkable_area[0]",
        ),
        (
            changed("/walkable_area", json!("/etc/passwd")),
            "walkable_area",
        ),
        (with("obstacles", json!("plan.dxf")), "obstacles"),
        (
            with("obstacles", json!([[[0, 0], [1, 0], ["x", 1]]])),
            "obstacles[0]",
        ),
        (with("profile", json!("steer")), "profile"),
        (with("speed", json!(1)), ""),
        (
            with(
                "zones",
                json!([{"area": [[0, 0], [1, 0], [1, 1]], "speed_factor": -1}]),
            ),
            "zones[0].speed_factor",
        ),
        (
            with(
                "events",
                json!([{"name": "push", "acceleration": "wave.txt"}]),
            ),
            "events[0].acceleration",
        ),
        (
            with(
                "levels",
                json!([{"name": "ground", "walkable_area": "ground.wkt"}]),
            ),
            "levels[0].walkable_area",
        ),
        (
            with("from", json!({"trajectory": "people.sqlite"})),
            "from.trajectory",
        ),
    ];
    for (document, place) in wrong {
        let found = studio.ask("check", &document);
        let problem = &found["problem"];
        let path = problem["path"]
            .as_str()
            .unwrap_or_else(|| panic!("{place}: {found}"));
        assert!(path.starts_with(place), "{place}: {problem}");
        assert!(problem["reason"].as_str().unwrap().len() > 10, "{problem}");
        // It cannot be played either, with the same words.
        let refused = studio.post("runs", &document);
        assert_eq!(refused.status, 422, "{place}");
        assert_eq!(refused.json()["error"], *problem);
    }
    assert_eq!(studio.ask("start", &Value::Null)["runs"], json!([]));
}

#[test]
fn its_examples_play_and_its_schema_is_that_of_the_program() {
    let studio = Studio::start(&[]);
    let start = studio.ask("start", &Value::Null);
    let names: Vec<&str> = start["examples"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["evacuation", "concert", "office", "empty"]);
    let expected = [400, 10_000, 150, 0];
    for (name, people) in names.into_iter().zip(expected) {
        let document =
            studio.ask(&format!("example?name={name}"), &Value::Null)["document"].clone();
        let run = studio.begin(&document);
        let state = studio.control(&run, &json!({"step": 1}));
        assert_eq!(state["people"], people, "{name}");
        let frames = studio.frames(&run, 0, 0);
        assert_eq!(frames.crowds.last().unwrap().len(), people, "{name}");
        studio.ask(&format!("{run}/close"), &json!({}));
    }
    let schema = run_json(&["list", "--schema"]);
    assert_eq!(studio.ask("schema", &Value::Null), schema);
    // A scenario of the command line comes first.
    let given = Studio::start(&["scenarios/office.json"]);
    let document = given.ask("start", &Value::Null)["given"].clone();
    assert_eq!(document["name"], "office");
    assert!(document["walkable_area"].is_array());
}

#[test]
fn plans_and_scenarios_of_others_are_opened() {
    let studio = Studio::start(&[]);
    let import = |name: &str, content: &[u8]| {
        let path = format!("{}import?name={name}", studio.root);
        studio.with("POST", &path, &[], content)
    };
    let wkt = import("my%20hall.wkt", b"POLYGON ((0 0, 10 0, 10 5, 0 5, 0 0))");
    let document = wkt.json()["document"].clone();
    assert_eq!(document["name"], "my hall");
    assert_eq!(
        document["walkable_area"],
        json!([[[[0.0, 5.0], [0.0, 0.0], [10.0, 0.0], [10.0, 5.0]]]])
    );
    assert_eq!(studio.ask("check", &document)["problem"], Value::Null);
    let json = import("room.json", room().to_string().as_bytes());
    assert_eq!(json.json()["document"]["crowds"], room()["crowds"]);
    // Errors name the file, and no folder of this machine.
    for (name, content) in [
        ("a.wkt", &b"POLYGON ((0 0"[..]),
        ("b.dxf", b"nothing"),
        ("c.json", b"{"),
        ("d.xyz", b"1"),
    ] {
        let refused = import(name, content);
        assert_eq!(refused.status, 422, "{name}");
        let message = refused.json()["error"]["message"]
            .as_str()
            .unwrap()
            .to_owned();
        assert!(
            message.contains(name) && !message.contains("/tmp"),
            "{message}"
        );
    }
    assert_eq!(import("..", b"").status, 400);
}

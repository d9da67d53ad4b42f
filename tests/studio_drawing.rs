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
fn a_door_that_is_closed_until_it_is_opened_by_hand_is_no_mistake() {
    let studio = Studio::start(&[]);
    let notes = |until: f64| {
        let mut document = room();
        document["doors"][0]["closed_secs"] = json!([[0, until]]);
        let found = studio.ask("check", &document);
        assert_eq!(found["problem"], Value::Null, "{found}");
        found["notes"].to_string()
    };
    assert!(notes(1e6).contains("is closed for the whole run"));
    assert!(!notes(1e7).contains("is closed for the whole run"));
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
    // A wrong one, too: it is mended in the page.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.json");
    let mut wrong = room();
    wrong["crowds"][0]["number"] = json!(100_000);
    std::fs::write(&file, wrong.to_string()).unwrap();
    let given = Studio::start(&[file.to_str().unwrap()]);
    assert_eq!(given.ask("start", &Value::Null)["given"], wrong);
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
    // A wrong scenario is opened, to be mended; what is none is not.
    let mut wrong = room();
    wrong["crowds"][0]["number"] = json!(100_000);
    let opened = import("wrong.json", wrong.to_string().as_bytes());
    assert_eq!(opened.json(), json!({"document": wrong, "notes": []}));
    let found = studio.ask("check", &opened.json()["document"]);
    assert_eq!(found["problem"]["path"], "crowds[0]");
    for other in ["{\"private\": true}", "[1, 2]", "7"] {
        assert_eq!(
            import("package.json", other.as_bytes()).status,
            422,
            "{other}"
        );
    }
}

#[test]
fn a_scenario_is_opened_with_the_files_that_it_names() {
    let studio = Studio::start(&[]);
    let plan = std::fs::read("scenarios/office.geojson").unwrap();
    let scenario = std::fs::read("scenarios/office.json").unwrap();
    let import = |files: &[(&str, &[u8])]| {
        let list: Vec<_> = files
            .iter()
            .map(|(name, content)| json!([name, content.len()]))
            .collect();
        let list = json!(list).to_string().replace('"', "%22");
        let path = format!("{}import?files={list}", studio.root);
        let body: Vec<u8> = files
            .iter()
            .flat_map(|(_, content)| content.to_vec())
            .collect();
        studio.with("POST", &path, &[], &body)
    };
    let both = [
        ("office.geojson", &plan[..]),
        ("office.json", &scenario[..]),
    ];
    let opened = import(&both);
    let text = String::from_utf8_lossy(&opened.content).into_owned();
    assert_eq!(opened.status, 200, "{text}");
    let whole = studio.ask("example?name=office", &Value::Null);
    assert_eq!(opened.json()["document"], whole["document"]);
    // In a folder of its own, as the scenario names it.
    let inner = String::from_utf8(scenario.clone()).unwrap();
    let inner = inner.replace("\"office.geojson\"", "\"plans/floor/office.geojson\"");
    let opened = import(&[both[0], ("office.json", inner.as_bytes())]);
    assert_eq!(opened.json()["document"], whole["document"]);
    // In UTF-16, as editors of Windows write it.
    let letters = format!("\u{feff}{}", String::from_utf8_lossy(&scenario));
    let utf16: Vec<u8> = letters.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let opened = import(&[both[0], ("office.json", &utf16)]);
    assert_eq!(opened.json()["document"], whole["document"]);
    // Alone, twice, with a file that it does not name, and with wrong lengths.
    let said = |reply: crate::common::studio::Reply, status: u16| {
        assert_eq!(reply.status, status);
        reply.json()["error"]["message"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    let alone = said(import(&both[1..]), 422);
    assert!(
        alone.contains("office.geojson") && alone.contains("together"),
        "{alone}"
    );
    let other = said(
        import(&[both[1], ("hall.wkt", b"POLYGON ((0 0, 1 0, 1 1, 0 0))")]),
        400,
    );
    assert!(other.contains("names no file hall.wkt"), "{other}");
    let twice = said(import(&[both[0], both[0], both[1]]), 400);
    assert!(twice.contains("office.geojson is given twice"), "{twice}");
    let outside = inner.replace("plans/floor/", "../");
    let outside = said(import(&[both[0], ("office.json", outside.as_bytes())]), 400);
    assert!(
        outside.contains("names no file office.geojson"),
        "{outside}"
    );
    for list in ["[]", "[[%22a.wkt%22,9]]", "[[%22a.wkt%22,1]]", "x"] {
        let path = format!("{}import?files={list}", studio.root);
        let message = said(studio.with("POST", &path, &[], b"POL"), 400);
        assert!(message.starts_with("files: "), "{message}");
    }
}

#[test]
fn drawings_are_kept_when_their_tab_is_closed() {
    let studio = Studio::start(&[]);
    let kept = || studio.ask("start", &Value::Null)["drawings"].clone();
    assert_eq!(kept(), json!([]));
    // What was only looked at is not kept; what was changed is, also while it is wrong.
    studio.ask("check", &room());
    assert_eq!(kept(), json!([]));
    let mut wrong = room();
    wrong["name"] = json!("wrong");
    wrong["crowds"][0]["number"] = json!(100_000);
    let found = studio.ask("check?drawing=a-1", &wrong);
    assert_eq!(found["problem"]["path"], "crowds[0]");
    studio.ask("check?drawing=b-2", &room());
    let list = kept();
    assert_eq!(list[0]["key"], "b-2");
    assert_eq!(
        list[1],
        json!({
            "key": "a-1", "name": "wrong", "elements": 4, "age_secs": list[1]["age_secs"],
        })
    );
    assert!(list[1]["age_secs"].as_u64().unwrap() < 600);
    let opened = studio.ask("drawings/a-1", &Value::Null);
    assert_eq!(opened["document"], wrong);
    // The latest state counts, and comes first.
    wrong["crowds"][0]["number"] = json!(7);
    studio.ask("check?drawing=a-1", &wrong);
    assert_eq!(kept()[0]["key"], "a-1");
    assert_eq!(studio.ask("drawings/a-1", &Value::Null)["document"], wrong);
    studio.ask("drawings/b-2/forget", &json!({}));
    assert_eq!(studio.get("drawings/b-2").status, 404);
    assert_eq!(studio.post("drawings/b-2/forget", &json!({})).status, 404);
    for key in ["", &"k".repeat(65)] {
        assert_eq!(
            studio.post(&format!("check?drawing={key}"), &room()).status,
            400
        );
    }
    // No more than twenty.
    for k in 0..20 {
        studio.ask(&format!("check?drawing=more-{k}"), &room());
    }
    assert_eq!(kept().as_array().unwrap().len(), 20);
    assert_eq!(studio.get("drawings/a-1").status, 404);
}

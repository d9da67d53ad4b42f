//! `sandbox studio`: what its page can ask for, and what it cannot.

use std::fs;

use sandbox::cli::json_report;
use sandbox::engine::simulation::Fault;
use sandbox::runs::drive::{Observer, Run};
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::program::{run_json, text};
use crate::common::studio::{Studio, room};

/// A run of a document to its end without a studio.
fn run_of(document: &Value) -> Run {
    let scenario = Scenario::parse(&document.to_string(), "played.json", &[]).unwrap();
    let mut run = Run::new(scenario).unwrap();
    run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
        .unwrap();
    run
}

fn digest(studio: &Studio, run: &str) -> String {
    let found = studio.ask(&format!("{run}/digest"), &Value::Null);
    found["state_sha256"].as_str().unwrap().to_owned()
}

#[test]
fn a_played_run_is_that_of_the_program_with_all_that_was_done_to_it() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    let act = |what: &Value| studio.ask(&format!("{run}/intervene"), what);
    // While it plays.
    studio.control(&run, &json!({"speed": 2, "play": true}));
    studio.wait(&run, |state| state["time"].as_f64() > Some(1.0));
    act(&json!({"close": "door"}));
    let region = json!([[5, 1], [7, 5]]);
    act(&json!({"push": {
        "region": region, "for_secs": 0.3, "acceleration": [[0, 4], [0.3, 4]], "direction": [-1, 0],
    }}));
    studio.wait(&run, |state| state["time"].as_f64() > Some(3.0));
    act(&json!({"open": "door"}));
    act(&json!({"remove": [3, 4]}));
    studio.control(&run, &json!({"play": false}));
    let added = act(
        &json!({"add": {"group": "people", "positions": [[50, 5], [10, 5], [10, 5], [10, 7]]}}),
    );
    // There is room for one; two would be outside of the floor.
    assert_eq!(added["ids"], json!([40]));
    assert_eq!(added["without_room"], json!([0, 2, 3]));
    let state = studio.control(&run, &json!({"step": 100}));
    assert_eq!(state["done"], 5, "{state}");

    let played = studio.get(&format!("{run}/saved?as=json"));
    assert_eq!(
        played.header("content-disposition"),
        Some("attachment; filename=\"room.json\"")
    );
    let again = run_of(&played.json());
    let report = json_report(&again);
    assert_eq!(report["state_sha256"], digest(&studio, &run).as_str());
    let clock = again.simulation.frame().clock;
    assert_eq!(state["frame"], clock.frame());
    let people = again.simulation.frame().agents.count_present();
    assert_eq!(state["people"], people);

    // The program itself says the same.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("played.json");
    fs::write(&file, &played.content).unwrap();
    let report = run_json(&["run", text(&file), "--json"]);
    assert_eq!(report["state_sha256"], digest(&studio, &run).as_str());
}

#[test]
fn pages_get_people_where_they_are() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    studio.control(&run, &json!({"follow": 7}));
    let state = studio.control(&run, &json!({"step": 60}));
    let about = studio.ask(&run, &Value::Null);
    let frames = studio.frames(&run, 0, 0);
    let again = {
        let mut document = room();
        document["duration_secs"] = state["time"].clone();
        run_of(&document)
    };
    let agents = again.simulation.frame().agents;
    let last = frames.crowds.last().unwrap();
    assert_eq!(last.len(), agents.count_present());
    let origin = &about["scene"]["origin"];
    for i in agents.present() {
        let person = &last[&i64::from(agents.id[i])];
        for axis in 0..2 {
            let at = origin[axis].as_f64().unwrap() + 0.01 * f64::from(person.values[axis]);
            assert!((at - agents.position[i][axis]).abs() <= 0.005 + 1e-9);
        }
        assert!((person.radius - agents.radius[i]).abs() <= 0.0005 + 1e-9);
    }
    // The forces on the person that is followed are those of `person`.
    let person = studio.ask(&format!("{run}/person?id=7"), &Value::Null);
    let total = &frames.forces.last().unwrap()[&7].values;
    for axis in 0..2 {
        let own = person["acceleration"][axis].as_f64().unwrap();
        assert!((own - 0.01 * f64::from(total[axis])).abs() <= 0.005 + 1e-9);
    }
    let times = frames.series["times"].as_array().unwrap();
    assert_eq!(times.last(), Some(&state["time"]));
    assert_eq!(frames.series["state"]["people"], 40);
    // The next request joins the frame before.
    let last = frames.series["last"].as_u64().unwrap();
    let epoch = frames.series["epoch"].as_u64().unwrap();
    studio.control(&run, &json!({"step": 2}));
    let next = studio.frames(&run, epoch, last);
    assert_eq!(next.series["joins"], true);
    assert_eq!(next.crowds.len(), 3);
    assert_eq!(next.series["times"].as_array().unwrap().len(), 2);
    assert_eq!(next.crowds[0], *frames.crowds.last().unwrap());
    let none = studio.frames(&run, epoch, last + 2);
    assert!(none.crowds.is_empty() && none.series["times"].as_array().unwrap().is_empty());
}

#[test]
fn pages_know_the_floor_behind_the_exit() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    let scene = studio.ask(&run, &Value::Null)["scene"].clone();
    let [behind] = &scene["behind"].as_array().unwrap()[..] else {
        panic!("{}", scene["behind"]);
    };
    assert_eq!(behind["name"], "out");
    let numbers: Vec<f64> = behind["area"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    let xs = numbers
        .iter()
        .step_by(2)
        .map(|x| x + scene["origin"][0].as_f64().unwrap());
    let [least, most] = [f64::min, f64::max].map(|of| xs.clone().reduce(of).unwrap());
    // From the line on, at least as far as bodies walk on.
    assert!((least - 12.0).abs() < 0.05 && most > 17.9, "{least} {most}");
}

#[test]
fn a_run_that_is_set_back_takes_the_same_course() {
    let studio = Studio::start(&[]);
    let mut document = room();
    document["exits"][0]["closed_secs"] = json!([[0, 1e5]]);
    let run = studio.begin(&document);
    let there = |secs: f64| {
        studio.control(&run, &json!({"to": secs}));
        let state = studio.wait(&run, |state| state["seeks"] == false);
        assert!(
            (state["time"].as_f64().unwrap() - secs).abs() < 0.02,
            "{state}"
        );
        digest(&studio, &run)
    };
    let [first, later] = [1.3, 4.0].map(there);
    assert_eq!(there(1.3), first);
    assert_eq!(there(4.0), later);
    // What is done then makes another course; a fork has none of it.
    there(1.3);
    let fork = studio.ask(&format!("{run}/fork"), &json!({}));
    let fork = format!("runs/{}", fork["run"]);
    let notes = |run: &str| studio.control(run, &json!({}))["warnings"].clone();
    assert_eq!(notes(&fork), notes(&run));
    assert_ne!(
        notes(&fork),
        json!([]),
        "the exit is closed for the whole run"
    );
    studio.ask(&format!("{run}/intervene"), &json!({"remove": [0]}));
    assert_ne!(there(4.0), later);
    studio.control(&fork, &json!({"to": 4.0}));
    studio.wait(&fork, |state| state["seeks"] == false);
    assert_eq!(digest(&studio, &fork), later);
    // It goes back to before it was made, too.
    let early = there(0.5);
    studio.control(&fork, &json!({"to": 0.5}));
    studio.wait(&fork, |state| state["seeks"] == false);
    assert_eq!(digest(&studio, &fork), early);
    // Before the beginning there is nothing.
    let refused = studio.post(&format!("{run}/control"), &json!({"to": -1}));
    assert_eq!(refused.status, 400);
}

#[test]
fn flows_at_doors_are_the_same_after_going_back() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    let flows = |secs: f64| -> Vec<Value> {
        studio.control(&run, &json!({"to": secs}));
        let state = studio.wait(&run, |state| state["seeks"] == false);
        let doors = state["doors"].as_array().unwrap();
        let flows: Vec<Value> = doors
            .iter()
            .map(|door| door["flow_per_s"].clone())
            .collect();
        assert_eq!(flows.len(), 2);
        assert!(
            flows.iter().any(|flow| flow.as_f64() > Some(0.0)),
            "{state}"
        );
        flows
    };
    let first = flows(8.0);
    flows(12.0);
    assert_eq!(flows(8.0), first);
}

#[test]
fn a_run_that_stops_shows_the_frame_in_which_it_stops() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    for secs in [0.5, 1.0, 1.5, 2.0, 2.5] {
        studio.control(&run, &json!({"speed": null, "play": true}));
        studio.wait(&run, |state| state["time"].as_f64() > Some(secs));
        let state = studio.control(&run, &json!({"play": false}));
        let frames = studio.frames(&run, 0, 0);
        let times = frames.series["times"].as_array().unwrap();
        let last = times.last().unwrap().as_f64().unwrap();
        assert!(
            (last - state["time"].as_f64().unwrap()).abs() < 1e-4,
            "{last} {state}"
        );
    }
}

#[test]
fn a_run_keeps_the_speed_that_is_asked_for() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    studio.control(&run, &json!({"speed": 4, "play": true}));
    let state = studio.wait(&run, |state| state["rate"].is_number());
    let rate = state["rate"].as_f64().unwrap();
    // Never faster; on a busy machine, slower.
    assert!(rate < 4.2, "{state}");
    let ended = studio.wait(&run, |state| state["playing"] == false);
    assert_eq!(ended["end"], "its duration of 30 s is over");
    // Who plays on goes beyond the end.
    studio.control(&run, &json!({"play": true}));
    let on = studio.wait(&run, |state| state["time"].as_f64() > Some(30.2));
    assert_eq!(on["playing"], true);
    // A closed run has no more frames, and the others go on.
    studio.ask(&format!("{run}/close"), &json!({}));
    assert_eq!(studio.get(&run).status, 404);
    assert_eq!(studio.ask("start", &Value::Null)["runs"], json!([]));
}

#[test]
fn pages_from_elsewhere_cannot_use_it() {
    let studio = Studio::start(&[]);
    let own = format!("http://{}", studio.host);
    let (root, port) = (studio.root.clone(), studio.host.split(':').nth(1).unwrap());
    let start = format!("{root}start");
    let status = |method: &str, path: &str, headers: &[(&str, &str)]| {
        studio.with(method, path, headers, b"{}").status
    };
    assert_eq!(status("GET", &start, &[("Origin", &own)]), 200);
    assert_eq!(status("GET", &root, &[]), 200);
    // Without the token, or with another one.
    for path in [
        "/",
        "/start",
        "/00000000000000000000000000000000/start",
        "//start",
    ] {
        assert_eq!(status("GET", path, &[]), 403, "{path}");
    }
    assert_eq!(status("GET", &start.to_uppercase(), &[]), 403);
    // From another page, also of this machine, and from a frame without an origin.
    let other = [
        "http://example.org",
        "null",
        "http://127.0.0.1:1",
        &format!("https://{}", studio.host),
        "file://",
    ];
    for origin in other {
        assert_eq!(
            status("POST", &format!("{root}runs"), &[("Origin", origin)]),
            403,
            "{origin}"
        );
    }
    let fetch = [("Sec-Fetch-Site", "cross-site")];
    assert_eq!(status("POST", &format!("{root}runs"), &fetch), 403);
    // Under another name of this machine, to which a page from elsewhere could have bound its own.
    for host in [
        "example.org",
        &format!("example.org:{port}"),
        "127.0.0.1",
        "",
    ] {
        assert_eq!(status("GET", &start, &[("Host", host)]), 403, "{host}");
    }
    assert_eq!(
        status("GET", &start, &[("Host", &format!("localhost:{port}"))]),
        200
    );
    // Nothing is sent to pages of other origins, shown within them, or kept.
    let page = studio.get("");
    assert_eq!(page.header("access-control-allow-origin"), None);
    assert_eq!(page.header("x-frame-options"), Some("DENY"));
    assert_eq!(page.header("cache-control"), Some("no-store"));
    let html = String::from_utf8(page.content).unwrap();
    assert!(html.contains("default-src 'none'") && html.contains("connect-src 'self'"));
}

#[test]
fn broken_messages_are_refused_and_change_nothing() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    let before = digest(&studio, &run);
    let root = &studio.root;
    let post = |path: &str, body: &[u8]| {
        studio
            .with("POST", &format!("{root}{path}"), &[], body)
            .status
    };
    for body in [&b"{"[..], b"", b"\xff\xfe", b"[1, 2", b"nothing"] {
        assert_eq!(post("check", body), 400);
        assert_eq!(post(&format!("{run}/intervene"), body), 400);
    }
    for (what, status) in [
        (
            json!({"add": {"group": "nobody", "positions": [[5, 5]]}}),
            422,
        ),
        (json!({"close": "no such door"}), 422),
        (json!({"push": {"region": [[0, 0], [1, 1]]}}), 422),
        (json!({"remove": [77]}), 422),
        (json!({"set_rate": {"entrance": "x", "per_sec": 1}}), 422),
        (json!([]), 422),
        (json!({}), 422),
    ] {
        let reply = studio.post(&format!("{run}/intervene"), &what);
        assert_eq!(reply.status, status, "{what}");
        let message = reply.json()["error"]["message"].clone();
        assert!(
            message.as_str().is_some_and(|text| text.len() > 10),
            "{what}: {message}"
        );
    }
    for what in [
        json!({"speed": 0}),
        json!({"speed": "fast"}),
        json!({"play": 1}),
        json!({"step": -1}),
        json!({"to": "x"}),
        json!({"fly": true}),
        json!(3),
        json!({"step": 1e9}),
        json!({"follow": -2}),
    ] {
        let reply = studio.post(&format!("{run}/control"), &what);
        assert_eq!(reply.status, 400, "{what}");
    }
    for path in [
        "runs/99",
        "runs/99/frames?epoch=0&after=0",
        "nothing",
        "runs/x",
        "example?name=none",
    ] {
        let status = studio.get(path).status;
        assert!(status == 404 || status == 400, "{path}: {status}");
    }
    assert_eq!(studio.get(&format!("{run}/person?id=77")).status, 404);
    assert_eq!(studio.get(&format!("{run}/saved?as=doc")).status, 400);
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(post("check", deep.as_bytes()), 400);
    assert_eq!(
        studio
            .with("DELETE", &format!("{root}{run}"), &[], b"")
            .status,
        405
    );
    // Half requests, of browsers that have gone.
    for half in [
        "POST ",
        "GET / HTTP/1.1\r\nHost",
        &format!("POST {root}runs HTTP/1.1\r\nContent-Length: 10\r\n\r\n{{"),
    ] {
        studio.leave(half.as_bytes());
    }
    assert_eq!(digest(&studio, &run), before);
    assert_eq!(studio.control(&run, &json!({}))["done"], 0);
    // On the way to another time, no frame in between is taken for the one that is shown.
    let other = studio.begin(&room());
    studio.control(&other, &json!({"to": 1e5}));
    for what in ["digest", "person?id=1", "saved?as=json"] {
        assert_eq!(studio.get(&format!("{other}/{what}")).status, 409, "{what}");
    }
    for (path, what) in [
        ("intervene", json!({"remove": [1]})),
        ("fork", json!({})),
        ("control", json!({"step": 1})),
    ] {
        let reply = studio.post(&format!("{other}/{path}"), &what);
        assert_eq!(reply.status, 409, "{path}");
    }
    studio.ask(&format!("{other}/close"), &json!({}));
}

#[test]
fn what_was_played_is_saved_as_every_kind_of_file() {
    let studio = Studio::start(&[]);
    let run = studio.begin(&room());
    studio.control(&run, &json!({"step": 30}));
    studio.ask(&format!("{run}/intervene"), &json!({"close": "door"}));
    for (ending, begins) in [
        ("html", &b"<!DOCTYPE html>"[..]),
        ("rrd", b"RRF"),
        ("pdf", b"%PDF"),
        ("png", b"\x89PNG"),
    ] {
        let saved = studio.get(&format!("{run}/saved?as={ending}"));
        assert_eq!(
            saved.status,
            200,
            "{}",
            String::from_utf8_lossy(&saved.content)
        );
        assert!(saved.content.starts_with(begins), "{ending}");
        assert_eq!(
            saved.header("content-disposition"),
            Some(format!("attachment; filename=\"room.{ending}\"").as_str())
        );
    }
    let page = studio.get(&format!("{run}/saved?as=html")).content;
    let page = String::from_utf8(page).unwrap();
    assert!(
        page.contains(&digest(&studio, &run)),
        "the page has the digest of the run"
    );
}

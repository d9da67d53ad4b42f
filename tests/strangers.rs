//! What people type who do not know the program: slips of JSON, units, wrong files and words of other programs. Each is
//! answered with what to do (tests/data/strangers.json).

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use sandbox::scenario::Scenario;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::common::program::{PROGRAM, run, stderr};

/// A slip, and a part of the answer.
#[derive(Deserialize)]
#[serde(untagged)]
enum Slip {
    /// The text of a scenario.
    Text { text: String, said: String },
    /// Changes of a room, by their paths.
    Change {
        change: Map<String, Value>,
        said: String,
    },
    /// A command line; `{}` is the folder with the files.
    Typed { typed: Vec<String>, said: String },
}

/// A room of 12 × 10 m with an exit and 20 people.
fn room() -> Value {
    json!({
        "profile": "steer+sph",
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[12, 4], [12, 6]]}],
        "crowds": [{"area": [[0, 0], [11, 0], [11, 10], [0, 10]], "number": 20}],
        "duration_secs": 120,
        "stop": {"when_empty": true}
    })
}

fn changed(changes: &Map<String, Value>) -> String {
    let mut room = room();
    for (path, value) in changes {
        let (parent, key) = path.rsplit_once('/').unwrap();
        room.pointer_mut(parent).unwrap()[key] = value.clone();
    }
    room.to_string()
}

/// The error or the notes of a scenario.
fn answer(text: &str) -> String {
    match Scenario::parse(text, "room.json", &[]) {
        Ok(scenario) => scenario.notes.join("\n"),
        Err(error) => error.to_string(),
    }
}

/// Whether a number has more than six significant digits, and more than two decimals.
fn is_long(word: &str) -> bool {
    let word = word.trim_matches(|c: char| !c.is_ascii_digit());
    let Some((whole, decimals)) = word.split_once('.') else {
        return false;
    };
    let are_digits = [whole, decimals]
        .iter()
        .all(|part| part.bytes().all(|b| b.is_ascii_digit()));
    let digits = format!("{whole}{decimals}");
    are_digits && decimals.len() > 2 && digits.trim_start_matches('0').len() > 6
}

#[test]
fn every_slip_of_a_stranger_is_answered_with_what_to_do() {
    let slips: Vec<Slip> = serde_json::from_str(include_str!("data/strangers.json")).unwrap();
    assert!(slips.len() > 110);
    assert_eq!(answer(&room().to_string()), "");
    let folder = tempfile::tempdir().unwrap();
    let outline = "(0 0, 12 0, 12 10, 0 10, 0 0)";
    let files = [
        ("room.json", room().to_string()),
        ("p.dxf", "  0\nSECTION\n".to_owned()),
        ("p.png", "no picture".to_owned()),
        ("t.csv", "id,frame,x,y\n1,0,0,0\n".to_owned()),
        (
            "result.json",
            json!({"scenario": "room", "state_sha256": "", "metrics": {}}).to_string(),
        ),
        (
            "t.txt",
            "# id frame x/m y/m\n1 0 0 0\n1 1 0.1 0\n".to_owned(),
        ),
        (
            "semicolon.wkt",
            "POLYGON ((0 0; 12 0; 12 10; 0 0))".to_owned(),
        ),
        (
            "decimal.wkt",
            "POLYGON ((0,5 0, 12 0, 12 10, 0,5 0))".to_owned(),
        ),
        (
            "rooms.xml",
            "<geometry unit=\"m\"><rooms><room><subrooms><subroom/></subrooms></room></rooms></geometry>".to_owned(),
        ),
        ("hole.wkt", format!("POLYGON ({outline}, {outline})")),
    ];
    for (name, text) in &files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let utf32 = "\u{feff}POLYGON".chars().map(u32::from);
    let utf32: Vec<u8> = utf32.flat_map(u32::to_le_bytes).collect();
    fs::write(folder.path().join("utf32.wkt"), utf32).unwrap();
    fs::write(folder.path().join("room.gz"), [0x1f, 0x8b, 8, 0]).unwrap();
    let place = folder.path().to_str().unwrap();
    for slip in &slips {
        let (about, found, said) = match slip {
            Slip::Text { text, said } => (text.clone(), answer(text), said),
            Slip::Change { change, said } => (
                Value::from(change.clone()).to_string(),
                answer(&changed(change)),
                said,
            ),
            Slip::Typed { typed, said } => {
                let arguments: Vec<String> =
                    typed.iter().map(|one| one.replace("{}", place)).collect();
                let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
                let output = run(&arguments);
                assert_eq!(output.status.code(), Some(2), "{typed:?}");
                (typed.join(" "), stderr(&output).replace(place, "{}"), said)
            }
        };
        assert!(
            found.contains(said),
            "{about}\nanswer: {found}\nexpected: {said}"
        );
        let long: Vec<&str> = found
            .split_whitespace()
            .filter(|word| is_long(word))
            .collect();
        assert!(long.is_empty(), "{about}: {long:?}");
    }
}

#[test]
fn numbers_of_errors_have_few_digits() {
    // Routes are checked from random places, and bodies have random radii.
    let mut narrow = room();
    narrow["walkable_area"] = json!([[
        [[0, 0], [12, 0], [12, 10], [0, 10]],
        [[6, 0], [6.2, 0], [6.2, 4.9], [6, 4.9]],
        [[6, 5.3], [6.2, 5.3], [6.2, 10], [6, 10]]
    ]]);
    narrow["crowds"][0]["area"] = json!([[0.1, 0.1], [5, 0.1], [5, 9], [0.1, 9]]);
    for (setting, value) in [
        ("min_passage_width", json!(0.8)),
        ("duration_secs", json!(100.123456789)),
    ] {
        let mut one = narrow.clone();
        one[setting] = value;
        let said = answer(&one.to_string());
        let long: Vec<&str> = said
            .split_whitespace()
            .filter(|word| is_long(word))
            .collect();
        assert!(long.is_empty(), "{said}");
    }
    narrow["min_passage_width"] = json!(0.8);
    assert!(answer(&narrow.to_string()).contains("narrower than `min_passage_width`, 0.8 m"));
    assert!(is_long("0.42400000000000004") && is_long("(4.844568103040832,"));
    assert!(!is_long("0.424") && !is_long("5268347.25") && !is_long("x.json"));
}

/// The width and the height of the polygon of this color in an SVG.
fn extent(svg: &str, color: &str) -> Option<[f64; 2]> {
    let line = svg
        .lines()
        .find(|line| line.starts_with("<polygon") && line.contains(color))?;
    let points = line.split("points=\"").nth(1)?.split('"').next()?;
    let number = |text: &str| text.parse::<f64>().unwrap();
    let points = points
        .split_whitespace()
        .map(|point| point.split_once(',').unwrap());
    let (x, y): (Vec<f64>, Vec<f64>) = points.map(|(x, y)| (number(x), number(y))).unzip();
    let width = |all: &[f64]| {
        let ends = [f64::min, f64::max].map(|of| all.iter().copied().reduce(of).unwrap());
        ends[1] - ends[0]
    };
    Some([width(&x), width(&y)])
}

#[test]
fn a_floor_plan_is_drawn_by_itself_and_a_built_in_scenario_runs_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(
        path("plan.wkt"),
        "POLYGON((0 0, 12 0, 12 10, 0 10, 0 0), (5 4, 5 6, 7 6, 7 4, 5 4))",
    )
    .unwrap();
    let ring = json!([[[0, 0], [12, 0], [12, 10], [0, 10], [0, 0]]]);
    fs::write(
        path("plan.geojson"),
        json!({"type": "Polygon", "coordinates": ring}).to_string(),
    )
    .unwrap();
    for plan in ["plan.wkt", "plan.geojson"] {
        let out = path(&format!("{plan}.svg"));
        let output = run(&["draw", &path(plan), "--out", &out]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        // The floor is 12 m × 10 m, the pillar 2 m × 2 m.
        let drawing = fs::read_to_string(&out).unwrap();
        let floor = extent(&drawing, "#FCFCF9").unwrap();
        assert!((floor[0] / floor[1] - 1.2).abs() < 0.01, "{floor:?}");
        let pillar = extent(&drawing, "#B0B0AC").map(|pillar| floor[0] / pillar[0]);
        assert_eq!(pillar.map(f64::round), (plan == "plan.wkt").then_some(6.0));
    }
    let by_name = run(&["run", "evacuation", "--until", "1", "--json"]);
    let command = run(&["evacuation", "--until", "1", "--json"]);
    let digest = |output: &std::process::Output| {
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        report["state_sha256"].clone()
    };
    assert_eq!(digest(&by_name), digest(&command));
}

#[test]
fn a_run_says_which_motivation_it_used() {
    let first = |settings: &[&str]| {
        let typed = [&["evacuation", "--until", "0.2"], settings].concat();
        let said = String::from_utf8(run(&typed).stdout).unwrap();
        said.lines().next().unwrap().to_owned()
    };
    let calm = first(&["--profile", "steer+sph", "--set", "motivation=0"]);
    assert!(calm.contains("(steer+sph, motivation 0), seed 1"), "{calm}");
    let hurried = first(&["--profile", "steer+sph"]); // as the file says
    assert!(hurried.contains("(steer+sph, motivation 1)"), "{hurried}");
    assert!(first(&[]).contains("(sph), seed 1"), "no law reads it");
}

#[test]
fn a_scenario_can_come_from_the_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.json"), room().to_string()).unwrap();
    let digest = |typed: &[&str], given: &str| {
        let mut program = Command::new(PROGRAM);
        let program = program.args(typed).current_dir(folder.path());
        let streams = program.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = streams.stderr(Stdio::piped()).spawn().unwrap();
        let mut input = child.stdin.take().unwrap();
        input.write_all(given.as_bytes()).unwrap();
        drop(input);
        let output = child.wait_with_output().unwrap();
        let report: Option<Value> = serde_json::from_slice(&output.stdout).ok();
        let digest = report.map(|report| report["state_sha256"].clone());
        (digest, stderr(&output))
    };
    let piped = digest(&["run", "-", "--until", "1", "--json"], &room().to_string());
    let named = digest(&["run", "room.json", "--until", "1", "--json"], "");
    assert!(piped.0.is_some(), "{}", piped.1);
    assert_eq!(piped.0, named.0);
    let (none, said) = digest(&["run", "-", "--json"], "{\"sed\": 1}");
    assert!(none.is_none());
    assert!(
        said.contains("error: standard input: sed: unknown key"),
        "{said}"
    );
}

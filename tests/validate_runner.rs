//! `sandbox validate --runner`: another simulator gets the same people, and is measured in the same way.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::program::{run_in, stderr, text};

/// Two streams that come in through entrances.
const CASE: &str = "two-ways-0.9";
const SCENE: &str = "scenarios/validation/two_ways.json";

fn in_repository(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    path.to_str().unwrap().to_owned()
}

/// `sandbox validate` with one seed and this command as runner.
fn judged(folder: &Path, cases: &[&str], command: &str) -> (i32, String, String) {
    let end = ["--seeds", "1", "--runner", command, "--out", "out"];
    let output = run_in(folder, &[&["validate"], cases, &end].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.code().unwrap(), said, stderr(&output))
}

/// The values of a case in the JSON file of results, by their quantities.
fn values(file: &Path) -> Vec<(String, f64)> {
    let all: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    let case = all
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["case"] == CASE);
    let checks = case.unwrap()["checks"].as_array().unwrap().iter();
    let near = checks.filter(|check| check["expected"]["near"].is_object());
    near.map(|check| {
        let name = check["quantity"].as_str().unwrap().to_owned();
        (name, check["value"].as_f64().unwrap())
    })
    .collect()
}

#[test]
fn our_own_trajectories_give_the_values_of_our_own_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let own = [
        "run",
        &in_repository(SCENE),
        "--profile",
        "sph",
        "--seed",
        "1",
        "--trajectory",
    ];
    let output = run_in(folder.path(), &[&own[..], &["own.txt"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let copy = format!("copy() {{ cp {} \"$2\"; }}; copy", text(&path("own.txt")));
    let (code, said, talk) = judged(folder.path(), &[CASE], &copy);
    assert_eq!(code, 0, "{talk}");
    assert!(
        said.contains("0 of 1 cases") || said.contains("1 of 1 cases"),
        "{said}"
    );
    let ours = [
        "validate",
        CASE,
        "--profile",
        "sph",
        "--seeds",
        "1",
        "--out",
        "ours",
    ];
    run_in(folder.path(), &ours);
    let (own, runner) = (
        values(&path("ours/validation.json")),
        values(&path("out/validation.json")),
    );
    assert_eq!(own.len(), 3);
    for ((name, own), (same, value)) in own.iter().zip(&runner) {
        assert_eq!(name, same);
        // Trajectories have fewer frames than runs.
        assert!((value / own - 1.0).abs() < 0.02, "{name}: {value}, {own}");
    }
}

#[test]
fn a_scene_has_the_people_the_floor_and_the_places() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let command =
        "keep() { cp \"$1\" kept.json; cp \"$(dirname \"$1\")/floor.wkt\" .; exit 7; }; keep";
    let (code, _, talk) = judged(folder.path(), &[CASE], command);
    assert_eq!(code, 1);
    assert!(
        talk.contains("two ways 0.9 m, seed 1") && talk.contains("it said nothing"),
        "{talk}"
    );
    let scene: Value =
        serde_json::from_str(&fs::read_to_string(path("kept.json")).unwrap()).unwrap();
    let file: Value =
        serde_json::from_str(&fs::read_to_string(in_repository(SCENE)).unwrap()).unwrap();
    for (got, exit) in scene["exits"]
        .as_array()
        .unwrap()
        .iter()
        .zip(file["exits"].as_array().unwrap())
    {
        assert_eq!(got["name"], exit["name"]);
        for (end, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert_eq!(
                got["line"][end][axis].as_f64(),
                exit["line"][end][axis].as_f64()
            );
        }
    }
    assert_eq!(scene["exits"].as_array().unwrap().len(), 2);
    let people = scene["people"].as_array().unwrap();
    for (k, entrance) in file["entrances"].as_array().unwrap().iter().enumerate() {
        let own = people
            .iter()
            .filter(|one| one["journey"] == entrance["journey"]);
        let own: Vec<&Value> = own.collect();
        assert_eq!(own.len() as u64, entrance["number"].as_u64().unwrap());
        let y = entrance["line"][0][1].as_f64().unwrap();
        for (n, person) in own.iter().enumerate() {
            let at = person["enters_secs"].as_f64().unwrap();
            let due = n as f64 / entrance["per_sec"].as_f64().unwrap();
            assert!((at - due).abs() < 1e-9, "entrance {k}: {at}, {due}");
            let [x, place_y] = [0, 1].map(|axis| person["position"][axis].as_f64().unwrap());
            assert!((1.1..=2.5).contains(&x) && (place_y - y).abs() < 1e-9);
        }
    }
    let journey = &scene["journeys"][0];
    let stages = file["journeys"][0]["stages"].as_array().unwrap();
    let alone: Vec<Value> = stages
        .iter()
        .map(|stage| serde_json::json!([stage]))
        .collect();
    assert_eq!(journey["stages"], Value::Array(alone));
    let floor = fs::read_to_string(path("floor.wkt")).unwrap();
    for k in 0..1000 {
        let [x, y] = [
            -2.05 + 0.2 * f64::from(k % 40),
            -7.95 + 0.64 * f64::from(k / 40),
        ];
        let is_at_end = y.abs() > 4.0 && -2.0 < x && x < 5.6;
        let is_in_corridor = y.abs() <= 4.0 && 0.0 < x && x < 3.6;
        let is_beyond_exit = x > 5.6 && y > 4.0 || x < -2.0 && y < -4.0;
        let is_on_floor = is_at_end || is_in_corridor || is_beyond_exit;
        assert_eq!(is_in(&floor, [x, y]), is_on_floor, "({x}, {y}) of {floor}");
    }
}

/// Whether a point is in a polygon in WKT without holes: whether a ray from it crosses the outline an odd number of
/// times.
fn is_in(wkt: &str, [x, y]: [f64; 2]) -> bool {
    let numbers = wkt.split(|c: char| !"0123456789.-".contains(c));
    let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
    let points: Vec<&[f64]> = numbers.chunks(2).collect();
    let crosses = |ends: &&[&[f64]]| {
        let [[ax, ay], [bx, by]] = [ends[0], ends[1]].map(|p| [p[0], p[1]]);
        (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
    };
    points.windows(2).filter(crosses).count() % 2 == 1
}

#[test]
fn what_a_runner_cannot_do_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, talk) = judged(folder.path(), &[CASE], "true");
    assert_eq!(code, 1);
    assert!(
        talk.contains("must write trajectories to the file that is its last argument"),
        "{talk}"
    );
    let (code, _, talk) = judged(folder.path(), &[CASE], "no_such_program_here");
    assert_eq!(code, 1);
    assert!(talk.contains("`no_such_program_here` failed"), "{talk}");
    // Periodic scenes are skipped.
    let (code, said, talk) = judged(folder.path(), &["speeds"], "true");
    assert_eq!(code, 0, "{talk}");
    assert!(
        said.contains("Skipped because another simulator cannot be judged by them: 1."),
        "{said}"
    );
    let both = ["validate", CASE, "--runner", "true", "--profile", "sph"];
    let output = run_in(folder.path(), &both);
    assert_eq!(output.status.code(), Some(2));
}

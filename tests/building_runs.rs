//! What runs of a building say and write, recomputed from the example in docs/guide/buildings.md alone.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::program::{json, refused, run, text};

/// The levels of the example: their names, the ends of their floors along x, meters, and the heights there.
const LEVELS: [(&str, [f64; 2], [f64; 2]); 3] = [
    ("ground", [0.0, 10.0], [0.0, 0.0]),
    ("stairs", [10.0, 14.0], [0.0, 2.5]),
    ("upper", [14.0, 20.0], [2.5, 2.5]),
];

/// The example of the page, in a folder.
fn house(folder: &TempDir) -> String {
    let page = include_str!("../docs/guide/buildings.md");
    let example = page.split("```json\n").nth(1).unwrap();
    let path = folder.path().join("house.json");
    std::fs::write(&path, example.split("```").next().unwrap()).unwrap();
    text(&path).to_owned()
}

/// The rows of a trajectory file: for each, its columns by name.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.deserialize();
    rows.map(Result::unwrap).collect()
}

#[test]
fn files_and_results_have_the_levels_and_heights_of_the_building() {
    let folder = tempfile::tempdir().unwrap();
    let (house, file) = (house(&folder), folder.path().join("house.csv"));
    let output = run(&["run", &house, "--json", "--trajectory", text(&file)]);
    let results = json(&output);
    let (mut last, mut highest) = (BTreeMap::new(), (0.0, String::new()));
    for row in rows(&file) {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let (x, y, z) = (number("pos_x"), number("pos_y"), number("z"));
        let level = LEVELS.iter().find(|(name, ..)| *name == row["level"]);
        let (name, [from, to], [low, high]) = level.unwrap();
        // Bodies of those who have left walk on behind the exit.
        assert!(x > from - 0.1 || *name == "ground", "{name}: {x}");
        assert!(x < to + 0.1 && y > 0.0, "{name}: ({x}, {y})");
        let expected = low + (high - low) * (x - from) / (to - from);
        assert!((z - expected).abs() < 1e-9, "{name}: {z} at {x}");
        let time = number("time");
        last.insert(row["id"].clone(), time);
        if number("density") > highest.0 {
            highest = (number("density"), (*name).to_owned());
        }
    }
    // All have left, the last one when the results say so.
    assert_eq!(last.len(), 40);
    let end = last.values().copied().fold(0.0, f64::max);
    let said = results["t100_secs"].as_f64().unwrap();
    assert!((said - end).abs() <= 0.1 + 1e-9, "{said}, {end}");
    assert_eq!(results["highest_density"]["level"], Value::from(highest.1));
    let most = results["highest_density"]["density_per_m2"]
        .as_f64()
        .unwrap();
    assert!((most - highest.0).abs() < 1e-9, "{most}, {}", highest.0);
    // The crowd waits at the head of the stairs.
    let queue = &results["longest_queues"][0];
    assert_eq!(queue["before"], "the opening at (14, 0.75) on `upper`");
    assert_eq!(queue["at"], serde_json::json!([14.0, 0.75]));
    assert_eq!(queue["level"], "upper");
    assert!(queue["agents"].as_u64().unwrap() > 10);
    assert_eq!(results["metrics"]["foot_passages"], 40);
}

#[test]
fn other_formats_are_refused_and_files_with_levels_are_no_trajectories_of_one_floor() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    for name in ["a.sqlite", "a.txt"] {
        let file = folder.path().join(name);
        let words = [
            name,
            "the trajectories of a building are written as .csv only",
        ];
        refused(&["run", &house, "--trajectory", text(&file)], 2, &words);
    }
    let file = folder.path().join("a.csv");
    run(&["run", &house, "--until", "1", "--trajectory", text(&file)]);
    let words = ["a.csv:1", "on several levels of a building"];
    refused(&["measure", text(&file), "--line", "10,0,10,1"], 2, &words);
}

#[test]
fn one_person_is_inspected_on_their_level() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(&["inspect", &house(&folder), "--agent", "3", "--at", "5"]);
    let said = String::from_utf8(output.stdout).unwrap();
    let line = said.lines().find(|line| line.starts_with("on `")).unwrap();
    let (name, rest) = line[4..].split_once("` at (").unwrap();
    let (place, rest) = rest.split_once("), ").unwrap();
    let x: f64 = place.split_once(", ").unwrap().0.parse().unwrap();
    let height: f64 = rest.split_once(" m high").unwrap().0.parse().unwrap();
    let level = LEVELS.iter().find(|(own, ..)| *own == name);
    let (_, [from, to], [low, high]) = level.unwrap();
    let expected = low + (high - low) * (x - from) / (to - from);
    assert!(
        (from - 0.1..to + 0.1).contains(&x) && (height - expected).abs() < 0.006,
        "{line}"
    );
}

//! Agents that wait for room at an entrance are in the program's note, in its JSON and in recordings.

use std::fs;

use crate::common::program::{json, run, stderr};
use crate::common::recording::Recording;

/// A line that has room for some five agents, none of whom leave.
const SCENARIO: &str = r#"{
  "name": "narrow", "goal": [0, 0], "duration_secs": 2,
  "entrances": [{"name": "gate", "line": [[0, 0], [0, 3]], "per_sec": 20, "until_secs": 1, "premovement_secs": 60}]
}"#;

#[test]
fn the_backlog_is_reported_and_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let [scenario, recording] = ["narrow.json", "narrow.rrd"].map(|name| folder.path().join(name));
    fs::write(&scenario, SCENARIO).unwrap();
    let [file, record] = [&scenario, &recording].map(|path| path.to_str().unwrap());
    let output = run(&["run", file, "--json", "--save", record, "--threads", "1"]);
    let report = json(&output);
    let backlog = &report["backlogs"][0];
    let (agents, waiting) = (&report["agents"], &backlog["at_end"]);
    assert_eq!(backlog["entrance"], "gate");
    assert_eq!(agents.as_u64().unwrap() + waiting.as_u64().unwrap(), 20);
    assert!(waiting.as_u64().unwrap() > 0);
    let largest = backlog["largest"].as_u64().unwrap();
    let time = backlog["largest_at_secs"].as_f64().unwrap();
    let note = format!(
        "note: up to {largest} agent(s) waited for room at \"gate\", the most at {time:.1} s; {waiting} still wait"
    );
    let said = stderr(&output);
    assert!(said.contains(&note), "{said}");
    let recording = Recording::read(&recording);
    let series = recording.numbers("/stats/crowd/waiting/0", "Scalars:scalars");
    let most = series
        .iter()
        .map(|(_, counts)| counts[0])
        .fold(0.0, f64::max);
    assert_eq!(most, largest as f64);
    assert_eq!(Some(series[series.len() - 1].1[0]), waiting.as_f64());
}

/// Twelve agents, who stand for long, before a counter with room for eight.
const QUEUE: &str = r#"{
  "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
  "crowds": [{"area": [[10, 2], [18, 2], [18, 8], [10, 8]], "number": 12, "journey": "j"}],
  "queues": [{"name": "counter", "path": [[0.5, 5], [4, 5]], "service_secs": 1000}],
  "obstacles": [[[4.3, 4], [4.5, 4], [4.5, 6], [4.3, 6]]],
  "exits": [{"name": "out", "line": [[20, 4], [20, 6]]}],
  "journeys": [{"name": "j", "stages": ["counter", "out"]}],
  "duration_secs": 60
}"#;

#[test]
fn queues_longer_than_their_line_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("queue.json");
    let room = "has room for 8: the others gathered at its end";
    for (path, is_full) in [("[4, 5]", true), ("[4, 5], [4, 1]", false)] {
        fs::write(&file, QUEUE.replace("[4, 5]", path)).unwrap();
        let said = stderr(&run(&["run", file.to_str().unwrap()]));
        assert_eq!(said.contains(room), is_full, "{said}");
    }
}

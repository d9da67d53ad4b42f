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
        "note: up to {largest} agent(s) waited for room at \"gate\" (first at {time:.1} s); {waiting} still wait"
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

//! What every report of a benchmark has. The tests of the package `experiments` share this file.

use sandbox::lab::bench::{Plan, Report};
use serde_json::Value;

/// The plan of all tests.
pub fn quick() -> Plan {
    Plan {
        repeats: 3,
        quick: true,
        largest: 1_000_000,
    }
}

pub fn rows(report: &Report) -> Vec<Value> {
    report.findings().unwrap().data["rows"]
        .as_array()
        .unwrap()
        .clone()
}

/// Checks that the report of a quick plan has the benchmark's name and the machine, and in every row `keys` and the
/// spread of `times`.
pub fn assert_is_complete(report: &Report, name: &str, keys: &[&str], times: &[&str]) {
    let findings = report.findings().unwrap();
    let json = &findings.data;
    assert_eq!(json["benchmark"], name);
    assert_eq!(
        (&json["repeats"], &json["quick"]),
        (&3.into(), &true.into())
    );
    for key in [
        "cpu",
        "cores",
        "hardware_threads",
        "memory_bytes",
        "load",
        "system",
    ] {
        assert!(!json["machine"][key].is_null(), "{name}: {key}");
    }
    assert!(json["vectors"]["lanes"].as_u64().unwrap() >= 1);
    let text = findings.document.text();
    assert!(text.contains(json["machine"]["cpu"].as_str().unwrap()));
    assert!(text.contains(json["vectors"]["level"].as_str().unwrap()));
    let rows = rows(report);
    let table = text.split("\n\n").nth(1).unwrap();
    assert!(!rows.is_empty() && table.lines().count() == 1 + rows.len());
    for row in rows {
        for key in keys {
            assert!(row.get(key).is_some(), "{name}: no {key} in {row}");
        }
        times.iter().for_each(|key| assert_is_spread(&row[key]));
    }
}

fn assert_is_spread(value: &Value) {
    let [low, middle, high] =
        ["minimum", "median", "maximum"].map(|key| value[key].as_f64().unwrap());
    assert!(0.0 < low && low <= middle && middle <= high, "{value}");
}

//! Tables of reports: the free width of lines, and what has set a value.

use std::fs;

use serde_json::{Value, json};

use crate::common::html::rows;
use crate::common::room::{done, scenario};

#[test]
fn the_free_width_of_a_line_leaves_out_walls_on_it_and_flush_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let plan = |obstacle: Value, line: Value| {
        json!({
            "duration_secs": 20, "profile": "steer+sph", "obstacles": obstacle, "stop": {"when_empty": true},
            "walkable_area": [[[[0, 0], [12, 0], [12, 8], [0, 8]]]],
            "exits": [{"name": "east", "line": line}],
            "crowds": [{"area": [[1, 1], [6, 1], [6, 7], [1, 7]], "number": 20}]
        })
    };
    let whole = json!([[12, 3], [12, 5]]);
    for (obstacle, line, width) in [
        (json!([]), whole.clone(), "2.00"),
        (
            json!([[[11, 2], [12, 2], [12, 4], [11, 4]]]),
            whole.clone(),
            "1.00",
        ),
        (
            json!([[[11, 2], [12.4, 2], [12.4, 4], [11, 4]]]),
            whole,
            "1.00",
        ),
        (json!([]), json!([[12, 6.5], [12, 8.4]]), "1.50"),
        (
            json!([[[8.5, 2], [9, 2], [9, 5], [8.5, 5]]]),
            json!([[9, 0], [9, 8]]),
            "5.00",
        ),
    ] {
        fs::write(
            folder.path().join("flush.json"),
            plan(obstacle, line).to_string(),
        )
        .unwrap();
        let run = done(folder.path(), &["run", "flush.json", "--json"]);
        done(
            folder.path(),
            &["report", "flush.json", "--force", "--json"],
        );
        let html = fs::read_to_string(folder.path().join("flush.html")).unwrap();
        let row = &rows(&html, "Exits, doors and gates")[0];
        assert_eq!(row[2], width, "{row:?}");
        let [first, last] = [0, 1].map(|k| run["places"][0]["from_to_secs"][k].as_f64().unwrap());
        let flow = 19.0 / (last - first) / width.parse::<f64>().unwrap();
        assert_eq!(run["places"][0]["passed"], 20);
        assert!(
            (row[7].parse::<f64>().unwrap() - flow).abs() < 0.006,
            "{row:?}: {flow}"
        );
    }
}

#[test]
fn a_report_says_what_has_set_a_value() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let typed = [
        "report",
        "room.json",
        "--until",
        "5",
        "--preset",
        "fast",
        "--seed",
        "4",
        "--json",
    ];
    done(folder.path(), &typed);
    let html = fs::read_to_string(folder.path().join("room.html")).unwrap();
    let rows = rows(&html, "Settings that differ from the defaults");
    let by = |key: &str| {
        rows.iter()
            .find(|row| row[0] == key)
            .map(|row| row[3].as_str())
    };
    assert_eq!(by("duration_secs"), Some("command line"));
    assert_eq!(by("seed"), Some("command line"));
    assert_eq!(by("avoidance_tolerance"), Some("preset"));
    assert_eq!(by("profile"), Some("scenario"));
}

//! Texts may begin with a byte-order mark, as some editors write it.

use std::fs;
use std::path::Path;

use crate::common::program::{run_in, stderr};
use serde_json::json;

/// Writes a file with a byte-order mark.
fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), format!("\u{feff}{text}")).unwrap();
}

#[test]
fn scenarios_studies_plans_and_trajectories_may_begin_with_a_byte_order_mark() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let hall =
        json!({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]});
    write(folder, "hall.geojson", &hall.to_string());
    write(folder, "hall.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 9))");
    let rows = |between: &str| {
        let row = |frame: i32| ["1", &frame.to_string(), "1", "2"].join(between);
        (0..20).map(row).collect::<Vec<_>>().join("\n")
    };
    write(
        folder,
        "a.txt",
        &format!("# framerate: 10\n{}\n", rows(" ")),
    );
    write(
        folder,
        "a.csv",
        &format!("id,frame,x/m,y/m\n{}\n", rows(",")),
    );
    let scenario = json!({"duration_secs": 0, "goal": [8, 8], "walkable_area": "hall.geojson",
                          "from": {"trajectory": "a.txt", "unit": "m"}});
    write(folder, "hall.json", &scenario.to_string());
    let study = json!({"scenario": "hall.json", "seeds": 2});
    write(folder, "study.json", &study.to_string());
    for arguments in [
        &["run", "hall.json"][..],
        &["run", "hall.json", "--geometry", "hall.wkt"],
        &["sweep", "study.json", "--list"],
        &[
            "measure",
            "a.txt",
            "--geometry",
            "hall.geojson",
            "--out",
            "a",
        ],
        &[
            "measure",
            "a.csv",
            "--fps",
            "10",
            "--geometry",
            "hall.wkt",
            "--out",
            "b",
        ],
    ] {
        let output = run_in(folder, arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    }
}

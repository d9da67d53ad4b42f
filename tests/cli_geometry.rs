//! `--geometry` and `sandbox list --schema` on the command line.

use crate::common::program::{run, run_json, stderr};

#[test]
fn a_floor_plan_replaces_the_walls_of_a_shipped_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("hall.wkt");
    // Without a doorway no agent gets near the goal, which is 2 m outside.
    std::fs::write(&plan, "POLYGON ((0 0, 20 0, 20 20, 0 20, 0 0))").unwrap();
    let plan = plan.to_str().unwrap();
    let report = run_json(&["evacuation", "--geometry", plan, "--until", "20", "--json"]);
    assert_eq!(report["metrics"]["evacuated"], 0);
    let inspect = ["inspect", "evacuation", "--agent", "0", "--json"];
    let walls = |more: &[&str]| {
        let report = run_json(&[&inspect[..], more].concat());
        report["agents"][0]["walls"].as_array().unwrap().len()
    };
    let open = walls(&["--set", "obstacles=[]"]);
    let walled = walls(&["--geometry", plan]);
    assert_eq!((open, walled), (0, 2), "in the corner of the hall");
}

#[test]
fn an_invalid_floor_plan_is_refused_with_its_name_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("hall.wkt");
    std::fs::write(&plan, "POLYGON ((8.41 49.01, 8.42 49.01, 8.42 49.02))").unwrap();
    let plan = plan.to_str().unwrap();
    let output = run(&["evacuation", "--geometry", plan]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let start = format!("error: --geometry {plan}: too small for a person");
    assert!(stderr(&output).starts_with(&start), "{}", stderr(&output));
    let missing = run(&["evacuation", "--geometry", "no/such.geojson"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(stderr(&missing).contains("--geometry no/such.geojson: cannot be read"));
}

/// A trajectory of two people with this geometry.
fn trajectory(folder: &std::path::Path, wkt: Option<String>) -> String {
    let path = folder.join("run.sqlite");
    let file = rusqlite::Connection::open(&path).unwrap();
    let tables = "DROP TABLE IF EXISTS geometry;
        CREATE TABLE geometry (hash INTEGER, wkt TEXT);
        CREATE TABLE IF NOT EXISTS metadata AS SELECT 'fps' AS key, '10' AS value;
        CREATE TABLE IF NOT EXISTS trajectory_data AS
        WITH RECURSIVE frames (frame) AS (SELECT 0 UNION ALL SELECT frame + 1 FROM frames LIMIT 20)
        SELECT frame, id, 0.1 * frame + id AS pos_x, 5.0 AS pos_y
        FROM frames, (SELECT 1 AS id UNION SELECT 2)";
    file.execute_batch(tables).unwrap();
    file.execute("INSERT INTO geometry VALUES (1, ?)", [wkt])
        .unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn an_invalid_geometry_in_a_trajectory_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    for (wkt, reason) in [
        (None, "has no polygons"),
        (
            Some("GEOMETRYCOLLECTION (".repeat(20_000)),
            "not valid WKT: line 1, column 1300: more than 64 parentheses are open",
        ),
    ] {
        let file = trajectory(folder.path(), wkt);
        let output = run(&["measure", &file, "--out", out]);
        let fix = "give another one with --geometry, or use --geometry none";
        let expected = format!("error: {file}: its geometry: {reason}; {fix}\n");
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).ends_with(&expected), "{}", stderr(&output));
        let without = run(&[
            "measure",
            &file,
            "--out",
            out,
            "--geometry",
            "none",
            "--force",
        ]);
        assert_eq!(without.status.code(), Some(0), "{}", stderr(&without));
        std::fs::remove_dir_all(out).unwrap();
    }
}

#[test]
fn the_schema_is_one_json_object_on_stdout() {
    let printed = run_json(&["list", "--schema"]);
    assert_eq!(printed, sandbox::scenario::schema());
    assert_eq!(
        printed["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
}

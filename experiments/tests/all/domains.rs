//! How crowds divide: what the report has, and bounds of the model.

use crate::reports::{assert_is_complete, quick, rows};
use experiments::domains::BENCHMARK;
use serde_json::Value;

#[test]
fn the_report_has_the_machine_and_the_spread_of_every_time() {
    let report = BENCHMARK.measure(&quick(), &|_| ()).unwrap();
    let keys = ["crowd", "parts", "cut", "halo_mean", "drift", "model"];
    assert_is_complete(&report, "domains", &keys, &["ms_per_frame"]);
}

#[test]
fn divided_crowds_are_not_modeled_faster_than_their_parts_allow() {
    let rows = rows(&BENCHMARK.measure(&quick(), &|_| ()).unwrap());
    for row in &rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        let parts = number("parts");
        assert!(number("agents_ratio") >= 1.0 && number("work_ratio") >= 1.0);
        assert!(number("work_ratio") >= number("agents_ratio"), "no RVO");
        assert!(number("halo_mean") <= number("halo_largest"));
        assert!(0.0 < number("halo_mean") && number("halo_largest") < number("agents"));
        assert!(number("neighbors_mean") <= number("neighbors_most"));
        assert!(number("neighbors_most") < parts);
        if row["cut"] == "bisection" {
            // One agent more than the mean.
            let fair = 1.0 + parts / number("agents");
            assert!(number("agents_ratio") <= fair, "{row}");
        }
        let model = row["model"].as_array().unwrap();
        let speed_up = |model: &Value| model["speed_up"].as_f64().unwrap();
        assert!(model.windows(2).all(|m| speed_up(&m[0]) > speed_up(&m[1])));
        assert!(speed_up(&model[0]) < parts / number("work_ratio"));
        let drifts = row["crowd"] != "block";
        assert_eq!(drifts, !row["drift"].is_null(), "{row}");
    }
    for crowd in ["block", "streams"] {
        assert!(rows.iter().any(|row| row["crowd"] == crowd));
    }
}

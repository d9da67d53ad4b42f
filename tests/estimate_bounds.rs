//! Bounds by order statistics, and curves with bands.

use std::fs;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::analysis::statistics::{draws_above, probability_above};
use sandbox::lab::estimate::Bound;
use serde_json::Value;

use crate::common::program::{json, refused, run_in, stderr};

#[test]
fn the_number_of_runs_of_a_bound_is_the_smallest_that_holds() {
    assert_eq!(draws_above(0.95, 0.95), 59);
    assert_eq!(draws_above(0.9, 0.95), 29);
    assert_eq!(draws_above(0.99, 0.95), 299);
    assert_eq!(draws_above(0.5, 0.75), 2);
    for share in [0.5, 0.8, 0.95, 0.999] {
        for probability in [0.5, 0.9, 0.95, 0.99] {
            let draws = draws_above(share, probability);
            let holds = |draws: usize| 1.0 - share.powf(draws as f64);
            assert!(holds(draws) >= probability - 1e-12);
            assert!(
                draws == 1 || holds(draws - 1) < probability,
                "{share} {probability}"
            );
        }
    }
}

#[test]
fn ranks_are_above_quantiles_as_often_as_they_say() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let (trials, draws, share) = (4000, 50, 0.95);
    for rank in [47, 49, 50] {
        // Uniform draws: the quantile is the share itself.
        let above = (0..trials).filter(|_| {
            let mut values: Vec<f64> = (0..draws).map(|_| rng.random()).collect();
            values.sort_by(f64::total_cmp);
            values[rank - 1] >= share
        });
        let found = above.count() as f64 / f64::from(trials);
        let expected = probability_above(rank, draws, share);
        // Four standard deviations of the count.
        assert!(
            (found - expected).abs() < 4.0 * 0.5 / f64::from(trials).sqrt(),
            "{rank}"
        );
    }
    let of_largest = 1.0 - share.powi(50);
    assert!((probability_above(50, 50, share) - of_largest).abs() < 1e-12);
    assert_eq!(probability_above(0, 50, share), 0.0);
}

#[test]
fn bounds_are_read_as_shares() {
    let read = |text: &str| text.parse::<Bound>();
    let upper = read(" t95_secs = 95 %").unwrap();
    assert_eq!((upper.name.as_str(), upper.share), ("t95_secs", 0.95));
    assert!(upper.is_upper() && !read("flow=5%").unwrap().is_upper());
    assert!((read("flow=5%").unwrap().inner() - 0.95).abs() < 1e-12);
    for wrong in [
        "t", "t=", "t=0.95", "t=0%", "t=100%", "t=-5%", "t=x%", "t=NaN%",
    ] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

/// A small evacuation; `more` follows.
fn estimate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let small = [
        "estimate",
        "evacuation",
        "--json",
        "--set",
        "grids.0.columns=5",
        "--set",
        "grids.0.rows=5",
        "--set",
        "measurements.1.flow_of_first.arrivals=15",
    ];
    [&small[..], more].concat()
}

fn answer(folder: &Path, more: &[&str]) -> Value {
    let output = run_in(folder, &estimate(more));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)["estimate"].clone()
}

fn values(bound: &Value) -> Vec<f64> {
    let values = bound["values"].as_array().unwrap().iter();
    values.map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn a_bound_is_the_largest_or_smallest_of_the_runs_that_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    let both = ["--bound", "time_secs=90%", "--bound", "flow_per_s=10%"];
    let answer = answer(folder.path(), &both);
    assert_eq!(answer["runs"]["all"], 29);
    let [time, flow] = [&answer["bounds"][0], &answer["bounds"][1]];
    assert_eq!(values(time).len(), 29);
    let largest = values(time).into_iter().fold(f64::NEG_INFINITY, f64::max);
    let smallest = values(flow).into_iter().fold(f64::INFINITY, f64::min);
    assert_eq!(
        (time["value"].as_f64(), &time["rank"]),
        (Some(largest), &29.into())
    );
    assert_eq!(
        (flow["value"].as_f64(), &flow["rank"]),
        (Some(smallest), &1.into())
    );
    for bound in [time, flow] {
        let holds = bound["confidence"].as_f64().unwrap();
        assert!((holds - (1.0 - 0.9_f64.powi(29))).abs() < 1e-9, "{holds}");
    }
    let table = folder
        .path()
        .join("estimate/evacuation-sph-grids.0.columns=5-grids.0.rows=5");
    let name = format!(
        "{}-measurements.1.flow_of_first.arrivals=15-bounds.csv",
        table.display()
    );
    assert!(
        fs::read_to_string(name)
            .unwrap()
            .starts_with("result,share,bound,rank,n,")
    );
}

#[test]
fn bounds_do_not_depend_on_errors_that_are_asked_for_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    let alone = answer(folder.path(), &["--bound", "time_secs=80%"]);
    let more = ["--bound", "time_secs=80%", "--error", "time_secs=3%"];
    let beside = answer(folder.path(), &more);
    assert_eq!(alone["bounds"], beside["bounds"]);
    assert_eq!(beside["results"][0]["is_reached"], true);
}

#[test]
fn too_few_runs_for_a_bound_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--bound", "time_secs=90%", "--most-runs", "10"];
    let output = run_in(folder.path(), &estimate(&more));
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("at most 10 runs"),
        "{}",
        stderr(&output)
    );
    let bound = &json(&output)["estimate"]["bounds"][0];
    assert_eq!((&bound["runs"], &bound["needed"]), (&10.into(), &29.into()));
    let plan = ["--bound", "time_secs=95%", "--plan"];
    let plan = json(&run_in(folder.path(), &estimate(&plan)));
    assert_eq!(plan["bounds"][0]["runs"], 59);
    refused(
        &[
            "estimate",
            "evacuation",
            "--runs",
            "imo",
            "--error",
            "flow_per_s=1%",
        ],
        2,
        &["--bound"],
    );
    refused(
        &["estimate", "evacuation", "--bound", "flow=95%"],
        2,
        &["--bound flow", "no such result"],
    );
}

#[test]
fn runs_of_imo_are_ten_populations_where_behavior_is_random_and_fifty_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let imo = ["--bound", "time_secs=95%", "--runs", "imo"];
    let walking = answer(folder.path(), &imo);
    let bound = &walking["bounds"][0];
    assert_eq!(bound["populations"], Value::from(vec![50, 1]));
    assert_eq!((&bound["runs"], &bound["rank"]), (&50.into(), &49.into()));
    let mut sorted = values(bound);
    sorted.sort_by(f64::total_cmp);
    assert_eq!(bound["value"].as_f64(), Some(sorted[48]));
    assert_eq!(sorted.len(), 50);
    let random = answer(
        folder.path(),
        &[&imo[..], &["--profile", "rvo->sph"]].concat(),
    );
    let bound = &random["bounds"][0];
    assert_eq!(bound["populations"], Value::from(vec![10, 5]));
    assert!(
        bound["confidence"].is_null(),
        "runs of a population are not independent"
    );
    // Runs of the same population differ.
    let values = values(bound);
    assert!(
        values
            .chunks(5)
            .any(|runs| runs.iter().any(|value| *value != runs[0]))
    );
}

#[test]
fn curves_of_an_estimate_have_bands_around_their_means() {
    let folder = tempfile::tempdir().unwrap();
    let line = r#"measurements.2={"line_flow": {"line": [[20.5, 9.6], [20.5, 10.4]]}}"#;
    let more = ["--set", line, "--bound", "time_secs=60%"];
    answer(folder.path(), &more);
    let files = || fs::read_dir(folder.path().join("estimate")).unwrap();
    let paths = files().map(|file| file.unwrap().path());
    let curves = paths.filter(|path| path.to_str().unwrap().ends_with("-curves.csv"));
    let text = fs::read_to_string(curves.last().unwrap()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("settings,curve,x,mean,low_95,high_95,n"));
    let rows = lines.map(|line| {
        let fields: Vec<f64> = line
            .split(',')
            .skip(2)
            .map(|text| text.parse().unwrap())
            .collect();
        fields
    });
    let rows: Vec<Vec<f64>> = rows.collect();
    assert!(rows.len() > 50);
    assert!(
        rows.iter().all(|row| row[2] <= row[1] && row[1] <= row[3]),
        "{text}"
    );
    assert!(rows.iter().any(|row| row[2] < row[3]), "{text}");
    // Numbers of passages rise to all 25 people.
    assert!(rows.windows(2).all(|pair| pair[0][1] <= pair[1][1]));
    assert_eq!(rows.last().unwrap()[1], 25.0);
}

//! The error of the model in estimates: computed again from the ratios of the validation, and how often it holds.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::program::{json, run_in, stderr};

/// An evacuation of 25 people, with the flow through its door.
const SMALL: [&str; 9] = [
    "evacuation",
    "--profile",
    "walk+sph",
    "--set",
    "grids.0.columns=5",
    "--set",
    "grids.0.rows=5",
    "--set",
    r#"measurements.2={"line_flow": {"line": [[20.5, 9.6], [20.5, 10.4]]}}"#,
];

/// A simulated value over the measured one, as a logarithm.
#[derive(Clone)]
struct Ratio {
    experiment: String,
    is_hurried: bool,
    log: f64,
}

fn read(path: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The ratios of a profile with one of these units.
fn ratios(profile: &str, units: &[&str]) -> Vec<Ratio> {
    let study = read("scenarios/studies/validation.json");
    let cases = study["cases"].as_array().unwrap().iter();
    let kinds: BTreeMap<&str, &str> = cases
        .filter_map(|case| Some((case["name"].as_str()?, case["kind"].as_str()?)))
        .collect();
    let status = read("docs/findings/validation.json");
    let mut all = Vec::new();
    for (case, values) in status["profiles"][profile]["ratios"].as_object().unwrap() {
        for (name, ratio) in values.as_object().unwrap() {
            if units.iter().any(|unit| name.ends_with(unit)) {
                all.push(Ratio {
                    experiment: case.clone(),
                    is_hurried: kinds[case.as_str()].starts_with("hurried"),
                    log: ratio.as_f64().unwrap().ln(),
                });
            }
        }
    }
    all
}

/// The mean of people alike, as if there were four more values of 0.
fn center(all: &[Ratio], is_hurried: bool, without: Option<&str>) -> f64 {
    let own: Vec<f64> = all
        .iter()
        .filter(|one| one.is_hurried == is_hurried && Some(one.experiment.as_str()) != without)
        .map(|one| one.log)
        .collect();
    own.iter().sum::<f64>() / (own.len() as f64 + 4.0)
}

/// The half width around the center that holds the next of n deviations in 90 %: the ⌈0.9 (n + 1)⌉-th smallest.
fn width(all: &[Ratio]) -> f64 {
    let from_center =
        |one: &Ratio| (one.log - center(all, one.is_hurried, Some(&one.experiment))).abs();
    let mut scores: Vec<f64> = all.iter().map(from_center).collect();
    scores.sort_by(f64::total_cmp);
    scores[(0.9 * (scores.len() + 1) as f64).ceil() as usize - 1]
}

#[test]
fn an_estimate_has_the_error_of_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let errors = [
        "--error",
        "line_flow_per_s=20%",
        "--error",
        "time_secs=10%",
        "--error",
        "highest_density=20%",
    ];
    let typed = [&["estimate"], &SMALL[..], &errors].concat();
    let output = run_in(folder.path(), &typed);
    let again = run_in(folder.path(), &[&typed[..], &["--json"]].concat());
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let rows = json(&again)["estimate"]["results"].clone();
    let row = |name: &str| {
        let mut all = rows.as_array().unwrap().iter();
        all.find(|row| row["name"] == name).unwrap()
    };

    let flow = row("line_flow_per_s");
    let known = ratios("walk+sph", &["[P/s]", "[P/(m s)]"]);
    let experiments: BTreeSet<&str> = known.iter().map(|one| one.experiment.as_str()).collect();
    let hurried = known.iter().filter(|one| one.is_hurried);
    let alike: BTreeSet<&str> = hurried.map(|one| one.experiment.as_str()).collect();
    let (center, width) = (center(&known, true, None), width(&known));
    let value = flow["value"].as_f64().unwrap();
    for (bound, expected) in [("low", -center - width), ("high", -center + width)] {
        let found = flow["model"][bound].as_f64().unwrap();
        assert!(
            (found / (value * expected.exp()) - 1.0).abs() < 1e-9,
            "{bound} {found}"
        );
    }
    assert_eq!(flow["model"]["experiments"], experiments.len());
    assert_eq!(flow["model"]["alike"], alike.len());
    assert_eq!(flow["model"]["through_flows"], false);

    // A time of people who queue: what comes after the first arrival is as much longer as flows are lower.
    let time = row("time_secs");
    assert_eq!(time["model"]["through_flows"], true);
    let secs = time["value"].as_f64().unwrap();
    let [low, high] = ["low", "high"].map(|bound| time["model"][bound].as_f64().unwrap());
    let first = [(low, center - width), (high, center + width)]
        .map(|(bound, by)| (bound - secs * by.exp()) / (1.0 - by.exp()));
    assert!((first[0] - first[1]).abs() < 1e-6, "{first:?}");
    assert!(first[0] > 1.0 && first[0] < secs, "{first:?}");

    // Nothing that experiments measure.
    let density = row("highest_density");
    assert_eq!(density["model"]["unknown"], "no experiment measures it");

    // The text says the same.
    let said = String::from_utf8(output.stdout).unwrap();
    let counts = format!(
        "(90 %; {} experiments, {} of them with hurried people)",
        experiments.len(),
        alike.len()
    );
    assert!(said.contains("model −") && said.contains(&counts), "{said}");
}

/// The two differences of `model −a … +b` in a line.
fn differences(line: &str) -> [f64; 2] {
    let (_, rest) = line.split_once("model −").unwrap();
    let (low, rest) = rest.split_once(" … +").unwrap();
    let (high, _) = rest.split_once(" (90 %; ").unwrap();
    [low, high].map(|one| one.parse().unwrap())
}

#[test]
fn the_first_page_of_a_report_says_what_its_numbers_are_worth() {
    let folder = tempfile::tempdir().unwrap();
    let run = [&["run"], &SMALL[..], &["--json"]].concat();
    let run = json(&run_in(folder.path(), &run));
    let drawn = ["--egress", "--out", "egress.svg", "--json"];
    let drawn = json(&run_in(
        folder.path(),
        &[&["draw"], &SMALL[..], &drawn].concat(),
    ));
    let report = [&["report"], &SMALL[..], &["--out", "report.html"]].concat();
    let report = run_in(folder.path(), &report);
    assert_eq!(report.status.code(), Some(0), "{}", stderr(&report));
    let html = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let (before, section) = html.split_once("What the numbers are worth").unwrap();
    assert!(!before.contains("<h2>Scenario"));
    let line = |start: &str| {
        let (_, rest) = section.split_once(start).unwrap();
        rest.split("</li>").next().unwrap()
    };
    let known = ratios("walk+sph", &["[P/s]", "[P/(m s)]"]);
    let (center, width) = (center(&known, true, None), width(&known));

    let flow = run["metrics"]["line_flow_per_s"].as_f64().unwrap();
    let said = line("line_flow_per_s: ");
    assert!(said.starts_with(&format!(
        "{flow:.2} P/s; chance and step: not known from one run; "
    )));
    let [low, high] = differences(said);
    assert!(
        (low - flow * (1.0 - (-center - width).exp())).abs() < 0.005,
        "{said}"
    );
    assert!(
        (high - flow * ((-center + width).exp() - 1.0)).abs() < 0.005,
        "{said}"
    );

    // People queue: what comes after the first has left is as much longer as flows are lower.
    let secs = run["t95_secs"].as_f64().unwrap();
    let exits = drawn["exits"].as_array().unwrap().iter();
    let left = exits.flat_map(|exit| exit["secs"].as_array().unwrap());
    let first = left
        .map(|one| one.as_f64().unwrap())
        .fold(f64::MAX, f64::min);
    let said = line("95 % out: ");
    assert!(said.starts_with(&format!(
        "{secs:.1} s; chance and step: not known from one run; "
    )));
    let [low, high] = differences(said);
    let longer = |by: f64| (secs - first) * (by.exp() - 1.0);
    assert!((low + longer(center - width)).abs() < 0.05, "{said}");
    assert!((high - longer(center + width)).abs() < 0.05, "{said}");
}

#[test]
fn intervals_of_the_model_hold_experiments_that_they_do_not_know() {
    let quantities = [&["[P/s]", "[P/(m s)]"][..], &["[P/m²]"][..], &["[m/s]"][..]];
    let (mut held, mut count) = (0, 0);
    for units in quantities {
        let all = ratios("steer+sph", units);
        for left_out in &all {
            let others = all
                .iter()
                .filter(|one| one.experiment != left_out.experiment);
            let others: Vec<Ratio> = others.cloned().collect();
            let from = center(&others, left_out.is_hurried, None);
            held += usize::from((left_out.log - from).abs() <= width(&others));
            count += 1;
        }
    }
    let share = f64::from(held as u32) / f64::from(count);
    assert!((0.85..=0.95).contains(&share), "{held} of {count}");
}

//! The tables of other simulators on our scenes, in docs/findings/validation.md, are those of the data.

use std::ops::RangeInclusive;

use serde_json::Value;

const PAGE: &str = include_str!("../docs/findings/validation.md");
const MODELS: [&str; 3] = ["collision-free speed", "anticipation velocity", "steer+sph"];

fn data() -> Value {
    serde_json::from_str(include_str!("../docs/findings/jupedsim.json")).unwrap()
}

/// A value of a model over the measured one, minus 1; `None` if too few people passed.
fn deviation(row: &Value, model: &str) -> Option<f64> {
    Some(row[model].as_f64()? / row["measured"].as_f64().unwrap() - 1.0)
}

fn kinds(rows: &[Value]) -> Vec<&str> {
    let mut kinds: Vec<&str> = rows
        .iter()
        .map(|row| row["kind"].as_str().unwrap())
        .collect();
    kinds.dedup();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

/// A line of a table with these cells.
fn line(first: &str, cells: &[String]) -> String {
    format!("| {first} | {} |", cells.join(" | "))
}

#[test]
fn counts_of_values_within_the_tolerances_are_those_of_the_data() {
    let data = data();
    let rows = data["values"].as_array().unwrap();
    for kind in kinds(rows).into_iter().chain(["all"]) {
        let own = rows
            .iter()
            .filter(|row| kind == "all" || row["kind"] == kind);
        let own: Vec<&Value> = own.collect();
        let cell = |model: &str| {
            let is_met = |row: &&&Value| {
                let tolerance = row["tolerance"].as_f64().unwrap();
                deviation(row, model).is_some_and(|by| by.abs() <= tolerance)
            };
            format!("{} of {}", own.iter().filter(is_met).count(), own.len())
        };
        let expected = line(kind, &MODELS.map(cell));
        assert!(PAGE.contains(&expected), "{expected}");
    }
}

#[test]
fn differences_from_the_measured_values_are_those_of_the_data() {
    let data = data();
    let rows = data["values"].as_array().unwrap();
    for kind in kinds(rows) {
        for (quantity, unit) in [("flow", "P/s]"), ("density", "P/m²]"), ("speed", "m/s]")] {
            let own = rows.iter().filter(|row| {
                row["kind"] == kind && row["quantity"].as_str().unwrap().ends_with(unit)
            });
            let own: Vec<&Value> = own.collect();
            assert!(!own.is_empty(), "{kind}: {quantity}");
            let cell = |model: &str| {
                let all = own.iter().filter_map(|row| deviation(row, model));
                range(all).map_or("–".to_owned(), |range| {
                    format!("{} to {} %", signed(*range.start()), signed(*range.end()))
                })
            };
            let first = if quantity == "flow" { kind } else { "" };
            let cells: Vec<String> = [quantity.to_owned()]
                .into_iter()
                .chain(MODELS.map(cell))
                .collect();
            let expected = line(first, &cells);
            let table = PAGE.split(&format!("| {kind} | flow |")).nth(1).unwrap();
            assert!(PAGE.contains(&expected), "{kind}: {expected}");
            assert!(
                quantity == "flow" || table.lines().take(3).any(|one| one == expected),
                "{kind}: {expected}"
            );
        }
    }
}

/// The least and the most, in whole percent.
fn range(all: impl Iterator<Item = f64>) -> Option<RangeInclusive<i32>> {
    let mut percent: Vec<i32> = all.map(|by| (100.0 * by).round() as i32).collect();
    percent.sort_unstable();
    Some(*percent.first()?..=*percent.last()?)
}

fn signed(percent: i32) -> String {
    match percent {
        0 => "0".to_owned(),
        1.. => format!("+{percent}"),
        _ => format!("−{}", -percent),
    }
}

#[test]
fn the_page_names_the_version_and_the_defaults() {
    let version = format!("JuPedSim {}", data()["jupedsim"].as_str().unwrap());
    let section = PAGE.split("## JuPedSim on the same scenes").nth(1).unwrap();
    let section = section.split("## Results").next().unwrap();
    for words in [
        version.as_str(),
        "defaults",
        "fitted to 36 of the 72 values",
    ] {
        let flat = section.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(words), "{words}");
    }
    // The values of experiments and their tolerances are those of the study.
    let study: Value =
        serde_json::from_str(include_str!("../scenarios/studies/validation.json")).unwrap();
    let cases = study["cases"].as_array().unwrap();
    for row in data()["values"].as_array().unwrap() {
        let case = cases
            .iter()
            .find(|case| case["name"] == row["case"])
            .unwrap();
        assert_eq!(case["kind"], row["kind"]);
    }
}

#[test]
fn values_of_steer_are_those_of_the_present_validation() {
    let status: Value =
        serde_json::from_str(include_str!("../docs/findings/validation.json")).unwrap();
    let ratios = &status["profiles"]["steer+sph"]["ratios"];
    let mut compared = 0;
    for row in data()["values"].as_array().unwrap() {
        let [case, quantity] = [&row["case"], &row["quantity"]].map(|name| name.as_str().unwrap());
        // The validation has no ratios of scenes that need data.
        if case.starts_with("data-") {
            continue;
        }
        let now = ratios[case][quantity].as_f64().unwrap() - 1.0;
        let shown = deviation(row, "steer+sph").unwrap();
        assert!(
            (now - shown).abs() < 1e-4,
            "{case}, {quantity}: {shown}, now {now}"
        );
        compared += 1;
    }
    assert!(compared > 40, "{compared} compared");
}

//! The results and the settings of a run, as tables and as HTML.

use std::collections::BTreeMap;

use serde_json::Value;

use figures::html::{escape, facts};
use figures::table::{Cell, Table};
use runs::drive::End;
use runs::summary::{JourneyResult, PlaceResult};
use scenario::measurements::Quantity;
use scenario::quote::shown;
use scenario::{Scenario, tidy};

/// Longer values of settings are cut; the scenario below them is whole.
const LONGEST: usize = 160;
/// Keys of a report that depend on the machine, not on the run.
const OF_MACHINE: [&str; 4] = ["threads", "ms_per_frame", "real_time_factor", "stages_ms"];
/// What a report says of the people and of the end: keys and words.
const OUTCOME: [(&str, &str); 10] = [
    ("scenario", "scenario"),
    ("profile", "profile"),
    ("seed", "seed"),
    ("time_secs", "simulated time [s]"),
    ("agents", "people entered"),
    ("arrived", "people arrived"),
    ("remaining", "people remain"),
    ("removed", "people removed"),
    ("stuck", "people stuck"),
    ("end", "it ended because"),
];

/// Tables of a report, which is what `--json` prints: outcome, measurements, journeys, places, settings, digests.
pub fn results(report: &Value, scenario: Option<&Scenario>) -> String {
    let outcome = OUTCOME.iter().filter_map(|(key, words)| {
        let value = report.get(key).filter(|value| !value.is_null())?;
        let text = match *key {
            "end" => reason(value),
            "time_secs" => tidy(&words_of(value)),
            _ => words_of(value),
        };
        Some(((*words).to_owned(), text))
    });
    let mut html = section("Outcome", &pairs(&outcome.collect::<Vec<_>>()).html());
    let metrics = facts(report.get("metrics").unwrap_or(&Value::Null));
    if !metrics.is_empty() {
        html += &section("Measurements", &measurements(report, scenario).html());
    }
    let of = |key: &str| report.get(key).cloned().unwrap_or_default();
    if let Ok(journeys) = serde_json::from_value::<Vec<JourneyResult>>(of("journeys")) {
        html += &section("Journeys", &self::journeys(&journeys).html());
    }
    if let Ok(places) = serde_json::from_value::<Vec<PlaceResult>>(of("places")) {
        html += &section("Places", &self::places(&places).html());
    }
    let digests = ["version", "identity", "state_sha256"]
        .iter()
        .filter_map(|key| {
            let value = report.get(key).and_then(Value::as_str)?;
            Some(((*key).to_owned(), value.to_owned()))
        });
    html += &section(
        "Version and digests",
        &pairs(&digests.collect::<Vec<_>>()).html(),
    );
    let listed = facts(&of("settings")).into_iter();
    let settings: Vec<_> = listed
        .map(|(key, value)| (key, cut(tidy(&value))))
        .collect();
    html += &format!(
        "<details><summary>Settings ({})</summary>\n{}</details>\n",
        settings.len(),
        pairs(&settings).html(),
    );
    if let Some(scenario) = scenario {
        let text = escape(&scenario.to_text());
        html += &format!("<details><summary>Scenario</summary>\n<pre>{text}</pre></details>\n");
    }
    format!("<section class=\"results\">\n{html}</section>\n")
}

/// A report without what depends on the machine.
pub fn reproducible(mut report: Value) -> Value {
    if let Some(entries) = report.as_object_mut() {
        entries.retain(|key, _| !OF_MACHINE.contains(&key.as_str()));
    }
    report
}

/// A table of names and texts.
pub fn pairs(rows: &[(String, String)]) -> Table {
    Table::of(rows)
        .column("", |(name, _)| name.as_str())
        .column("", |(_, value)| value.as_str())
        .table()
}

/// A heading with HTML below it.
pub fn section(heading: &str, html: &str) -> String {
    format!("<section><h2>{}</h2>\n{html}</section>\n", escape(heading))
}

/// Why a run ended, in words.
fn reason(end: &Value) -> String {
    match serde_json::from_value(end.clone()) {
        Ok(End::Empty) => "no people were left".to_owned(),
        Ok(End::Idle) => "no one arrived any more".to_owned(),
        Ok(End::Duration) => "its duration was over".to_owned(),
        Ok(End::Interrupted) => "it was interrupted".to_owned(),
        Err(_) => words_of(end),
    }
}

fn words_of(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}

/// A long text, cut.
fn cut(text: String) -> String {
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text,
    }
}

/// Measurements, with units and meanings if the scenario is known.
fn measurements(report: &Value, scenario: Option<&Scenario>) -> Table {
    let measured = scenario.map(|scenario| scenario.measurements.iter());
    let all = measured.into_iter().flatten();
    let quantities = all.flat_map(|one| one.quantities());
    let known: BTreeMap<String, Quantity> = quantities.map(|one| (one.name.clone(), one)).collect();
    let metrics = report["metrics"].as_object();
    let rows: Vec<(&String, &Value)> = metrics.into_iter().flatten().collect();
    let of = |name: &String| known.get(name);
    Table::of(&rows)
        .column("measurement", |(name, _)| name.as_str())
        .column("value", |(_, value)| match value.as_f64() {
            Some(number) if value.is_f64() => Cell::Text(format!("{number:.3}")),
            Some(number) => Cell::from(number),
            None => Cell::Missing,
        })
        .column("unit", |(name, _)| of(name).map_or("", |one| one.unit))
        .column("meaning", |(name, _)| {
            of(name).map_or("", |one| one.meaning.as_str())
        })
        .table()
}

/// The journeys that agents have begun.
pub fn journeys(journeys: &[JourneyResult]) -> Table {
    Table::of(journeys)
        .column("journey", |row| shown(&row.name))
        .column("started", |row| row.left.started)
        .column("left", |row| row.left.finished)
        .fixed("mean [s]", 1, |row| row.left.mean_secs)
        .fixed("50 % [s]", 1, |row| row.left.t50_secs)
        .fixed("95 % [s]", 1, |row| row.left.t95_secs)
        .fixed("all [s]", 1, |row| row.left.t100_secs)
        .fixed("waited [s]", 1, |row| row.left.waited_secs)
        .table()
}

/// The places of these journeys.
pub fn places(places: &[PlaceResult]) -> Table {
    Table::of(places)
        .column("place", |row| shown(&row.name))
        .column("kind", |row| row.kind.as_str())
        .column("passed", |row| row.passed)
        .fixed("share [%]", 1, |row| row.share.map(|share| 100.0 * share))
        .fixed("first [s]", 1, |row| {
            row.from_to_secs.map(|[first, _]| first)
        })
        .fixed("last [s]", 1, |row| row.from_to_secs.map(|[_, last]| last))
        .fixed("waited [s]", 1, |row| row.waited_secs)
        .table()
}

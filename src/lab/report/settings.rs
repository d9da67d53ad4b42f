//! The settings of a run that differ from the defaults.

use serde::Deserialize;
use serde_json::Value;

use output::document::Block;
use output::table::Table;
use scenario::{Preset, Scenario, settings, tidy};

/// Keys that the report shows elsewhere.
const ELSEWHERE: [&str; 3] = ["name", "description", "preset"];

/// Options that have another name than the key that they set.
const OPTIONS: [(&str, &str); 2] = [("until", "duration_secs"), ("time-step", "time_step_secs")];

struct Row {
    key: &'static str,
    value: String,
    default: String,
    from: &'static str,
    meaning: String,
}

/// The numbers and words of a scenario that differ from the defaults, with their meanings. `by` is what has changed
/// the values that are not those of the file.
pub fn changed(scenario: &Scenario, by: &'static str) -> Block {
    let all = scenario.settings();
    let chosen = Preset::deserialize(&all["preset"]).unwrap_or_default();
    let preset = chosen.document();
    let is_changed = |key: &str| {
        let changes = scenario.changes.iter();
        let names = changes.filter_map(|change| change.split(['=', ' ']).next());
        let mut keys = names.map(|name| {
            OPTIONS
                .iter()
                .find(|(option, _)| *option == name)
                .map_or(name, |(_, key)| key)
        });
        keys.any(|changed| changed == key)
    };
    let row = |doc: scenario::SettingDoc| {
        let given = |document: &Value| {
            let parameter = document.get("parameters").and_then(|all| all.get(doc.key));
            parameter.or_else(|| document.get(doc.key)).cloned()
        };
        let found = given(&all)?;
        let is_parameter = |key: &str| {
            let parameters = all.get("parameters");
            parameters.is_some_and(|all| all.get(key).is_some())
        };
        let is_simple = !found.is_object() && !found.is_array() && !found.is_null();
        let value = match found {
            Value::String(text) => text,
            value => tidy(&value.to_string()),
        };
        let default = doc.default.unwrap_or_else(|| "–".to_owned());
        let differs = is_simple && value != default && !is_equal(&value, &default);
        (differs && !ELSEWHERE.contains(&doc.key)).then(|| Row {
            key: doc.key,
            value,
            default,
            from: match (given(&scenario.document), is_parameter(doc.key)) {
                _ if is_changed(doc.key) => by,
                (Some(value), _) if given(&preset) == Some(value.clone()) => "preset",
                (Some(_), _) => "scenario",
                (None, true) => "profile",
                (None, false) => "program",
            },
            meaning: doc.description.replace('`', ""),
        })
    };
    let rows: Vec<Row> = settings().into_iter().filter_map(row).collect();
    let table = Table::of(&rows)
        .column("setting", |row| row.key)
        .column("value", |row| row.value.as_str())
        .column("default", |row| row.default.as_str())
        .column("set by", |row| row.from)
        .column("meaning", |row| row.meaning.as_str())
        .table();
    let caption = "All other settings have their defaults: `sandbox list --settings` lists them. Crowds, places and \
                   measurements are in the scenario.";
    Block::Table(table, caption.to_owned())
}

fn is_equal(value: &str, default: &str) -> bool {
    matches!([value, default].map(|text| text.parse::<f64>().ok()), [Some(a), Some(b)] if a == b)
}

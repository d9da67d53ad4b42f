//! `sandbox list`: the scenarios and profiles, the settings that `--set` takes, what measurements measure, or the JSON
//! Schema.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::failure::Failure;
use super::terminal::{say, tell};
use super::update::UpdateOptions;
use output::table::Table;
use scenario::catalog::{ABOUT, NAMES};
use scenario::measurements::{Measurement, Quantity};
use scenario::{self, ObjectDoc, Presence, SHIPPED, SettingDoc, calibrated, nested_settings};

/// Most characters in a line beside a name.
const WIDTH: usize = 80;

/// `sandbox list` alone.
pub fn overview(document: &UpdateOptions, as_json: bool) -> Result<(), Failure> {
    if let Some(file) = &document.update {
        let file = file.display();
        let reason = format!(
            "--update {file}: inserts the tables of --settings or of --measurements; give one of them, too"
        );
        return Err(Failure::Input(reason));
    }
    tell(as_json, all_names, names_text)
}

/// The names of the tables in documents.
const VALUES: &str = "values";
const SETTINGS: &str = "settings";
const NESTED: &str = "nested";

/// `sandbox list --measurements`.
pub fn measurements(document: &UpdateOptions, as_json: bool) -> Result<(), Failure> {
    document.check(None, &[VALUES])?;
    let all = Measurement::all_quantities();
    let pairs = all
        .iter()
        .flat_map(|(of, own)| own.iter().map(move |one| (of, one)));
    let rows: Vec<(&String, &Quantity)> = pairs.collect();
    let table = Table::of(&rows)
        .column("measurement", |(of, _)| format!("`{of}`"))
        .column("value", |(_, one)| format!("`{}`", one.name))
        .column("unit", |(_, one)| one.unit)
        .column("meaning", |(_, one)| one.meaning.as_str())
        .table();
    document.put([(VALUES, table.markdown())])?;
    let line = |(of, one): &(&String, &Quantity)| {
        let (value, unit, meaning) = (&one.name, one.unit, &one.meaning);
        json!({"measurement": of, "value": value, "unit": unit, "meaning": meaning})
    };
    let json = || rows.iter().map(line).collect::<Value>();
    tell(as_json, json, || table.text().replace('`', ""))
}

/// `sandbox list --settings`.
pub fn settings(document: &UpdateOptions, as_json: bool) -> Result<(), Failure> {
    document.check(None, &[SETTINGS, NESTED])?;
    let all = scenario::settings();
    let nested = nested_settings();
    document.put([
        (SETTINGS, settings_table(&all).markdown()),
        (NESTED, nested_table(&nested).markdown()),
    ])?;
    let json = || {
        let names = nested.iter().map(|object| (&object.path, object.names()));
        let names: BTreeMap<_, _> = names.collect();
        json!({ "settings": all, "nested": names, "objects": nested })
    };
    tell(as_json, json, || settings_text(&all, &nested))
}

fn settings_table(all: &[SettingDoc]) -> Table {
    Table::of(all)
        .column("key", |doc| format!("`{}`", doc.key))
        .column("meaning", |doc| doc.description)
        .column("default", default_cell)
        .column("range", |doc| doc.range.as_str())
        .table()
}

fn nested_table(objects: &[ObjectDoc]) -> Table {
    let rows = objects.iter().flat_map(|object| {
        let keys = object.keys.iter();
        keys.map(|doc| (object.path.as_str(), doc))
    });
    let rows: Vec<(&str, &SettingDoc)> = rows.collect();
    Table::of(&rows)
        .column("object", |(path, _)| format!("`{path}`"))
        .column("key", |(_, doc)| format!("`{}`", doc.key))
        .column("meaning", |(_, doc)| doc.description)
        .column("default", |(_, doc)| default_cell(doc))
        .column("range", |(_, doc)| doc.range.as_str())
        .table()
}

/// The default of a key, or that the key must be given.
fn default_cell(doc: &SettingDoc) -> Option<String> {
    match doc.presence {
        Presence::OneOf => Some("one of these".to_owned()),
        Presence::Required => Some("required".to_owned()),
        Presence::Optional => doc.default.as_ref().map(|default| format!("`{default}`")),
    }
}

/// The built-in scenarios, the profiles of the paper, and the calibrated ones: names and descriptions.
fn lists() -> [Vec<(&'static str, String)>; 3] {
    let scenarios = SHIPPED.iter().map(|of| (of.name, of.description()));
    let of_paper = NAMES.into_iter().zip(ABOUT);
    let paper = of_paper.map(|(name, about)| (name, about.to_owned()));
    let fitted = calibrated::all().iter();
    let calibrated = fitted.map(|of| (of.name, of.about.to_owned()));
    [scenarios.collect(), paper.collect(), calibrated.collect()]
}

fn all_names() -> Value {
    let entry = |(name, about)| json!({"name": name, "description": about});
    let lists = lists().map(|list| list.into_iter().map(entry).collect::<Value>());
    let [scenarios, paper, calibrated] = lists;
    json!({ "scenarios": scenarios, "profiles": { "paper": paper, "calibrated": calibrated } })
}

fn names_text() -> String {
    let heads = [
        "Scenarios (sandbox NAME)",
        "Profiles of the paper (--profile NAME; quote the arrow, or write sf-sph)",
        "Profiles fitted to experiments (docs/findings/validation.md)",
    ];
    let texts = heads.into_iter().zip(lists()).map(|(head, list)| {
        let lines = list.iter().map(|(name, about)| entry(name, 0, about));
        format!("{head}\n{}", lines.collect::<String>())
    });
    texts.collect::<Vec<_>>().join("\n")
}

fn settings_text(all: &[SettingDoc], nested: &[ObjectDoc]) -> String {
    let setting = |setting: &SettingDoc| {
        let default = setting.default.as_ref();
        let default = default.map(|default| format!("default: {default}; "));
        let values = format!("{}{}", default.unwrap_or_default(), setting.range);
        entry(setting.key, 0, setting.description) + &entry("", 2, &values)
    };
    let settings: String = all.iter().map(setting).collect();
    let objects = nested.iter();
    let nested = objects.map(|object| entry(&object.path, 0, &object.names()));
    let nested: String = nested.collect();
    format!(
        "{settings}\nKeys of nested objects (? = optional; `sandbox list --schema` describes them):\n{nested}\n\
         A dotted path sets a value inside a list or object: --set sources.0.rows=50\n\
         Parameters set this way apply to all profiles of the scenario.\n"
    )
}

/// `sandbox list --schema`.
pub fn schema() -> Result<(), Failure> {
    say(format!("{:#}\n", scenario::schema()))
}

/// A name with a text beside it, broken into lines that are indented by `indent` spaces.
fn entry(name: &str, indent: usize, text: &str) -> String {
    let indent = " ".repeat(indent);
    let mut broken = vec![indent.clone()];
    for word in text.split(' ') {
        match broken.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < WIDTH => {
                *line += word;
                *line += " ";
            }
            _ => broken.push(format!("{indent}{word} ")),
        }
    }
    let names = std::iter::once(name).chain(std::iter::repeat(""));
    let lines = names.zip(broken.iter().map(|line| line.trim_end()));
    lines
        .map(|(name, line)| format!("{name:<20} {line}\n"))
        .collect()
}

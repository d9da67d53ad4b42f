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
use scenario::{self, SHIPPED, SettingDoc, calibrated, nested_settings, settings};

/// Most characters in a line beside a name.
const WIDTH: usize = 80;

pub fn run(list_settings: bool, document: &UpdateOptions, as_json: bool) -> Result<(), Failure> {
    if let Some(file) = &document.update {
        let file = file.display();
        let reason =
            format!("--update {file}: inserts the table of --measurements; give that, too");
        return Err(Failure::Input(reason));
    }
    match list_settings {
        true => tell(as_json, all_settings, settings_text),
        false => tell(as_json, overview, overview_text),
    }
}

/// The name of the table in the document.
const TABLE: &str = "values";

/// `sandbox list --measurements`.
pub fn measurements(document: &UpdateOptions, as_json: bool) -> Result<(), Failure> {
    document.check(None, &[TABLE])?;
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
    document.put([(TABLE, table.markdown())])?;
    let line = |(of, one): &(&String, &Quantity)| {
        let (value, unit, meaning) = (&one.name, one.unit, &one.meaning);
        json!({"measurement": of, "value": value, "unit": unit, "meaning": meaning})
    };
    let json = || rows.iter().map(line).collect::<Value>();
    tell(as_json, json, || table.text().replace('`', ""))
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

fn overview() -> Value {
    let entry = |(name, about)| json!({"name": name, "description": about});
    let lists = lists().map(|list| list.into_iter().map(entry).collect::<Value>());
    let [scenarios, paper, calibrated] = lists;
    json!({ "scenarios": scenarios, "profiles": { "paper": paper, "calibrated": calibrated } })
}

fn overview_text() -> String {
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

fn all_settings() -> Value {
    let setting = |doc: SettingDoc| {
        json!({
            "key": doc.key, "description": doc.description, "default": doc.default, "range": doc.range,
        })
    };
    json!({
        "settings": settings().into_iter().map(setting).collect::<Vec<_>>(),
        "nested": nested_settings().into_iter().collect::<BTreeMap<_, _>>(),
    })
}

fn settings_text() -> String {
    let setting = |setting: SettingDoc| {
        let default = setting
            .default
            .map(|default| format!("default: {default}; "));
        let values = format!("{}{}", default.unwrap_or_default(), setting.range);
        entry(setting.key, 0, setting.description) + &entry("", 2, &values)
    };
    let settings: String = settings().into_iter().map(setting).collect();
    let paths = nested_settings().into_iter();
    let nested: String = paths.map(|(path, keys)| entry(&path, 0, &keys)).collect();
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

//! The list of settings: the keys of a scenario with their descriptions, defaults and ranges, from the schema.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::error::numbers::plain;
use crate::file::File;
use crate::file::range::{Range, required};
use crate::file::schema::{allows, alternatives, property, resolved, words_of};
use crate::keys::catalog::Parameters;
use crate::keys::names::names;

/// One line of the list of settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingDoc {
    /// The key, as in `--set key=value` and in the file.
    pub key: &'static str,
    /// Its meaning, with its unit.
    pub description: &'static str,
    /// The default: the paper's value, if the paper gives one; `None` if the description says it.
    pub default: Option<String>,
    /// The allowed values, in words.
    pub range: String,
}

/// All keys of `--set`: those at the top of the file, then the parameters of profiles.
pub fn settings() -> Vec<SettingDoc> {
    let keys = names::<File>().iter().chain(names::<Parameters>());
    let line = |&key| {
        let schema = property(key);
        SettingDoc {
            key,
            description: schema["description"].as_str().unwrap_or_default(),
            default: schema.get("default").map(plain),
            range: words(schema),
        }
    };
    keys.map(line).collect()
}

/// Whether `key` is one of [`settings`].
pub fn is_setting(key: &str) -> bool {
    names::<File>().contains(&key) || is_parameter(key)
}

/// Whether `key` is a parameter of profiles.
pub fn is_parameter(key: &str) -> bool {
    names::<Parameters>().contains(&key)
}

/// Whether the value of `key` is any text, never parsed as JSON.
pub fn is_text(key: &str) -> bool {
    let schema = property(key);
    allows(schema, "string") && schema.get("enum").is_none()
}

/// Whether the value of `key` is an object that may be empty.
pub fn may_be_empty(key: &str) -> bool {
    let schema = resolved(property(key));
    let mut others = alternatives(schema).into_iter().flatten();
    let schema = match (others.next(), others.next()) {
        (Some(only), None) => resolved(only),
        _ => schema,
    };
    allows(schema, "object") && schema.get("required").is_none()
}

/// The values that a schema allows, in words.
fn words(schema: &'static Value) -> String {
    if schema.get("$ref").is_some() {
        let definition = resolved(schema);
        return words_of(definition).unwrap_or_else(|| words(definition));
    }
    if let Some(alternatives) = alternatives(schema) {
        let (constants, others): (Vec<_>, Vec<_>) =
            alternatives.partition(|way| way["const"] != Value::Null);
        let constants = one_of(constants.iter().map(|way| plain(&way["const"])).collect());
        let others = others.into_iter().map(words);
        let all = others.chain(Some(constants).filter(|words| !words.is_empty()));
        return all.collect::<Vec<_>>().join(", or ");
    }
    if let Some(words) = schema["enum"].as_array() {
        return one_of(words.iter().map(plain).collect());
    }
    let range = Range::of(schema).to_string();
    match ["integer", "number", "boolean", "string", "array"].map(|name| allows(schema, name)) {
        [true, ..] => format!("a whole number, {range}"),
        [_, true, ..] => range,
        [_, _, true, ..] => "true or false".to_owned(),
        [_, _, _, true, _] => "text".to_owned(),
        [.., true] => "a list".to_owned(),
        _ => "an object".to_owned(),
    }
}

/// Joins alternatives: `a, b or c`.
fn one_of(mut words: Vec<String>) -> String {
    let last = words.pop().unwrap_or_default();
    match words.is_empty() {
        true => last,
        false => format!("{} or {last}", words.join(", ")),
    }
}

/// The keys of the nested objects, each with the path of the object: first those that are required, then the optional
/// ones, marked by `?`.
pub fn nested_settings() -> Vec<(String, String)> {
    let mut lines = Vec::new();
    let mut seen = BTreeSet::from(["#/$defs/Parameters"]); // among the settings
    for key in names::<File>() {
        collect(key, property(key), &mut seen, &mut lines);
    }
    lines
}

/// Adds the lines of the objects in `schema`, which is that of `path`. Definitions that were `seen` are left out.
fn collect(
    path: &str,
    schema: &'static Value,
    seen: &mut BTreeSet<&'static str>,
    lines: &mut Vec<(String, String)>,
) {
    let name = schema["$ref"].as_str();
    if name.is_some_and(|name| !seen.insert(name)) {
        return;
    }
    let schema = resolved(schema);
    let lists = ["anyOf", "oneOf"].map(|key| schema[key].as_array());
    let alternatives = || lists.into_iter().flatten().flatten();
    // The keys that tell alternatives apart.
    let first_keys = alternatives().filter_map(|one| one["required"][0].as_str());
    let keyed: Vec<&str> = first_keys.collect();
    let keys = || schema["properties"].as_object().into_iter().flatten();
    let mut line = Vec::new();
    if !keyed.is_empty() {
        let keyed = keyed.iter().map(|&key| key.to_owned()).collect();
        line.push(format!("one of {}", one_of(keyed)));
    }
    line.extend(required(schema).map(str::to_owned));
    let is_named = |key: &str| keyed.contains(&key) || required(schema).any(|one| one == key);
    let others = keys().filter(|(key, value)| !is_named(key) && value["type"] != "null");
    line.extend(others.map(|(key, _)| format!("{key}?")));
    if !line.is_empty() {
        lines.push((path.to_owned(), line.join(", ")));
    }
    for way in alternatives().chain(schema.get("items")) {
        match way["properties"].as_object() {
            Some(keys) if !keyed.is_empty() => {
                for (key, value) in keys {
                    collect(&format!("{path}.{key}"), value, seen, lines);
                }
            }
            _ => collect(path, way, seen, lines),
        }
    }
    for (key, value) in keys() {
        collect(&format!("{path}.{key}"), value, seen, lines);
    }
}

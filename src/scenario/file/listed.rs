//! The list of settings: the keys of a scenario with their descriptions, defaults and ranges, from the schema.

use std::collections::BTreeSet;

use serde::Serialize;
use serde_json::Value;

use crate::error::numbers::plain;
use crate::file::File;
use crate::file::range::{Range, required};
use crate::file::schema::{allows, alternatives, property, resolved, words_of};
use crate::keys::catalog::Parameters;
use crate::keys::names::names;

/// One line of the list of settings.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SettingDoc {
    /// The key, as in `--set key=value` and in the file.
    pub key: &'static str,
    /// Its meaning, with its unit.
    pub description: &'static str,
    /// The default: the paper's value, if the paper gives one; `None` if the description says it.
    pub default: Option<String>,
    /// The allowed values, in words.
    pub range: String,
    /// Whether the object that it belongs to must have it.
    pub presence: Presence,
}

/// Whether an object must have a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Presence {
    /// The object has exactly one of its keys of this kind.
    OneOf,
    /// The object must have it.
    Required,
    /// The object may have it.
    Optional,
}

/// The keys of a nested object.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ObjectDoc {
    /// The keys that lead to it, joined by dots; numbers of list elements are left out.
    #[serde(rename = "object")]
    pub path: String,
    /// Its keys, in the order of [`Presence`].
    pub keys: Vec<SettingDoc>,
}

impl ObjectDoc {
    /// The names of its keys. Optional ones are marked by `?`.
    pub fn names(&self) -> String {
        let names = |presence| {
            let keys = self.keys.iter().filter(move |doc| doc.presence == presence);
            keys.map(|doc| doc.key.to_owned())
        };
        let one = one_of(names(Presence::OneOf).collect());
        let one = (!one.is_empty()).then(|| format!("one of {one}"));
        let optional = names(Presence::Optional).map(|name| name + "?");
        let all = one
            .into_iter()
            .chain(names(Presence::Required))
            .chain(optional);
        all.collect::<Vec<_>>().join(", ")
    }
}

/// All keys of `--set`: those at the top of the file, then the parameters of profiles.
pub fn settings() -> Vec<SettingDoc> {
    let keys = names::<File>().iter().chain(names::<Parameters>());
    keys.map(|&key| described(key, property(key), property(key), Presence::Optional))
        .collect()
}

/// The line of a key with this schema. Its description is that of the schema, of the `alternative` that the key tells
/// from others, or of the definition that the schema refers to.
fn described(
    key: &'static str,
    schema: &'static Value,
    alternative: &'static Value,
    presence: Presence,
) -> SettingDoc {
    let places = [schema, alternative, resolved(schema)];
    let description = places.into_iter().find_map(|of| of["description"].as_str());
    SettingDoc {
        key,
        description: description.unwrap_or_default(),
        default: schema.get("default").map(plain),
        range: words(schema),
        presence,
    }
}

/// Whether `key` is one of [`settings`].
pub fn is_setting(key: &str) -> bool {
    names::<File>().contains(&key) || is_parameter(key)
}

/// Whether `key` is a parameter of profiles.
pub fn is_parameter(key: &str) -> bool {
    names::<Parameters>().contains(&key)
}

/// Whether the value of `key`, such as `name` or `plan.storey`, is any text, never parsed as JSON.
pub fn is_text(key: &str) -> bool {
    let mut parts = key.split('.');
    let first = property(parts.next().unwrap_or_default());
    let of_key = parts.fold(first, |outer, part| {
        let mut objects = alternatives(outer).into_iter().flatten();
        let object = objects.next().unwrap_or(outer);
        &resolved(object)["properties"][part]
    });
    allows(of_key, "string") && of_key.get("enum").is_none()
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

/// The keys of the nested objects. An object that occurs in several places is listed at the first.
pub fn nested_settings() -> Vec<ObjectDoc> {
    let mut objects = Vec::new();
    let mut seen = BTreeSet::from(["#/$defs/Parameters"]); // among the settings
    for key in names::<File>() {
        collect(key, property(key), &mut seen, &mut objects);
    }
    objects
}

/// Adds the objects in `schema`, which is that of `path`. Definitions that were `seen` are left out.
fn collect(
    path: &str,
    schema: &'static Value,
    seen: &mut BTreeSet<&'static str>,
    objects: &mut Vec<ObjectDoc>,
) {
    let name = schema["$ref"].as_str();
    if name.is_some_and(|name| !seen.insert(name)) {
        return;
    }
    let schema = resolved(schema);
    let lists = ["anyOf", "oneOf"].map(|key| schema[key].as_array());
    let alternatives = || lists.into_iter().flatten().flatten();
    // The keys that tell alternatives apart.
    let first_keys = alternatives().filter_map(|one| Some((one["required"][0].as_str()?, one)));
    let keyed: Vec<(&str, &Value)> = first_keys.collect();
    let of = &schema["properties"];
    let keys = || of.as_object().into_iter().flatten();
    let telling = keyed.iter().map(|&(key, alternative)| {
        let own = of.get(key).unwrap_or(&alternative["properties"][key]);
        described(key, own, alternative, Presence::OneOf)
    });
    let needed = required(schema).map(|key| described(key, &of[key], &of[key], Presence::Required));
    let is_named = |key: &str| {
        keyed.iter().any(|(one, _)| *one == key) || required(schema).any(|one| one == key)
    };
    let others = keys().filter(|(key, value)| !is_named(key) && value["type"] != "null");
    let others = others.map(|(key, own)| described(key, own, own, Presence::Optional));
    let docs: Vec<SettingDoc> = telling.chain(needed).chain(others).collect();
    if !docs.is_empty() {
        objects.push(ObjectDoc {
            path: path.to_owned(),
            keys: docs,
        });
    }
    for way in alternatives().chain(schema.get("items")) {
        match way["properties"].as_object() {
            Some(keys) if !keyed.is_empty() => {
                for (key, value) in keys {
                    collect(&format!("{path}.{key}"), value, seen, objects);
                }
            }
            _ => collect(path, way, seen, objects),
        }
    }
    for (key, value) in keys() {
        collect(&format!("{path}.{key}"), value, seen, objects);
    }
}

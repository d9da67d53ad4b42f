//! The JSON Schema of scenario files. It comes from the structs in [`file`](super) and `keys`: names, words, defaults
//! and ranges from their fields, descriptions from their doc comments. The range checks and the list of settings read
//! it.

use std::sync::LazyLock;

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Value, json};

use crate::file::File;
use crate::keys::levels::ON_LEVELS;
use crate::keys::names::{OLD_KEYS, OldKey};

static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(tidy));
    let schema = settings.into_generator().into_root_schema_for::<File>();
    let mut schema = schema.to_value();
    add_levels(&mut schema);
    schema
});

/// Adds the key `level` to everything that lies on a level of a building: reading takes it away.
fn add_levels(schema: &mut Value) {
    let level = json!({
        "description": "In a building: the name of the level on which it lies. See `levels`.",
        "type": ["string", "null"],
    });
    let mut objects: Vec<String> = Vec::new();
    for list in ON_LEVELS {
        let items = &schema["properties"][list]["items"];
        match items["$ref"].as_str() {
            Some("#/$defs/Measurement") => {
                let kinds = schema["$defs"]["Measurement"]["oneOf"].as_array();
                let keys = kinds.into_iter().flatten().map(|kind| &kind["properties"]);
                let keys = keys
                    .filter_map(Value::as_object)
                    .flat_map(|keys| keys.values());
                let named = keys.filter_map(|key| key["$ref"].as_str());
                let has_place = |name: &&str| {
                    let own = schema.pointer(name.trim_start_matches('#'));
                    own.is_some_and(|own| {
                        PLACES
                            .iter()
                            .any(|key| own["properties"].get(key).is_some())
                    })
                };
                objects.extend(named.filter(has_place).map(str::to_owned));
            }
            Some(name) => objects.push(name.to_owned()),
            None => objects.push(format!("#/properties/{list}/items")),
        }
    }
    for name in objects {
        if let Some(object) = schema.pointer_mut(name.trim_start_matches('#')) {
            object["properties"]["level"] = level.clone();
        }
    }
}

/// The keys by which a measurement lies somewhere.
const PLACES: [&str; 3] = ["region", "line", "area"];

/// The JSON Schema (draft 2020-12) of scenario files. Every file that the program accepts is valid. The schema does
/// not check relations between values (order of corners, at least one goal).
pub fn schema() -> Value {
    let mut schema = SCHEMA.clone();
    schema["properties"]["$schema"] =
        json!({"type": "string", "description": "The location of this schema, for editors."});
    for key in OLD_KEYS {
        let definition = match key.measurement {
            None => "",
            Some(kind) => definition_of(kind),
        };
        if let Some(object) = schema.pointer_mut(definition) {
            add_old(object, &key);
        }
    }
    schema
}

/// The pointer to the definition of a kind of measurement.
fn definition_of(kind: &str) -> &'static str {
    let list = SCHEMA["$defs"]["Measurement"]["oneOf"].as_array();
    let mut kinds = list.into_iter().flatten();
    let pointer = kinds.find_map(|one| one["properties"][kind]["$ref"].as_str());
    pointer.unwrap_or_default().trim_start_matches('#')
}

/// Adds the former name of a key to the schema of its object. One of both is enough.
fn add_old(object: &mut Value, key: &OldKey) {
    let mut property = object["properties"][key.new].clone();
    property["deprecated"] = true.into();
    property["description"] = format!("The old name of `{}`.", key.new).into();
    object["properties"][key.old] = property;
    if let Some(required) = object.get_mut("required").and_then(Value::as_array_mut) {
        let count = required.len();
        required.retain(|name| name != key.new);
        if required.len() < count {
            object["anyOf"] = json!([{"required": [key.new]}, {"required": [key.old]}]);
        }
    }
}

/// Joins the lines of descriptions, drops defaults that say nothing, and gives integers their largest value.
fn tidy(schema: &mut Schema) {
    if let Some(Value::String(description)) = schema.get_mut("description") {
        *description = description.replace('\n', " ");
    }
    let says_nothing = |default: &Value| match default {
        Value::Object(keys) => keys.values().all(Value::is_null),
        other => *other == Value::Null || *other == json!([]),
    };
    if schema.get("default").is_some_and(says_nothing) {
        schema.remove("default");
    }
    let largest = match schema.remove("format") {
        Some(Value::String(format)) if format == "uint32" => json!(u32::MAX),
        Some(Value::String(format)) if format == "uint64" => json!(u64::MAX),
        _ => return,
    };
    if schema.get("maximum").is_none() {
        schema.insert("maximum".to_owned(), largest);
    }
}

/// The schema of a whole file.
pub fn root() -> &'static Value {
    &SCHEMA
}

/// The schema of a top-level key or parameter; `Null` for other names.
pub fn property(key: &str) -> &'static Value {
    let objects = [
        &SCHEMA["properties"],
        &SCHEMA["$defs"]["Parameters"]["properties"],
    ];
    let found = objects.into_iter().find_map(|keys| keys.get(key));
    found.unwrap_or(&Value::Null)
}

/// The schema that `schema` refers to, or `schema` itself.
pub fn resolved(schema: &'static Value) -> &'static Value {
    let reference = schema["$ref"].as_str();
    let name = reference.and_then(|path| path.strip_prefix("#/$defs/"));
    name.map_or(schema, |name| resolved(&SCHEMA["$defs"][name]))
}

/// The alternatives of a schema that has some, without `null`.
pub fn alternatives(schema: &'static Value) -> Option<impl Iterator<Item = &'static Value>> {
    let mut keys = ["anyOf", "oneOf"].into_iter();
    let listed = keys.find_map(|key| schema[key].as_array())?;
    let has_no_type = schema.get("type").is_none(); // else they are conditions on its object
    has_no_type.then(|| listed.iter().filter(|one| one["type"] != "null"))
}

/// Whether the schema allows this JSON type.
pub fn allows(schema: &Value, name: &str) -> bool {
    match &schema["type"] {
        Value::Array(names) => names.iter().any(|one| one == name),
        one => one == name,
    }
}

/// The words for the values of a definition: its description, unless that is a sentence about an object.
pub fn words_of(definition: &Value) -> Option<String> {
    let description = definition["description"].as_str()?;
    let letter = description.chars().next();
    let first = letter.filter(|_| !description.ends_with('.'))?;
    Some(format!(
        "{}{}",
        first.to_lowercase(),
        &description[first.len_utf8()..]
    ))
}

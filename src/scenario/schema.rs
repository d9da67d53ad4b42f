//! The JSON Schema of scenario files. It comes from the key structs in [`file`](super::file): names, words, defaults
//! and ranges from their fields, descriptions from their doc comments. The range checks and the list of settings read
//! it.

use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Visitor, value};
use serde::forward_to_deserialize_any;
use serde_json::{Value, json};

use super::document::OLD_KEYS;
use super::file::File;

static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(tidy));
    let schema = settings.into_generator().into_root_schema_for::<File>();
    schema.to_value()
});

/// The JSON Schema (draft 2020-12) of scenario files. Every file that the program accepts is valid. The schema does
/// not check relations between values (order of corners, at least one goal).
pub fn schema() -> Value {
    let mut schema = SCHEMA.clone();
    schema["properties"]["$schema"] =
        json!({"type": "string", "description": "The location of this schema, for editors."});
    for (old, new) in OLD_KEYS {
        let mut property = schema["properties"][new].clone();
        property["deprecated"] = true.into();
        property["description"] = format!("The old name of `{new}`.").into();
        schema["properties"][old] = property;
    }
    schema
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
pub(super) fn root() -> &'static Value {
    &SCHEMA
}

/// The schema of a top-level key or parameter; `Null` for other names.
pub(super) fn property(key: &str) -> &'static Value {
    let objects = [
        &SCHEMA["properties"],
        &SCHEMA["$defs"]["Parameters"]["properties"],
    ];
    let found = objects.into_iter().find_map(|keys| keys.get(key));
    found.unwrap_or(&Value::Null)
}

/// The schema that `schema` refers to, or `schema` itself.
pub(super) fn resolved(schema: &'static Value) -> &'static Value {
    let name = schema["$ref"]
        .as_str()
        .and_then(|path| path.strip_prefix("#/$defs/"));
    name.map_or(schema, |name| resolved(&SCHEMA["$defs"][name]))
}

/// The alternatives of a schema that has some, without `null`.
pub(super) fn ways(schema: &'static Value) -> Option<impl Iterator<Item = &'static Value>> {
    let ways = ["anyOf", "oneOf"]
        .into_iter()
        .find_map(|key| schema[key].as_array())?;
    let only_ways = schema.get("type").is_none(); // else they are conditions on its object
    only_ways.then(|| ways.iter().filter(|way| way["type"] != "null"))
}

/// Whether the schema allows this JSON type.
pub(super) fn allows(schema: &Value, name: &str) -> bool {
    match &schema["type"] {
        Value::Array(names) => names.iter().any(|one| one == name),
        one => one == name,
    }
}

/// The words for the values of a definition: its description, unless that is a sentence about an object.
pub(super) fn words_of(definition: &Value) -> Option<String> {
    let description = definition["description"].as_str()?;
    let first = description
        .chars()
        .next()
        .filter(|_| !description.ends_with('.'))?;
    Some(format!(
        "{}{}",
        first.to_lowercase(),
        &description[first.len_utf8()..]
    ))
}

/// The schema of a word: one of the names of `T`, an enum of the engine.
pub(super) fn word<T: Deserialize<'static>>(_: &mut SchemaGenerator) -> Schema {
    json_schema!({"type": "string", "enum": names::<T>()})
}

/// The keys of a struct or the words of an enum, in the order of their declaration, as serde reads them.
pub(super) fn names<T: Deserialize<'static>>() -> &'static [&'static str] {
    let mut names: &[&str] = &[];
    T::deserialize(Names(&mut names)).ok();
    names
}

/// Learns the names that a type asks for, and gives it nothing.
struct Names<'a>(&'a mut &'static [&'static str]);

impl Names<'_> {
    fn learn<T>(self, names: &'static [&'static str]) -> Result<T, value::Error> {
        *self.0 = names;
        Err(value::Error::custom("only names are asked for"))
    }
}

impl<'de> Deserializer<'de> for Names<'_> {
    type Error = value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, value::Error> {
        self.learn(&[])
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, value::Error> {
        self.learn(fields)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, value::Error> {
        self.learn(variants)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

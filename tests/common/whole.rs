//! Valid scenarios that together have every key, and a walk over a document along its schema.

use std::collections::BTreeSet;

use serde_json::Value;

use super::json_schema::refusal;

/// A scenario with most keys.
pub fn whole() -> Value {
    serde_json::from_str(include_str!("../data/whole.json")).unwrap()
}

/// Scenarios that together have every key, except those of trajectory files: some keys exclude each other.
pub fn documents() -> [Value; 4] {
    let journeys = include_str!("../data/whole_journeys.json");
    let periodic = include_str!("../data/whole_periodic.json");
    let building = include_str!("../data/whole_building.json");
    let others = [journeys, periodic, building].map(|text| serde_json::from_str(text).unwrap());
    let [journeys, periodic, building] = others;
    [whole(), journeys, periodic, building]
}

/// An object of a document.
pub struct Object<'a> {
    /// Its pointer in the document.
    pub pointer: String,
    /// The schema of its keys.
    pub schema: &'a Value,
}

/// The keys and the objects that a walk finds. Keys stand behind the name of their definition, as `Agent.position`, or
/// behind the path from there; keys of the whole scenario begin with a dot.
#[derive(Default)]
pub struct Walk<'a> {
    pub keys: BTreeSet<String>,
    pub objects: Vec<Object<'a>>,
}

/// A part of a schema, with its place for the names of keys.
type Part<'a> = (&'a Value, &'a str);

fn options(schema: &Value) -> impl Iterator<Item = &Value> {
    let lists = ["anyOf", "oneOf"]
        .into_iter()
        .filter_map(move |key| schema[key].as_array());
    lists.flatten()
}

fn definition<'a>(root: &'a Value, schema: &'a Value) -> Option<Part<'a>> {
    let pointer = schema["$ref"].as_str()?.strip_prefix('#')?;
    Some((root.pointer(pointer)?, pointer.rsplit('/').next()?))
}

fn properties(schema: &Value) -> impl Iterator<Item = (&String, &Value)> {
    let keys = schema["properties"].as_object().into_iter().flatten();
    keys.filter(|(_, of_key)| of_key["type"] != "null")
}

/// All keys of a schema.
pub fn all_keys(root: &Value) -> BTreeSet<String> {
    let (mut keys, mut seen) = (BTreeSet::new(), BTreeSet::new());
    let mut waiting = vec![(root, String::new())];
    while let Some((schema, at)) = waiting.pop() {
        if let Some((definition, name)) = definition(root, schema)
            && seen.insert(name)
        {
            waiting.push((definition, name.to_owned()));
        }
        let parts = options(schema).chain(schema.get("items"));
        waiting.extend(parts.map(|part| (part, at.clone())));
        for (key, of_key) in properties(schema) {
            waiting.push((of_key, format!("{at}.{key}")));
            keys.insert(format!("{at}.{key}"));
        }
    }
    keys
}

impl<'a> Walk<'a> {
    /// Adds the keys and the objects of a valid document.
    pub fn add(&mut self, root: &'a Value, document: &Value) {
        self.walk(root, (root, ""), "", document);
        let schema = root;
        let pointer = String::new();
        self.objects.push(Object { pointer, schema });
    }

    fn walk(
        &mut self,
        root: &'a Value,
        (schema, at): (&'a Value, &str),
        pointer: &str,
        value: &Value,
    ) {
        if let Some((definition, name)) = definition(root, schema) {
            self.walk(root, (definition, name), pointer, value);
            self.take(definition, pointer, value);
        }
        for option in options(schema) {
            if refusal(root, option, value).is_none() {
                self.walk(root, (option, at), pointer, value);
            }
        }
        if let Some((schema, items)) = schema.get("items").zip(value.as_array()) {
            for (k, item) in items.iter().enumerate() {
                let pointer = format!("{pointer}/{k}");
                self.walk(root, (schema, at), &pointer, item);
                self.take(schema, &pointer, item);
            }
        }
        for (key, schema) in properties(schema) {
            if let Some(value) = value.get(key) {
                let at = format!("{at}.{key}");
                self.walk(root, (schema, &at), &format!("{pointer}/{key}"), value);
                self.keys.insert(at);
            }
        }
    }

    /// Adds an object with keys. Choices of one key, such as the kind of a measurement, are no objects of their own.
    fn take(&mut self, schema: &'a Value, pointer: &str, value: &Value) {
        if schema.get("properties").is_some() && value.is_object() {
            let pointer = pointer.to_owned();
            self.objects.push(Object { pointer, schema });
        }
    }
}

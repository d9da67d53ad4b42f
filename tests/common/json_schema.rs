//! A validator for the JSON Schema keywords in the schema of scenarios. Any other keyword is a panic, so that none
//! is ignored.

use serde_json::Value;

/// Why `value` does not match `schema`, whose definitions are in `root`; `None` if it matches.
pub fn refusal(root: &Value, schema: &Value, value: &Value) -> Option<String> {
    let mut reasons = schema
        .as_object()
        .unwrap()
        .iter()
        .filter_map(|(keyword, rule)| {
            let fine = holds(root, schema, keyword, rule, value);
            (!fine).then(|| format!("{value} fails {keyword}: {rule}"))
        });
    reasons.next()
}

fn valid(root: &Value, schema: &Value, value: &Value) -> bool {
    refusal(root, schema, value).is_none()
}

fn holds(root: &Value, schema: &Value, keyword: &str, rule: &Value, value: &Value) -> bool {
    let routes = || {
        rule.as_array()
            .unwrap()
            .iter()
            .filter(|way| valid(root, way, value))
            .count()
    };
    let bound = || rule.as_f64().unwrap();
    let number = value.as_f64();
    let length = || rule.as_u64().unwrap() as usize;
    match keyword {
        "$schema" | "title" | "description" | "default" | "deprecated" | "$defs" => true,
        "$ref" => {
            let pointer = rule.as_str().unwrap().strip_prefix('#').unwrap();
            valid(root, root.pointer(pointer).expect(pointer), value)
        }
        "type" => match rule {
            Value::Array(types) => types.iter().any(|name| is(name, value)),
            name => is(name, value),
        },
        "enum" => rule.as_array().unwrap().contains(value),
        "const" => rule == value,
        "not" => !valid(root, rule, value),
        "anyOf" => routes() > 0,
        "oneOf" => routes() == 1,
        "minimum" => number.is_none_or(|x| x >= bound()),
        "exclusiveMinimum" => number.is_none_or(|x| x > bound()),
        "maximum" => number.is_none_or(|x| x <= bound()),
        "minLength" => value
            .as_str()
            .is_none_or(|text| text.chars().count() >= length()),
        "minItems" => value.as_array().is_none_or(|list| list.len() >= length()),
        "maxItems" => value.as_array().is_none_or(|list| list.len() <= length()),
        "items" => value
            .as_array()
            .is_none_or(|list| list.iter().all(|item| valid(root, rule, item))),
        "required" => value.as_object().is_none_or(|object| {
            let mut keys = rule.as_array().unwrap().iter();
            keys.all(|key| object.contains_key(key.as_str().unwrap()))
        }),
        "properties" => value.as_object().is_none_or(|object| {
            let mut known = object
                .iter()
                .filter_map(|(key, value)| Some((rule.get(key)?, value)));
            known.all(|(schema, value)| valid(root, schema, value))
        }),
        "additionalProperties" => {
            let known = |key: &String| schema["properties"].get(key).is_some();
            let fits = |value: &Value| *rule != Value::Bool(false) && valid(root, rule, value);
            value.as_object().is_none_or(|object| {
                let mut entries = object.iter();
                entries.all(|(key, value)| known(key) || fits(value))
            })
        }
        unknown => panic!("{unknown} is not known here"),
    }
}

fn is(name: &Value, value: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        "array" => value.is_array(),
        "object" => value.is_object(),
        unknown => panic!("no type is called {unknown}"),
    }
}

//! Checks numbers against the ranges of the schema, and names of keys, with error messages.

use std::fmt;

use serde::Deserialize;
use serde_json::{Map, Value};

use crate::error::numbers::brief;
use crate::error::quote::shown;
use crate::error::{Problem, Under, in_plain_words};
use crate::file::schema::{allows, alternatives, resolved, root, words_of};
use crate::file::{brackets, keyed};

/// Rejects numbers out of range, empty names and lists, and missing keys. Also rejects wrong types that serde would
/// accept (a list in place of an object) or would refuse without saying where.
pub fn check(document: &Value) -> Result<(), Problem> {
    check_value(root(), document)
}

fn check_value(schema: &'static Value, value: &Value) -> Result<(), Problem> {
    if value.is_null() && may_be_null(resolved(schema)) {
        return Ok(());
    }
    let problem = brackets::refusal(schema, value);
    problem
        .or_else(|| keyed::refusal(schema, value, false))
        .map_or(Ok(()), Err)?;
    let Some(schema) = chosen(schema, value) else {
        return Ok(());
    };
    check_type(schema, value)?;
    check_list(schema, value)?;
    match value {
        Value::Number(number) => Range::of(schema).check(number.as_f64().unwrap_or(f64::NAN)),
        Value::String(text) if text.is_empty() && schema["minLength"] == 1 => {
            Err(Problem::new("", "must not be empty"))
        }
        Value::Object(object) => match required(schema).find(|&key| !object.contains_key(key)) {
            Some(key) => Err(Problem::new("", format!("missing key `{key}`"))),
            None => Ok(()),
        },
        _ => Ok(()),
    }?;
    check_parts(schema, value, check_value)
}

/// Rejects an empty list, and elements that are of several kinds.
fn check_list(schema: &'static Value, value: &Value) -> Result<(), Problem> {
    let Value::Array(list) = value else {
        return Ok(());
    };
    if list.is_empty() && schema["minItems"] == 1 {
        return Err(Problem::new("", "must not be empty"));
    }
    list.iter().enumerate().try_for_each(|(k, item)| {
        let problem = keyed::refusal(&schema["items"], item, true);
        problem.map_or(Ok(()), Err).under(&format!("[{k}]"))
    })
}

/// Checks the items of a list and the values of an object, each against its schema.
fn check_parts(
    schema: &'static Value,
    value: &Value,
    check: fn(&'static Value, &Value) -> Result<(), Problem>,
) -> Result<(), Problem> {
    match value {
        Value::Array(list) => {
            let mut items = list.iter().enumerate();
            items.try_for_each(|(k, item)| check(&schema["items"], item).under(&format!("[{k}]")))
        }
        Value::Object(object) => object.iter().try_for_each(|(key, value)| {
            let known = schema["properties"].get(key);
            let of_key = known.unwrap_or(&schema["additionalProperties"]);
            check(of_key, value).under(key)
        }),
        _ => Ok(()),
    }
}

/// Rejects unknown keys. serde rejects most of them, but cannot do so where keys of several structs lie in one object.
pub fn check_names(document: &Value) -> Result<(), Problem> {
    check_names_in(root(), document)
}

fn check_names_in(schema: &'static Value, value: &Value) -> Result<(), Problem> {
    let Some(schema) = chosen(schema, value) else {
        return Ok(());
    };
    if let Value::Object(object) = value
        && schema["additionalProperties"] == false
    {
        let entries = schema["properties"].as_object().into_iter().flatten();
        let known: Vec<&str> = entries.map(|(key, _)| key.as_str()).collect();
        if let Some(key) = object.keys().find(|key| !known.contains(&key.as_str())) {
            let reason = format!(
                "unknown field `{key}`, expected one of `{}`",
                known.join("`, `")
            );
            return Err(Problem::new(key, in_plain_words(&reason)));
        }
    }
    check_parts(schema, value, check_names_in)
}

fn may_be_null(schema: &Value) -> bool {
    let mut alternatives = schema["anyOf"].as_array().into_iter().flatten();
    allows(schema, "null") || alternatives.any(|one| allows(one, "null"))
}

/// Rejects values of another type in place of an object, a number or a list, and lists of another length in place of a
/// described list of fixed length.
fn check_type(schema: &'static Value, value: &Value) -> Result<(), Problem> {
    let wrong = if allows(schema, "object") && !value.is_object() {
        Map::<String, Value>::deserialize(value).err()
    } else if allows(schema, "number") {
        f64::deserialize(value).err()
    } else {
        let length = value.as_array().map(|list| list.len() as u64);
        let right = match schema.get("maxItems").and_then(Value::as_u64) {
            Some(most) => length == Some(most),
            None => length.is_some() || !allows(schema, "array"),
        };
        return match words_of(schema).filter(|_| !right) {
            Some(words) => Err(Problem::new("", format!("must be {words}"))),
            None if value.is_array() || !allows(schema, "array") => Ok(()),
            None => Err(not_a_list(schema, value)),
        };
    };
    wrong.map_or(Ok(()), |error| {
        Err(Problem::new("", in_plain_words(&error.to_string())))
    })
}

/// The problem of a value in place of a list.
fn not_a_list(schema: &'static Value, value: &Value) -> Problem {
    let error = Vec::<Value>::deserialize(value).err();
    let said = error.map_or(String::new(), |error| in_plain_words(&error.to_string()));
    // The words already say this for objects.
    let is_element = !value.is_object() && fits(&schema["items"], value);
    let hint = match is_element {
        true => format!("; put brackets around it: [{}]", shown(&value.to_string())),
        false => String::new(),
    };
    Problem::new("", said + &hint)
}

/// The schema itself or, if it has alternatives, the one that `value` is meant for: the only one; else the first that
/// fits; else, for a list, the first that allows lists.
fn chosen(schema: &'static Value, value: &Value) -> Option<&'static Value> {
    let schema = resolved(schema);
    let Some(all) = alternatives(schema) else {
        return Some(schema);
    };
    let all: Vec<&'static Value> = all.collect();
    let is_list = |way: &&'static Value| value.is_array() && allows(resolved(way), "array");
    let way = match all.as_slice() {
        [only] => Some(*only),
        all => {
            let fitting = all.iter().copied().find(|way| fits(way, value));
            fitting.or_else(|| all.iter().copied().find(is_list))
        }
    };
    chosen(way?, value)
}

/// Whether the value has the type of the schema, its required keys, and a first item that fits.
fn fits(schema: &'static Value, value: &Value) -> bool {
    let Some(schema) = chosen(schema, value) else {
        return false;
    };
    let name = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) if allows(schema, "integer") => "integer",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let first = value.as_array().and_then(|list| list.first());
    allows(schema, name)
        && required(schema).all(|key| value.get(key).is_some())
        && first.is_none_or(|first| fits(&schema["items"], first))
}

/// The keys that an object of this schema must have.
pub fn required(schema: &Value) -> impl Iterator<Item = &str> {
    let keys = schema["required"].as_array().into_iter().flatten();
    keys.filter_map(Value::as_str)
}

/// An interval of numbers that includes its upper end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    lowest: Option<f64>,
    /// Whether `lowest` itself is excluded.
    open: bool,
    highest: Option<f64>,
}

impl Range {
    /// The range that a schema gives.
    pub fn of(schema: &Value) -> Self {
        let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
        let above = bound("exclusiveMinimum");
        Self {
            lowest: above.or_else(|| bound("minimum")),
            open: above.is_some(),
            highest: bound("maximum"),
        }
    }

    fn check(&self, value: f64) -> Result<(), Problem> {
        let high_enough = |lowest| value > lowest || (value == lowest && !self.open);
        if self.lowest.is_none_or(high_enough) && self.highest.is_none_or(|most| value <= most) {
            return Ok(());
        }
        let reason = format!("must be {self}, not {}", brief(value));
        Err(Problem::new("", reason))
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let from = if self.open { "above" } else { "at least" };
        let ends: Vec<String> = [(from, self.lowest), ("at most", self.highest)]
            .into_iter()
            .filter_map(|(words, end)| Some((words, end?)))
            .map(|(words, end)| format!("{words} {}", brief(end)))
            .collect();
        f.write_str(&ends.join(" and "))
    }
}

//! Text → JSON document. A duplicate key is an error.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use crate::error::quote::shown;
use crate::error::{Problem, ScenarioError, Under, hints, in_plain_words};
use crate::keys::names::{OLD_KEYS, OldKey};

/// Gives the last key of a path in a document its present name.
pub fn rename_last(path: &mut [String]) {
    let given: Vec<&str> = path.iter().map(String::as_str).collect();
    let renamed = OLD_KEYS.iter().find(|key| match given[..] {
        [name] => key.measurement.is_none() && name == key.old,
        ["measurements", _, kind, name] => key.measurement == Some(kind) && name == key.old,
        _ => false,
    });
    if let (Some(key), Some(last)) = (renamed, path.last_mut()) {
        *last = key.new.to_owned();
    }
}

/// Gives former keys their present names, so that settings and presets find them.
pub fn rename_old_keys(document: &mut Value) -> Result<(), Problem> {
    for key in OLD_KEYS {
        let Some(kind) = key.measurement else {
            rename(document, &key)?;
            continue;
        };
        let list = document.get_mut("measurements");
        let measurements = list.and_then(Value::as_array_mut);
        for (k, measurement) in measurements.into_iter().flatten().enumerate() {
            if let Some(keys) = measurement.get_mut(kind) {
                rename(keys, &key).under(&format!("measurements[{k}].{kind}"))?;
            }
        }
    }
    Ok(())
}

fn rename(object: &mut Value, key: &OldKey) -> Result<(), Problem> {
    let Some(object) = object.as_object_mut() else {
        return Ok(());
    };
    let Some(value) = object.remove(key.old) else {
        return Ok(());
    };
    if object.insert(key.new.to_owned(), value).is_some() {
        let reason = format!(
            "the old name of `{}`, which is given too; remove one",
            key.new
        );
        return Err(Problem::new(key.old, reason));
    }
    Ok(())
}

/// Parses `text`; messages call it `file`.
///
/// # Errors
/// The text is not JSON, or a key is given twice.
pub fn read(text: &str, file: &str) -> Result<Value, ScenarioError> {
    let document: Result<Unique, _> = serde_json::from_str(text);
    document.map(|document| document.0).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        let said = error.to_string();
        let place = format!(" at line {line} column {column}");
        ScenarioError::Syntax {
            file: file.to_owned(),
            line,
            column,
            reason: hints::of_syntax(text, line, column)
                .unwrap_or_else(|| in_plain_words(said.strip_suffix(&place).unwrap_or(&said))),
        }
    })
}

/// Writes a document as indented JSON. Values that fit on one line are written on one line; serde_json would write each
/// number of a point on its own line.
pub fn write(value: &Value) -> String {
    /// Most characters in a line.
    const WIDTH: usize = 76;
    written(value, 0, WIDTH)
}

fn written(value: &Value, indent: usize, width: usize) -> String {
    let (open, close, items): (_, _, Vec<(String, &Value)>) = match value {
        Value::Array(list) => {
            let items = list.iter().map(|item| (String::new(), item));
            ('[', ']', items.collect())
        }
        Value::Object(object) => {
            let entry = |(key, value)| (format!("{}: ", Value::from(String::as_str(key))), value);
            ('{', '}', object.iter().map(entry).collect())
        }
        scalar => return scalar.to_string(),
    };
    let joined = |indent: usize, width: usize, between: &str| {
        let entries = items.iter();
        let items = entries.map(|(key, item)| format!("{key}{}", written(item, indent, width)));
        items.collect::<Vec<_>>().join(between)
    };
    let line = format!("{open}{}{close}", joined(0, usize::MAX, ", "));
    if line.chars().count() <= width.saturating_sub(indent) {
        return line;
    }
    let [outer, inner] = [indent, indent + 2].map(|n| " ".repeat(n));
    let items = joined(indent + 2, width, &format!(",\n{inner}"));
    format!("{open}\n{inner}{items}\n{outer}{close}")
}

/// A JSON value whose objects have no duplicate keys.
struct Unique(Value);

impl<'de> Deserialize<'de> for Unique {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UniqueVisitor).map(Self)
    }
}

struct UniqueVisitor;

impl<'de> Visitor<'de> for UniqueVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        let number = Number::from_f64(value);
        number
            .map(Value::Number)
            .ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Unique(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format!(
                    "key `{}` is given twice; remove one",
                    shown(&key)
                )));
            }
            let Unique(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}

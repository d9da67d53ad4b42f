//! Text → JSON document. A duplicate key is an error.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use crate::scenario::error::quote::shown;
use crate::scenario::error::{Problem, ScenarioError, in_plain_words};
use crate::scenario::keys::names::OLD_KEYS;

/// The present name of a top-level key.
pub fn present_name(key: &str) -> &str {
    let renamed = OLD_KEYS.into_iter().find(|&(old, _)| old == key);
    renamed.map_or(key, |(_, new)| new)
}

/// Gives former keys their present names, so that `--set` and presets find them.
pub fn rename_old_keys(document: &mut Value) -> Result<(), Problem> {
    let Value::Object(object) = document else {
        return Ok(());
    };
    for (old, new) in OLD_KEYS {
        let Some(value) = object.remove(old) else {
            continue;
        };
        if object.insert(new.to_owned(), value).is_some() {
            let reason = format!("the old name of `{new}`, which is given too; remove one");
            return Err(Problem::new(old, reason));
        }
    }
    Ok(())
}

/// Parses `text`; messages call it `file`.
pub(crate) fn read(text: &str, file: &str) -> Result<Value, ScenarioError> {
    let document: Result<Document, _> = serde_json::from_str(text);
    document.map(|document| document.0).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        let said = error.to_string();
        let place = format!(" at line {line} column {column}");
        ScenarioError::Syntax {
            file: file.to_owned(),
            line,
            column,
            reason: in_plain_words(said.strip_suffix(&place).unwrap_or(&said)),
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
        let items = items.iter();
        let items = items.map(|(key, item)| format!("{key}{}", written(item, indent, width)));
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
struct Document(Value);

impl<'de> Deserialize<'de> for Document {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DocumentVisitor).map(Self)
    }
}

struct DocumentVisitor;

impl<'de> Visitor<'de> for DocumentVisitor {
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
        while let Some(Document(item)) = items.next_element()? {
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
            let Document(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}

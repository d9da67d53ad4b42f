//! The values of a file's preset.

use serde::Deserialize;
use serde_json::Value;

use crate::keys::preset::Preset;

/// The document with its preset's values for the keys that it does not give.
pub fn completed(mut document: Value) -> Value {
    if let Some(named) = document.get("preset")
        && let Ok(preset) = Preset::deserialize(named)
    {
        complete(&mut document, preset.document());
    }
    document
}

/// Adds missing values to an object, recursively.
fn complete(given: &mut Value, values: Value) {
    let (Value::Object(given), Value::Object(values)) = (given, values) else {
        return;
    };
    for (key, value) in values {
        match given.get_mut(&key) {
            Some(present) => complete(present, value),
            None => {
                given.insert(key, value);
            }
        }
    }
}

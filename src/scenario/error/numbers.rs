//! Numbers and values in messages.

use serde_json::Value;

/// Very large and very small numbers in scientific notation, the largest integers as powers, others in decimal
/// notation.
pub fn brief(value: f64) -> String {
    if value == f64::from(u32::MAX) {
        "2^32 - 1".to_owned()
    } else if value == u64::MAX as f64 {
        "2^64 - 1".to_owned()
    } else if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A value as `--set` takes it.
pub fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => brief(number.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

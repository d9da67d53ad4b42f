//! Values of settings as short labels for pictures, without JSON's quotes and braces.

use serde_json::{Map, Value};

use super::cell::plain;

/// The most letters of a label.
const LONGEST: usize = 48;

/// A value as a label, shortened in the middle if it is long.
pub fn readable(value: &Value) -> String {
    shortened(&words(value), LONGEST)
}

/// The labels of different values, which differ.
pub fn readables(values: &[Value]) -> Vec<String> {
    let mut labels: Vec<String> = Vec::new();
    for value in values {
        let label = readable(value);
        let again = (2..).map(|k| format!("{label} ({k})"));
        let mut all = std::iter::once(label.clone()).chain(again);
        labels.extend(all.find(|label| !labels.contains(label)));
    }
    labels
}

/// The name of an object, or its `key=value` pairs if it has no name; the items of a list; numbers and texts unchanged.
fn words(value: &Value) -> String {
    match value {
        Value::Object(entries) => match entries.get("name") {
            Some(Value::String(name)) => name.clone(),
            _ => of_entries(entries),
        },
        Value::Array(items) => joined(items.iter().map(|item| match item {
            Value::Array(_) => format!("({})", words(item)),
            other => words(other),
        })),
        Value::Null => "none".to_owned(),
        other => plain(other),
    }
}

/// `mean=1.3, std=0.2`; nested objects stand in parentheses: `normal(mean=1.3, std=0.2)`.
fn of_entries(entries: &Map<String, Value>) -> String {
    joined(entries.iter().map(|(key, value)| match value {
        Value::Object(_) | Value::Array(_) => format!("{key}({})", words(value)),
        other => format!("{key}={}", words(other)),
    }))
}

fn joined(parts: impl Iterator<Item = String>) -> String {
    parts.collect::<Vec<_>>().join(", ")
}

/// A text of at most this many letters: the beginning and the end of a longer text.
fn shortened(text: &str, most: usize) -> String {
    let letters: Vec<char> = text.chars().collect();
    let kept = most - 1;
    let Some(left_out) = letters.len().checked_sub(kept).filter(|&more| more > 1) else {
        return text.to_owned();
    };
    let begin = kept.div_ceil(2);
    let end = &letters[begin + left_out..];
    letters[..begin].iter().chain(&['…']).chain(end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn labels_are_names_or_keys_with_values_without_quotes_and_braces() {
        for (value, expected) in [
            (json!(0.5), "0.5"),
            (json!("sf->sph"), "sf->sph"),
            (json!(true), "true"),
            (json!(null), "none"),
            (json!({"name": "main", "line": [[0, 1], [2, 3]]}), "main"),
            (
                json!({"normal": {"mean": 1.3, "std": 0.2}}),
                "normal(mean=1.3, std=0.2)",
            ),
            (json!([[0, 1], [2.5, 3]]), "(0, 1), (2.5, 3)"),
            (json!([{"name": "a"}, {"name": "b"}]), "a, b"),
        ] {
            assert_eq!(readable(&value), expected);
        }
    }

    #[test]
    fn long_labels_keep_their_ends_and_labels_of_different_values_differ() {
        let long = "x".repeat(20) + &"y".repeat(40);
        let label = readable(&json!(long));
        assert_eq!(label.chars().count(), LONGEST);
        assert!(label.starts_with("xxx") && label.contains('…') && label.ends_with("yyy"));
        for letters in 1..60 {
            let text: String = ('a'..='z').cycle().take(letters).collect();
            let label = readable(&json!(text));
            assert_eq!(label == text, letters <= LONGEST, "{label}");
            assert!(label.chars().count() <= LONGEST);
        }
        let values: Vec<Value> = (0..3).map(|k| json!(format!("{long}{k}{long}"))).collect();
        let labels = readables(&values);
        assert!(labels[0] != labels[1] && labels[1] != labels[2] && labels[0] != labels[2]);
    }
}

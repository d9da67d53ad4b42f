//! Lists of points with too few or too many brackets around them.

use serde_json::Value;

use crate::error::Problem;
use crate::file::schema::{allows, alternatives, resolved};

/// A list of points is a list of lists of numbers.
const POINTS: usize = 2;

/// Refuses lists of points with fewer or more brackets around them than the schema has, and a pair of numbers where a
/// list of pairs is expected.
pub fn refusal(schema: &'static Value, value: &Value) -> Option<Problem> {
    let given = depth(value)?;
    if given < POINTS && !takes_pairs(schema) {
        return None;
    }
    let depths = depths(schema);
    let (least, most) = (*depths.iter().min()?, *depths.iter().max()?);
    let pairs = |count: usize, more: &str| match count {
        1 => format!("one {more}pair of brackets"),
        count => format!("{count} {more}pairs of brackets"),
    };
    let reason = if given < least {
        let example = example(value, given, least)?;
        format!("needs {}: {example}", pairs(least - given, "more "))
    } else if given > most && is_alone(value, given - most) {
        let example = example(value, given, most)?;
        format!("has {} too many: {example}", pairs(given - most, ""))
    } else {
        return None;
    };
    Some(Problem::new("", reason))
}

/// The number of lists around the numbers of a value: 1 for a point; `None` for other values than points and lists of
/// at least two of them.
fn depth(value: &Value) -> Option<usize> {
    let list = value.as_array()?;
    if let [Value::Number(_), Value::Number(_)] = list[..] {
        return Some(1);
    }
    let inner = depth(list.first()?)?;
    (inner >= POINTS || list.len() > 1).then_some(inner + 1)
}

/// The numbers of lists around numbers that a schema has; empty if it has other parts.
fn depths(schema: &'static Value) -> Vec<usize> {
    let schema = resolved(schema);
    match alternatives(schema) {
        Some(alternatives) => alternatives.flat_map(depths).collect(),
        None if allows(schema, "array") => {
            let items = depths(&schema["items"]);
            items.into_iter().map(|depth| depth + 1).collect()
        }
        None if allows(schema, "number") => vec![0],
        None => Vec::new(),
    }
}

/// Whether a schema is that of a list of pairs, which may be a single one.
fn takes_pairs(schema: &'static Value) -> bool {
    let schema = resolved(schema);
    let items = resolved(&schema["items"]);
    let least = schema["minItems"].as_u64().unwrap_or_default();
    least < 2 && items["maxItems"] == 2 && allows(items, "array")
}

/// Whether the outermost `count` lists have one element each.
fn is_alone(value: &Value, count: usize) -> bool {
    match value.as_array().map(Vec::as_slice) {
        _ if count == 0 => true,
        Some([only]) => is_alone(only, count - 1),
        _ => false,
    }
}

/// The first point of a value that has `given` lists around its numbers, with `right` ones.
fn example(value: &Value, given: usize, right: usize) -> Option<String> {
    let open = "[".repeat(right);
    if let [x @ Value::Number(_), y @ Value::Number(_)] = &value.as_array()?[..] {
        let close = if given < POINTS { "" } else { ", …" };
        return Some(format!("{open}{x}, {y}]{close}{}", "]".repeat(right - 1)));
    }
    example(value.as_array()?.first()?, given, right)
}

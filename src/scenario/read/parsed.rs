//! JSON → a type.

use serde::Deserialize;
use serde_json::Value;

use crate::error::{Problem, in_plain_words};

/// The value of a type, or the first problem and its place.
pub fn parsed<'a, T: Deserialize<'a>>(value: &'a Value) -> Result<T, Problem> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { String::new() } else { path };
        Problem::new(path, in_plain_words(&error.into_inner().to_string()))
    })
}

//! An object of a study's file that preserves the order of its keys.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;

use super::cell::LABEL;
use scenario::Problem;

/// Keys and values as written.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Entries(pub Vec<(String, Value)>);

impl Entries {
    /// The label, and the other entries.
    pub(super) fn split_label(&self, place: &str) -> Result<(Option<String>, Self), Problem> {
        let is_label = |(key, _): &&(String, Value)| key == LABEL;
        let unlabeled = self.0.iter().filter(|entry| !is_label(entry));
        let others = Self(unlabeled.cloned().collect());
        match self.0.iter().find(is_label) {
            None => Ok((None, others)),
            Some((_, Value::String(label))) => Ok((Some(label.clone()), others)),
            Some(_) => Err(Problem::new(format!("{place}.{LABEL}"), "must be text")),
        }
    }
}

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(EntriesVisitor)
    }
}

struct EntriesVisitor;

impl<'de> Visitor<'de> for EntriesVisitor {
    type Value = Entries;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Entries(entries))
    }
}

//! The names of keys and words, as serde reads them.

use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Visitor, value};
use serde::forward_to_deserialize_any;

/// The schema of a word: one of the names of `T`, an enum of the engine.
pub fn word<T: Deserialize<'static>>(_: &mut SchemaGenerator) -> Schema {
    json_schema!({"type": "string", "enum": names::<T>()})
}

/// The schema of a word, or of a key without a value.
pub fn optional_word<T: Deserialize<'static>>(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({"anyOf": [word::<T>(generator), {"type": "null"}]})
}

/// The keys of a struct or the words of an enum, in the order of their declaration, as serde reads them.
pub fn names<T: Deserialize<'static>>() -> &'static [&'static str] {
    let mut names: &[&str] = &[];
    T::deserialize(Names(&mut names)).ok();
    names
}

/// Learns the names that a type asks for, and gives it nothing.
struct Names<'a>(&'a mut &'static [&'static str]);

impl Names<'_> {
    fn learn<T>(self, names: &'static [&'static str]) -> Result<T, value::Error> {
        *self.0 = names;
        Err(value::Error::custom("only names are asked for"))
    }
}

impl<'de> Deserializer<'de> for Names<'_> {
    type Error = value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, value::Error> {
        self.learn(&[])
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, value::Error> {
        self.learn(fields)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, value::Error> {
        self.learn(variants)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

/// The former name of a key.
#[derive(Debug, Clone, Copy)]
pub struct OldKey {
    /// The kind of the measurements that have it; `None` at the top of the file.
    pub measurement: Option<&'static str>,
    /// The name that it had.
    pub old: &'static str,
    /// Its present name.
    pub new: &'static str,
}

impl OldKey {
    const fn end_of(measurement: &'static str) -> Self {
        Self {
            measurement: Some(measurement),
            old: "to_secs",
            new: "until_secs",
        }
    }
}

/// The former names of keys.
pub const OLD_KEYS: [OldKey; 4] = [
    OldKey {
        measurement: None,
        old: "behaviour_seed",
        new: "behavior_seed",
    },
    OldKey::end_of("wave"),
    OldKey::end_of("jitter"),
    OldKey::end_of("speed_by_density"),
];

//! The names of keys and words, as serde reads them.

use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Visitor, value};
use serde::forward_to_deserialize_any;

/// The schema of a word: one of the names of `T`, an enum of the engine.
pub fn word<T: Deserialize<'static>>(_: &mut SchemaGenerator) -> Schema {
    json_schema!({"type": "string", "enum": names::<T>()})
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

/// Former names of top-level keys, with the present ones.
pub const OLD_KEYS: [(&str, &str); 1] = [("behaviour_seed", "behavior_seed")];

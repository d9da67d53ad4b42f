//! Objects with exactly one key, which says what they are: measurements and distributions.

use serde_json::{Map, Value};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::file::schema::{alternatives, resolved};

/// The keys of which such an object has exactly one, each with the schema of its value.
struct Kinds {
    /// What they are: `measurement`.
    noun: &'static str,
    keys: Vec<(&'static str, &'static Value)>,
}

impl Kinds {
    /// Those of a schema, or of its only alternative that has some; `None` for other schemas.
    fn of(schema: &'static Value) -> Option<Self> {
        let schema = resolved(schema);
        // Beside a type, they are conditions on an object.
        let list = schema["oneOf"].as_array();
        let all = list.filter(|_| schema["type"].is_null());
        let own = all.and_then(|all| {
            let keys = all.iter().map(|way| {
                let mut keys = way["properties"].as_object()?.iter();
                let (key, value) = keys.next().filter(|_| keys.len() == 0)?;
                Some((key.as_str(), value))
            });
            let description = schema["description"].as_str().unwrap_or_default();
            let noun = description
                .strip_prefix("A ")?
                .split([' ', ',', '.'])
                .next();
            let (keys, noun) = (keys.collect::<Option<_>>()?, noun?);
            Some(Self { noun, keys })
        });
        own.or_else(|| alternatives(schema)?.find_map(Self::of))
    }

    fn find(&self, key: &str) -> Option<&'static Value> {
        let found = self.keys.iter().find(|(name, _)| *name == key);
        found.map(|&(_, schema)| schema)
    }

    /// Why an object is not of exactly one kind; `is_listed`: it is an element of a list.
    fn refusal(&self, given: &Map<String, Value>, is_listed: bool) -> Option<String> {
        let noun = self.noun;
        let found = given.keys().filter(|key| self.find(key).is_some());
        let known: Vec<&String> = found.collect();
        let quoted = |key: &str| format!("`{}`", shown(key));
        match known[..] {
            _ if given.is_empty() => {
                let all: Vec<String> = self.keys.iter().map(|(key, _)| quoted(key)).collect();
                Some(format!("has no {noun}: give one of {}", all.join(", ")))
            }
            [_, _, ..] if is_listed => {
                let objects = known.iter().map(|key| match given[*key].as_object() {
                    Some(keys) if keys.is_empty() => format!("{{\"{key}\": {{}}}}"),
                    _ => format!("{{\"{key}\": …}}"),
                });
                let each: Vec<String> = objects.collect();
                Some(format!("one {noun} per object: [{}]", each.join(", ")))
            }
            [_, _, ..] => {
                let all: Vec<String> = known.iter().map(|key| quoted(key)).collect();
                Some(format!("give one {noun}, not {}", all.join(" and ")))
            }
            [one] => {
                let other = given.keys().find(|key| *key != one)?;
                let inner = resolved(self.find(one)?);
                let is_inner = alternatives(inner).is_some_and(|mut alternatives| {
                    alternatives.any(|way| !resolved(way)["properties"][other].is_null())
                });
                let (one, other) = (shown(one), shown(other));
                Some(
                    match is_inner || !inner["properties"][other.as_str()].is_null() {
                        true => format!(
                            "`{other}` belongs into `{one}`: {{\"{one}\": {{\"{other}\": …}}}}"
                        ),
                        false => {
                            format!("unknown key `{other}` beside the {noun} `{one}`; remove it")
                        }
                    },
                )
            }
            [] => None, // an unknown name, which serde refuses
        }
    }
}

/// Refuses an object of this schema, or an element of a list of such objects, that is not of exactly one kind.
pub fn refusal(schema: &'static Value, value: &Value, is_listed: bool) -> Option<Problem> {
    let given = value.as_object()?;
    let reason = Kinds::of(schema)?.refusal(given, is_listed)?;
    Some(Problem::new("", reason))
}

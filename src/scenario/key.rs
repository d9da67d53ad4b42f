//! A key of a scenario file, with the values that it takes in words and as JSON Schema.

use serde_json::{Map, Value, json};

use super::range::{COORDINATE, Range};

/// The values that a key takes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// Any text.
    Text,
    /// Text that is not empty.
    Name,
    /// One of these words.
    Word(&'static [&'static str]),
    /// `true` or `false`.
    Switch,
    /// A number in a range.
    Number(Range),
    /// A number of seconds, or `auto`.
    Step(Range),
    /// A whole number in a range.
    Whole(Range),
    /// An unsigned integer of this many bits.
    Unsigned(u32),
    /// Two coordinates, meters.
    Point,
    /// Two numbers in a range.
    Pair(Range),
    /// The name of a definition under `$defs`, and its description in words.
    Defined(&'static str, &'static str),
    /// A list of such values; the words describe the list.
    List(&'static str, &'static str),
}

/// Whether a key may be missing or `null`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Presence {
    /// Must be present.
    Required,
    /// May be missing, but not `null`.
    Optional,
    /// May be missing or `null`, which mean the same.
    Nullable,
}

/// One key of an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Key {
    pub key: &'static str,
    pub unit: &'static str,
    /// The default, in words or as JSON.
    pub default: &'static str,
    pub kind: Kind,
    pub presence: Presence,
    pub description: &'static str,
}

impl Key {
    /// A key that may be missing or `null`.
    pub(super) const fn new(key: &'static str, kind: Kind, description: &'static str) -> Self {
        Self {
            key,
            unit: "",
            default: "none",
            kind,
            presence: Presence::Nullable,
            description,
        }
    }

    pub(super) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn default(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    pub(super) const fn required(self) -> Self {
        Self {
            presence: Presence::Required,
            ..self
        }
    }

    pub(super) const fn never_null(self) -> Self {
        Self {
            presence: Presence::Optional,
            ..self
        }
    }

    /// The schema of its value, with description, unit and default.
    fn schema(&self) -> Value {
        let mut schema = self.kind.schema();
        if self.presence == Presence::Nullable {
            schema = or_null(schema);
        }
        let value = self.kind.default(self.default);
        let mut description = self.description.to_owned();
        if !self.unit.is_empty() {
            description += &format!(" [{}]", self.unit);
        }
        if value.is_none() && self.default != "none" {
            description += &format!("; default: {}", self.default);
        }
        schema["description"] = description.into();
        if let Some(value) = value {
            schema["default"] = value;
        }
        schema
    }
}

impl Kind {
    /// The allowed values in words.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Text | Self::Name => "text".to_owned(),
            Self::Word([first @ .., last]) => format!("{} or {last}", first.join(", ")),
            Self::Word([]) => String::new(),
            Self::Switch => "true or false".to_owned(),
            Self::Number(range) | Self::Whole(range) => range.to_string(),
            Self::Step(range) => format!("{range}, or auto"),
            Self::Unsigned(bits) => format!("a whole number from 0 to 2^{bits} - 1"),
            Self::Point => "a point [x, y] in meters".to_owned(),
            Self::Pair(range) => format!("two numbers, {range}"),
            Self::Defined(_, words) | Self::List(_, words) => (*words).to_owned(),
        }
    }

    fn schema(&self) -> Value {
        match self {
            Self::Text => json!({"type": "string"}),
            Self::Name => json!({"type": "string", "minLength": 1}),
            Self::Word(words) => json!({"enum": words}),
            Self::Switch => json!({"type": "boolean"}),
            Self::Number(range) => range.schema("number"),
            Self::Step(range) => json!({"anyOf": [range.schema("number"), {"const": "auto"}]}),
            Self::Whole(range) => range.schema("integer"),
            Self::Unsigned(bits) => {
                json!({"type": "integer", "minimum": 0, "maximum": u64::MAX >> (64 - bits)})
            }
            Self::Point => pair(COORDINATE),
            Self::Pair(range) => pair(*range),
            Self::Defined(name, _) => defined(name),
            Self::List(name, _) => json!({"type": "array", "items": defined(name)}),
        }
    }

    /// The default as a JSON value, if `words` is one.
    fn default(&self, words: &str) -> Option<Value> {
        match self {
            Self::Word(known) => known.contains(&words).then(|| words.into()),
            Self::Number(_) | Self::Step(_) | Self::Whole(_) | Self::Unsigned(_) | Self::Switch => {
                serde_json::from_str(words).ok()
            }
            _ => None,
        }
    }
}

/// The schema of two numbers in a range.
pub(super) fn pair(range: Range) -> Value {
    let number = range.schema("number");
    json!({"type": "array", "items": number, "minItems": 2, "maxItems": 2})
}

/// A reference to a definition under `$defs`.
pub(super) fn defined(name: &str) -> Value {
    json!({"$ref": format!("#/$defs/{name}")})
}

/// `schema`, extended to allow `null`.
fn or_null(mut schema: Value) -> Value {
    if let Some(Value::String(name)) = schema.get("type") {
        schema["type"] = json!([name, "null"]);
        return schema;
    }
    for way in ["enum", "anyOf"] {
        if let Some(Value::Array(ways)) = schema.get_mut(way) {
            ways.push(match way {
                "enum" => Value::Null,
                _ => json!({"type": "null"}),
            });
            return schema;
        }
    }
    json!({"anyOf": [schema, {"type": "null"}]})
}

/// The schema of an object with these keys and no others.
pub(super) fn object(keys: &[Key], description: &str) -> Value {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|key| (key.key.to_owned(), key.schema()))
        .collect();
    let required: Vec<&str> = keys
        .iter()
        .filter(|key| key.presence == Presence::Required)
        .map(|key| key.key)
        .collect();
    let mut schema = json!({
        "type": "object",
        "description": description,
        "properties": properties,
        "additionalProperties": false,
    });
    if !required.is_empty() {
        schema["required"] = required.into();
    }
    schema
}

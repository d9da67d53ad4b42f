//! The parameters of profiles: values by name, and the structs of the engine that they set.

use std::fmt;
use std::sync::{Arc, LazyLock};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, DeserializeSeed, Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value, json};

use crate::error::in_plain_words;
use crate::keys::names::names;
use engine::density::SphParameters;
use engine::forces::walking::{DensityAhead, Headings, Headway, headings::Gap};
use engine::forces::{contact::Contact, drag::Drag, goal::GoalForce, legs::Legs, own::Force};
use engine::forces::{rvo::Rvo, social::SocialForce, viscosity::Viscosity};

/// The structs whose fields are the parameters. Meaning, range and default of a parameter are those of the field.
const PARTS: &[Part] = &[
    Part::of::<Walking>(),
    Part::of::<Viscosity>(),
    Part::of::<Contact>(),
    Part::of::<GoalForce>(),
    Part::of::<SocialForce>(),
    Part::of::<Headway>(),
    Part::of::<Headings>(),
    Part::of::<Gap>(),
    Part::of::<DensityAhead>(),
    Part::of::<Drag>(),
    Part::of::<Rvo>(),
    Part::of::<SphParameters>(),
];

/// The forces that are not in the paper. A profile has one if the parameter of its name is true.
const FORCES: &[Switched] = &[Switched {
    name: "legs",
    about: "Whether people have legs under their bodies, and sway: the law of Chatagnon and others (2026). All \
            profiles of a blend have the same legs.",
    part: Part::of::<Legs>(),
    force: |all| Arc::new(all.part::<Legs>()),
}];

/// The parameter that no struct of the engine has.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Walking {
    /// What slows agents in a crowd, beside the paper's forces: `headway`, a time gap to the nearest agent ahead;
    /// `headings`, also a choice of directions by the room along them; `density-ahead`, Weidmann's speed at the
    /// density ahead; `drag`, a friction. A law replaces social forces; with both, agents brake twice.
    pub walking_law: WalkingLawKind,
}

/// The kind of walking law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WalkingLawKind {
    /// None: the paper's profiles.
    #[default]
    None,
    /// A time gap to the nearest agent ahead.
    Headway,
    /// Slower the denser the crowd ahead.
    DensityAhead,
    /// Friction by density.
    Drag,
    /// A choice of headings by the room along them, with a time gap.
    Headings,
}

impl WalkingLawKind {
    /// All laws, that is, every kind but [`None`](Self::None), in the order of their declaration.
    pub fn laws() -> impl Iterator<Item = Self> {
        let named = |name: &&str| Self::deserialize(json!(name)).ok();
        let kinds = names::<Self>().iter().filter_map(named);
        kinds.filter(|kind| *kind != Self::None)
    }
}

/// The kind of navigation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NavigationKind {
    /// Straight to the goal.
    Goal,
    /// Social forces.
    Social,
    /// Velocity obstacles.
    Rvo,
}

/// A struct whose fields are parameters.
struct Part {
    names: fn() -> &'static [&'static str],
    schema: fn(&mut SchemaGenerator) -> Schema,
    /// The value as the field of this name has it.
    read: fn(&str, Value) -> serde_json::Result<Value>,
}

impl Part {
    const fn of<T: DeserializeOwned + Serialize + JsonSchema>() -> Self {
        Self {
            names: names::<T>,
            schema: T::json_schema,
            read: |name, value| Ok(json!(T::deserialize(json!({ name: value }))?)[name].take()),
        }
    }
}

/// A force that a parameter switches on.
struct Switched {
    name: &'static str,
    about: &'static str,
    part: Part,
    force: fn(&Parameters) -> Arc<dyn Force>,
}

fn parts() -> impl Iterator<Item = &'static Part> {
    PARTS.iter().chain(FORCES.iter().map(|force| &force.part))
}

/// The names of all parameters. Each is a field of one struct, or switches a force on.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let of_parts = PARTS.iter().flat_map(|part| (part.names)());
    let switches = FORCES.iter().map(|force| &force.name);
    let of_forces = FORCES.iter().flat_map(|force| (force.part.names)());
    of_parts.chain(switches).chain(of_forces).copied().collect()
});

/// Parameters of a profile; `None` means the paper's value (§5.5). Where a text says that the paper's time step is
/// too long, Δt = 0.02 s is beyond the formula of `docs/findings/stability.md`, and agents shake; `time_step_secs`
/// `auto` finds the step.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Parameters(#[schemars(schema_with = "schema")] Map<String, Value>);

/// There is no such parameter, or its value is of another kind.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ParameterError(String);

impl Parameters {
    /// Parameters with these values: numbers, truth values or words. Ranges are not checked.
    ///
    /// # Errors
    /// There is no such parameter, or a value is not of its kind.
    pub fn of<'a, V: Into<Value>>(
        values: impl IntoIterator<Item = (&'a str, V)>,
    ) -> Result<Self, ParameterError> {
        let mut values = values.into_iter();
        values.try_fold(Self::default(), |all, (name, value)| all.with(name, value))
    }

    /// These parameters with another value of one.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn with(&self, name: &str, value: impl Into<Value>) -> Result<Self, ParameterError> {
        let reason = match Self::deserialize(Value::from_iter([(name, value)])) {
            Ok(one) if !one.0.is_empty() => return Ok(one.or(self)),
            Ok(_) => format!("the parameter {name} must be a finite number"), // others are null in JSON
            Err(error) => format!("{name}: {}", in_plain_words(&error.to_string())),
        };
        Err(ParameterError(reason))
    }

    /// The values that are given, by name.
    pub fn given(&self) -> &Map<String, Value> {
        &self.0
    }

    /// The value of a parameter, if it is given.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.get(name)
    }

    /// These values, and those of `fallback` where these are not given.
    pub fn or(&self, fallback: &Self) -> Self {
        let mut all = fallback.clone();
        all.0.extend(self.0.clone());
        all
    }

    /// The part of the engine that these values set; other fields have their defaults.
    pub fn part<T: DeserializeOwned>(&self) -> T {
        T::deserialize(json!(self.0)).expect("each value was read as this field when it was given")
    }

    /// The forces that are not in the paper.
    pub fn forces(&self) -> Vec<Arc<dyn Force>> {
        let is_on = |force: &&Switched| self.get(force.name) == Some(&true.into());
        let on = FORCES.iter().filter(is_on);
        on.map(|force| (force.force)(self)).collect()
    }

    /// All forces that are not in the paper and that parameters can switch on.
    pub fn every_force() -> Vec<Arc<dyn Force>> {
        FORCES
            .iter()
            .map(|of| (of.force)(&Self::default()))
            .collect()
    }
}

/// The schema of all parameters. Each may be null, as if it were not given.
fn schema(generator: &mut SchemaGenerator) -> Schema {
    let mut properties = Map::new();
    for force in FORCES {
        let switch = json!({"type": "boolean", "description": force.about, "default": false});
        properties.insert(force.name.into(), switch);
    }
    for part in parts() {
        let mut schema = (part.schema)(generator).to_value();
        let fields = schema["properties"].as_object_mut();
        properties.extend(fields.into_iter().flat_map(std::mem::take));
    }
    for field in properties.values_mut().filter_map(Value::as_object_mut) {
        if let Some(definition) = field.remove("$ref") {
            let ways = json!([{"$ref": definition}, {"type": "null"}]);
            field.insert("anyOf".into(), ways);
        } else if let Some(kind @ Value::String(_)) = field.get_mut("type") {
            *kind = json!([kind, "null"]);
        }
    }
    json_schema!({"type": "object", "properties": properties, "additionalProperties": false})
}

impl<'de> Deserialize<'de> for Parameters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("Parameters", &NAMES, Entries)
    }
}

/// Reads parameters. Null means that one is not given.
struct Entries;

impl<'de> Visitor<'de> for Entries {
    type Value = Parameters;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Parameters, A::Error> {
        let mut all = Map::new();
        while let Some(name) = map.next_key::<String>()? {
            let value = map.next_value_seed(Field(&name))?;
            all.extend(value.map(|value| (name, value)));
        }
        Ok(Parameters(all))
    }
}

/// Reads the value of the parameter of this name, as its field has it.
struct Field<'a>(&'a str);

impl<'de> DeserializeSeed<'de> for Field<'_> {
    type Value = Option<Value>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        if !NAMES.contains(&self.0) {
            return Err(D::Error::unknown_field(self.0, &NAMES));
        }
        let read = |value| match parts().find(|part| (part.names)().contains(&self.0)) {
            Some(part) => (part.read)(self.0, value),
            None => bool::deserialize(value).map(Value::from), // a switch
        };
        let value = Option::deserialize(deserializer)?.map(read);
        value.transpose().map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_the_engine_is_listed() {
        let schema = schemars::schema_for!(Parameters).to_value();
        let mut described: Vec<&String> =
            schema["properties"].as_object().unwrap().keys().collect();
        let mut listed = names::<Parameters>().to_vec();
        described.sort_unstable();
        listed.sort_unstable();
        assert_eq!(described, listed);
        for (name, property) in schema["properties"].as_object().unwrap() {
            assert!(property["description"].is_string(), "{name}");
            let is_number = property["type"][0] == "number";
            assert!(!is_number || property["minimum"].is_number(), "{name}");
        }
    }

    #[test]
    fn every_walking_law_is_listed() {
        let schema = schemars::schema_for!(WalkingLawKind).to_value();
        let kinds = schema["oneOf"].as_array().unwrap().iter();
        let laws = kinds
            .map(|kind| &kind["const"])
            .filter(|law| **law != "none");
        assert!(
            laws.eq(&WalkingLawKind::laws()
                .map(|law| json!(law))
                .collect::<Vec<_>>())
        );
    }

    #[test]
    fn values_that_are_no_parameters_are_errors_with_their_names() {
        for (name, number) in [("gas_constant", f64::NAN), ("viscosity", f64::INFINITY)] {
            let error = Parameters::of([(name, number)]).unwrap_err();
            let said = format!("the parameter {name} must be a finite number");
            assert_eq!(error.to_string(), said);
        }
        let said = |name: &str| Parameters::of([(name, 5.5)]).unwrap_err().to_string();
        let number = "invalid type: floating point `5.5`, expected";
        assert_eq!(said("legs"), format!("legs: {number} true or false"));
        let unknown = "viscosty: unknown key `viscosty`; did you mean `viscosity`?";
        assert_eq!(said("viscosty"), unknown);
    }
}

//! The keys of profiles and blends.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};
use serde_untagged::UntaggedEnumVisitor;

use crate::keys::catalog;
use crate::keys::catalog::{ALIASES, NavigationKind, Parameters};
use crate::keys::limits::HIGHEST_DENSITY;

/// A name (see `sandbox list`), or a profile or blend defined in full
#[derive(Debug, Clone, PartialEq, JsonSchema)]
#[schemars(untagged)]
pub enum ProfileChoice {
    Named(ProfileName),
    Custom(Box<CustomProfile>),
}

/// The name of a profile or blend
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(extend("enum" = known_names()))]
pub struct ProfileName(pub String);

/// A profile or blend defined in full, with exactly one of `base`, `navigation` and `blend`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("oneOf" = ["base", "navigation", "blend"].map(given)))]
pub struct CustomProfile {
    /// The name in reports. Default: that of its base, or of its blended profiles.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// A named profile to start from.
    pub base: Option<ProfileName>,
    /// The method of navigation.
    pub navigation: Option<NavigationKind>,
    /// With `navigation`: whether SPH forces act, too.
    #[schemars(extend("default" = true))]
    pub sph: Option<bool>,
    /// Profiles by density.
    #[schemars(length(min = 1))]
    pub blend: Option<Vec<Step>>,
    /// Parameters of the profile.
    pub parameters: Parameters,
}

/// One profile of a blend.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// ρ^j (§4.4), P/m²: the density at which this profile acts alone. Between two densities both are blended.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub at_density: f64,
    /// A plain profile, not a blend.
    pub profile: ProfileChoice,
}

fn known_names() -> Vec<&'static str> {
    let aliases = ALIASES.into_iter().map(|(alias, _)| alias);
    catalog::names().into_iter().chain(aliases).collect()
}

/// The schema of objects that have this key.
fn given(key: &str) -> Value {
    json!({"required": [key], "properties": {key: {"not": {"type": "null"}}}})
}

/// Not derived: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for ProfileChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("the name of a profile, or an object with its parameters")
            .string(|name| Ok(Self::Named(ProfileName(name.to_owned()))))
            .map(|keys| Ok(Self::Custom(Box::new(keys.deserialize()?))))
            .deserialize(deserializer)
    }
}

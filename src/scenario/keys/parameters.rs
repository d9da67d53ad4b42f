//! The parameters of profiles, and the parts of the engine that they set.

use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use engine::density::SphParameters;
use engine::forces::contact::Contact;
use engine::forces::drag::Drag;
use engine::forces::goal::GoalForce;
use engine::forces::legs::Legs;
use engine::forces::own::Force;
use engine::forces::rvo::Rvo;
use engine::forces::social::SocialForce;
use engine::forces::viscosity::Viscosity;
use engine::forces::walking::headings::Gap;
use engine::forces::walking::{DensityAhead, Headings, Headway};

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

/// The kind of walking law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WalkingLawKind {
    /// None: the paper's profiles.
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

/// The kind of a parameter: a number, if no other is given.
macro_rules! kind {
    () => {
        f64
    };
    ($kind:ty) => {
        $kind
    };
}

/// Declares the parameters of profiles, and how parts of the engine are made of them. Meaning, range and default of a
/// parameter are those of the engine's field of the same name. A part with `if` is a force that is not in the paper: a
/// profile has it if the parameter named there is true.
macro_rules! parameters {
    (
        $(#[$about:meta])*
        pub struct $All:ident {
            $($(#[$own_about:meta])* $own:ident: $own_kind:ty,)*
        }
        $(
            $(#[$part_about:meta])*
            $part:ident: $Part:ident { $($name:ident $(: $kind:ty)?),* }
            $(with $($shared:ident),*)? $(of $($inner:ident),*)? $(if $(#[$switch_about:meta])* $switch:ident)?;
        )*
    ) => {
        $(#[$about])*
        pub struct $All {
            $($(#[$own_about])* pub $own: Option<$own_kind>,)*
            $($($(#[$switch_about])* #[schemars(extend("default" = false))] pub $switch: Option<bool>,)?)*
            $($(
                #[doc = concat!("[`", stringify!($Part), "::", stringify!($name), "`].")]
                pub $name: Option<kind!($($kind)?)>,
            )*)*
        }

        impl $All {
            /// These values, and those of `fallback` where these are `None`.
            pub fn or(&self, fallback: &Self) -> Self {
                Self {
                    $($own: self.$own.or(fallback.$own),)*
                    $($($switch: self.$switch.or(fallback.$switch),)?)*
                    $($($name: self.$name.or(fallback.$name),)*)*
                }
            }

            /// The name of a number of a part that is not finite.
            fn not_finite_in_part(&self) -> Option<&'static str> {
                let is_wrong = |given: Option<f64>| given.is_some_and(|value| !value.is_finite());
                let all = [$($((stringify!($name), self.$name.map(f64::from)),)*)*];
                all.into_iter().find_map(|(name, given)| is_wrong(given).then_some(name))
            }

            /// All forces that are not in the paper and that parameters can switch on.
            pub fn every_force() -> Vec<Arc<dyn Force>> {
                let all = Self {
                    $($($switch: Some(true),)?)*
                    ..Self::default()
                };
                all.forces()
            }

            /// The forces that are not in the paper.
            pub fn forces(&self) -> Vec<Arc<dyn Force>> {
                let mut forces: Vec<Arc<dyn Force>> = Vec::new();
                $($(if self.$switch == Some(true) {
                    forces.push(Arc::new(self.$part()));
                })?)*
                forces
            }

            $(
                $(#[$part_about])*
                pub fn $part(&self) -> $Part {
                    let usual = $Part::default();
                    $Part {
                        $($name: self.$name.unwrap_or(usual.$name),)*
                        $($($shared: self.$shared.unwrap_or(usual.$shared),)*)?
                        $($($inner: self.$inner(),)*)?
                    }
                }
            )*
        }

        /// The schemas of the parts.
        const PARTS: &[fn(&mut SchemaGenerator) -> Schema] = &[$($Part::json_schema),*];
    };
}

parameters! {
    /// Parameters of a profile; `None` means the paper's value (§5.5). Where a text says that the paper's time step is
    /// too long, Δt = 0.02 s is beyond the formula of `docs/findings/stability.md`, and agents shake; `time_step_secs`
    /// `auto` finds the step.
    #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    #[schemars(transform = describe)]
    pub struct Parameters {
        /// What slows agents in a crowd, beside the paper's forces: `headway`, a time gap to the nearest agent ahead;
        /// `headings`, also a choice of directions by the room along them; `density-ahead`, Weidmann's speed at the
        /// density ahead; `drag`, a friction. A law replaces social forces; with both, agents brake twice.
        #[schemars(extend("default" = "none"))]
        walking_law: WalkingLawKind,
        /// [`Viscosity::coefficient`].
        viscosity: f64,
        /// [`Contact::agent_stiffness`].
        agent_stiffness: f64,
        /// [`Contact::wall_stiffness`].
        wall_stiffness: f64,
        /// [`Contact::contact_scale`].
        contact_scale: f64,
        /// [`Contact::wall_contact_scale`].
        wall_contact_scale: f64,
    }

    /// The goal force.
    goal: GoalForce { goal_scale, relaxation_time };
    /// Social forces.
    social: SocialForce {
        agent_strength, agent_range, anticipation_time, wall_strength, wall_range, avoidance_radius, avoidance_tolerance
    };
    /// The time gap.
    headway: Headway { headway_time, headway_length, headway_anticipation, lane_half_width };
    /// The choice of headings.
    headings: Headings {
        heading_angle, heading_half_width, look_ahead, heading_persistence, side_preference, evasion_time
    } of headway, gap;
    /// How the time gap depends on motivation, density and narrowings.
    gap: Gap {
        hurry_share, press_share, press_density, press_range, queue_share, queue_density, narrowing_share,
        narrowing_range
    };
    /// The law of the density ahead.
    density_ahead: DensityAhead { jam_density, slowing_density };
    /// The drag.
    drag: Drag { drag_per_density, drag_from_density };
    /// RVO.
    rvo: Rvo { collision_weight, candidates: u32 } with avoidance_radius;
    /// The legs under a body.
    legs_law: Legs {
        unbalancing_rate, balancing_rate, balance_speed, legs_strength, body_range, leg_range, legs_reach, lean_limit
    } if
        /// Whether people have legs under their bodies, and sway: the law of Chatagnon and others (2026). All profiles
        /// of a blend have the same legs.
        legs;
    /// The SPH parameters that all profiles of a blend share.
    sph: SphParameters { support_radius, gas_constant, rest_density_min, rest_density_max, averaging_time };
}

/// Gives the parameters the descriptions, ranges and defaults of the engine's fields of the same names.
fn describe(schema: &mut Schema) {
    let Some(parameters) = schema.get_mut("properties") else {
        return;
    };
    let others = [Viscosity::json_schema, Contact::json_schema];
    for schema in PARTS.iter().chain(&others) {
        let schema = schema(&mut SchemaGenerator::default()).to_value();
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            let parameter = &mut parameters[name];
            for word in ["description", "default", "minimum", "maximum"] {
                if let Some(value) = field.get(word) {
                    parameter[word] = value.clone();
                }
            }
        }
    }
}

/// A parameter by name.
type Field = (&'static str, fn(&mut Parameters) -> &mut Option<f64>);

/// The parameters of SPH.
pub const SPH: [Field; 5] = [
    ("support_radius", |all| &mut all.support_radius),
    ("gas_constant", |all| &mut all.gas_constant),
    ("rest_density_min", |all| &mut all.rest_density_min),
    ("rest_density_max", |all| &mut all.rest_density_max),
    ("averaging_time", |all| &mut all.averaging_time),
];

impl Parameters {
    /// The values that are given, by name.
    pub fn given(&self) -> Map<String, Value> {
        let Value::Object(mut values) = json!(self) else {
            return Map::new();
        };
        values.retain(|_, value| !value.is_null());
        values
    }

    /// Checks that all numbers are finite.
    ///
    /// # Errors
    /// The name of a parameter that is not.
    pub fn check(&self) -> Result<(), &'static str> {
        let own = [
            ("viscosity", self.viscosity),
            ("agent_stiffness", self.agent_stiffness),
            ("wall_stiffness", self.wall_stiffness),
            ("contact_scale", self.contact_scale),
            ("wall_contact_scale", self.wall_contact_scale),
        ]
        .into_iter()
        .find(|(_, given)| given.is_some_and(|value| !value.is_finite()));
        let wrong = own.map(|(name, _)| name).or(self.not_finite_in_part());
        wrong.map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::catalog;
    use crate::keys::names::names;

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
    fn numbers_that_are_not_finite_are_errors_with_their_names() {
        let of_part = Parameters {
            gas_constant: Some(f64::NAN),
            ..Parameters::default()
        };
        let own = Parameters {
            viscosity: Some(f64::INFINITY),
            ..Parameters::default()
        };
        for (parameters, name) in [(of_part, "gas_constant"), (own, "viscosity")] {
            let error = catalog::named("sf->sph", &parameters).unwrap_err();
            let said = format!("the parameter {name} must be a finite number");
            assert_eq!(error.to_string(), said);
        }
    }
}

//! The parameters of profiles, and the parts of the engine that they set.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::keys::limits::{HIGHEST_DENSITY, STRONGEST};
use engine::density::SphParameters;
use engine::forces::contact::Contact;
use engine::forces::goal::GoalForce;
use engine::forces::legs::Legs;
use engine::forces::rvo::Rvo;
use engine::forces::social::SocialForce;
use engine::forces::viscosity::Viscosity;
use engine::forces::walking::headings::Gap;
use engine::forces::walking::{DensityAhead, Drag, Headings, Headway};

/// The longest range, meters.
const FARTHEST: f64 = 100.0;

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

/// Parameters of a profile; `None` means the paper's value (§5.5). Where a text says that the paper's time step is too
/// long, Δt = 0.02 s is beyond the formula of `docs/findings/stability.md`, and agents shake; `time_step_secs` `auto`
/// finds the step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = describe)]
pub struct Parameters {
    /// [`GoalForce::goal_scale`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub goal_scale: Option<f64>,
    /// [`GoalForce::relaxation_time`].
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub relaxation_time: Option<f64>,
    /// [`SocialForce::agent_strength`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_strength: Option<f64>,
    /// [`SocialForce::agent_range`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub agent_range: Option<f64>,
    /// [`SocialForce::anticipation_time`].
    #[schemars(range(min = 0, max = 1000))]
    pub anticipation_time: Option<f64>,
    /// [`SocialForce::wall_strength`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_strength: Option<f64>,
    /// [`SocialForce::wall_range`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub wall_range: Option<f64>,
    /// [`SocialForce::avoidance_radius`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub avoidance_radius: Option<f64>,
    /// [`SocialForce::avoidance_tolerance`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub avoidance_tolerance: Option<f64>,
    /// What slows agents in a crowd, beside the paper's forces: `headway`, a time gap to the nearest agent ahead;
    /// `headings`, also a choice of directions by the room along them; `density-ahead`, Weidmann's speed at the density
    /// ahead; `drag`, a friction. A law replaces social forces; with both, agents brake twice.
    #[schemars(extend("default" = "none"))]
    pub walking_law: Option<WalkingLawKind>,
    /// [`Headway::headway_time`].
    #[schemars(range(min = 0.01, max = 100))]
    pub headway_time: Option<f64>,
    /// [`Headway::headway_length`].
    #[schemars(range(min = 0, max = FARTHEST))]
    pub headway_length: Option<f64>,
    /// [`Headway::headway_anticipation`].
    #[schemars(range(min = 0, max = 10))]
    pub headway_anticipation: Option<f64>,
    /// [`Headway::lane_half_width`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub lane_half_width: Option<f64>,
    /// [`Headings::heading_angle`].
    #[schemars(range(min = 0, max = 90))]
    pub heading_angle: Option<f64>,
    /// [`Headings::heading_half_width`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub heading_half_width: Option<f64>,
    /// [`Headings::look_ahead`].
    #[schemars(range(min = 0, max = FARTHEST))]
    pub look_ahead: Option<f64>,
    /// [`Headings::heading_persistence`].
    #[schemars(range(min = 0, max = 10))]
    pub heading_persistence: Option<f64>,
    /// [`Headings::side_preference`].
    #[schemars(range(min = -2, max = 2))]
    pub side_preference: Option<f64>,
    /// [`Headings::evasion_time`].
    #[schemars(range(min = 0, max = 10))]
    pub evasion_time: Option<f64>,
    /// [`Gap::hurry_share`].
    #[schemars(range(min = 0, max = 0.95))]
    pub hurry_share: Option<f64>,
    /// [`Gap::press_share`].
    #[schemars(range(min = 0, max = 0.95))]
    pub press_share: Option<f64>,
    /// [`Gap::press_density`].
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub press_density: Option<f64>,
    /// [`Gap::press_range`].
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub press_range: Option<f64>,
    /// [`Gap::queue_share`].
    #[schemars(range(min = 0, max = 10))]
    pub queue_share: Option<f64>,
    /// [`Gap::queue_density`].
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub queue_density: Option<f64>,
    /// [`Gap::narrowing_share`].
    #[schemars(range(min = -0.9, max = 10))]
    pub narrowing_share: Option<f64>,
    /// [`Gap::narrowing_range`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub narrowing_range: Option<f64>,
    /// [`DensityAhead::jam_density`].
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub jam_density: Option<f64>,
    /// [`DensityAhead::slowing_density`].
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub slowing_density: Option<f64>,
    /// [`Drag::drag_per_density`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub drag_per_density: Option<f64>,
    /// [`Drag::drag_from_density`].
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub drag_from_density: Option<f64>,
    /// [`Rvo::collision_weight`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub collision_weight: Option<f64>,
    /// [`Rvo::candidates`].
    #[schemars(range(min = 1, max = 1e6))]
    pub candidates: Option<u32>,
    /// Whether people have legs under their bodies, and sway: the law of Chatagnon and others (2026). All profiles of a
    /// blend have the same legs.
    #[schemars(extend("default" = false))]
    pub legs: Option<bool>,
    /// [`Legs::unbalancing_rate`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub unbalancing_rate: Option<f64>,
    /// [`Legs::balancing_rate`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub balancing_rate: Option<f64>,
    /// [`Legs::balance_speed`].
    #[schemars(range(min = 0, max = 100))]
    pub balance_speed: Option<f64>,
    /// [`Legs::legs_strength`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub legs_strength: Option<f64>,
    /// [`Legs::body_range`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub body_range: Option<f64>,
    /// [`Legs::leg_range`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub leg_range: Option<f64>,
    /// [`Legs::legs_reach`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub legs_reach: Option<f64>,
    /// [`Legs::lean_limit`].
    #[schemars(range(min = 0.01, max = 2))]
    pub lean_limit: Option<f64>,
    /// [`Viscosity::coefficient`].
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = 0))]
    pub viscosity: Option<f64>,
    /// [`Contact::agent_stiffness`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_stiffness: Option<f64>,
    /// [`Contact::wall_stiffness`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_stiffness: Option<f64>,
    /// [`Contact::contact_scale`].
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub contact_scale: Option<f64>,
    /// [`Contact::wall_contact_scale`].
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub wall_contact_scale: Option<f64>,
    /// [`SphParameters::support_radius`].
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub support_radius: Option<f64>,
    /// [`SphParameters::gas_constant`].
    #[schemars(range(min = 0, max = STRONGEST))]
    pub gas_constant: Option<f64>,
    /// [`SphParameters::rest_density_min`].
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub rest_density_min: Option<f64>,
    /// [`SphParameters::rest_density_max`].
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub rest_density_max: Option<f64>,
    /// [`SphParameters::averaging_time`].
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub averaging_time: Option<f64>,
}

/// Gives the parameters the descriptions and defaults of the engine's fields of the same names.
fn describe(schema: &mut Schema) {
    let Some(parameters) = schema.get_mut("properties") else {
        return;
    };
    let of_engine = [
        GoalForce::json_schema,
        SocialForce::json_schema,
        Headway::json_schema,
        Headings::json_schema,
        Gap::json_schema,
        DensityAhead::json_schema,
        Drag::json_schema,
        Rvo::json_schema,
        Legs::json_schema,
        Viscosity::json_schema,
        Contact::json_schema,
        SphParameters::json_schema,
    ];
    for schema in of_engine {
        let schema = schema(&mut SchemaGenerator::default()).to_value();
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            let parameter = &mut parameters[name];
            for word in ["description", "default"] {
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
    /// The values that are given, by name. Those that are not finite count as not given.
    pub fn given(&self) -> Map<String, Value> {
        let Value::Object(mut values) = json!(self) else {
            return Map::new();
        };
        values.retain(|_, value| !value.is_null());
        values
    }

    /// These values, and those of `fallback` where these are `None`.
    pub fn or(&self, fallback: &Self) -> Self {
        Self {
            goal_scale: finite(self.goal_scale).or(fallback.goal_scale),
            relaxation_time: finite(self.relaxation_time).or(fallback.relaxation_time),
            agent_strength: finite(self.agent_strength).or(fallback.agent_strength),
            agent_range: finite(self.agent_range).or(fallback.agent_range),
            anticipation_time: finite(self.anticipation_time).or(fallback.anticipation_time),
            wall_strength: finite(self.wall_strength).or(fallback.wall_strength),
            wall_range: finite(self.wall_range).or(fallback.wall_range),
            avoidance_radius: finite(self.avoidance_radius).or(fallback.avoidance_radius),
            avoidance_tolerance: finite(self.avoidance_tolerance).or(fallback.avoidance_tolerance),
            walking_law: self.walking_law.or(fallback.walking_law),
            headway_time: finite(self.headway_time).or(fallback.headway_time),
            headway_length: finite(self.headway_length).or(fallback.headway_length),
            headway_anticipation: finite(self.headway_anticipation)
                .or(fallback.headway_anticipation),
            lane_half_width: finite(self.lane_half_width).or(fallback.lane_half_width),
            heading_angle: finite(self.heading_angle).or(fallback.heading_angle),
            heading_half_width: finite(self.heading_half_width).or(fallback.heading_half_width),
            look_ahead: finite(self.look_ahead).or(fallback.look_ahead),
            heading_persistence: finite(self.heading_persistence).or(fallback.heading_persistence),
            side_preference: finite(self.side_preference).or(fallback.side_preference),
            evasion_time: finite(self.evasion_time).or(fallback.evasion_time),
            hurry_share: finite(self.hurry_share).or(fallback.hurry_share),
            press_share: finite(self.press_share).or(fallback.press_share),
            press_density: finite(self.press_density).or(fallback.press_density),
            press_range: finite(self.press_range).or(fallback.press_range),
            queue_share: finite(self.queue_share).or(fallback.queue_share),
            queue_density: finite(self.queue_density).or(fallback.queue_density),
            narrowing_share: finite(self.narrowing_share).or(fallback.narrowing_share),
            narrowing_range: finite(self.narrowing_range).or(fallback.narrowing_range),
            jam_density: finite(self.jam_density).or(fallback.jam_density),
            slowing_density: finite(self.slowing_density).or(fallback.slowing_density),
            drag_per_density: finite(self.drag_per_density).or(fallback.drag_per_density),
            drag_from_density: finite(self.drag_from_density).or(fallback.drag_from_density),
            collision_weight: finite(self.collision_weight).or(fallback.collision_weight),
            candidates: self.candidates.or(fallback.candidates),
            legs: self.legs.or(fallback.legs),
            unbalancing_rate: finite(self.unbalancing_rate).or(fallback.unbalancing_rate),
            balancing_rate: finite(self.balancing_rate).or(fallback.balancing_rate),
            balance_speed: finite(self.balance_speed).or(fallback.balance_speed),
            legs_strength: finite(self.legs_strength).or(fallback.legs_strength),
            body_range: finite(self.body_range).or(fallback.body_range),
            leg_range: finite(self.leg_range).or(fallback.leg_range),
            legs_reach: finite(self.legs_reach).or(fallback.legs_reach),
            lean_limit: finite(self.lean_limit).or(fallback.lean_limit),
            viscosity: finite(self.viscosity).or(fallback.viscosity),
            agent_stiffness: finite(self.agent_stiffness).or(fallback.agent_stiffness),
            wall_stiffness: finite(self.wall_stiffness).or(fallback.wall_stiffness),
            contact_scale: finite(self.contact_scale).or(fallback.contact_scale),
            wall_contact_scale: finite(self.wall_contact_scale).or(fallback.wall_contact_scale),
            support_radius: finite(self.support_radius).or(fallback.support_radius),
            gas_constant: finite(self.gas_constant).or(fallback.gas_constant),
            rest_density_min: finite(self.rest_density_min).or(fallback.rest_density_min),
            rest_density_max: finite(self.rest_density_max).or(fallback.rest_density_max),
            averaging_time: finite(self.averaging_time).or(fallback.averaging_time),
        }
    }
}

/// A value, if it is a finite number: others count as not given.
pub(super) fn finite(given: Option<f64>) -> Option<f64> {
    given.filter(|value| value.is_finite())
}

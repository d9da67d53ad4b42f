//! The keys of interventions: changes at given frames, as a played run records them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::keys::curve::CurvePoint;
use crate::keys::limits::{LONGEST_TIME, STRONGEST};
use crate::keys::shapes::Point;

/// A change of the crowd or its scene. It has `frame` or `at_secs`, and one other key, which says what is done.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Intervention {
    /// The frame at whose beginning it acts: as a simulation that was controlled from outside records it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<u64>,
    /// Instead of `frame`: the time, seconds; it acts from the next coarse frame.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_secs: Option<f64>,
    /// People enter, in this order; those without room between bodies and walls do not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub add: Option<Add>,
    /// The ids of people who are taken out. They do not count as arrived.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remove: Option<Vec<u32>>,
    /// People get new goals. They abandon their journeys.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_goal: Option<SetGoal>,
    /// People begin a journey, from its first stage on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_journey: Option<SetJourney>,
    /// People get another preferred speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_speed: Option<SetSpeed>,
    /// People in a region behave differently for a while.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<PushKeys>,
    /// The name of an exit, a door or an entrance that opens.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open: Option<String>,
    /// The name of an exit or a door that closes, or of an entrance: people who arrive wait before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub close: Option<String>,
    /// The name of a waiting area: from then on, people do not wait there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub release: Option<String>,
    /// The limit of an exit changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_capacity: Option<SetCapacity>,
    /// The rate at which people arrive at an entrance changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_rate: Option<SetRate>,
    /// The speed in a zone changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_zone: Option<SetZone>,
}

/// People who enter.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Add {
    /// The name of the group whose profile, journey and traits they have: that of a grid, a crowd, a source, an
    /// entrance or an agent.
    pub group: String,
    /// Where they enter.
    pub positions: Vec<Point>,
    /// Their goals, one for each. Groups with a journey or a direction need none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub goals: Vec<Point>,
    /// Their velocities, one for each, m/s. Default: at rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(inner(inner(range(min = -100, max = 100))))]
    pub velocities: Vec<[f64; 2]>,
}

/// New goals.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetGoal {
    /// The ids of the people.
    pub agents: Vec<u32>,
    /// Their goals: one for all, or one for each.
    pub goals: Vec<Point>,
}

/// A new journey.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetJourney {
    /// The ids of the people.
    pub agents: Vec<u32>,
    /// The name of the journey.
    pub journey: String,
}

/// New preferred speeds.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetSpeed {
    /// The ids of the people.
    pub agents: Vec<u32>,
    /// Their s_pref, m/s: one for all, or one for each. The largest speed changes with it.
    #[schemars(inner(range(min = 0, max = 100)))]
    pub preferred_speeds: Vec<f64>,
}

/// A push.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PushKeys {
    /// The name in reports.
    #[serde(default = "push_name")]
    #[schemars(length(min = 1))]
    pub name: String,
    /// The lower left and the upper right corner: people who are here when it begins take part.
    pub region: [Point; 2],
    /// The duration, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub for_secs: f64,
    /// K^goal (Eq. 17) of these people. Default: unchanged.
    #[schemars(range(min = 0, max = STRONGEST))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal_scale: Option<f64>,
    /// Whether they feel no contact forces.
    #[serde(default)]
    pub ignore_contact: bool,
    /// Whether they feel no SPH forces.
    #[serde(default)]
    pub ignore_sph: bool,
    /// A force from outside, over their mass: seconds since it begins and m/s², in straight lines. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub acceleration: Vec<CurvePoint>,
    /// The direction of `acceleration`. Default: along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Point>,
}

fn push_name() -> String {
    "push".to_owned()
}

/// A new limit of an exit.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetCapacity {
    /// Its name.
    pub exit: String,
    /// The most people that pass per second; `null`: unlimited.
    #[schemars(range(max = 1e4), extend("exclusiveMinimum" = 0))]
    pub most_per_sec: Option<f64>,
}

/// A new rate of arrivals.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetRate {
    /// The name of the entrance.
    pub entrance: String,
    /// People per second; 0: none. Until the entrance's `until_secs` and up to its `number`, if it has them.
    #[schemars(range(min = 0, max = 1e4))]
    pub per_sec: f64,
}

/// A new speed in a zone.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetZone {
    /// The name of the zone.
    pub zone: String,
    /// The preferred speed is multiplied by this.
    #[schemars(range(min = 0.01, max = 10))]
    pub speed_factor: f64,
}

impl Intervention {
    /// The keys, other than its time, that are given.
    pub fn actions(&self) -> Vec<String> {
        let all = serde_json::to_value(self).unwrap_or_default();
        let keys = all.as_object().into_iter().flatten();
        let keys = keys.map(|(key, _)| key.clone());
        keys.filter(|key| key != "frame" && key != "at_secs")
            .collect()
    }

    /// How many people it adds.
    pub fn adds(&self) -> u64 {
        self.add
            .as_ref()
            .map_or(0, |add| add.positions.len() as u64)
    }

    /// As an element of the list `interventions`.
    pub fn document(&self) -> Value {
        serde_json::to_value(self).unwrap_or_else(|error| json!(error.to_string()))
    }
}

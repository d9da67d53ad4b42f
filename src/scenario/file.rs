//! The contents of a scenario file, key by key. Only names and types are checked here.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Serialize};

use super::plan::Nested;
use super::preset::Preset;
use crate::engine::boundary::WallMethod;
use crate::engine::neighbors::ListPolicy;
use crate::engine::pairs::Precision;
use crate::engine::scene::Integrator;
use crate::scenario::catalog::{NavigationKind, Parameters};
use crate::scenario::measurements::Measurement;

/// The lower left and the upper right corner.
pub type Corners = [[f64; 2]; 2];

/// A value that must be a JSON object. Without this wrapper serde would also accept a list of the fields.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Object<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData))
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
    type Value = Object<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Object<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(entries)).map(Object)
    }
}

/// A whole file.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct File {
    pub name: Option<String>,
    pub description: Option<String>,
    pub seed: Option<u64>,
    pub population_seed: Option<u64>,
    pub behaviour_seed: Option<u64>,
    pub duration_secs: Option<f64>,
    /// Unused: [`super::preset::fill`] has expanded it.
    #[serde(rename = "preset")]
    pub _preset: Preset,
    pub time_step_secs: Option<TimeStep>,
    pub longest_step_secs: Option<f64>,
    pub coarse_every: Option<u32>,
    pub integrator: Integrator,
    pub wall_method: WallMethod,
    pub precision: Precision,
    pub neighbor_lists: ListPolicy,
    pub preferred_speed: Option<f64>,
    pub max_speed: Option<f64>,
    pub profile: Option<ProfileChoice>,
    pub parameters: Object<Parameters>,
    pub walkable_area: Option<Vec<Vec<Vec<[f64; 2]>>>>,
    pub obstacles: Vec<Vec<Nested>>,
    pub goal: Option<[f64; 2]>,
    pub agents: Vec<Object<Agent>>,
    pub grids: Vec<Object<Grid>>,
    pub sources: Vec<Object<Source>>,
    pub events: Vec<Object<Event>>,
    pub measurements: Vec<Measurement>,
    pub stop: Object<Stop>,
    pub view: Option<Object<View>>,
    pub debug_agents: Option<Vec<u32>>,
}

/// Δt_fine as given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TimeStep {
    /// Seconds.
    Given(f64),
    /// The largest stable step.
    Auto,
}

impl<'de> Deserialize<'de> for TimeStep {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TimeStepVisitor)
    }
}

struct TimeStepVisitor;

impl Visitor<'_> for TimeStepVisitor {
    type Value = TimeStep;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or \"auto\"")
    }

    fn visit_f64<E>(self, seconds: f64) -> Result<TimeStep, E> {
        Ok(TimeStep::Given(seconds))
    }

    fn visit_u64<E>(self, seconds: u64) -> Result<TimeStep, E> {
        Ok(TimeStep::Given(seconds as f64))
    }

    fn visit_i64<E>(self, seconds: i64) -> Result<TimeStep, E> {
        Ok(TimeStep::Given(seconds as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<TimeStep, E> {
        if text == "auto" {
            Ok(TimeStep::Auto)
        } else {
            Err(E::invalid_value(Unexpected::Str(text), &self))
        }
    }
}

/// The keys about behavior and removal that agents, grids and sources share.
#[derive(Debug, Clone, Default)]
pub(super) struct Behavior {
    pub profile: Option<ProfileChoice>,
    pub remove_within: Option<f64>,
    pub counted: Option<bool>,
}

/// One agent.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Agent {
    pub position: [f64; 2],
    pub velocity: Option<[f64; 2]>,
    pub radius: Option<f64>,
    pub mass: Option<f64>,
    pub goal: Option<[f64; 2]>,
    pub mean_density: Option<f64>,
    pub profile: Option<ProfileChoice>,
    pub remove_within: Option<f64>,
    pub counted: Option<bool>,
}

/// Agents that stand on a grid at the start.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Grid {
    pub name: Option<String>,
    pub min: [f64; 2],
    pub max: [f64; 2],
    pub columns: u32,
    pub rows: u32,
    #[serde(default)]
    pub jitter: f64,
    pub goal: Option<[f64; 2]>,
    pub goal_offset: Option<[f64; 2]>,
    pub profile: Option<ProfileChoice>,
    pub remove_within: Option<f64>,
    pub counted: Option<bool>,
}

/// Agents that enter on a grid repeatedly.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Source {
    pub name: Option<String>,
    pub min: [f64; 2],
    pub max: [f64; 2],
    pub columns: u32,
    pub rows: u32,
    #[serde(default)]
    pub jitter: f64,
    pub goal: Option<[f64; 2]>,
    pub goal_offset: Option<[f64; 2]>,
    pub profile: Option<ProfileChoice>,
    pub remove_within: Option<f64>,
    pub counted: Option<bool>,
    #[serde(default)]
    pub start_secs: f64,
    pub every_secs: f64,
    pub times: Option<u32>,
}

impl Agent {
    pub(super) fn behavior(&self) -> Behavior {
        Behavior {
            profile: self.profile.clone(),
            remove_within: self.remove_within,
            counted: self.counted,
        }
    }
}

impl Grid {
    pub(super) fn behavior(&self) -> Behavior {
        Behavior {
            profile: self.profile.clone(),
            remove_within: self.remove_within,
            counted: self.counted,
        }
    }
}

impl Source {
    /// The keys that it shares with a grid.
    pub(super) fn grid(&self) -> Grid {
        Grid {
            name: self.name.clone(),
            min: self.min,
            max: self.max,
            columns: self.columns,
            rows: self.rows,
            jitter: self.jitter,
            goal: self.goal,
            goal_offset: self.goal_offset,
            profile: self.profile.clone(),
            remove_within: self.remove_within,
            counted: self.counted,
        }
    }
}

/// A push: agents in a region behave differently for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Event {
    pub name: Option<String>,
    pub at_secs: f64,
    pub for_secs: f64,
    pub region: Corners,
    pub goal_scale: Option<f64>,
    #[serde(default)]
    pub ignore_contact: bool,
    #[serde(default)]
    pub ignore_sph: bool,
}

/// When to stop early.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Stop {
    pub when_empty: bool,
    pub idle_secs: Option<f64>,
}

/// The initial view of a recording.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct View {
    pub region: Corners,
    #[serde(default)]
    pub opens_at_secs: f64,
}

/// A profile, by name or defined in full.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum ProfileChoice {
    Named(String),
    Custom(Box<CustomProfile>),
}

/// A profile or blend defined in full, with exactly one of `base`, `navigation` and `blend`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct CustomProfile {
    pub name: Option<String>,
    pub base: Option<String>,
    pub navigation: Option<NavigationKind>,
    pub sph: Option<bool>,
    pub blend: Option<Vec<Object<Step>>>,
    pub parameters: Object<Parameters>,
}

/// One profile of a blend.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Step {
    pub at_density: f64,
    pub profile: ProfileChoice,
}

/// Implemented by hand: the errors of an untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for ProfileChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ProfileVisitor)
    }
}

struct ProfileVisitor;

impl<'de> Visitor<'de> for ProfileVisitor {
    type Value = ProfileChoice;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the name of a profile, or an object with its parameters")
    }

    fn visit_str<E>(self, name: &str) -> Result<ProfileChoice, E> {
        Ok(ProfileChoice::Named(name.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<ProfileChoice, A::Error> {
        let custom = CustomProfile::deserialize(MapAccessDeserializer::new(entries))?;
        Ok(ProfileChoice::Custom(Box::new(custom)))
    }
}

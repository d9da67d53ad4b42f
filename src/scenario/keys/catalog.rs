//! The seven profiles of §5.5, calibrated ones, and custom profiles from parameters.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::engine::density::SphParameters;
use crate::engine::forces::contact::Contact;
use crate::engine::forces::goal::GoalForce;
use crate::engine::forces::rvo::Rvo;
use crate::engine::forces::social::SocialForce;
use crate::engine::forces::viscosity::Viscosity;
use crate::engine::forces::walking::{DensityAhead, Drag, Headway, WalkingLaw};
use crate::engine::profile::{Blend, BlendError, BlendStep, Navigation, Profile};
use crate::scenario::keys::calibrated;
use crate::scenario::keys::limits::{HIGHEST_DENSITY, STRONGEST};

/// The names of §5.5.
pub const NAMES: [&str; 7] = [
    "sf", "rvo", "sf+sph", "rvo+sph", "sph", "sf->sph", "rvo->sph",
];

/// What the profiles of §5.5 do, in the order of their names.
pub const ABOUT: [&str; NAMES.len()] = [
    "social forces: agents push each other away from a distance; for crowds up to about 2 P/m²",
    "velocity obstacles: agents choose velocities without collisions; for crowds up to about 2 P/m²",
    "social forces and fluid forces at all densities",
    "velocity obstacles and fluid forces at all densities",
    "fluid forces and the way to the goal only, no avoidance; for dense crowds, from about 4 P/m²",
    "social forces up to 2 P/m², fluid forces from 4 P/m², a blend between: for crowds of all densities",
    "velocity obstacles up to 2 P/m², fluid forces from 4 P/m², a blend between: for crowds of all densities",
];

/// Other spellings of blends: a shell takes an unquoted `>` for a redirection.
pub const ALIASES: [(&str, &str); 2] = [("sf-sph", "sf->sph"), ("rvo-sph", "rvo->sph")];

/// ρ^j of the paper's two blends, P/m² (§5.5).
const BLEND_DENSITIES: [f64; 2] = [2.0, 4.0];

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
}

/// Parameters of a profile; `None` means the paper's value (§5.5). Where a text says that the paper's time step is too
/// long, Δt = 0.02 s is beyond the formula of `docs/stability.md`, and agents shake; `time_step_secs` `auto` finds the
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Parameters {
    /// K^goal (Eq. 17): the strength of the goal force. Higher: agents push harder toward their goals. Above about 40
    /// the paper's time step is too long.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = GoalForce::default().goal_scale))]
    pub goal_scale: Option<f64>,
    /// τ (Eq. 17), seconds: the time in which the goal force corrects the velocity. Longer: agents respond more slowly
    /// and push less. Below about 0.013 s the paper's time step is too long.
    #[schemars(range(min = 1e-6, max = 1e6), extend("default" = GoalForce::default().relaxation_time))]
    pub relaxation_time: Option<f64>,
    /// V₀ (Eq. 18), m²/s²: the strength of the social force between agents. Higher: they keep more distance; 0: none.
    /// V₀/σ² acts like a stiffness and limits the time step like `agent_stiffness`.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().agent_strength))]
    pub agent_strength: Option<f64>,
    /// σ (Eq. 18), meters: the range over which the social force between agents falls by a factor e. Longer: agents
    /// react from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().agent_range))]
    pub agent_range: Option<f64>,
    /// T (Eq. 18), seconds: how far ahead the social force looks. Longer: agents avoid collisions earlier; 0: they
    /// react to distances alone.
    #[schemars(range(min = 0, max = 1000), extend("default" = SocialForce::default().anticipation_time))]
    pub anticipation_time: Option<f64>,
    /// U₀ (Eq. 19), m²/s²: the strength of the social force of walls. Higher: agents keep more distance from walls;
    /// 0: none.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().wall_strength))]
    pub wall_strength: Option<f64>,
    /// R (Eq. 19), meters: the range over which the social force of walls falls by a factor e. Longer: agents react to
    /// walls from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().wall_range))]
    pub wall_range: Option<f64>,
    /// Social forces and RVO ignore agents and walls beyond this distance, meters. Longer: the cost grows with its
    /// square. If it is shorter than the distance walked in `anticipation_time`, agents notice others late.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().avoidance_radius))]
    pub avoidance_radius: Option<f64>,
    /// Leaves out social forces that are certainly smaller than this, for an agent of mass 1, m/s². Higher: cheaper
    /// and less exact. 1e-3 moves agents by up to 2 cm in a second and saves up to a third of the time in crowds of
    /// 10,000.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().avoidance_tolerance))]
    pub avoidance_tolerance: Option<f64>,
    /// What slows agents in a crowd, beside the paper's forces: `headway`, a time gap to the nearest agent ahead;
    /// `density-ahead`, Weidmann's speed at the density ahead; `drag`, a friction. A law replaces social forces;
    /// with both, agents brake twice.
    #[schemars(extend("default" = "none"))]
    pub walking_law: Option<WalkingLawKind>,
    /// T (`headway`), seconds: the time gap. An agent with d meters to the nearest agent ahead walks at (d - l)/T.
    /// Longer: slower crowds and smaller flows. Below about twice `relaxation_time` files stop and go.
    #[schemars(range(min = 0.01, max = 100), extend("default" = Headway::default().headway_time))]
    pub headway_time: Option<f64>,
    /// l (`headway`), meters: the distance to the nearest agent ahead at which an agent stands. Longer: sparser queues.
    #[schemars(range(min = 0, max = FARTHEST), extend("default" = Headway::default().headway_length))]
    pub headway_length: Option<f64>,
    /// t (`headway`), seconds: agents look at the distance to the nearest agent ahead that they expect after this time.
    /// Longer: faster behind agents that speed up, as before a door; no change in a crowd that moves as one.
    #[schemars(range(min = 0, max = 10), extend("default" = Headway::default().headway_anticipation))]
    pub headway_anticipation: Option<f64>,
    /// w (`headway`), meters: the half-width of the lane; its edges fade over another half of it. Wider: slower crowds.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = Headway::default().lane_half_width))]
    pub lane_half_width: Option<f64>,
    /// The jam density (`density-ahead`), P/m²: agents stand before a crowd of this density. Higher: faster crowds.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY), extend("default" = DensityAhead::default().jam_density))]
    pub jam_density: Option<f64>,
    /// Weidmann's γ (`density-ahead`), P/m²: how soon agents slow down. Higher: faster at all densities below the jam.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY), extend("default" = DensityAhead::default().slowing_density))]
    pub slowing_density: Option<f64>,
    /// γ₀ (`drag`), m²/s: the friction per density above `drag_from_density`. Higher: slower crowds.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = Drag::default().drag_per_density))]
    pub drag_per_density: Option<f64>,
    /// The density (`drag`), P/m², at which the friction begins. Below 1.55 it slows lone agents, too, whose density is
    /// that of their own mass.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = Drag::default().drag_from_density))]
    pub drag_from_density: Option<f64>,
    /// w (Eq. 20), meters: the weight of the time to collision in RVO. Higher: agents avoid collisions earlier, with
    /// larger detours; 0: they do not avoid them.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = Rvo::default().collision_weight))]
    pub collision_weight: Option<f64>,
    /// The number of candidate velocities of RVO per agent and coarse frame. The cost grows with it. It is part of the
    /// model: 100 lower the density of the evacuation by 3.7 %, 5000 raise it by 1.6 %.
    #[schemars(range(min = 1, max = 1e6), extend("default" = Rvo::default().candidates))]
    pub candidates: Option<u32>,
    /// μ (Eq. 2), 1/s: the viscosity. Higher: neighbors move together, and a crowd calms down sooner after a push;
    /// 0: none. Above about 40 the paper's time step is too long.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = 0))]
    pub viscosity: Option<f64>,
    /// K^ag (Eq. 22), 1/s²: the stiffness of contacts between agents. Higher: agents overlap less; 0: no contact
    /// force. Above about 2000 the paper's time step is too long. Default: 1000; with SPH 50.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_stiffness: Option<f64>,
    /// K^obs (Eq. 23), 1/s²: the stiffness of contacts with walls. Higher: agents enter walls less deeply; 0: no
    /// contact force. Above about 4000 the paper's time step is too long. Default: 1000; with SPH 200.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_stiffness: Option<f64>,
    /// The part of D_i that counts in contacts between agents. Smaller: shoulders turn, crowds get denser before
    /// overlaps push. Masses, entrances and avoidance keep D_i.
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub contact_scale: Option<f64>,
    /// The part of D_i that counts in contacts with walls. Smaller: more room in narrow doors and corridors.
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub wall_contact_scale: Option<f64>,
    /// h (§5.2), meters: the support radius of the SPH kernels. Larger: smoother densities, at a cost that grows with
    /// its square. At 0.5 m an agent has four neighbors at 5 P/m², too few for a density.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SphParameters::default().support_radius))]
    pub support_radius: Option<f64>,
    /// k (Eq. 5), m²/s²: the pressure per excess density; pressure alone carries waves at √(k/2). Higher: a stiffer
    /// crowd; 0: no pressure. From about 400 on, crowds between the paper's walls keep boiling at any time step.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SphParameters::default().gas_constant))]
    pub gas_constant: Option<f64>,
    /// ρ⁰min, P/m²: the lowest personal rest density. Higher: sparser crowds feel no pressure. If it equals
    /// `rest_density_max`, the rest density is static, and crowds at rest move more.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = SphParameters::default().rest_density_min))]
    pub rest_density_min: Option<f64>,
    /// ρ⁰max, P/m²: the highest personal rest density; above it, agents are always pushed apart. Higher: denser
    /// crowds. From about 5 on, discs of 0.24 m overlap in any packing.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = SphParameters::default().rest_density_max))]
    pub rest_density_max: Option<f64>,
    /// T^ρ (Eq. 8), seconds: the time in which the personal rest density adapts. Longer: changes of density cause
    /// pressure for longer. Below Δt it adapts within one frame, and only densities beyond its limits cause pressure.
    #[schemars(range(min = 1e-6, max = 1e6), extend("default" = SphParameters::default().averaging_time))]
    pub averaging_time: Option<f64>,
}

impl Parameters {
    /// The values that are given, by name. Those that are not finite count as not given.
    pub fn given(&self) -> Map<String, Value> {
        let Value::Object(mut values) = json!(self) else {
            return Map::new();
        };
        values.retain(|_, value| !value.is_null());
        values
    }

    /// The fields of `T` that are given; the others have the paper's values.
    fn part<T: DeserializeOwned + Default>(&self) -> T {
        from_values(self.given())
    }

    /// These values, and those of `fallback` where these are `None`.
    pub fn or(&self, fallback: &Self) -> Self {
        let mut values = fallback.given();
        values.extend(self.given());
        from_values(values)
    }

    /// The SPH parameters that all profiles of a blend share.
    pub fn sph(&self) -> SphParameters {
        self.part()
    }

    fn walking(&self) -> Option<WalkingLaw> {
        match self.walking_law? {
            WalkingLawKind::None => None,
            WalkingLawKind::Headway => Some(WalkingLaw::Headway(self.part())),
            WalkingLawKind::DensityAhead => Some(WalkingLaw::DensityAhead(self.part())),
            WalkingLawKind::Drag => Some(WalkingLaw::Drag(self.part())),
        }
    }

    /// A profile with navigation `kind`, with or without SPH. Zero stiffness, k or μ switches the term off.
    pub fn profile(&self, name: &str, kind: NavigationKind, sph: bool) -> Profile {
        let switch = |value: f64| (value != 0.0).then_some(value);
        let (agent_stiffness, wall_stiffness) = if sph { (50.0, 200.0) } else { (1000.0, 1000.0) };
        Profile {
            name: name.to_owned(),
            navigation: match kind {
                NavigationKind::Goal => Navigation::Goal(self.part()),
                NavigationKind::Social => Navigation::Social(self.part(), self.part()),
                NavigationKind::Rvo => Navigation::Rvo(self.part()),
            },
            walking: self.walking(),
            pressure: sph && self.sph().gas_constant != 0.0,
            viscosity: switch(self.viscosity.unwrap_or(0.0))
                .filter(|_| sph)
                .map(|coefficient| Viscosity { coefficient }),
            contact: Contact {
                agent_stiffness: switch(self.agent_stiffness.unwrap_or(agent_stiffness)),
                wall_stiffness: switch(self.wall_stiffness.unwrap_or(wall_stiffness)),
                contact_scale: self.contact_scale.unwrap_or(1.0),
                wall_contact_scale: self.wall_contact_scale.unwrap_or(1.0),
            },
        }
    }
}

/// The names of all profiles: those of §5.5, then the calibrated ones.
pub fn names() -> Vec<&'static str> {
    let calibrated = calibrated::all().iter().map(|profile| profile.name);
    NAMES.into_iter().chain(calibrated).collect()
}

/// The profile of the paper on which `name` is based, and `parameters` with those of a calibrated profile where they
/// have none.
pub fn resolved<'a>(name: &'a str, parameters: &Parameters) -> (&'a str, Parameters) {
    match calibrated::named(name) {
        Some(profile) => (profile.base, parameters.or(&profile.parameters)),
        None => (name, *parameters),
    }
}

/// Reads parameters from their values by name.
pub fn from_values<T: DeserializeOwned + Default>(values: Map<String, Value>) -> T {
    serde_json::from_value(values.into()).unwrap_or_default()
}

/// A profile or blend with some parameters changed; `None` for an unknown name.
pub fn named(name: &str, parameters: &Parameters) -> Option<Result<Blend, BlendError>> {
    let alias = ALIASES.into_iter().find(|&(alias, _)| alias == name);
    let name = alias.map_or(name, |(_, name)| name);
    let (first, second) = match name.split_once("->") {
        Some((first, second)) if NAMES.contains(&name) => (first, Some(second)),
        _ => (name, None),
    };
    let first = plain(first, parameters)?;
    let Some(second) = second else {
        let (_, parameters) = resolved(name, parameters);
        return Some(Ok(Blend::single(first, parameters.sph())));
    };
    let profiles = [first, plain(second, parameters)?];
    let steps = BLEND_DENSITIES.into_iter().zip(profiles);
    let steps = steps.map(|(at_density, profile)| BlendStep {
        at_density,
        profile,
    });
    let name = name.to_owned();
    Some(Blend::new(name, parameters.sph(), steps.collect()))
}

/// A calibrated profile, or one of the five of §5.5 that are not blends; `None` for other names.
pub fn plain(name: &str, parameters: &Parameters) -> Option<Profile> {
    let (base, parameters) = resolved(name, parameters);
    let (kind, sph) = match base {
        "sf" => (NavigationKind::Social, false),
        "rvo" => (NavigationKind::Rvo, false),
        "sf+sph" => (NavigationKind::Social, true),
        "rvo+sph" => (NavigationKind::Rvo, true),
        "sph" => (NavigationKind::Goal, true),
        _ => return None,
    };
    Some(parameters.profile(name, kind, sph))
}

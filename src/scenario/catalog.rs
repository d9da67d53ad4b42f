//! The seven profiles of §5.5, and custom profiles from parameters.

use serde::{Deserialize, Serialize};

use crate::engine::density::SphParameters;
use crate::engine::forces::contact::Contact;
use crate::engine::forces::goal::GoalForce;
use crate::engine::forces::rvo::Rvo;
use crate::engine::forces::social::SocialForce;
use crate::engine::forces::viscosity::Viscosity;
use crate::engine::profile::{Blend, BlendError, BlendStep, Navigation, Profile};

/// The names of §5.5.
pub const NAMES: [&str; 7] = [
    "sf", "rvo", "sf+sph", "rvo+sph", "sph", "sf->sph", "rvo->sph",
];

/// Other spellings of blends: a shell takes an unquoted `>` for a redirection.
pub const ALIASES: [(&str, &str); 2] = [("sf-sph", "sf->sph"), ("rvo-sph", "rvo->sph")];

/// ρ^j of the paper's two blends, P/m² (§5.5).
const BLEND_DENSITIES: [f64; 2] = [2.0, 4.0];

/// The kind of navigation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NavigationKind {
    /// Straight to the goal.
    Goal,
    /// Social forces.
    Social,
    /// Velocity obstacles.
    Rvo,
}

/// Parameters of a profile; `None` means the paper's value (§5.5).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Parameters {
    /// K^goal.
    pub goal_scale: Option<f64>,
    /// τ, seconds.
    pub relaxation_time: Option<f64>,
    /// V₀.
    pub agent_strength: Option<f64>,
    /// σ, meters.
    pub agent_range: Option<f64>,
    /// T, seconds.
    pub anticipation_time: Option<f64>,
    /// U₀.
    pub wall_strength: Option<f64>,
    /// R, meters.
    pub wall_range: Option<f64>,
    /// Range of the avoidance methods, meters.
    pub avoidance_radius: Option<f64>,
    /// Social forces below this are left out, m/s².
    pub avoidance_tolerance: Option<f64>,
    /// w, meters.
    pub collision_weight: Option<f64>,
    /// Number of candidate velocities of RVO.
    pub candidates: Option<u32>,
    /// μ.
    pub viscosity: Option<f64>,
    /// K^ag.
    pub agent_stiffness: Option<f64>,
    /// K^obs.
    pub wall_stiffness: Option<f64>,
    /// h, meters.
    pub support_radius: Option<f64>,
    /// k.
    pub gas_constant: Option<f64>,
    /// ρ⁰min, P/m².
    pub rest_density_min: Option<f64>,
    /// ρ⁰max, P/m².
    pub rest_density_max: Option<f64>,
    /// T^ρ, seconds.
    pub averaging_time: Option<f64>,
}

impl Parameters {
    /// These values, and those of `fallback` where these are `None`.
    pub fn or(&self, fallback: &Self) -> Self {
        Self {
            goal_scale: self.goal_scale.or(fallback.goal_scale),
            relaxation_time: self.relaxation_time.or(fallback.relaxation_time),
            agent_strength: self.agent_strength.or(fallback.agent_strength),
            agent_range: self.agent_range.or(fallback.agent_range),
            anticipation_time: self.anticipation_time.or(fallback.anticipation_time),
            wall_strength: self.wall_strength.or(fallback.wall_strength),
            wall_range: self.wall_range.or(fallback.wall_range),
            avoidance_radius: self.avoidance_radius.or(fallback.avoidance_radius),
            avoidance_tolerance: self.avoidance_tolerance.or(fallback.avoidance_tolerance),
            collision_weight: self.collision_weight.or(fallback.collision_weight),
            candidates: self.candidates.or(fallback.candidates),
            viscosity: self.viscosity.or(fallback.viscosity),
            agent_stiffness: self.agent_stiffness.or(fallback.agent_stiffness),
            wall_stiffness: self.wall_stiffness.or(fallback.wall_stiffness),
            support_radius: self.support_radius.or(fallback.support_radius),
            gas_constant: self.gas_constant.or(fallback.gas_constant),
            rest_density_min: self.rest_density_min.or(fallback.rest_density_min),
            rest_density_max: self.rest_density_max.or(fallback.rest_density_max),
            averaging_time: self.averaging_time.or(fallback.averaging_time),
        }
    }

    /// The SPH parameters that all profiles of a blend share.
    pub fn sph(&self) -> SphParameters {
        let paper = SphParameters::default();
        SphParameters {
            support_radius: self.support_radius.unwrap_or(paper.support_radius),
            gas_constant: self.gas_constant.unwrap_or(paper.gas_constant),
            rest_density_min: self.rest_density_min.unwrap_or(paper.rest_density_min),
            rest_density_max: self.rest_density_max.unwrap_or(paper.rest_density_max),
            averaging_time: self.averaging_time.unwrap_or(paper.averaging_time),
        }
    }

    /// A profile with navigation `kind`, with or without SPH. Zero stiffness, k or μ switches the term off.
    pub fn profile(&self, name: &str, kind: NavigationKind, sph: bool) -> Profile {
        let switch = |value: f64| (value != 0.0).then_some(value);
        let (agent_stiffness, wall_stiffness) = if sph { (50.0, 200.0) } else { (1000.0, 1000.0) };
        Profile {
            name: name.to_owned(),
            navigation: self.navigation(kind),
            pressure: sph && self.sph().gas_constant != 0.0,
            viscosity: switch(self.viscosity.unwrap_or(0.0))
                .filter(|_| sph)
                .map(|coefficient| Viscosity { coefficient }),
            contact: Contact {
                agent_stiffness: switch(self.agent_stiffness.unwrap_or(agent_stiffness)),
                wall_stiffness: switch(self.wall_stiffness.unwrap_or(wall_stiffness)),
            },
        }
    }

    fn navigation(&self, kind: NavigationKind) -> Navigation {
        let goal = GoalForce::default();
        let goal = GoalForce {
            goal_scale: self.goal_scale.unwrap_or(goal.goal_scale),
            relaxation_time: self.relaxation_time.unwrap_or(goal.relaxation_time),
        };
        match kind {
            NavigationKind::Goal => Navigation::Goal(goal),
            NavigationKind::Social => {
                let paper = SocialForce::default();
                let social = SocialForce {
                    agent_strength: self.agent_strength.unwrap_or(paper.agent_strength),
                    agent_range: self.agent_range.unwrap_or(paper.agent_range),
                    anticipation_time: self.anticipation_time.unwrap_or(paper.anticipation_time),
                    wall_strength: self.wall_strength.unwrap_or(paper.wall_strength),
                    wall_range: self.wall_range.unwrap_or(paper.wall_range),
                    avoidance_radius: self.avoidance_radius.unwrap_or(paper.avoidance_radius),
                    avoidance_tolerance: self
                        .avoidance_tolerance
                        .unwrap_or(paper.avoidance_tolerance),
                };
                Navigation::Social(goal, social)
            }
            NavigationKind::Rvo => {
                let paper = Rvo::default();
                Navigation::Rvo(Rvo {
                    collision_weight: self.collision_weight.unwrap_or(paper.collision_weight),
                    candidates: self.candidates.unwrap_or(paper.candidates),
                    avoidance_radius: self.avoidance_radius.unwrap_or(paper.avoidance_radius),
                })
            }
        }
    }
}

/// A profile or blend of §5.5 with some parameters changed; `None` for an unknown name.
pub fn named(name: &str, parameters: &Parameters) -> Option<Result<Blend, BlendError>> {
    let alias = ALIASES.into_iter().find(|&(alias, _)| alias == name);
    let name = alias.map_or(name, |(_, name)| name);
    let (first, second) = match name.split_once("->") {
        Some((first, second)) if NAMES.contains(&name) => (first, Some(second)),
        _ => (name, None),
    };
    let first = plain(first, parameters)?;
    let Some(second) = second else {
        return Some(Ok(Blend::single(first, parameters.sph())));
    };
    let profiles = [first, plain(second, parameters)?];
    let steps = profiles
        .into_iter()
        .zip(BLEND_DENSITIES)
        .map(|(profile, at_density)| BlendStep {
            at_density,
            profile,
        });
    Some(Blend::new(
        name.to_owned(),
        parameters.sph(),
        steps.collect(),
    ))
}

/// One of the five profiles of §5.5 that are not blends; `None` for other names.
pub fn plain(name: &str, parameters: &Parameters) -> Option<Profile> {
    let (kind, sph) = match name {
        "sf" => (NavigationKind::Social, false),
        "rvo" => (NavigationKind::Rvo, false),
        "sf+sph" => (NavigationKind::Social, true),
        "rvo+sph" => (NavigationKind::Rvo, true),
        "sph" => (NavigationKind::Goal, true),
        _ => return None,
    };
    Some(parameters.profile(name, kind, sph))
}

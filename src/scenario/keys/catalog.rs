//! The seven profiles of §5.5, calibrated ones, and custom profiles from parameters.

use std::sync::Arc;

pub use super::parameters::{NavigationKind, ParameterError, Parameters, WalkingLawKind};

use crate::error::{quote::shown, suggestion};
use crate::keys::{calibrated, parameters::Walking};
use engine::density::SphParameters;
use engine::forces::walking::{Headings, WalkingLaw};
use engine::forces::{contact::Contact, drag::Drag, rvo::Rvo};
use engine::forces::{social::SocialForce, viscosity::Viscosity};
use engine::profile::{Blend, BlendError, BlendStep, Navigation, Profile};

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

impl Parameters {
    fn walking(&self, kind: WalkingLawKind) -> Option<WalkingLaw> {
        match kind {
            WalkingLawKind::None | WalkingLawKind::Drag => None,
            WalkingLawKind::Headway => Some(WalkingLaw::Headway(self.part())),
            WalkingLawKind::DensityAhead => Some(WalkingLaw::DensityAhead(self.part())),
            WalkingLawKind::Headings => Some(WalkingLaw::Headings(Headings {
                headway: self.part(),
                gap: self.part(),
                ..self.part()
            })),
        }
    }

    /// A profile with navigation `kind`, with or without SPH. Zero stiffness, k or μ switches the term off.
    pub fn profile(&self, name: &str, kind: NavigationKind, sph: bool) -> Profile {
        let switch = |value: f64| (value != 0.0).then_some(value);
        let (agent_stiffness, wall_stiffness) = if sph { (50.0, 200.0) } else { (1000.0, 1000.0) };
        let (contact, viscosity): (Contact, Viscosity) = (self.part(), self.part());
        let Walking { walking_law } = self.part();
        let mut forces = self.forces();
        if walking_law == WalkingLawKind::Drag {
            forces.push(Arc::new(self.part::<Drag>()));
        }
        Profile {
            name: name.to_owned(),
            navigation: match kind {
                NavigationKind::Goal => Navigation::Goal(self.part()),
                NavigationKind::Social => Navigation::Social(self.part(), self.part()),
                NavigationKind::Rvo => Navigation::Rvo(Rvo {
                    avoidance_radius: self.part::<SocialForce>().avoidance_radius,
                    ..self.part()
                }),
            },
            walking: self.walking(walking_law),
            pressure: sph && self.part::<SphParameters>().gas_constant != 0.0,
            viscosity: (sph && viscosity.coefficient != 0.0).then_some(viscosity),
            contact: Contact {
                agent_stiffness: switch(contact.agent_stiffness.unwrap_or(agent_stiffness)),
                wall_stiffness: switch(contact.wall_stiffness.unwrap_or(wall_stiffness)),
                ..contact
            },
            forces,
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
        None => (name, parameters.clone()),
    }
}

/// Why there is no such profile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// No profile has this name.
    #[error("unknown profile `{}`{} (known profiles: {})", shown(.0), advice(.0), names().join(", "))]
    Unknown(String),
    /// It is a blend, where only a plain profile may be.
    #[error("a blend must consist of plain profiles; `{0}` is a blend")]
    IsBlend(String),
    /// There is no such parameter, or its value is of another kind.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Its profiles do not fit together.
    #[error(transparent)]
    Blend(#[from] BlendError),
}

/// Advice for an unknown name.
fn advice(name: &str) -> String {
    if name.ends_with('-') {
        "; a shell takes an unquoted `>` for a redirection: quote the name, or write sf-sph or rvo-sph".to_owned()
    } else {
        suggestion(name, names())
    }
}

/// The two profiles of a blend of the paper.
fn ends_of_blend(name: &str) -> Option<(&str, &str)> {
    let alias = ALIASES.into_iter().find(|&(alias, _)| alias == name);
    let name = alias.map_or(name, |(_, name)| name);
    name.split_once("->").filter(|_| NAMES.contains(&name))
}

/// A profile or blend with some parameters changed.
///
/// # Errors
/// No profile or blend has this name.
pub fn named(name: &str, parameters: &Parameters) -> Result<Blend, ProfileError> {
    let Some((first, second)) = ends_of_blend(name) else {
        let (_, all) = resolved(name, parameters);
        return Ok(Blend::single(plain(name, parameters)?, all.part()));
    };
    let profiles = [plain(first, parameters)?, plain(second, parameters)?];
    let densities = BLEND_DENSITIES.into_iter().zip(profiles);
    let steps = densities.map(|(at_density, profile)| BlendStep {
        at_density,
        profile,
    });
    let name = format!("{first}->{second}");
    Ok(Blend::new(name, parameters.part(), steps.collect())?)
}

/// A calibrated profile, or one of the five of §5.5 that are not blends.
///
/// # Errors
/// No profile has this name, or it is a blend.
pub fn plain(name: &str, parameters: &Parameters) -> Result<Profile, ProfileError> {
    let (base, parameters) = resolved(name, parameters);
    let (kind, sph) = match base {
        "sf" => (NavigationKind::Social, false),
        "rvo" => (NavigationKind::Rvo, false),
        "sf+sph" => (NavigationKind::Social, true),
        "rvo+sph" => (NavigationKind::Rvo, true),
        "sph" => (NavigationKind::Goal, true),
        _ if ends_of_blend(name).is_some() => return Err(ProfileError::IsBlend(name.to_owned())),
        _ => return Err(ProfileError::Unknown(name.to_owned())),
    };
    Ok(parameters.profile(name, kind, sph))
}

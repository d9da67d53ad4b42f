//! The seven profiles of §5.5, calibrated ones, and custom profiles from parameters.

use std::sync::Arc;

pub use super::parameters::{NavigationKind, Parameters, SPH, WalkingLawKind};

use crate::error::{quote::shown, suggestion};
use crate::keys::calibrated;
use engine::forces::contact::Contact;
use engine::forces::viscosity::Viscosity;
use engine::forces::walking::WalkingLaw;
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
    fn walking(&self) -> Option<WalkingLaw> {
        match self.walking_law? {
            WalkingLawKind::None | WalkingLawKind::Drag => None,
            WalkingLawKind::Headway => Some(WalkingLaw::Headway(self.headway())),
            WalkingLawKind::DensityAhead => Some(WalkingLaw::DensityAhead(self.density_ahead())),
            WalkingLawKind::Headings => Some(WalkingLaw::Headings(self.headings())),
        }
    }

    /// A profile with navigation `kind`, with or without SPH. Zero stiffness, k or μ switches the term off.
    pub fn profile(&self, name: &str, kind: NavigationKind, sph: bool) -> Profile {
        let switch = |value: f64| (value != 0.0).then_some(value);
        let (agent_stiffness, wall_stiffness) = if sph { (50.0, 200.0) } else { (1000.0, 1000.0) };
        let mut forces = self.forces();
        if self.walking_law == Some(WalkingLawKind::Drag) {
            forces.push(Arc::new(self.drag()));
        }
        Profile {
            name: name.to_owned(),
            navigation: match kind {
                NavigationKind::Goal => Navigation::Goal(self.goal()),
                NavigationKind::Social => Navigation::Social(self.goal(), self.social()),
                NavigationKind::Rvo => Navigation::Rvo(self.rvo()),
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
        None => (name, *parameters),
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
    /// A parameter is no finite number.
    #[error("the parameter {0} must be a finite number")]
    NotFinite(&'static str),
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
        return Ok(Blend::single(plain(name, parameters)?, all.sph()));
    };
    let profiles = [plain(first, parameters)?, plain(second, parameters)?];
    let densities = BLEND_DENSITIES.into_iter().zip(profiles);
    let steps = densities.map(|(at_density, profile)| BlendStep {
        at_density,
        profile,
    });
    let name = format!("{first}->{second}");
    Ok(Blend::new(name, parameters.sph(), steps.collect())?)
}

/// A calibrated profile, or one of the five of §5.5 that are not blends.
///
/// # Errors
/// No profile has this name, or it is a blend.
pub fn plain(name: &str, parameters: &Parameters) -> Result<Profile, ProfileError> {
    parameters.check().map_err(ProfileError::NotFinite)?;
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

//! Profiles and blends: their keys in a file, and their conversion to blends of the engine.

use crate::error::numbers::brief;
use crate::error::{Problem, Under};
use crate::keys::catalog::{self, Parameters, ProfileError};
use crate::keys::names::names;
use crate::keys::profiles::{CustomProfile, ProfileChoice, ProfileName, Step};
use engine::density::SphParameters;
use engine::profile::{Blend, BlendStep, Profile};

impl From<ProfileError> for Problem {
    fn from(error: ProfileError) -> Self {
        Self::new("", error.to_string())
    }
}

/// Converts a profile or blend; the scenario-wide values `overriding` override its own.
pub fn blend(choice: &ProfileChoice, overriding: &Parameters) -> Result<Blend, Problem> {
    let blend = match choice {
        ProfileChoice::Named(ProfileName(name)) => catalog::named(name, overriding)?,
        ProfileChoice::Custom(custom) => custom_blend(custom, overriding)?,
    };
    let (min, max) = (blend.sph.rest_density_min, blend.sph.rest_density_max);
    if min > max {
        let reason = format!("rest_density_min {min} is above rest_density_max {max}; set both");
        return Err(Problem::new("", reason));
    }
    Ok(blend)
}

fn custom_blend(custom: &CustomProfile, overriding: &Parameters) -> Result<Blend, Problem> {
    checked(custom)?;
    let parameters = overriding.or(&custom.parameters);
    if let Some(steps) = &custom.blend {
        return blend_of_steps(custom, steps, overriding);
    }
    if let Some(ProfileName(base)) = &custom.base
        && let Err(ProfileError::IsBlend(_)) = catalog::plain(base, &parameters)
    {
        let mut blend = catalog::named(base, &parameters)?;
        if let Some(name) = &custom.name {
            blend.name.clone_from(name);
        }
        return Ok(blend);
    }
    let profile = custom_profile(custom, &parameters)?;
    // A calibrated base has parameters of its own.
    let sph = match &custom.base {
        Some(ProfileName(base)) => catalog::resolved(base, &parameters).1.part(),
        None => parameters.part(),
    };
    Ok(Blend::single(profile, sph))
}

/// A profile that is not a blend.
fn custom_profile(custom: &CustomProfile, parameters: &Parameters) -> Result<Profile, Problem> {
    let profile = match (&custom.base, custom.navigation) {
        (Some(ProfileName(base)), _) => catalog::plain(base, parameters)
            .map_err(Problem::from)
            .under("base")?,
        (None, Some(kind)) => parameters.profile("custom", kind, custom.sph.unwrap_or(true)),
        (None, None) => {
            let reason = "a blend must consist of plain profiles, not of blends";
            return Err(Problem::new("blend", reason));
        }
    };
    let name = custom.name.clone().unwrap_or(profile.name);
    Ok(Profile { name, ..profile })
}

fn checked(custom: &CustomProfile) -> Result<(), Problem> {
    let forms = [
        custom.base.is_some(),
        custom.navigation.is_some(),
        custom.blend.is_some(),
    ];
    if forms.into_iter().filter(|&given| given).count() != 1 {
        let reason = "needs exactly one of `base`, `navigation` and `blend`";
        return Err(Problem::new("", reason));
    }
    if custom.sph.is_some() && custom.navigation.is_none() {
        return Err(Problem::new(
            "sph",
            "is allowed only with `navigation`; remove it",
        ));
    }
    Ok(())
}

fn blend_of_steps(
    custom: &CustomProfile,
    steps: &[Step],
    overriding: &Parameters,
) -> Result<Blend, Problem> {
    let shared = shared_by(custom, steps)?;
    let parameters = overriding.or(&custom.parameters).or(&shared);
    let mut converted = Vec::with_capacity(steps.len());
    for (k, step) in steps.iter().enumerate() {
        let profile = step_profile(&step.profile, &parameters);
        converted.push(BlendStep {
            at_density: step.at_density,
            profile: profile.under(&format!("blend[{k}].profile"))?,
        });
    }
    let name = custom.name.clone().unwrap_or_else(|| {
        let each = converted.iter().map(|step| step.profile.name.as_str());
        let names: Vec<&str> = each.collect();
        names.join("->")
    });
    Blend::new(name, parameters.part(), converted)
        .map_err(|error| Problem::new("blend", error.to_string()))
}

fn step_profile(choice: &ProfileChoice, parameters: &Parameters) -> Result<Profile, Problem> {
    match choice {
        ProfileChoice::Named(ProfileName(name)) => Ok(catalog::plain(name, parameters)?),
        ProfileChoice::Custom(custom) => {
            checked(custom)?;
            custom_profile(custom, &parameters.or(&custom.parameters))
        }
    }
}

/// The parameters of a step's own, or those of the calibrated profile that it names.
fn own_parameters(choice: &ProfileChoice) -> Parameters {
    let (name, own) = match choice {
        ProfileChoice::Named(name) => (Some(name), Parameters::default()),
        ProfileChoice::Custom(custom) => (custom.base.as_ref(), custom.parameters.clone()),
    };
    match name {
        Some(ProfileName(name)) => catalog::resolved(name, &own).1,
        None => own,
    }
}

/// The SPH parameters given anywhere in a blend, which apply to all of it.
fn shared_by(custom: &CustomProfile, steps: &[Step]) -> Result<Parameters, Problem> {
    let mut shared = Parameters::default();
    let of_steps = steps.iter().enumerate().map(|(k, step)| {
        let own = own_parameters(&step.profile);
        (format!("blend[{k}].profile."), own)
    });
    let of_all = std::iter::once((String::new(), custom.parameters.clone()));
    for (place, own) in of_all.chain(of_steps) {
        for key in names::<SphParameters>() {
            let number = |all: &Parameters| all.get(key)?.as_f64();
            let Some(here) = number(&own) else {
                continue;
            };
            let before = number(&shared).unwrap_or(here);
            if before != here {
                let reason = format!(
                    "must be the same in all profiles of a blend: {} here, {} before; give it once",
                    brief(here),
                    brief(before)
                );
                return Err(Problem::new(format!("{place}parameters.{key}"), reason));
            }
            shared = shared.with(key, here).map_err(ProfileError::from)?;
        }
    }
    Ok(shared)
}

//! Profiles and blends of a file → blends of the engine.

use super::error::{Problem, Under, suggestion};
use super::file::{CustomProfile, Object, ProfileChoice, Step};
use super::parameters::{self, DENSITY};
use crate::engine::profile::{Blend, BlendStep, Profile};
use crate::scenario::catalog::{self, NAMES, Parameters};
use crate::scenario::quote::shown;

/// Converts a profile or blend; the scenario-wide values `overriding` override its own.
pub(super) fn blend(choice: &ProfileChoice, overriding: &Parameters) -> Result<Blend, Problem> {
    let blend = match choice {
        ProfileChoice::Named(name) => named(name, overriding)?,
        ProfileChoice::Custom(custom) => custom_blend(custom, overriding)?,
    };
    let (min, max) = (blend.sph.rest_density_min, blend.sph.rest_density_max);
    if min > max {
        let reason = format!("rest_density_min {min} is above rest_density_max {max}; set both");
        return Err(Problem::new("", reason));
    }
    Ok(blend)
}

fn named(name: &str, parameters: &Parameters) -> Result<Blend, Problem> {
    catalog::named(name, parameters)
        .ok_or_else(|| unknown(name))?
        .map_err(|error| Problem::new("", error.to_string()))
}

fn unknown(name: &str) -> Problem {
    let names = NAMES.join(", ");
    let near = if name.ends_with('-') {
        "; a shell takes an unquoted `>` for a redirection: quote the name, or write sf-sph or rvo-sph".to_owned()
    } else {
        suggestion(name, NAMES)
    };
    Problem::new(
        "",
        format!(
            "unknown profile `{}`{near} (known profiles: {names})",
            shown(name)
        ),
    )
}

fn custom_blend(custom: &CustomProfile, overriding: &Parameters) -> Result<Blend, Problem> {
    checked(custom)?;
    let parameters = overriding.or(&custom.parameters.0);
    if let Some(steps) = &custom.blend {
        return blend_of_steps(custom, steps, overriding);
    }
    if let Some(base) = &custom.base
        && catalog::plain(base, &parameters).is_none()
    {
        let mut blend = named(base, &parameters).under("base")?;
        if let Some(name) = &custom.name {
            blend.name.clone_from(name);
        }
        return Ok(blend);
    }
    Ok(Blend::single(
        custom_profile(custom, &parameters)?,
        parameters.sph(),
    ))
}

/// A profile that is not a blend.
fn custom_profile(custom: &CustomProfile, parameters: &Parameters) -> Result<Profile, Problem> {
    let profile = match (&custom.base, custom.navigation) {
        (Some(base), _) => plain(base, parameters).under("base")?,
        (None, Some(kind)) => parameters.profile("custom", kind, custom.sph.unwrap_or(true)),
        (None, None) => {
            let reason = "a blend must consist of plain profiles, not of blends";
            return Err(Problem::new("blend", reason));
        }
    };
    let name = custom.name.clone().unwrap_or(profile.name);
    Ok(Profile { name, ..profile })
}

fn plain(name: &str, parameters: &Parameters) -> Result<Profile, Problem> {
    catalog::plain(name, parameters).ok_or_else(|| {
        if catalog::named(name, parameters).is_some() {
            let reason = format!("a blend must consist of plain profiles; `{name}` is a blend");
            Problem::new("", reason)
        } else {
            unknown(name)
        }
    })
}

fn checked(custom: &CustomProfile) -> Result<(), Problem> {
    if custom.name.as_ref().is_some_and(|name| name.is_empty()) {
        return Err(Problem::new("name", "must not be empty"));
    }
    let ways = [
        custom.base.is_some(),
        custom.navigation.is_some(),
        custom.blend.is_some(),
    ];
    if ways.into_iter().filter(|&given| given).count() != 1 {
        let reason = "needs exactly one of `base`, `navigation` and `blend`";
        return Err(Problem::new("", reason));
    }
    if custom.sph.is_some() && custom.navigation.is_none() {
        return Err(Problem::new(
            "sph",
            "is allowed only with `navigation`; remove it",
        ));
    }
    parameters::check(&custom.parameters.0).under("parameters")
}

fn blend_of_steps(
    custom: &CustomProfile,
    steps: &[Object<Step>],
    overriding: &Parameters,
) -> Result<Blend, Problem> {
    let shared = shared_by(custom, steps)?;
    let parameters = overriding.or(&custom.parameters.0).or(&shared);
    let mut converted = Vec::with_capacity(steps.len());
    for (k, Object(step)) in steps.iter().enumerate() {
        let place = format!("blend[{k}]");
        let at_density = DENSITY.check("at_density", step.at_density).under(&place)?;
        let profile = step_profile(&step.profile, &parameters)
            .under("profile")
            .under(&place)?;
        converted.push(BlendStep {
            at_density,
            profile,
        });
    }
    let name = custom.name.clone().unwrap_or_else(|| {
        let names: Vec<&str> = converted
            .iter()
            .map(|step| step.profile.name.as_str())
            .collect();
        names.join("->")
    });
    Blend::new(name, parameters.sph(), converted)
        .map_err(|error| Problem::new("blend", error.to_string()))
}

fn step_profile(choice: &ProfileChoice, parameters: &Parameters) -> Result<Profile, Problem> {
    match choice {
        ProfileChoice::Named(name) => plain(name, parameters),
        ProfileChoice::Custom(custom) => {
            checked(custom)?;
            custom_profile(custom, &parameters.or(&custom.parameters.0))
        }
    }
}

/// The SPH parameters given anywhere in a blend, which apply to all of it.
fn shared_by(custom: &CustomProfile, steps: &[Object<Step>]) -> Result<Parameters, Problem> {
    let mut shared = sph_only(&custom.parameters.0);
    for (k, Object(step)) in steps.iter().enumerate() {
        let ProfileChoice::Custom(step) = &step.profile else {
            continue;
        };
        let own = sph_only(&step.parameters.0);
        let so_far = parameters::given(&shared);
        for (key, value) in parameters::given(&own) {
            if let Some((_, other)) = so_far.iter().find(|(k, v)| *k == key && *v != value) {
                let path = format!("blend[{k}].profile.parameters.{key}");
                let reason = format!(
                    "must be the same in all profiles of a blend: {value} here, {other} before; give it once"
                );
                return Err(Problem::new(path, reason));
            }
        }
        shared = shared.or(&own);
    }
    Ok(shared)
}

fn sph_only(parameters: &Parameters) -> Parameters {
    Parameters {
        support_radius: parameters.support_radius,
        gas_constant: parameters.gas_constant,
        rest_density_min: parameters.rest_density_min,
        rest_density_max: parameters.rest_density_max,
        averaging_time: parameters.averaging_time,
        ..Parameters::default()
    }
}

//! The step and the method of time integration: as the file gives them, or by rule where it says `auto`.

use crate::error::Problem;
use crate::file::File;
use crate::keys::numerics::{IntegratorChoice, TimeStep};
use engine::clock::{Clock, PAPER_TIME_STEP, SHORTEST_TIME_STEP};
use engine::journeys::Place;
use engine::profile::{BlendStep, Navigation};
use engine::scene::{Integrator, Scene};
use engine::stability;

impl IntegratorChoice {
    /// The integrator for `scene`, which is otherwise complete.
    pub fn for_scene(self, scene: &Scene) -> Integrator {
        match self {
            Self::SemiImplicit => Integrator::SemiImplicit,
            Self::ForwardEuler => Integrator::ForwardEuler,
            Self::VelocityVerlet => Integrator::VelocityVerlet,
            Self::Midpoint => Integrator::Midpoint,
            Self::Auto => suited_integrator(scene),
        }
    }
}

/// Velocity Verlet where agents stay: it is closer to the limit of fine steps in crowds that press or stand, but no
/// better with avoidance, worse with walking laws, and lowers the flow through doors (docs/findings/accuracy.md).
fn suited_integrator(scene: &Scene) -> Integrator {
    if agents_stay(scene) {
        Integrator::VelocityVerlet
    } else {
        Integrator::SemiImplicit
    }
}

/// Whether no agent avoids others, has a walking law or leaves.
fn agents_stay(scene: &Scene) -> bool {
    let needs = scene.needs();
    let exits = scene.journeys.places.iter().any(Place::is_exit);
    !(needs.avoidance.is_some() || needs.walking || needs.removal || exits)
}

/// The longest step, seconds, at which the evacuations of Table 1 differ from those at the paper's step by no more than
/// two standard deviations of their seeds (docs/findings/accuracy.md). Where agents avoid each other in a jam, the jam
/// depends on the step. Where agents stay, the limit is the accuracy of waves.
fn longest_faithful_step(scene: &Scene) -> f64 {
    if agents_stay(scene) {
        return 0.05;
    }
    let avoids = |step: &BlendStep| !matches!(step.profile.navigation, Navigation::Goal(_));
    let mut densest = (scene.groups.iter()).filter_map(|group| group.blend.steps().last());
    match densest.any(avoids) {
        true => PAPER_TIME_STEP,
        false => 0.025,
    }
}

/// The step, seconds, that `"time_step_secs": "auto"` takes in `scene` by default; `None` if there is no formula for
/// its integrator.
pub fn automatic_step(scene: &Scene) -> Option<f64> {
    let step = stability::time_step(scene)?.min(longest_faithful_step(scene));
    Some(Clock::up_to(step).time_step())
}

/// The clock of a file, with the paper's step if that is missing or `auto`.
pub fn first_clock(keys: &File) -> Clock {
    let step = match keys.time_step_secs {
        Some(TimeStep::Fixed(step)) => step,
        Some(TimeStep::Auto(_)) | None => PAPER_TIME_STEP,
    };
    let nearest = || Clock::nearest_coarse_every(step);
    Clock::new(step, keys.coarse_every.unwrap_or_else(nearest))
}

/// The clock of a file for `scene`, which is otherwise complete; an error if `auto` finds no step.
pub fn clock_for(keys: &File, scene: &Scene) -> Result<Clock, Problem> {
    let Some(TimeStep::Auto(_)) = keys.time_step_secs else {
        return Ok(first_clock(keys));
    };
    let step = stability::time_step(scene).ok_or_else(|| {
        let reason = "`auto` works only with the integrators `semi-implicit` and `velocity-verlet`; \
                      give a number";
        Problem::new("time_step_secs", reason)
    })?.min(match keys.longest_step_secs {
        Some(TimeStep::Fixed(longest)) => longest,
        Some(TimeStep::Auto(_)) | None => longest_faithful_step(scene),
    });
    if step < SHORTEST_TIME_STEP {
        let reason = format!(
            "`auto` finds no step: this crowd is so stiff that it needs {step:e} s, below the shortest step of \
             {SHORTEST_TIME_STEP:e} s; lower gas_constant, viscosity or the stiffnesses, or raise the masses"
        );
        return Err(Problem::new("time_step_secs", reason));
    }
    Ok(match keys.coarse_every {
        Some(frames) => Clock::new(step, frames),
        None => Clock::up_to(step),
    })
}

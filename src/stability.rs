//! How long a frame may be: a formula for the largest stable time step, with constants from maps of where
//! crowds at rest begin to shake (`sandbox stress`, `docs/stability.md`).
//!
//! Near rest every mode of a crowd is an oscillator, ẍ = −ω² x − γ ẋ. Moved on by semi-implicit Euler it
//! decays as long as ω² Δt² + 2γ Δt < 4, so up to
//!
//! Δt = 4 / (γ + √(γ² + 4ω²)),
//!
//! which is 2/ω without friction and 2/γ without springs. Two modes of a crowd are fast, and the faster
//! decides:
//!
//! - people pressed together: ω² = (C₁ c/h)² + C₂ K/m, c = √(k/2) the speed of sound
//!   ([`crate::sound`]), K/m the stiffest contact of the lightest person: the Courant condition of
//!   SPH, and that of springs;
//! - people who drag each other along: γ = C₃ μ. A person's drag is μ ∇²W/ρ² for every neighbour; it is
//!   largest in a loose crowd, where the density is hardly more than the own ~ 1/h², and h drops out.
//!
//! A corner, both of whose edges push, counts with 2 K^obs/m by itself, and a wall with K^obs/m where that
//! is more than the contacts. To all friction the goal force adds K^goal/(τ m). No step is longer than the paper's Δt_coarse.

use crate::agents::{RADIUS_RANGE, REFERENCE_RADIUS};
use crate::clock::PAPER_COARSE_STEP;
use crate::profile::{Navigation, Profile};
use crate::scene::Scene;
use crate::sound;

/// C₁ to C₃, and what is left as a margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// C₁: the pressure's fastest mode in c/h.
    pub pressure: f64,
    /// C₂: the fastest mode of contacts, squared, in K/m.
    pub contact: f64,
    /// C₃: drag over μ, 1/s.
    pub drag: f64,
    /// The part of the formula's step that is taken.
    pub margin: f64,
}

/// What least squares give for the maps' places (`stress/fit.rs`).
pub const FITTED: Constants = Constants {
    pressure: 2.25,
    contact: 4.0,
    drag: 2.3,
    margin: 0.85,
};

/// Both edges of a corner push the same way whoever stands before it.
const EDGES_AT_A_CORNER: f64 = 2.0;

/// The fastest mode of a crowd.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// c/h of the pressure, 1/s.
    pub pressure: f64,
    /// K/m of contact between people, 1/s².
    pub contact: f64,
    /// K/m of a wall, and of the social forces, 1/s².
    pub other_springs: f64,
    /// K/m of a corner, 1/s².
    pub corner: f64,
    /// μ.
    pub viscosity: f64,
    /// K^goal/(τ m), or what RVO corrects, 1/s.
    pub correction: f64,
}

impl Mode {
    /// The fastest that the profiles of a scene and its lightest person allow.
    pub fn of(scene: &Scene) -> Self {
        let mass = lightest(scene);
        let mut mode = Self {
            pressure: 0.0,
            contact: 0.0,
            other_springs: 0.0,
            corner: 0.0,
            viscosity: 0.0,
            correction: 0.0,
        };
        for group in &scene.groups {
            let sph = &group.blend.sph;
            let speed = sound::speed_of_fluid(sph.gas_constant);
            for step in group.blend.steps() {
                let profile = &step.profile;
                if profile.pressure {
                    mode.pressure = mode.pressure.max(speed / sph.support_radius);
                }
                mode.take(profile, mass);
            }
        }
        // Whoever pushes has the goal force of a whole push.
        let pushes = scene.pushes.iter();
        let strongest = pushes
            .filter_map(|push| push.change.goal_scale)
            .fold(0.0, f64::max);
        mode.correction = mode
            .correction
            .max(strongest / shortest_relaxation(scene) / mass);
        mode
    }

    fn take(&mut self, profile: &Profile, mass: f64) {
        let contact = profile.contact;
        let viscosity = profile.viscosity.map_or(0.0, |v| v.coefficient);
        let wall = contact.wall_stiffness.unwrap_or(0.0);
        let (social, correction) = match profile.navigation {
            Navigation::Goal(goal) => (0.0, goal.goal_scale / goal.relaxation_time / mass),
            Navigation::Social(goal, social) => (
                social.agent_strength / social.agent_range.powi(2)
                    + social.wall_strength / social.wall_range.powi(2),
                goal.goal_scale / goal.relaxation_time / mass,
            ),
            Navigation::Rvo(_) => (0.0, 1.0 / PAPER_COARSE_STEP),
        };
        self.contact = self
            .contact
            .max(contact.agent_stiffness.unwrap_or(0.0) / mass);
        self.other_springs = self.other_springs.max((wall + social) / mass);
        self.corner = self.corner.max(EDGES_AT_A_CORNER * wall / mass);
        self.viscosity = self.viscosity.max(viscosity);
        self.correction = self.correction.max(correction);
    }

    /// The formula's step, seconds, margin not included.
    pub fn largest_step(&self, constants: &Constants) -> f64 {
        let springs = (constants.contact * self.contact).max(self.other_springs);
        let pressed = (constants.pressure * self.pressure).powi(2) + springs;
        let drag = constants.drag * self.viscosity + self.correction;
        let steps = [
            largest_step(pressed, self.correction),
            largest_step(self.corner, self.correction),
            largest_step(0.0, drag),
            PAPER_COARSE_STEP,
        ];
        steps.into_iter().fold(f64::INFINITY, f64::min)
    }
}

/// Up to where ẍ = −ω² x − γ ẋ decays, seconds.
fn largest_step(omega_squared: f64, gamma: f64) -> f64 {
    4.0 / (gamma + (gamma * gamma + 4.0 * omega_squared).sqrt())
}

/// The step that `auto` stands for, seconds: three digits of the formula's step and its margin.
pub fn time_step(scene: &Scene) -> f64 {
    let step = FITTED.margin * Mode::of(scene).largest_step(&FITTED);
    three_digits(step)
}

/// Rounded down.
fn three_digits(value: f64) -> f64 {
    let digit = 10_f64.powf(value.log10().floor() - 2.0);
    // Through text: the nearest number to so many digits, whatever the division says.
    let rounded = (value / digit + 1e-9).floor() * digit;
    format!("{rounded:.2e}").parse().unwrap_or(rounded)
}

/// The least mass that anybody in the scene has or may be given.
fn lightest(scene: &Scene) -> f64 {
    let of_radius = |radius: f64| (radius / REFERENCE_RADIUS).powi(2);
    let drawn = of_radius(RADIUS_RANGE[0]);
    let given = scene.agents.iter().map(|agent| {
        let radius = agent.radius.map(of_radius);
        agent.mass.or(radius).unwrap_or(drawn)
    });
    let entering = (!scene.sources.is_empty()).then_some(drawn);
    given.chain(entering).reduce(f64::min).unwrap_or(drawn)
}

/// The least τ of any goal force, seconds; the paper's if there is none.
fn shortest_relaxation(scene: &Scene) -> f64 {
    let profiles = scene.groups.iter().flat_map(|group| group.blend.steps());
    let times = profiles.filter_map(|step| match step.profile.navigation {
        Navigation::Goal(goal) | Navigation::Social(goal, _) => Some(goal.relaxation_time),
        Navigation::Rvo(_) => None,
    });
    let paper = crate::forces::goal::GoalForce::default().relaxation_time;
    times.reduce(f64::min).unwrap_or(paper)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |largest eigenvalue| of one step of semi-implicit Euler.
    fn growth(omega_squared: f64, gamma: f64, dt: f64) -> f64 {
        // λ² − (2 − γΔt − ω²Δt²) λ + (1 − γΔt) = 0.
        let (b, c) = (2.0 - gamma * dt - omega_squared * dt * dt, 1.0 - gamma * dt);
        let discriminant = b * b - 4.0 * c;
        if discriminant < 0.0 {
            c.sqrt()
        } else {
            0.5 * (b.abs() + discriminant.sqrt())
        }
    }

    #[test]
    fn the_step_is_where_an_oscillator_begins_to_grow() {
        for (omega_squared, gamma) in [(1.0, 0.0), (700.0, 2.0), (3.0, 90.0), (0.0, 5.0)] {
            let step = largest_step(omega_squared, gamma);
            assert!(growth(omega_squared, gamma, 0.999 * step) <= 1.0 + 1e-12);
            assert!(growth(omega_squared, gamma, 1.001 * step) > 1.0);
        }
    }

    #[test]
    fn steps_are_rounded_down_to_what_is_written() {
        assert_eq!(three_digits(0.017_999), 0.0179);
        assert_eq!(three_digits(0.1), 0.1);
        assert_eq!(three_digits(0.003_21), 0.003_21);
        assert_eq!(three_digits(9.999e-5), 9.99e-5);
    }
}

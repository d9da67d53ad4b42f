//! A formula for the largest stable time step. Its constants are fitted to maps of the largest step at which
//! crowds come to rest (`sandbox stress`, `docs/stability.md`).
//!
//! Near rest every mode of a crowd is an oscillator, ẍ = −ω² x − γ ẋ. With semi-implicit Euler it decays if
//! ω² Δt² + 2γ Δt < 4, that is, for steps up to
//!
//! Δt = 4 / (γ + √(γ² + 4ω²)),
//!
//! which is 2/ω without friction and 2/γ without springs. At this step an eigenvalue of the frame map passes −1.
//! In velocity Verlet friction counts twice, because it acts on the predicted velocity, ẋ + ẍ Δt. At eigenvalue −1
//! every frame begins and ends at a turning point, v = 0, so that x = −ẍ Δt²/4 and the predicted velocity is −ẍ Δt.
//! Then ẍ = −ω² x − γ ẋ becomes ω² Δt² + 4γ Δt = 4, with the limits 2/ω and 1/γ (see [`Scheme`]).
//!
//! Two modes of a crowd are fast; the faster one limits the step:
//!
//! - Compression of a pressed crowd: ω² = (C₁ c/h)² + C₂ K/m, with the speed of sound c = √(k/2)
//!   ([`crate::analysis::sound`]) and the largest contact stiffness over the smallest mass, K/m. This combines the
//!   Courant condition of SPH with that of springs.
//! - Viscous drag in a loose crowd: γ = C₃ μ. Every neighbor contributes μ ∇²W/ρ² to the drag on an agent. The drag
//!   is largest in a loose crowd, where the density is little more than the agent's own contribution ~ 1/h², so
//!   that h drops out. In a uniform crowd it is proportional to 1/ρ; in a pressed crowd the friction is C₃ μ/4.
//!
//! A corner has its own limit with ω² = 2 K^obs/m, because both of its edges push. Springs of walls and social
//! forces replace C₂ K/m if they are stiffer. All friction includes K^goal/(τ m) of the goal force, or 1/Δt_coarse
//! for RVO. No step is longer than the paper's Δt_coarse.

use crate::analysis::sound;
use crate::engine::agents::{RADIUS_RANGE, REFERENCE_RADIUS};
use crate::engine::clock::PAPER_COARSE_STEP;
use crate::engine::profile::{Navigation, Profile};
use crate::engine::scene::{Integrator, Scene};

/// C₁ to C₃, and the safety margins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// C₁: frequency of the fastest pressure mode, in units of c/h.
    pub pressure: f64,
    /// C₂: squared frequency of the fastest contact mode, in units of K/m.
    pub contact: f64,
    /// C₃: drag in 1/s, divided by μ.
    pub drag: f64,
    /// The fraction of the formula's step that `auto` takes with semi-implicit Euler.
    pub margin: f64,
    /// The fraction that `auto` takes with velocity Verlet, whose limits are closer to the formula.
    pub verlet_margin: f64,
}

impl Constants {
    fn margin(&self, scheme: Scheme) -> f64 {
        match scheme {
            Scheme::SemiImplicit => self.margin,
            Scheme::VelocityVerlet => self.verlet_margin,
        }
    }
}

/// Rounded least-squares fit to the points of the maps (`lab/stress/fit.rs`). The margin of velocity Verlet is chosen
/// from its limits.
pub const FITTED: Constants = Constants {
    pressure: 2.25,
    contact: 4.0,
    drag: 2.3,
    margin: 0.85,
    verlet_margin: 0.88,
};

/// An integrator with a formula for its largest stable step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Semi-implicit Euler.
    SemiImplicit,
    /// Velocity Verlet.
    VelocityVerlet,
}

impl Scheme {
    /// The scheme of an integrator; `None` if there is no formula for it.
    pub fn of(integrator: Integrator) -> Option<Self> {
        match integrator {
            Integrator::SemiImplicit => Some(Self::SemiImplicit),
            Integrator::VelocityVerlet => Some(Self::VelocityVerlet),
            Integrator::ForwardEuler | Integrator::Midpoint => None,
        }
    }

    /// The corresponding integrator of a scene.
    pub fn integrator(self) -> Integrator {
        match self {
            Self::SemiImplicit => Integrator::SemiImplicit,
            Self::VelocityVerlet => Integrator::VelocityVerlet,
        }
    }

    /// The largest step for which ẍ = −ω² x − γ ẋ decays, seconds.
    fn largest_step(self, omega_squared: f64, gamma: f64) -> f64 {
        let gamma = match self {
            Self::SemiImplicit => gamma,
            Self::VelocityVerlet => 2.0 * gamma,
        };
        4.0 / (gamma + (gamma * gamma + 4.0 * omega_squared).sqrt())
    }
}

/// Drag in a pressed crowd relative to a loose crowd, which has a quarter of its density.
const PRESSED_DRAG: f64 = 0.25;
/// Both edges of a corner push an agent in front of it in the same direction.
const EDGES_AT_A_CORNER: f64 = 2.0;

/// The rates that determine the fastest modes of a crowd.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mode {
    /// c/h of the pressure, 1/s.
    pub pressure: f64,
    /// K/m of contact between agents, 1/s².
    pub contact: f64,
    /// Stiffness over mass of a wall and of social forces, 1/s².
    pub other_springs: f64,
    /// Stiffness over mass of a corner, 1/s².
    pub corner: f64,
    /// μ.
    pub viscosity: f64,
    /// K^goal/(τ m), or 1/Δt_coarse for RVO, 1/s.
    pub correction: f64,
}

impl Mode {
    /// The largest rates over all profiles of a scene, for its smallest mass.
    pub fn of(scene: &Scene) -> Self {
        let mass = lightest(scene);
        let mut mode = Self::default();
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
        // A push can override K^goal of any agent.
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
        let social = match profile.navigation {
            Navigation::Social(_, social) => {
                social.agent_strength / social.agent_range.powi(2)
                    + social.wall_strength / social.wall_range.powi(2)
            }
            Navigation::Goal(_) | Navigation::Rvo(_) => 0.0,
        };
        let correction = match profile.navigation {
            Navigation::Goal(goal) | Navigation::Social(goal, _) => {
                goal.goal_scale / goal.relaxation_time / mass
            }
            Navigation::Rvo(_) => 1.0 / PAPER_COARSE_STEP,
        };
        let agents = contact.agent_stiffness.unwrap_or(0.0);
        self.contact = self.contact.max(agents / mass);
        self.other_springs = self.other_springs.max((wall + social) / mass);
        self.corner = self.corner.max(EDGES_AT_A_CORNER * wall / mass);
        self.viscosity = self.viscosity.max(viscosity);
        self.correction = self.correction.max(correction);
    }

    /// The step by the formula, without margin, seconds.
    pub fn largest_step(&self, scheme: Scheme, constants: &Constants) -> f64 {
        let springs = (constants.contact * self.contact).max(self.other_springs);
        let pressed = (constants.pressure * self.pressure).powi(2) + springs;
        let drag = constants.drag * self.viscosity;
        let steps = [
            scheme.largest_step(pressed, PRESSED_DRAG * drag + self.correction),
            scheme.largest_step(self.corner, self.correction),
            scheme.largest_step(0.0, drag + self.correction),
            PAPER_COARSE_STEP,
        ];
        steps.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The step that `auto` takes, seconds: the formula's step times the margin, rounded down to three digits.
    pub fn time_step(&self, scheme: Scheme) -> f64 {
        three_digits(FITTED.margin(scheme) * self.largest_step(scheme, &FITTED))
    }
}

/// The step that `auto` takes, seconds; `None` if there is no formula for the scene's integrator.
pub fn time_step(scene: &Scene) -> Option<f64> {
    let scheme = Scheme::of(scene.integrator)?;
    Some(Mode::of(scene).time_step(scheme))
}

/// `value`, rounded down to three significant digits.
fn three_digits(value: f64) -> f64 {
    let digit = 10_f64.powf(value.log10().floor() - 2.0);
    // Formatting to three digits and parsing removes the rounding error of the division.
    let rounded = (value / digit + 1e-9).floor() * digit;
    format!("{rounded:.2e}").parse().unwrap_or(rounded)
}

/// The smallest mass that an agent of the scene has or may be assigned.
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

/// The smallest τ of all goal forces, seconds; the paper's τ if there is none.
fn shortest_relaxation(scene: &Scene) -> f64 {
    let profiles = scene.groups.iter().flat_map(|group| group.blend.steps());
    let times = profiles.filter_map(|step| match step.profile.navigation {
        Navigation::Goal(goal) | Navigation::Social(goal, _) => Some(goal.relaxation_time),
        Navigation::Rvo(_) => None,
    });
    let paper = crate::engine::forces::goal::GoalForce::default().relaxation_time;
    times.reduce(f64::min).unwrap_or(paper)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::*;

    /// The linear map of one frame, acting on x, the velocity that forces see and the previous acceleration.
    fn frame(scheme: Scheme, omega_squared: f64, gamma: f64, dt: f64) -> Matrix3<f64> {
        let moved = |x: f64, seen: f64, before: f64| {
            let a = -omega_squared * x - gamma * seen;
            let (way, velocity) = match scheme {
                Scheme::SemiImplicit => (seen + a * dt, seen + a * dt),
                Scheme::VelocityVerlet => {
                    let v = seen + 0.5 * dt * (a - before);
                    (v + 0.5 * dt * a, v + dt * a)
                }
            };
            Vector3::new(x + way * dt, velocity, a)
        };
        let columns = [
            moved(1.0, 0.0, 0.0),
            moved(0.0, 1.0, 0.0),
            moved(0.0, 0.0, 1.0),
        ];
        Matrix3::from_columns(&columns)
    }

    /// The spectral radius of the map of one frame, from the growth over 2⁴⁰ frames.
    fn growth(mut frames: Matrix3<f64>) -> f64 {
        let (mut logarithm, mut count) = (0.0, 1.0);
        for _ in 0..40 {
            let norm = frames.norm();
            logarithm += norm.ln() / count;
            frames = (frames / norm).pow(2);
            count *= 2.0;
        }
        logarithm.exp()
    }

    #[test]
    fn the_step_is_where_an_oscillator_begins_to_grow() {
        for scheme in [Scheme::SemiImplicit, Scheme::VelocityVerlet] {
            for (omega_squared, gamma) in [
                (1.0, 0.0),
                (1.0, 1.0),
                (700.0, 2.0),
                (700.0, 30.0),
                (3.0, 90.0),
                (0.0, 5.0),
            ] {
                let step = scheme.largest_step(omega_squared, gamma);
                let growth = |part: f64| growth(frame(scheme, omega_squared, gamma, part * step));
                for part in 1..1000 {
                    let part = f64::from(part) / 1000.0;
                    assert!(
                        growth(part) < 1.0 + 1e-9,
                        "{scheme:?} {omega_squared} {gamma}"
                    );
                }
                assert!(
                    growth(1.001) > 1.0 + 1e-6,
                    "{scheme:?} {omega_squared} {gamma}"
                );
            }
        }
    }

    #[test]
    fn only_integrators_with_a_formula_have_an_automatic_step() {
        let step = |integrator| {
            time_step(&Scene {
                integrator,
                ..Scene::default()
            })
        };
        for integrator in Integrator::ALL {
            let scheme = Scheme::of(integrator);
            assert_eq!(scheme.is_some(), step(integrator).is_some());
            assert!(scheme.is_none_or(|scheme| scheme.integrator() == integrator));
        }
        assert_eq!(step(Integrator::ForwardEuler), None);
        assert_eq!(step(Integrator::Midpoint), None);
    }

    #[test]
    fn steps_are_rounded_down_to_what_is_written() {
        assert_eq!(three_digits(0.017_999), 0.0179);
        assert_eq!(three_digits(0.1), 0.1);
        assert_eq!(three_digits(0.003_21), 0.003_21);
        assert_eq!(three_digits(9.999e-5), 9.99e-5);
    }
}

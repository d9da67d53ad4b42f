//! A formula for the largest stable time step. Its constants are fitted to maps of the largest step at which
//! crowds come to rest (`sandbox stress`, `docs/findings/stability.md`).
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
//!   (`analysis::sound`) and the largest contact stiffness over the smallest mass, K/m. This combines the
//!   Courant condition of SPH with that of springs.
//! - Viscous drag in a loose crowd: γ = C₃ μ. Every neighbor contributes μ ∇²W/ρ² to the drag on an agent. The drag
//!   is largest in a loose crowd, where the density is little more than the agent's own contribution ~ 1/h², so
//!   that h drops out. In a uniform crowd it is proportional to 1/ρ; in a pressed crowd the friction is C₃ μ/4.
//!
//! A corner has its own limit with ω² = 2 K^obs/m, because both of its edges push. Springs of walls and social
//! forces replace C₂ K/m if they are stiffer. All friction includes K^goal/(τ m) of the goal force, or 1/Δt_coarse
//! for RVO. A walking law that looks ahead, with ds/dx its change of speed over distance, adds ω² = 2 K^goal/(τ m)
//! |ds/dx| everywhere: it pulls an agent after the one ahead; if the law anticipates, it adds 2 K^goal/(τ m) |ds/dv| to
//! all friction. Drag adds its γ at twice ρ⁰max to all friction. Legs add A over the shorter of their ranges, where
//! the repulsion is steepest, to the stiffness of contact and of corners, and the larger of their rates to all
//! friction. No step is longer than the paper's Δt_coarse.
//!
//! Every force returns its own [`Rates`]; those on all agents add theirs to those of the profiles.

use crate::agents::{Agents, RADIUS_RANGE, REFERENCE_RADIUS};
use crate::clock::PAPER_COARSE_STEP;
use crate::density::SphParameters;
use crate::forces::goal::GoalForce;
use crate::forces::rates::{Extremes, Rates};
use crate::scene::{Integrator, Scene};
use crate::traits::Traits;
use libm::{log10, pow};

/// C₁ to C₃, and the safety margins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// C₁: frequency of the fastest pressure mode, in units of c/h.
    pub pressure: f64,
    /// C₂: squared frequency of the fastest contact mode, in units of K/m.
    pub contact: f64,
    /// C₃: drag, 1/s, divided by μ.
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
/// A walking law couples an agent to the one ahead: the fastest mode moves both, in opposite directions.
const BOTH_ENDS: f64 = 2.0;

impl Rates {
    /// The largest rates over all profiles of a scene, for its smallest mass, with those of forces on all agents.
    pub fn of(scene: &Scene) -> Self {
        let (mass, speed) = (lightest(scene), fastest(scene));
        let profiles = scene.groups.iter().flat_map(|group| {
            let sph = &group.blend.sph;
            let extremes = Extremes { mass, speed, sph };
            let steps = group.blend.steps().iter();
            steps.map(move |step| step.profile.rates(&extremes))
        });
        let profiles = profiles.filter(|_| !scene.is_replaced());
        let mut rates = profiles.fold(Self::default(), Self::max);
        // A push can override K^goal of any agent.
        let pushes = scene.pushes.iter();
        let strongest = pushes
            .filter_map(|push| push.change.goal_scale)
            .fold(0.0, f64::max);
        rates.correction = rates
            .correction
            .max(strongest / shortest_relaxation(scene) / mass);
        let sph = &SphParameters::default();
        let extremes = Extremes { mass, speed, sph };
        let own = scene.own_forces.iter().map(|force| force.rates(&extremes));
        own.fold(rates, Self::plus)
    }

    /// The step by the formula, without margin, seconds.
    pub fn largest_step(&self, scheme: Scheme, constants: &Constants) -> f64 {
        let springs = (constants.contact * self.contact).max(self.other_springs);
        let law = BOTH_ENDS * self.steepness * self.correction;
        let everywhere = law + self.everywhere;
        let pressed = (constants.pressure * self.pressure).powi(2) + springs + everywhere;
        let drag = constants.drag * self.viscosity;
        let following = BOTH_ENDS * self.damping * self.correction;
        let friction = self.correction + self.friction + following;
        let steps = [
            scheme.largest_step(pressed, PRESSED_DRAG * drag + friction),
            scheme.largest_step(self.corner + everywhere, friction),
            scheme.largest_step(self.everywhere, drag + friction),
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
    Some(Rates::of(scene).time_step(scheme))
}

/// `value`, rounded down to three significant digits.
pub fn three_digits(value: f64) -> f64 {
    let digit = pow(10_f64, log10(value).floor() - 2.0);
    // Formatting to three digits and parsing removes the rounding error of the division.
    let rounded = (value / digit + 1e-9).floor() * digit;
    format!("{rounded:.2e}").parse().unwrap_or(rounded)
}

/// The share of drawn radii and masses that may be smaller than assumed: a normal distribution has no smallest radius.
const RARE: f64 = 1e-6;

/// The smallest mass that an agent of the scene has or may be assigned.
fn lightest(scene: &Scene) -> f64 {
    let of_radius = |radius: f64| (radius / REFERENCE_RADIUS).powi(2);
    let drawn = of_radius(RADIUS_RANGE[0]);
    let of_groups = scene.groups.iter().map(|group| {
        let Traits { radius, mass, .. } = &group.traits;
        match (mass, radius) {
            (Some(mass), _) => mass.quantile(RARE),
            (None, Some(radius)) => of_radius(radius.quantile(RARE)),
            (None, None) => drawn,
        }
    });
    let of_groups: Vec<f64> = of_groups.collect();
    let of_group = |group: u16| of_groups[usize::from(group)];
    let given = scene.agents.iter().map(|agent| {
        let own_mass = &scene.groups[usize::from(agent.group)].traits.mass;
        let radius = agent.radius.filter(|_| own_mass.is_none());
        (agent.mass.or(radius.map(of_radius))).unwrap_or_else(|| of_group(agent.group))
    });
    let sources = scene.sources.iter().map(|source| source.group);
    let entrances = scene.entrances.iter().map(|entrance| entrance.group);
    let late = scene.scheduled.iter().map(|late| late.agent.group);
    let entering = sources.chain(entrances).chain(late).map(of_group);
    given.chain(entering).reduce(f64::min).unwrap_or(drawn)
}

/// The highest preferred speed that an agent of the scene has or may be assigned, m/s.
fn fastest(scene: &Scene) -> f64 {
    let drawn = scene.groups.iter().filter_map(|group| {
        let speed = group.traits.preferred_speed.as_ref();
        speed.map(|speed| speed.quantile(1.0 - RARE))
    });
    let given = scene
        .agents
        .iter()
        .filter_map(|agent| agent.preferred_speed);
    let own = drawn.chain(given).fold(0.0, f64::max);
    own.max(scene.highest_pace(&Agents::default()))
}

/// The smallest τ of all goal forces, seconds; the paper's τ if there is none.
fn shortest_relaxation(scene: &Scene) -> f64 {
    let goals = (scene.profiles()).filter_map(|profile| profile.navigation.goal());
    let times = goals.map(|goal| goal.relaxation_time);
    let paper = GoalForce::default().relaxation_time;
    times.reduce(f64::min).unwrap_or(paper)
}

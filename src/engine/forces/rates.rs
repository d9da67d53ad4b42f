//! The rates by which forces limit the time step: each force returns its own, and `engine/stability.rs` computes the
//! largest stable step from them.

use crate::density::SphParameters;

/// The rates that determine the fastest modes of a crowd.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates {
    /// c/h of the pressure, 1/s.
    pub pressure: f64,
    /// K/m of contact between agents, 1/s².
    pub contact: f64,
    /// Stiffness over mass of a wall and of social forces, 1/s².
    pub other_springs: f64,
    /// Stiffness over mass of a corner, 1/s².
    pub corner: f64,
    /// μ, 1/s.
    pub viscosity: f64,
    /// K^goal/(τ m), or 1/Δt_coarse for RVO, 1/s.
    pub correction: f64,
    /// The steepest walking law: speed per distance, 1/s.
    pub steepness: f64,
    /// The derivative of the speed that a walking law gives an agent with respect to the speed of the agent ahead.
    pub damping: f64,
    /// Stiffness over mass that acts on all agents, in addition to the other springs, 1/s².
    pub everywhere: f64,
    /// The friction on all agents in the densest crowds, 1/s.
    pub friction: f64,
}

/// The parameters and extremes of a scene on which the rates of a force depend.
#[derive(Debug, Clone, Copy)]
pub struct Extremes<'a> {
    /// The smallest mass.
    pub mass: f64,
    /// The highest preferred speed, m/s.
    pub speed: f64,
    /// The parameters of SPH.
    pub sph: &'a SphParameters,
}

impl Rates {
    /// The rates of two forces that act on the same agents.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        self.combined(other, |one, two| one + two)
    }

    /// The larger ones of the rates of two crowds.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.combined(other, f64::max)
    }

    fn combined(self, other: Self, of_two: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            pressure: of_two(self.pressure, other.pressure),
            contact: of_two(self.contact, other.contact),
            other_springs: of_two(self.other_springs, other.other_springs),
            corner: of_two(self.corner, other.corner),
            viscosity: of_two(self.viscosity, other.viscosity),
            correction: of_two(self.correction, other.correction),
            steepness: of_two(self.steepness, other.steepness),
            damping: of_two(self.damping, other.damping),
            everywhere: of_two(self.everywhere, other.everywhere),
            friction: of_two(self.friction, other.friction),
        }
    }
}

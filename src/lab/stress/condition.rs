//! The conditions under which every point of the maps is tested.

use engine::boundary::WallMethod;
use engine::stability::Scheme;

/// The wall method, and the integration scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condition {
    /// Its name.
    pub name: &'static str,
    /// How walls enter SPH.
    pub walls: WallMethod,
    /// The integration scheme.
    pub scheme: Scheme,
}

impl Condition {
    /// The paper's walls and semi-implicit Euler.
    pub const PAPER: Self = Self {
        name: "paper",
        walls: WallMethod::Representative,
        scheme: Scheme::SemiImplicit,
    };
    /// Exact walls, between which more crowds come to rest.
    pub const EXACT_WALLS: Self = Self {
        name: "exact walls",
        walls: WallMethod::Union,
        ..Self::PAPER
    };
    /// The paper's walls and velocity Verlet.
    pub const VERLET: Self = Self {
        name: "Verlet",
        scheme: Scheme::VelocityVerlet,
        ..Self::PAPER
    };
    /// All conditions, the paper's first.
    pub const ALL: [Self; 3] = [Self::PAPER, Self::EXACT_WALLS, Self::VERLET];
}

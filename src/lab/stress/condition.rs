//! Under what every place of the maps is looked at.

use crate::engine::boundary::WallMethod;
use crate::engine::stability::Scheme;

/// Walls and how people are moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condition {
    /// What it is called.
    pub name: &'static str,
    /// How walls enter SPH.
    pub walls: WallMethod,
    /// What moves people.
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
    /// All of them, the paper's first.
    pub const ALL: [Self; 3] = [Self::PAPER, Self::EXACT_WALLS, Self::VERLET];
}

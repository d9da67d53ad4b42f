//! Distributions of the properties of agents.

use rand::Rng;

/// A distribution of a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// Always this number.
    Constant(f64),
}

impl Distribution {
    /// One value.
    pub fn draw(&self, _random: &mut impl Rng) -> f64 {
        match self {
            Self::Constant(value) => *value,
        }
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Constant(value) => *value,
        }
    }
}

//! The terms of an agent's acceleration.

use crate::math::Vector;

/// Declares the terms: each is one line here, in the order of the simulation loop.
macro_rules! terms {
    ($($(#[$about:meta])* $Term:ident = $name:literal,)*) => {
        /// A term of an agent's acceleration.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Term {
            $($(#[$about])* $Term,)*
        }

        impl Term {
            /// Every term, in the order of the simulation loop.
            pub const ALL: &[Self] = &[$(Self::$Term),*];

            /// The name of the term in breakdowns and recordings.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Term => $name,)*
                }
            }
        }
    };
}

terms! {
    /// Eq. 17.
    Goal = "goal",
    /// The reduction of the speed by a walking law.
    Walking = "walking",
    /// Eq. 18.
    SocialAgents = "social_agents",
    /// Eq. 19.
    SocialWalls = "social_walls",
    /// Eq. 21.
    Rvo = "rvo",
    /// Eq. 11.
    PressureAgents = "pressure_agents",
    /// Eq. 12.
    PressureWalls = "pressure_walls",
    /// Eq. 7.
    Viscosity = "viscosity",
    /// Eq. 22.
    ContactAgents = "contact_agents",
    /// Eq. 23.
    ContactWalls = "contact_walls",
}

impl Term {
    /// Whether the term comes from walls.
    pub fn is_of_walls(self) -> bool {
        self.name().ends_with("_walls")
    }
}

/// Accelerations of one agent by one profile, term by term, m/s².
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Terms {
    values: [Option<Vector>; Term::ALL.len()],
    /// The terms of the profile's forces that are no terms of the paper: their names, and accelerations in m/s².
    pub own: Vec<(String, Vector)>,
}

impl Terms {
    /// The value of one term, m/s²; `None` if the profile has no such term.
    pub fn get(&self, term: Term) -> Option<Vector> {
        self.values[term as usize]
    }

    /// Sets the value of a term, m/s².
    pub fn set(&mut self, term: Term, value: Option<Vector>) {
        self.values[term as usize] = value;
    }

    /// Sets a term to zero if it has no value yet.
    pub fn set_zero_if_none(&mut self, term: Term) {
        self.values[term as usize].get_or_insert(Vector::zeros());
    }

    /// The names and values of the terms that the profile has, in the order of the simulation loop.
    pub fn listed(&self) -> impl Iterator<Item = (&str, Vector)> {
        let built_in = Term::ALL
            .iter()
            .filter_map(|&term| Some((term.name(), self.get(term)?)));
        built_in.chain(self.own.iter().map(|(name, value)| (&name[..], *value)))
    }

    /// The profile's acceleration, m/s².
    pub fn sum(&self) -> Vector {
        self.listed().map(|(_, value)| value).sum()
    }
}

//! The terms of an agent's acceleration.

use crate::math::Vector;

/// Accelerations of one agent by one profile, term by term, m/s²; `None` if the profile has no such term.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// Eq. 17.
    pub goal: Option<Vector>,
    /// The reduction of the speed by a walking law.
    pub walking: Option<Vector>,
    /// Eq. 18.
    pub social_agents: Option<Vector>,
    /// Eq. 19.
    pub social_walls: Option<Vector>,
    /// Eq. 21.
    pub rvo: Option<Vector>,
    /// Eq. 11.
    pub pressure_agents: Option<Vector>,
    /// Eq. 12.
    pub pressure_walls: Option<Vector>,
    /// Eq. 7.
    pub viscosity: Option<Vector>,
    /// Eq. 22.
    pub contact_agents: Option<Vector>,
    /// Eq. 23.
    pub contact_walls: Option<Vector>,
    /// The fall of a body that leans.
    pub balance: Option<Vector>,
    /// The repulsion of bodies.
    pub body_agents: Option<Vector>,
    /// The repulsion of bodies by walls.
    pub body_walls: Option<Vector>,
}

/// A term of an agent's acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Eq. 17.
    Goal,
    /// The reduction of the speed by a walking law.
    Walking,
    /// Eq. 18.
    SocialAgents,
    /// Eq. 19.
    SocialWalls,
    /// Eq. 21.
    Rvo,
    /// Eq. 11.
    PressureAgents,
    /// Eq. 12.
    PressureWalls,
    /// Eq. 7.
    Viscosity,
    /// Eq. 22.
    ContactAgents,
    /// Eq. 23.
    ContactWalls,
    /// The fall of a body that leans.
    Balance,
    /// The repulsion of bodies.
    BodyAgents,
    /// The repulsion of bodies by walls.
    BodyWalls,
}

impl Term {
    /// Every term, in the order of the simulation loop.
    pub fn all() -> impl Iterator<Item = Self> {
        Terms::default().listed().into_iter().map(|(term, _)| term)
    }

    /// The name of the term in breakdowns and recordings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Goal => "goal",
            Self::Walking => "walking",
            Self::SocialAgents => "social_agents",
            Self::SocialWalls => "social_walls",
            Self::Rvo => "rvo",
            Self::PressureAgents => "pressure_agents",
            Self::PressureWalls => "pressure_walls",
            Self::Viscosity => "viscosity",
            Self::ContactAgents => "contact_agents",
            Self::ContactWalls => "contact_walls",
            Self::Balance => "balance",
            Self::BodyAgents => "body_agents",
            Self::BodyWalls => "body_walls",
        }
    }

    /// Whether the term comes from walls.
    pub fn is_of_walls(self) -> bool {
        matches!(
            self,
            Self::SocialWalls | Self::PressureWalls | Self::ContactWalls | Self::BodyWalls
        )
    }
}

impl Terms {
    /// Every term with its value, in the order of the simulation loop. Destructuring makes a forgotten field a
    /// compile error, and so does every `match` on [`Term`].
    pub fn listed(&self) -> [(Term, Option<Vector>); 13] {
        let Self {
            goal,
            walking,
            social_agents,
            social_walls,
            rvo,
            pressure_agents,
            pressure_walls,
            viscosity,
            contact_agents,
            contact_walls,
            balance,
            body_agents,
            body_walls,
        } = *self;
        [
            (Term::Goal, goal),
            (Term::Walking, walking),
            (Term::SocialAgents, social_agents),
            (Term::SocialWalls, social_walls),
            (Term::Rvo, rvo),
            (Term::PressureAgents, pressure_agents),
            (Term::PressureWalls, pressure_walls),
            (Term::Viscosity, viscosity),
            (Term::ContactAgents, contact_agents),
            (Term::ContactWalls, contact_walls),
            (Term::Balance, balance),
            (Term::BodyAgents, body_agents),
            (Term::BodyWalls, body_walls),
        ]
    }

    /// The value of one term, m/s².
    pub fn get(&self, term: Term) -> Option<Vector> {
        let listed = self.listed().into_iter();
        listed
            .filter(|&(other, _)| other == term)
            .find_map(|(_, value)| value)
    }

    /// The profile's acceleration, m/s².
    pub fn sum(&self) -> Vector {
        self.listed()
            .into_iter()
            .filter_map(|(_, value)| value)
            .sum()
    }
}

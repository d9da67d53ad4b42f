//! Profiles (§5.5) and their blending by density (§4.4).
//!
//! Plain form: `terms` and `profile` in `examples/paper.rs`.

mod blend;
mod terms;
mod walls;

pub use blend::{Blend, BlendError, BlendStep};
pub use terms::{Term, Terms};

use std::ops::Range;

use crate::forces::contact::{self, Contact};
use crate::forces::goal::GoalForce;
use crate::forces::legs::Legs;
use crate::forces::near::{self, PairCoefficients, Wanted};
use crate::forces::pressure;
use crate::forces::rates::{Extremes, Rates};
use crate::forces::rvo::Rvo;
use crate::forces::social::SocialForce;
use crate::forces::viscosity::Viscosity;
use crate::forces::walking::WalkingLaw;
use crate::frame::Frame;
use crate::math::Vector;
use crate::neighbors::BLOCK;

/// Steps 3, 3B and 4 for one agent: how it navigates, and which forces act on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Name in reports.
    pub name: String,
    /// Step 3.
    pub navigation: Navigation,
    /// Step 3: the law by which the crowd slows its walk; `None` in the paper's profiles.
    pub walking: Option<WalkingLaw>,
    /// Step 3B, pressure; `false` in a profile without SPH, and if k = 0.
    pub pressure: bool,
    /// Step 3B, viscosity; `None` in a profile without SPH, and if μ = 0.
    pub viscosity: Option<Viscosity>,
    /// Step 4.
    pub contact: Contact,
    /// The legs under the body; `None` in the paper's profiles.
    pub legs: Option<Legs>,
}

/// Step 3: how an agent finds its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Navigation {
    /// Straight to the goal.
    Goal(GoalForce),
    /// Goal force and social forces (§5.3.1).
    Social(GoalForce, SocialForce),
    /// Velocity obstacles (§5.3.2); their cost includes the preferred velocity.
    Rvo(Rvo),
}

impl Navigation {
    /// The goal force, if there is one.
    pub fn goal(&self) -> Option<GoalForce> {
        match *self {
            Self::Goal(goal) | Self::Social(goal, _) => Some(goal),
            Self::Rvo(_) => None,
        }
    }

    /// The social force, if there is one.
    pub fn social(&self) -> Option<SocialForce> {
        match *self {
            Self::Social(_, social) => Some(social),
            _ => None,
        }
    }

    /// The avoidance radius, meters; `None` without avoidance.
    pub fn avoidance_radius(&self) -> Option<f64> {
        match self {
            Self::Goal(_) => None,
            Self::Social(_, social) => Some(social.avoidance_radius),
            Self::Rvo(rvo) => Some(rvo.avoidance_radius),
        }
    }

    fn rates(&self, of: &Extremes) -> Rates {
        match self {
            Self::Goal(goal) => goal.rates(of),
            Self::Social(goal, social) => goal.rates(of).plus(social.rates(of)),
            Self::Rvo(rvo) => rvo.rates(),
        }
    }
}

/// Changes for the agents that take part in a push (§6.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Override {
    /// K^goal instead of the profile's.
    pub goal_scale: Option<f64>,
    /// Ignore contact forces.
    pub ignore_contact: bool,
    /// Ignore SPH forces.
    pub ignore_sph: bool,
}

impl Profile {
    /// The sums over near agents that this profile reads.
    pub fn wanted(&self) -> Wanted {
        Wanted {
            pressure: self.pressure,
            viscosity: self.viscosity.is_some(),
            contact: self.contact.agent_stiffness.is_some(),
            legs: self.legs.is_some_and(|legs| legs.legs_strength != 0.0),
        }
    }

    /// The rates by which the forces of this profile limit the time step. Destructuring makes a forgotten force a
    /// compile error.
    pub fn rates(&self, of: &Extremes) -> Rates {
        let Self {
            name: _,
            navigation,
            walking,
            pressure,
            viscosity,
            contact,
            legs,
        } = self;
        let forces = [
            Some(navigation.rates(of)),
            walking.map(|law| law.rates(of)),
            pressure.then(|| pressure::rates(of.sph)),
            viscosity.map(|viscosity| viscosity.rates()),
            Some(contact.rates(of)),
            legs.map(|legs| legs.rates(of)),
        ];
        forces
            .into_iter()
            .flatten()
            .fold(Rates::default(), Rates::plus)
    }

    /// Whether this profile has `term`, given agents and walls.
    pub fn has(&self, term: Term) -> bool {
        let social = matches!(self.navigation, Navigation::Social(..));
        let rvo = matches!(self.navigation, Navigation::Rvo(_));
        match term {
            Term::Goal => !rvo,
            Term::Walking => self.walking.is_some_and(|law| !(rvo && law.looks_ahead())),
            Term::SocialAgents | Term::SocialWalls => social,
            Term::Rvo => rvo,
            Term::PressureAgents | Term::PressureWalls => self.pressure,
            Term::Viscosity => self.viscosity.is_some(),
            Term::ContactAgents => self.contact.agent_stiffness.is_some(),
            Term::ContactWalls => self.contact.wall_stiffness.is_some(),
            Term::Balance => self.legs.is_some(),
            Term::BodyAgents | Term::BodyWalls => self.wanted().legs,
        }
    }

    /// Every term of this profile for agent `i` of a frozen frame.
    pub fn terms(&self, frame: &Frame, i: usize, changed: Option<&Override>) -> Terms {
        let mut terms = Terms::default();
        self.each_term(frame, i..i + 1, changed, |place, _, term| {
            *place(&mut terms) = Some(term);
        });
        let mut felt = PairCoefficients::default();
        self.add_pair_coefficients(frame, i..i + 1, changed, 1.0, &mut felt);
        let [pressure, viscosity, contact] = near::accelerations_of(frame, i, &felt);
        if feels_sph(changed) {
            if self.pressure {
                terms.pressure_agents = Some(pressure);
                terms.pressure_walls.get_or_insert(Vector::zeros());
            }
            terms.viscosity = self.viscosity.map(|_| viscosity);
        }
        if let Some(social) = self.navigation.social() {
            terms.social_agents = Some(social.from_agents(frame, i));
        }
        if feels_contact(changed) {
            terms.contact_agents = self.contact.agent_stiffness.map(|_| contact);
            if self.contact.wall_stiffness.is_some() {
                terms.contact_walls.get_or_insert(Vector::zeros());
            }
        }
        if let Some(legs) = self.legs {
            terms.balance = Some(legs.balance(frame, i).body);
            if self.wanted().legs {
                let near = frame.neighbors.near_walls(i);
                terms.body_agents = Some(near::repulsion_of(frame, i).body);
                terms.body_walls = Some(legs.from_walls(frame, i, near).body);
            }
        }
        terms
    }

    /// Adds the coefficients of this profile for sums over near agents, times `weight`, for `agents` of one block of a
    /// frozen frame.
    fn add_pair_coefficients(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        changed: Option<&Override>,
        weight: f64,
        coefficients: &mut PairCoefficients,
    ) {
        let first = agents.start % BLOCK;
        let places = first..first + agents.len();
        if feels_sph(changed) && self.pressure {
            let coefficients = &mut coefficients.pressure[places.clone()];
            pressure::add_coefficients(frame, agents.clone(), weight, coefficients);
        }
        if let Some(viscosity) = self.viscosity
            && feels_sph(changed)
        {
            let coefficients = &mut coefficients.viscosity[places.clone()];
            viscosity.add_coefficients(frame, agents.clone(), weight, coefficients);
        }
        if let Some(stiffness) = self.contact.agent_stiffness
            && feels_contact(changed)
        {
            let coefficients = &mut coefficients.contact[places];
            contact::add_coefficients(frame, agents, weight * stiffness, coefficients);
        }
    }

    /// Passes `take` all terms of `agents` that do not depend on other agents: the field of [`Terms`], the agent and
    /// the acceleration, m/s². Passes SPH and contact terms of walls only for agents near walls.
    #[inline]
    fn each_term(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        changed: Option<&Override>,
        mut take: impl FnMut(fn(&mut Terms) -> &mut Option<Vector>, usize, Vector),
    ) {
        let goal = self.navigation.goal();
        let goal = goal.map(|goal| changed_goal(goal, changed));
        if let Some(goal) = goal {
            goal.accelerations(frame, agents.clone(), |i, a| take(|t| &mut t.goal, i, a));
        }
        match self.navigation {
            Navigation::Goal(_) => {}
            Navigation::Social(_, social) => {
                for i in agents.clone() {
                    take(|t| &mut t.social_walls, i, social.from_walls(frame, i));
                }
            }
            Navigation::Rvo(_) => {
                for i in agents.clone() {
                    if let Some(held) = frame.agents.avoidance[i] {
                        take(|t| &mut t.rvo, i, held);
                    }
                }
            }
        }
        match (self.walking, goal) {
            (Some(WalkingLaw::Drag(drag)), _) => {
                for i in agents.clone() {
                    take(|t| &mut t.walking, i, drag.acceleration(frame, i));
                }
            }
            (Some(law), Some(goal)) => {
                let rate = goal.rate();
                let lost = law.lost_velocities(frame, agents.clone());
                for (i, lost) in agents.clone().zip(lost) {
                    take(|t| &mut t.walking, i, lost * (rate / frame.agents.mass[i]));
                }
            }
            _ => {}
        }
        if self.pressure && feels_sph(changed) {
            for (i, _) in frame.neighbors.agents_near_walls(agents.clone()) {
                let gradient = frame.fields.wall_gradient[i];
                let push = pressure::from_walls(frame, i, gradient);
                take(|t| &mut t.pressure_walls, i, push);
            }
        }
        if self.contact.wall_stiffness.is_some() && feels_contact(changed) {
            for (i, near) in frame.neighbors.agents_near_walls(agents) {
                let push = contact::from_walls(frame, i, near, &self.contact);
                take(|t| &mut t.contact_walls, i, push);
            }
        }
    }
}

/// The goal force, with K^goal replaced if a push overrides it.
fn changed_goal(goal: GoalForce, changed: Option<&Override>) -> GoalForce {
    let goal_scale = changed.and_then(|change| change.goal_scale);
    GoalForce {
        goal_scale: goal_scale.unwrap_or(goal.goal_scale),
        ..goal
    }
}

fn feels_sph(changed: Option<&Override>) -> bool {
    !changed.is_some_and(|change| change.ignore_sph)
}

fn feels_contact(changed: Option<&Override>) -> bool {
    !changed.is_some_and(|change| change.ignore_contact)
}

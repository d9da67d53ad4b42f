//! Profiles (§5.5) and their blending by density (§4.4).
//!
//! Plain form: `terms` and `profile` in `examples/paper.rs`.

mod blend;
mod terms;
mod walls;

pub use crate::density::SphParameters;
pub use blend::{Blend, BlendError, BlendStep};
pub use terms::{Term, Terms};

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::forces::contact::{self, Contact};
use crate::forces::goal::GoalForce;
use crate::forces::near::{self, PairCoefficients, Wanted};
use crate::forces::own::Force;
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
    /// Forces in addition to those of the paper; none in the paper's profiles.
    pub forces: Vec<Arc<dyn Force>>,
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    #[doc(hidden)]
    pub fn wanted(&self) -> Wanted {
        Wanted {
            pressure: self.pressure,
            viscosity: self.viscosity.is_some(),
            contact: self.contact.agent_stiffness.is_some(),
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
            forces,
        } = self;
        let of_paper = [
            Some(navigation.rates(of)),
            walking.map(|law| law.rates(of)),
            pressure.then(|| pressure::rates(of.sph)),
            viscosity.map(|viscosity| viscosity.rates()),
            Some(contact.rates(of)),
        ];
        let others = forces.iter().map(|force| force.rates(of));
        let all = of_paper.into_iter().flatten().chain(others);
        all.fold(Rates::default(), Rates::plus)
    }

    /// Whether this profile has `term`, given agents and walls.
    pub fn has(&self, term: Term) -> bool {
        let social = matches!(self.navigation, Navigation::Social(..));
        let rvo = matches!(self.navigation, Navigation::Rvo(_));
        match term {
            Term::Goal => !rvo,
            Term::Walking => self.walking.is_some() && !rvo,
            Term::SocialAgents | Term::SocialWalls => social,
            Term::Rvo => rvo,
            Term::PressureAgents | Term::PressureWalls => self.pressure,
            Term::Viscosity => self.viscosity.is_some(),
            Term::ContactAgents => self.contact.agent_stiffness.is_some(),
            Term::ContactWalls => self.contact.wall_stiffness.is_some(),
        }
    }

    /// Every term of this profile for agent `i` of a frozen frame.
    pub fn terms(&self, frame: &Frame, i: usize, changed: Option<&Override>) -> Terms {
        let mut terms = Terms::default();
        self.each_term(frame, i..i + 1, changed, |term, _, value| {
            terms.set(term, Some(value));
        });
        let mut felt = PairCoefficients::default();
        self.add_pair_coefficients(frame, i..i + 1, changed, 1.0, &mut felt);
        let [pressure, viscosity, contact] = near::accelerations_of(frame, i, &felt);
        if feels_sph(changed) {
            if self.pressure {
                terms.set(Term::PressureAgents, Some(pressure));
                terms.set_zero_if_none(Term::PressureWalls);
            }
            terms.set(Term::Viscosity, self.viscosity.map(|_| viscosity));
        }
        if let Some(social) = self.navigation.social() {
            terms.set(Term::SocialAgents, Some(social.from_agents(frame, i)));
        }
        if feels_contact(changed) {
            let stiffness = self.contact.agent_stiffness;
            terms.set(Term::ContactAgents, stiffness.map(|_| contact));
            if self.contact.wall_stiffness.is_some() {
                terms.set_zero_if_none(Term::ContactWalls);
            }
        }
        for force in &self.forces {
            let names = force.term_names().into_iter().map(str::to_owned);
            terms.own.extend(names.zip(force.terms(frame, i)));
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

    /// Passes `take` all terms of the paper that do not depend on other agents: the term, the agent and the
    /// acceleration, m/s². Passes SPH and contact terms of walls only for agents near walls.
    #[inline]
    fn each_term(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        changed: Option<&Override>,
        mut take: impl FnMut(Term, usize, Vector),
    ) {
        let goal = self.navigation.goal();
        let goal = goal.map(|goal| changed_goal(goal, changed));
        if let Some(goal) = goal {
            goal.accelerations(frame, agents.clone(), |i, a| take(Term::Goal, i, a));
        }
        match self.navigation {
            Navigation::Goal(_) => {}
            Navigation::Social(_, social) => {
                for i in agents.clone() {
                    take(Term::SocialWalls, i, social.from_walls(frame, i));
                }
            }
            Navigation::Rvo(_) => {
                for i in agents.clone() {
                    if let Some(held) = frame.agents.avoidance[i] {
                        take(Term::Rvo, i, held);
                    }
                }
            }
        }
        if let (Some(law), Some(goal)) = (self.walking, goal) {
            let rate = goal.rate();
            let mut lost = [Vector::zeros(); BLOCK];
            law.lost_velocities(frame, agents.clone(), &mut lost[..agents.len()]);
            for (i, lost) in agents.clone().zip(lost) {
                take(Term::Walking, i, lost * (rate / frame.agents.mass[i]));
            }
        }
        if self.pressure && feels_sph(changed) {
            for (i, _) in frame.neighbors.agents_near_walls(agents.clone()) {
                let gradient = frame.fields.wall_gradient[i];
                let push = pressure::from_walls(frame, i, gradient);
                take(Term::PressureWalls, i, push);
            }
        }
        if self.contact.wall_stiffness.is_some() && feels_contact(changed) {
            for (i, near) in frame.neighbors.agents_near_walls(agents) {
                let push = contact::from_walls(frame, i, near, &self.contact);
                take(Term::ContactWalls, i, push);
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

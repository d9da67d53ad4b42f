//! Profiles and their blending by density (§4.4, §5.5).

use crate::density::SphParameters;
use crate::forces::contact::{self, Contact};
use crate::forces::goal::GoalForce;
use crate::forces::pressure;
use crate::forces::rvo::Rvo;
use crate::forces::social::SocialForce;
use crate::forces::viscosity::Viscosity;
use crate::frame::Frame;
use crate::math::Vector;
use crate::pairs::PairSums;

/// Steps 3, 3B and 4 for one agent: how it navigates, and which interactions it feels.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// What it is called in reports.
    pub name: String,
    /// Step 3.
    pub navigation: Navigation,
    /// Step 3B, pressure; switched off in a profile without SPH, and where k = 0.
    pub pressure: bool,
    /// Step 3B, viscosity; `None` in a profile without SPH, and where μ = 0.
    pub viscosity: Option<Viscosity>,
    /// Step 4.
    pub contact: Contact,
}

/// Step 3: how an agent finds its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Navigation {
    /// Straight to the goal.
    Goal(GoalForce),
    /// Goal force and social forces (§5.3.1).
    Social(GoalForce, SocialForce),
    /// Velocity obstacles (§5.3.2); the preferred velocity is in the cost.
    Rvo(Rvo),
}

impl Navigation {
    /// How far this way of avoiding others looks, metres.
    pub fn avoidance_radius(&self) -> Option<f64> {
        match self {
            Self::Goal(_) => None,
            Self::Social(_, social) => Some(social.avoidance_radius),
            Self::Rvo(rvo) => Some(rvo.avoidance_radius),
        }
    }
}

/// What a push changes for the agents that take part (§6.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Override {
    /// K^goal instead of the profile's.
    pub goal_scale: Option<f64>,
    /// Feel no contact force.
    pub ignore_contact: bool,
    /// Feel no SPH force.
    pub ignore_sph: bool,
}

/// One profile's accelerations of one agent, term by term, m/s²; `None`: the profile has no such term.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// Eq. 17.
    pub goal: Option<Vector>,
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
}

impl Terms {
    /// Every term with its name, in the order of the simulation loop.
    pub fn named(&self) -> [(&'static str, Option<Vector>); 9] {
        [
            ("goal", self.goal),
            ("social_agents", self.social_agents),
            ("social_walls", self.social_walls),
            ("rvo", self.rvo),
            ("pressure_agents", self.pressure_agents),
            ("pressure_walls", self.pressure_walls),
            ("viscosity", self.viscosity),
            ("contact_agents", self.contact_agents),
            ("contact_walls", self.contact_walls),
        ]
    }

    /// The profile's acceleration, m/s².
    pub fn sum(&self) -> Vector {
        let [mut sum, none] = [Vector::zeros(); 2];
        // One by one: no array of names where every agent passes in every frame.
        sum += self.goal.unwrap_or(none);
        sum += self.social_agents.unwrap_or(none) + self.social_walls.unwrap_or(none);
        sum += self.rvo.unwrap_or(none);
        sum += self.pressure_agents.unwrap_or(none) + self.pressure_walls.unwrap_or(none);
        sum += self.viscosity.unwrap_or(none);
        sum + self.contact_agents.unwrap_or(none) + self.contact_walls.unwrap_or(none)
    }
}

impl Profile {
    /// Every term of this profile for agent `i` of a frozen frame.
    #[inline]
    pub fn terms(
        &self,
        frame: &Frame,
        i: usize,
        sums: &PairSums,
        changed: Option<&Override>,
    ) -> Terms {
        let mut terms = Terms::default();
        match self.navigation {
            Navigation::Goal(goal) => terms.goal = Some(goal_term(goal, frame, i, changed)),
            Navigation::Social(goal, social) => {
                terms.goal = Some(goal_term(goal, frame, i, changed));
                terms.social_agents = Some(social.from_agents(frame, i));
                terms.social_walls = Some(social.from_walls(frame, i));
            }
            Navigation::Rvo(_) => terms.rvo = frame.agents.avoidance[i],
        }
        let feels_sph = !changed.is_some_and(|change| change.ignore_sph);
        let feels_contact = !changed.is_some_and(|change| change.ignore_contact);
        if feels_sph {
            if self.pressure {
                terms.pressure_agents = Some(pressure::from_agents(frame, i, sums));
                terms.pressure_walls = Some(pressure::from_walls(frame, i));
            }
            terms.viscosity = self.viscosity.map(|v| v.acceleration(frame, i, sums));
        }
        if feels_contact {
            let (agents, walls) = (self.contact.agent_stiffness, self.contact.wall_stiffness);
            terms.contact_agents = agents.map(|k| contact::from_agents(frame, i, k, sums));
            terms.contact_walls = walls.map(|k| contact::from_walls(frame, i, k));
        }
        terms
    }
}

fn goal_term(goal: GoalForce, frame: &Frame, i: usize, changed: Option<&Override>) -> Vector {
    let goal_scale = changed
        .and_then(|change| change.goal_scale)
        .unwrap_or(goal.goal_scale);
    GoalForce { goal_scale, ..goal }.acceleration(frame, i)
}

/// A sequence {(Π^j, ρ^j)} of profiles in rising order of density, and the SPH parameters they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Blend {
    /// What the whole is called.
    pub name: String,
    /// Density and pressure of an agent with this blend.
    pub sph: SphParameters,
    steps: Vec<BlendStep>,
}

/// One profile of a blend.
#[derive(Debug, Clone, PartialEq)]
pub struct BlendStep {
    /// ρ^j, P/m²: where this profile acts alone.
    pub at_density: f64,
    /// Π^j.
    pub profile: Profile,
}

/// Why a sequence of profiles is not a blend.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BlendError {
    /// There is no profile.
    #[error("a blend needs at least one profile")]
    Empty,
    /// Two densities in the wrong order.
    #[error("densities must rise: {1} P/m² follows {0} P/m²")]
    NotRising(f64, f64),
    /// Two profiles avoid by RVO, each in its own way.
    #[error("profiles of one blend share one velocity of RVO: give them the same RVO parameters")]
    DifferentRvo,
}

impl Blend {
    /// Puts profiles together.
    ///
    /// # Errors
    /// No profile, densities that do not rise, or profiles with different RVO parameters.
    pub fn new(
        name: String,
        sph: SphParameters,
        steps: Vec<BlendStep>,
    ) -> Result<Self, BlendError> {
        if steps.is_empty() {
            return Err(BlendError::Empty);
        }
        for pair in steps.windows(2) {
            let (low, high) = (pair[0].at_density, pair[1].at_density);
            if low.partial_cmp(&high) != Some(std::cmp::Ordering::Less) {
                return Err(BlendError::NotRising(low, high));
            }
        }
        let mut rvos = steps.iter().filter_map(|step| rvo_of(&step.profile));
        if let Some(first) = rvos.next()
            && rvos.any(|other| other != first)
        {
            return Err(BlendError::DifferentRvo);
        }
        Ok(Self { name, sph, steps })
    }

    /// One profile at all densities.
    pub fn single(profile: Profile, sph: SphParameters) -> Self {
        Self {
            name: profile.name.clone(),
            sph,
            steps: vec![BlendStep {
                at_density: 0.0,
                profile,
            }],
        }
    }

    /// The profiles in rising order of density.
    pub fn steps(&self) -> &[BlendStep] {
        &self.steps
    }

    /// Does the behaviour depend on the density?
    pub fn depends_on_density(&self) -> bool {
        self.steps.len() > 1
    }

    /// The RVO parameters of this blend, if any of its profiles avoids by RVO.
    pub fn rvo(&self) -> Option<Rvo> {
        self.steps.iter().find_map(|step| rvo_of(&step.profile))
    }

    /// The profiles that act on agent `i` of a frozen frame, with their weights, which sum to 1.
    #[inline]
    pub fn acting(&self, frame: &Frame, i: usize) -> impl Iterator<Item = (&Profile, f64)> {
        let density = if self.depends_on_density() {
            frame.fields.density[i]
        } else {
            0.0
        };
        self.weights(density)
    }

    /// The profiles with a weight above zero at a density in P/m² (§4.4).
    #[inline]
    pub fn weights(&self, density: f64) -> impl Iterator<Item = (&Profile, f64)> {
        let last = self.steps.len() - 1;
        let above = |step: &BlendStep| density <= step.at_density;
        let high = self.steps.iter().position(above).unwrap_or(last);
        let low = high.saturating_sub(1);
        let (from, to) = (self.steps[low].at_density, self.steps[high].at_density);
        // Alone at its own density, and at the ends beyond it.
        let kappa = if low < high {
            ((density - from) / (to - from)).min(1.0)
        } else {
            1.0
        };
        let lower = (kappa < 1.0).then(|| (&self.steps[low].profile, 1.0 - kappa));
        lower
            .into_iter()
            .chain([(&self.steps[high].profile, kappa)])
    }

    /// Does RVO act on agent `i` of a frozen frame?
    pub fn rvo_acts(&self, frame: &Frame, i: usize) -> bool {
        self.acting(frame, i)
            .any(|(profile, _)| rvo_of(profile).is_some())
    }

    /// The blended acceleration of agent `i` of a frozen frame, m/s².
    pub fn acceleration(
        &self,
        frame: &Frame,
        i: usize,
        sums: &PairSums,
        changed: Option<&Override>,
    ) -> Vector {
        let mut blended = Vector::zeros();
        for (profile, weight) in self.acting(frame, i) {
            blended += profile.terms(frame, i, sums, changed).sum() * weight;
        }
        blended
    }
}

fn rvo_of(profile: &Profile) -> Option<Rvo> {
    match profile.navigation {
        Navigation::Rvo(rvo) => Some(rvo),
        _ => None,
    }
}

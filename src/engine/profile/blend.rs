//! Blending of profiles by density (§4.4).
//!
//! Plain form: `acting` and `acceleration` in `examples/paper.rs`.

use std::ops::Range;
use std::sync::Arc;

use super::{Navigation, Override, Profile};
use crate::density::SphParameters;
use crate::forces::near::PairCoefficients;
use crate::forces::own::Force;
use crate::forces::rvo::Rvo;
use crate::forces::social::SocialForce;
use crate::forces::walking::WalkingLaw;
use crate::frame::Frame;
use crate::math::Vector;
use crate::neighbors::BLOCK;
use crate::pairs::Reach;

/// Largest number of profiles in a blend. Every group of agents has its own copy of them.
const MOST_STEPS: usize = 16;

/// A sequence {(Π^j, ρ^j)} of profiles in ascending order of density, and the SPH parameters they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Blend {
    /// Name in reports.
    pub name: String,
    /// SPH parameters of all agents with this blend.
    pub sph: SphParameters,
    steps: Vec<BlendStep>,
}

/// One profile of a blend.
#[derive(Debug, Clone, PartialEq)]
pub struct BlendStep {
    /// ρ^j, P/m²: the density at which this profile acts alone.
    pub at_density: f64,
    /// Π^j.
    pub profile: Profile,
}

/// Why a sequence of profiles is not a valid blend.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BlendError {
    /// There is no profile.
    #[error("a blend needs at least one profile")]
    Empty,
    /// Too many profiles.
    #[error("{0} profiles in one blend; at most {MOST_STEPS} may be")]
    TooMany(usize),
    /// The second density is not greater than the first.
    #[error("densities must rise: {1} P/m² follows {0} P/m²")]
    NotRising(f64, f64),
    /// Two profiles have different RVO parameters or, with RVO, different walking laws.
    #[error(
        "profiles of one blend share one velocity of RVO: give them the same RVO parameters and the same walking law"
    )]
    DifferentRvo,
    /// Two profiles have different walking laws.
    #[error(
        "profiles of one blend share one walking law that looks ahead: give all that have one the same law with the \
         same parameters"
    )]
    DifferentLaws,
    /// A force that keeps a state has different parameters in two profiles, or only one has it.
    #[error(
        "profiles of one blend share what a force keeps for each agent: give all of them the same parameters of `{0}`"
    )]
    DifferentForces(String),
    /// Two profiles have bodies of different sizes.
    #[error("profiles of one blend share one `contact_scale`: {1} follows {0}")]
    DifferentContact(f64, f64),
}

impl Blend {
    /// Combines profiles into a blend.
    ///
    /// # Errors
    /// No profile or too many, densities that do not rise, or profiles with different RVO parameters, walking laws,
    /// contact scales or forces that keep a state.
    pub fn new(
        name: String,
        sph: SphParameters,
        steps: Vec<BlendStep>,
    ) -> Result<Self, BlendError> {
        if steps.is_empty() {
            return Err(BlendError::Empty);
        }
        if steps.len() > MOST_STEPS {
            return Err(BlendError::TooMany(steps.len()));
        }
        for pair in steps.windows(2) {
            let (low, high) = (pair[0].at_density, pair[1].at_density);
            if low.partial_cmp(&high) != Some(std::cmp::Ordering::Less) {
                return Err(BlendError::NotRising(low, high));
            }
            let [before, here] = [0, 1].map(|k| pair[k].profile.contact.contact_scale);
            if before != here {
                return Err(BlendError::DifferentContact(before, here));
            }
            if let Some(name) = different_state(&pair[0].profile, &pair[1].profile) {
                return Err(BlendError::DifferentForces(name));
            }
        }
        let rvo = |step: &BlendStep| Some((rvo_of(&step.profile)?, step.profile.walking));
        let mut rvos = steps.iter().filter_map(rvo);
        if let Some(first) = rvos.next()
            && rvos.any(|other| other != first)
        {
            return Err(BlendError::DifferentRvo);
        }
        let mut laws = steps.iter().filter_map(|step| step.profile.walking);
        if let Some(first) = laws.next()
            && laws.any(|other| other != first)
        {
            return Err(BlendError::DifferentLaws);
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

    /// The profiles in ascending order of density.
    pub fn steps(&self) -> &[BlendStep] {
        &self.steps
    }

    /// Whether the behavior depends on the density.
    pub fn depends_on_density(&self) -> bool {
        self.steps.len() > 1
    }

    /// The reach of the forces of an agent with this blend.
    #[doc(hidden)]
    pub fn reach(&self) -> Reach {
        Reach {
            support_radius: self.sph.support_radius,
            contact_scale: self.steps[0].profile.contact.contact_scale,
        }
    }

    /// The RVO parameters of this blend, if any of its profiles uses RVO.
    pub fn rvo(&self) -> Option<Rvo> {
        self.steps.iter().find_map(|step| rvo_of(&step.profile))
    }

    /// The forces in addition to those of the paper of its first profile. Those that keep a state are forces of all its
    /// profiles.
    pub fn forces(&self) -> &[Arc<dyn Force>] {
        &self.steps[0].profile.forces
    }

    /// The walking law of the profiles that have one.
    pub fn walking_law(&self) -> Option<&WalkingLaw> {
        let mut profiles = self.steps.iter().map(|step| &step.profile);
        profiles.find_map(|profile| profile.walking.as_ref())
    }

    /// The walking law that changes the preferred velocity of RVO.
    pub fn law_of_rvo(&self) -> Option<&WalkingLaw> {
        let mut with_rvo = (self.steps.iter()).filter(|step| rvo_of(&step.profile).is_some());
        with_rvo.find_map(|step| step.profile.walking.as_ref())
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
        self.weights_of(self.mix(density))
    }

    #[inline]
    fn mix(&self, density: f64) -> Mix {
        let last = self.steps.len() - 1;
        let above = |step: &BlendStep| density <= step.at_density;
        let high = self.steps.iter().position(above).unwrap_or(last);
        let low = high.saturating_sub(1);
        let (from, to) = (self.steps[low].at_density, self.steps[high].at_density);
        // A profile acts alone at its own density; the first and the last also act alone beyond the ends.
        let kappa = if low < high {
            ((density - from) / (to - from)).min(1.0)
        } else {
            1.0
        };
        Mix { high, kappa }
    }

    #[inline]
    fn weights_of(&self, Mix { high, kappa }: Mix) -> impl Iterator<Item = (&Profile, f64)> {
        let low = &self.steps[high.saturating_sub(1)];
        let lower = (kappa < 1.0).then_some((&low.profile, 1.0 - kappa));
        let higher = (&self.steps[high].profile, kappa);
        lower.into_iter().chain([higher])
    }

    /// Whether RVO acts on agent `i` of a frozen frame.
    pub fn rvo_acts(&self, frame: &Frame, i: usize) -> bool {
        self.acting(frame, i)
            .any(|(profile, _)| rvo_of(profile).is_some())
    }

    /// Adds the weighted coefficients of all profiles for sums over near agents, for `agents` of one block of a frozen
    /// frame, all with this blend.
    #[doc(hidden)]
    pub fn add_pair_coefficients(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        changed: Option<&Override>,
        coefficients: &mut PairCoefficients,
    ) {
        self.each_share(frame, agents, |profile, agents, weight| {
            profile.add_pair_coefficients(frame, agents, changed, weight, coefficients);
        });
    }

    /// Adds the coefficients of a social force, its weight divided by the mass, for `agents` of one block of a frozen
    /// frame, all with this blend.
    #[doc(hidden)]
    pub fn add_social_coefficients(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        social: &SocialForce,
        coefficients: &mut [f64; BLOCK],
    ) {
        self.each_share(frame, agents, |profile, agents, weight| {
            if profile.navigation.social().as_ref() == Some(social) {
                for i in agents {
                    coefficients[i % BLOCK] += weight / frame.agents.mass[i];
                }
            }
        });
    }

    /// Adds the accelerations of the paper that do not depend on other agents, and those by [`Profile::forces`], m/s²,
    /// for `agents` of a frozen frame, all with this blend.
    #[doc(hidden)]
    pub fn add_accelerations(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        changed: Option<&Override>,
        accelerations: &mut [Vector],
    ) {
        let first = agents.start;
        self.each_share(frame, agents, |profile, agents, weight| {
            profile.each_term(frame, agents.clone(), changed, |_, i, term| {
                accelerations[i - first] += term * weight;
            });
            for force in &profile.forces {
                let out = &mut accelerations[agents.start - first..];
                force.add_accelerations(frame, agents.clone(), weight, out);
            }
        });
    }

    /// Passes `take` each active profile with the agents on which it acts and its weight.
    #[inline]
    fn each_share(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        mut take: impl FnMut(&Profile, Range<usize>, f64),
    ) {
        if let [step] = &self.steps[..] {
            take(&step.profile, agents, 1.0);
            return;
        }
        let density = &frame.fields.density;
        let mut start = agents.start;
        while start < agents.end {
            let mix = self.mix(density[start]);
            let mut end = start + 1;
            // Groups neighbors in memory on which the same profile acts alone.
            while end < agents.end && mix.kappa == 1.0 && self.mix(density[end]) == mix {
                end += 1;
            }
            for (profile, weight) in self.weights_of(mix) {
                take(profile, start..end, weight);
            }
            start = end;
        }
    }
}

/// The mix of profiles at a density.
#[derive(Clone, Copy, PartialEq)]
struct Mix {
    /// The index of the last profile that acts. The one before it has the rest of the weight.
    high: usize,
    /// The weight of the last profile.
    kappa: f64,
}

/// The name of a force that keeps a state and that only one of these profiles has.
fn different_state(one: &Profile, other: &Profile) -> Option<String> {
    let lacks = |profile: &Profile, force: &Arc<dyn Force>| {
        !force.kept().is_empty() && !profile.forces.contains(force)
    };
    let of_one = one.forces.iter().filter(|force| lacks(other, force));
    let of_other = other.forces.iter().filter(|force| lacks(one, force));
    let first = of_one.chain(of_other).next();
    first.map(|force| force.name().to_owned())
}

fn rvo_of(profile: &Profile) -> Option<Rvo> {
    match profile.navigation {
        Navigation::Rvo(rvo) => Some(rvo),
        _ => None,
    }
}

//! Traits: the properties that are drawn for each agent when it enters.

use crate::agents::{NewAgent, radius_of};
use crate::distribution::Distribution;
use crate::random::Purpose;

/// Distributions of the traits of a group; `None`: the scene's value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Traits {
    /// s_pref, m/s.
    pub preferred_speed: Option<Distribution>,
    /// D_i, meters.
    pub radius: Option<Distribution>,
    /// m_i; `None`: (D_i / 0.24)².
    pub mass: Option<Distribution>,
    /// Time from its entry until an agent walks, seconds.
    pub premovement: Option<Distribution>,
}

impl Traits {
    /// D_i of agent `id`, if it has no radius of its own, meters. `seed` is that of the population.
    pub fn radius_of(&self, seed: u64, id: u32) -> f64 {
        match &self.radius {
            Some(radius) => radius.draw(seed, Purpose::Body, id),
            None => radius_of(seed, id),
        }
    }

    /// `new` with the traits that it lacks, as drawn for agent `id`. `seed` is that of the population.
    #[must_use]
    pub fn drawn(&self, new: NewAgent, seed: u64, id: u32) -> NewAgent {
        let draw = |own: Option<f64>, of: &Option<Distribution>, purpose| {
            own.or_else(|| Some(of.as_ref()?.draw(seed, purpose, id)))
        };
        NewAgent {
            preferred_speed: draw(new.preferred_speed, &self.preferred_speed, Purpose::Speed),
            radius: draw(new.radius, &self.radius, Purpose::Body),
            mass: draw(new.mass, &self.mass, Purpose::Mass),
            premovement: draw(new.premovement, &self.premovement, Purpose::Premovement),
            ..new
        }
    }
}

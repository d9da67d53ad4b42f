//! The pressure of a crowd on each person: the virial stress of pressure and contact, and the resulting force.
//!
//! σ_i = −(ρ_i/2) (Σ_j r_ij ⊗ f_ij + Σ_k 2 (r_i − r_k*) ⊗ f_ik), N/m: summed over the agents j and over the walls k. A
//! wall counts as a person at the mirror image of the agent. f is body mass × m_i × the acceleration by Eqs. 11, 12, 22
//! and 23, and ρ_i is the density of [`local`](super::local). The force on a person is the largest principal pressure,
//! −σ, times the width of a person. Social forces, RVO and goal forces do not press.

use libm::hypot;
use serde::{Deserialize, Serialize};

use super::evaluated::Evaluated;
use super::exposure::{Spell, Weight};
use engine::math::Vector;

/// The mass of an average person, m = 1, if none is given, kg.
pub const BODY_MASS: f64 = 75.0;
/// The width of a person, meters.
pub const WIDTH: f64 = 0.5;
/// Forces in the literature, newtons: tolerable on a bar (Evans and Hayden 1971), fatal in 4 to 6 minutes and in 15 s
/// (Hopkins et al. 1993), as Lee and Hughes (2006) give them. Not safety limits.
pub const THRESHOLDS: [f64; 3] = [623.0, 1112.0, 6227.0];

/// A person with the stress and the force on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pressed {
    /// The agent's id.
    pub agent: u32,
    /// Meters.
    pub position: Vector,
    /// σ as xx, xy and yy, N/m; pressure is negative.
    pub stress: [f64; 3],
    /// The force on the person, newtons.
    pub force: f64,
}

/// The stress and the force on each agent of an evaluated frame, by id.
pub fn pressed(evaluated: &Evaluated, body_mass: f64) -> Vec<Pressed> {
    let agents = evaluated.simulation.frame().agents;
    let mut virials = evaluated.simulation.virials();
    for wall in evaluated.wall_pushes() {
        let (i, push) = (wall.agent, wall.push);
        let arm = (agents.position[i] - wall.nearest) * 2.0;
        let xy = 0.5 * (arm.x * push.y + arm.y * push.x);
        let own = [arm.x * push.x, xy, arm.y * push.y];
        (0..3).for_each(|k| virials[i][k] += own[k]);
    }
    let mut order: Vec<usize> = agents.present().collect();
    order.sort_unstable_by_key(|&i| agents.id[i]);
    let people = order.into_iter().zip(evaluated.people(false));
    let pressed = people.map(|(i, person)| {
        let scale = -0.5 * person.density * body_mass * agents.mass[i];
        let stress = virials[i].map(|virial| virial * scale);
        Pressed {
            agent: agents.id[i],
            position: agents.position[i],
            stress,
            force: principal_pressure(stress).max(0.0) * WIDTH,
        }
    });
    pressed.collect()
}

/// The largest eigenvalue of −σ, N/m.
fn principal_pressure([xx, xy, yy]: [f64; 3]) -> f64 {
    -0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy)
}

/// The observations of one person.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Person {
    /// The largest force, newtons.
    most: f64,
    /// The intervals above each of [`THRESHOLDS`].
    spells: [Spell; 3],
    /// The number of the last sample with this person, from 1.
    last: u32,
}

/// The observations of people at several times.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyForces {
    /// The largest force so far, and when, seconds.
    pub peak: Option<(Pressed, f64)>,
    /// By id.
    people: Vec<Person>,
    /// The number of samples.
    samples: u32,
    weight: Weight,
}

/// One person's largest force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PersonForce {
    /// The agent's id.
    pub agent: u32,
    /// Newtons.
    pub max_n: f64,
}

impl BodyForces {
    /// Adds the people at a time in seconds.
    pub fn add(&mut self, time: f64, people: &[Pressed]) {
        self.samples += 1;
        let weight = self.weight.of_next();
        for person in people {
            let id = person.agent as usize;
            if self.people.len() <= id {
                self.people.resize(id + 1, Person::default());
            }
            let own = &mut self.people[id];
            own.most = own.most.max(person.force);
            for (spell, threshold) in own.spells.iter_mut().zip(THRESHOLDS) {
                if own.last + 1 < self.samples {
                    spell.add(false, weight); // the person was not there in between
                }
                spell.add(person.force > threshold, weight);
            }
            own.last = self.samples;
            if self.peak.is_none_or(|(peak, _)| person.force > peak.force) {
                self.peak = Some((*person, time));
            }
        }
    }

    /// For each of [`THRESHOLDS`]: the number of people above it in any sample, and the largest number of intervals of
    /// one person above it without a break.
    pub fn above(&self) -> [(u32, f64); 3] {
        std::array::from_fn(|k| {
            let longest = self.people.iter().map(|own| own.spells[k].longest());
            let above = |own: &&Person| own.most > THRESHOLDS[k];
            let people = self.people.iter().filter(above).count();
            (people as u32, longest.fold(0.0, f64::max))
        })
    }

    /// The largest force on each person with a force above 0.
    pub fn of_people(&self) -> impl Iterator<Item = PersonForce> + '_ {
        let people = self.people.iter().zip(0..);
        let pressed = people.filter(|(own, _)| own.most > 0.0);
        pressed.map(|(own, agent)| PersonForce {
            agent,
            max_n: own.most,
        })
    }
}

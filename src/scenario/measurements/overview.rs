//! What every run observes beside its measurements: the highest density, and the longest queues.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::is_due;
use super::queues::{LongestQueue, Queues};
use super::standing::EVERY;
use super::stuck::Headway;
use engine::kernel;
use engine::simulation::Simulation;

/// The highest density of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HighestDensity {
    /// The SPH density at an agent, P/m².
    pub density_per_m2: f64,
    /// When, seconds.
    pub at_secs: f64,
    /// The position of the agent, meters.
    pub at: [f64; 2],
    /// In a building: the name of the level there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// Its id.
    pub agent: u32,
    /// Its mass m_i, 1 for a person of average size.
    pub mass: f64,
}

/// Bodies with more mass are not those of persons of ordinary size.
const LARGE: f64 = 1.5;

impl HighestDensity {
    /// What to know if its body is large: how dense it is alone.
    pub fn of_large(&self) -> Option<String> {
        let alone = self.mass * kernel::density(0.0, 1.0);
        (self.mass > LARGE).then(|| {
            format!(
                "at a body of mass {:.2}, which has {alone:.2} P/m² alone",
                self.mass
            )
        })
    }
}

/// The highest density and the longest queues so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Overview {
    highest: Option<HighestDensity>,
    queues: Queues,
}

impl Overview {
    /// Observes an evaluated frame with the headways of its agents, by id: densities in coarse frames, if forces need
    /// them, and queues once per second.
    pub fn observe(&mut self, headways: &[Option<Headway>], simulation: &Simulation) {
        if simulation.needs().density && simulation.frame().clock.is_coarse() {
            self.observe_density(simulation);
        }
        if is_due(simulation, [0.0, f64::INFINITY], EVERY) {
            self.queues.observe(headways, simulation);
        }
    }

    /// The highest density; `None` if no force needs densities.
    pub fn highest(&self) -> Option<HighestDensity> {
        self.highest.clone()
    }

    /// The longest queue before each passage, the longest one first.
    pub fn longest(&self, simulation: &Simulation) -> Vec<LongestQueue> {
        self.queues.longest(simulation)
    }

    /// The agents in the queue before each place, by its number, when they were last observed.
    pub fn queues(&self) -> &BTreeMap<u16, u32> {
        self.queues.latest()
    }

    fn observe_density(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let densities = &frame.fields.density;
        let highest = self.highest.as_ref();
        let mut most = highest.map_or(0.0, |highest| highest.density_per_m2);
        let mut found = None;
        // A frame of a damaged checkpoint may have no densities.
        let known = frame.agents.present().filter(|&i| i < densities.len());
        for i in known {
            if densities[i] > most {
                (most, found) = (densities[i], Some(i));
            }
        }
        if let Some(i) = found {
            self.highest = Some(HighestDensity {
                density_per_m2: most,
                at_secs: frame.clock.time(),
                at: frame.agents.position[i].into(),
                level: None,
                agent: frame.agents.id[i],
                mass: frame.agents.mass[i],
            });
        }
    }
}

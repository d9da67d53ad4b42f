//! The density around each person and the variance of the velocities there, of people in runs and in trajectories.
//!
//! Both are means with the kernel of Eq. 13 at h = √5 m. Its second moment is that of the Gaussian exp(−r²/R²)/(π R²)
//! with R = 1 m of Helbing, Johansson and Al-Abideen (2007). Unlike the Gaussian it has compact support, so that the
//! part hidden by walls can be computed exactly. Every person counts as one, whatever its mass.

use serde::{Deserialize, Serialize};

use super::site::{Hidden, Kernel, Site};
use super::surroundings::{MOST_HIDDEN, Surroundings};
use engine::agents::Agents;
use engine::boundary::WallMethod;
use engine::geometry::Walls;
use engine::math::Vector;
use engine::period::Period;

/// The kernel: h = √5 m, and the union of the regions hidden by walls.
pub const KERNEL: Kernel = Kernel {
    support_radius: 2.236_067_977_499_79,
    walls: WallMethod::Union,
};

/// A person at one time, with its surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Local {
    /// The number of the person, the same at all times.
    pub number: u32,
    /// Meters.
    pub position: Vector,
    /// m/s; `None` if unknown.
    pub speed: Option<f64>,
    /// ρ = Σ_j W(r_ij) / (1 − the part of W that walls hide), P/m², over the person itself and all that it sees.
    pub density: f64,
    /// ρ Var(v), 1/s²; `None` if no velocity is known nearby, or if it was not asked for.
    pub pressure: Option<f64>,
}

/// People at one time.
#[derive(Debug, Clone, Default)]
pub struct People {
    /// The number of each person.
    pub numbers: Vec<u32>,
    /// Meters; after those of the people, images of people beyond the ends of a period.
    positions: Vec<Vector>,
    /// m/s; `None` if unknown. As long as `positions`.
    velocities: Vec<Option<Vector>>,
}

impl People {
    /// People with their positions and, if known, velocities.
    pub fn new(people: impl Iterator<Item = (u32, Vector, Option<Vector>)>) -> Self {
        let mut all = Self::default();
        for (number, position, velocity) in people {
            all.numbers.push(number);
            all.positions.push(position);
            all.velocities.push(velocity);
        }
        all
    }

    /// The agents of a run that are present, by id, so that the order of sums does not depend on the order in memory.
    pub fn of(agents: &Agents, period: Option<&Period>) -> Self {
        let mut order: Vec<usize> = agents.present().collect();
        order.sort_unstable_by_key(|&i| agents.id[i]);
        let state = |i: usize| (agents.id[i], agents.position[i], Some(agents.velocity[i]));
        let mut all = Self::new(order.into_iter().map(state));
        if let Some(period) = period {
            all.add_images(period);
        }
        all
    }

    /// Adds the images of people within h of the ends of the period.
    fn add_images(&mut self, period: &Period) {
        let h = KERNEL.support_radius;
        let [low, high] = period.ends();
        let laps = (h / period.length).ceil() as i32;
        for k in 0..self.numbers.len() {
            for lap in (-laps..=laps).filter(|&lap| lap != 0) {
                let image = self.positions[k] + period.way(lap);
                if (low - h..high + h).contains(&period.along(image)) {
                    self.positions.push(image);
                    self.velocities.push(self.velocities[k]);
                }
            }
        }
    }

    /// The surroundings of people at a site, where they may lean over walls.
    pub fn at<'a>(&self, site: &'a Site) -> Surroundings<'a> {
        let hide = |p, near: &mut Vec<u32>| site.hidden(p, near, &KERNEL);
        Surroundings::new(
            &site.walls,
            &self.positions,
            &[],
            KERNEL.support_radius,
            hide,
        )
    }

    /// The surroundings of people, all of whom must be outside of the obstacles.
    pub(super) fn among<'a>(&self, walls: &'a Walls) -> Surroundings<'a> {
        let hide = |p, near: &mut Vec<u32>| Hidden {
            share: KERNEL.share(walls, p, near),
            eye: p,
            inside: None,
        };
        Surroundings::new(walls, &self.positions, &[], KERNEL.support_radius, hide)
    }

    /// The people with their surroundings, in their order, with pressures if `pressure`.
    pub fn local(&self, around: &Surroundings, pressure: bool) -> Vec<Local> {
        let sums = around.from_people(true);
        let people = self.numbers.iter().zip(sums).enumerate();
        let local = people.map(|(k, (&number, sum))| Local {
            number,
            position: self.positions[k],
            speed: self.velocities[k].map(|v| v.norm()),
            density: sum / (1.0 - around.hidden(k).share.min(MOST_HIDDEN)),
            pressure: None,
        });
        let mut local: Vec<Local> = local.collect();
        if pressure {
            self.add_pressures(around, &mut local);
        }
        local
    }

    /// Adds the pressures ρ Var(v), where Var(v) = Σ W |v_j − V|² / Σ W and V is the mean velocity with the same
    /// weights.
    pub(super) fn add_pressures(&self, around: &Surroundings, local: &mut [Local]) {
        let moments = around.moments(&self.velocities);
        for (person, moments) in local.iter_mut().zip(moments) {
            let variance = moments.variance();
            person.pressure = variance.map(|variance| person.density * variance);
        }
    }
}

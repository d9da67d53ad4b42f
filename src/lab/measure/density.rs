//! The density of people in a frame (§8): Eqs. 9 and 10 without a simulation.

use super::site::{Hidden, Kernel, Site};
use crate::engine::agents::{Agents, NewAgent, REFERENCE_RADIUS};
use crate::engine::density::{SphParameters, from_agents};
use crate::engine::kernel;
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, Neighbors, Ranges};
use crate::engine::pairs::Bodies;

/// At most this share of a kernel counts as hidden: in a narrow gap, the visible rest is too small to be meaningful.
pub const MOST_HIDDEN: f64 = 0.9;

/// The density assumed behind walls: ρ_i⁰ in Eq. 10.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Behind {
    /// The density at the person's position: ρ_i = Σ_j m_j W / (1 − Σ_k ∫ W over P_k), summed over the people that
    /// walls do not hide. A uniform crowd then has the same density up to its walls, and people behind a thin wall do
    /// not count.
    #[default]
    Same,
    /// As in the engine: the moving average ρ̂_i of the person's own density (Eq. 8), clamped between 0 and this
    /// value, P/m². It depends on earlier frames, and all people within reach count.
    Rest(f64),
}

/// The terms of Eq. 9.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Σ_j m_j W including j = i, P/m², over the visible people or over all.
    pub from_people: f64,
    /// The part that walls hide.
    pub hidden: Hidden,
}

/// The terms for all people in a frame, in the given order. Without `masses`, all masses are 1.
pub fn parts(
    site: &Site,
    positions: &[Vector],
    masses: &[f64],
    (kernel, behind): (&Kernel, Behind),
) -> Vec<Parts> {
    let mut agents = Agents::default();
    for (k, &position) in positions.iter().enumerate() {
        let person = NewAgent {
            radius: Some(REFERENCE_RADIUS),
            mass: Some(masses.get(k).copied().unwrap_or(1.0)),
            ..NewAgent::at(position, position, 0)
        };
        agents.enter(person, 0);
    }
    let ranges = Ranges {
        support: kernel.support_radius,
        ..Ranges::default()
    };
    let mut neighbors = Neighbors::default();
    neighbors.sort(&mut agents, ranges);
    neighbors.list_agents();
    neighbors.list_walls(&agents, &site.walls);
    // Eq. 9 without walls, by the engine's own sums, in double precision.
    let mut bodies = Bodies::<f64>::default();
    bodies.take(&agents, 1.0, None, |_| kernel.support_radius);
    bodies.take_motions(&agents);
    let mut from_people = vec![0.0; agents.len()];
    for (b, sums) in from_people.chunks_mut(BLOCK).enumerate() {
        from_agents(&bodies, neighbors.near().block(b), sums);
    }
    let seen = (0..agents.len()).map(|i| {
        let mut near = neighbors.near_walls(i).to_vec();
        let hidden = site.hidden(agents.position[i], &mut near, kernel);
        (near, hidden)
    });
    let (near, hidden): (Vec<Vec<u32>>, Vec<Hidden>) = seen.unzip();
    if behind == Behind::Same {
        for i in (0..agents.len()).filter(|&i| !near[i].is_empty()) {
            let eye = hidden[i].eye;
            let seen = neighbors.near().near(i).map(|(j, _)| j);
            let seen = seen.filter(|&j| j == i || site.sees(eye, hidden[j].eye, &near[i]));
            let weight = |j: usize| {
                let offset = agents.position[i] - agents.position[j];
                agents.mass[j] * kernel::density(offset.norm_squared(), kernel.support_radius)
            };
            from_people[i] = seen.map(weight).sum();
        }
    }
    let of = |i: usize| Parts {
        from_people: from_people[i],
        hidden: hidden[i],
    };
    // The ids count the positions in their given order.
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by_key(|&i| agents.id[i]);
    order.into_iter().map(of).collect()
}

/// The moving averages for [`Behind::Rest`].
pub struct History {
    behind: Behind,
    sph: SphParameters,
    /// ρ̂ of each person, and its frame.
    kept: Vec<Option<(i64, f64)>>,
}

impl History {
    /// No averages yet, for `people` people.
    pub fn new(behind: Behind, people: usize) -> Self {
        let mut sph = SphParameters::default();
        if let Behind::Rest(max) = behind {
            sph.rest_density_max = max;
        }
        let kept = vec![None; people];
        Self { behind, sph, kept }
    }

    /// The walls' part of ρ_i of a person in a frame, P/m². `step` frame numbers take `interval` seconds. Frames must
    /// come in order.
    pub fn walls_part(
        &mut self,
        (person, frame): (usize, i64),
        parts: &Parts,
        (step, interval): (i64, f64),
    ) -> f64 {
        let (from_people, hidden) = (parts.from_people, parts.hidden.share);
        if self.behind == Behind::Same {
            let hidden = hidden.min(MOST_HIDDEN);
            return from_people * hidden / (1.0 - hidden);
        }
        // A person who was absent one frame earlier is new, as in the engine.
        let before = self.kept[person].filter(|&(last, _)| last == frame - step);
        let before = before.map(|(_, mean)| mean);
        let sph = &self.sph;
        let [from_walls, mean] = sph.from_walls_and_mean(from_people, hidden, before, interval);
        self.kept[person] = Some((frame, mean));
        from_walls
    }
}

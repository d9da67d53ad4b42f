//! The density of people in a frame (§8): Eqs. 9 and 10 without a simulation.

use super::options::{Behind, Options};
use crate::analysis::site::{Hidden, Kernel, Site};
use crate::analysis::surroundings::{MOST_HIDDEN, Surroundings};
use crate::engine::density::SphParameters;
use crate::engine::kernel;
use crate::engine::math::Vector;

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
    let h = kernel.support_radius;
    let around = Surroundings::new(&site.walls, positions, masses, h, |p, near| {
        site.hidden(p, near, kernel)
    });
    let sums = around.from_people(behind == Behind::Same);
    let sums = sums.into_iter().enumerate();
    sums.map(|(person, from_people)| Parts {
        from_people,
        hidden: around.hidden(person),
    })
    .collect()
}

/// The moving averages for [`Behind::Rest`].
pub struct History {
    behind: Behind,
    /// h, meters.
    support_radius: f64,
    sph: SphParameters,
    /// ρ̂ of each person, and its frame.
    kept: Vec<Option<(i64, f64)>>,
}

impl History {
    /// No averages yet, for `people` people.
    pub fn new(options: &Options, people: usize) -> Self {
        let (behind, support_radius) = (options.behind, options.kernel.support_radius);
        let mut sph = SphParameters::default();
        if let Behind::Rest(max) = behind {
            sph.rest_density_max = max;
        }
        let kept = vec![None; people];
        Self {
            behind,
            support_radius,
            sph,
            kept,
        }
    }

    /// The part of ρ_i that comes from the weight of the person, which has this mass, P/m². The crowd that is assumed
    /// behind walls is as dense as at the person's position, so its density includes this part.
    pub fn own_part(&self, parts: &Parts, mass: f64) -> f64 {
        let own = mass * kernel::density(0.0, self.support_radius);
        match self.behind {
            Behind::Same => own / (1.0 - parts.hidden.share.min(MOST_HIDDEN)),
            Behind::Rest(_) => own,
        }
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

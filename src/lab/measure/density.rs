//! The density of people in a frame (§8): Eqs. 9 and 10 without a simulation.

use super::options::{Behind, Options};
use super::person::Person;
use analysis::site::{Hidden, Kernel, Site};
use analysis::surroundings::{MOST_HIDDEN, Surroundings};
use engine::density::SphParameters;
use engine::kernel;
use engine::math::Vector;

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
    let by_kind = around.from_people(behind == Behind::Same);
    let sums = by_kind.into_iter().enumerate();
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

    /// Sets the densities of a person in a frame; `step` frame numbers take `interval` seconds. Frames must come in
    /// order.
    pub fn complete(
        &mut self,
        person: &mut Person,
        parts: &Parts,
        (frame, step, interval): (i64, i64, f64),
    ) {
        let (from_people, hidden) = (parts.from_people, parts.hidden.share);
        // The crowd that is assumed behind walls may be as dense as at the person's position, whose density includes
        // the person's own weight.
        let mut own = person.mass * kernel::density(0.0, self.support_radius);
        if self.behind == Behind::Same {
            let hidden = hidden.min(MOST_HIDDEN);
            own /= 1.0 - hidden;
            person.density_from_walls = from_people * hidden / (1.0 - hidden);
        } else {
            let kept = &mut self.kept[person.number as usize];
            // A person who was absent one frame earlier is new, as in the engine.
            let adjacent = kept.filter(|&(last, _)| last == frame - step);
            let before = adjacent.map(|(_, mean)| mean);
            let sph = &self.sph;
            let [from_walls, mean] = sph.from_walls_and_mean(from_people, hidden, before, interval);
            *kept = Some((frame, mean));
            person.density_from_walls = from_walls;
        }
        person.density = from_people + person.density_from_walls;
        person.density_of_others = (person.density - own).max(0.0);
    }
}

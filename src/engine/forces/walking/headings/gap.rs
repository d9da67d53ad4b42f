//! How the time gap T depends on motivation, density and narrowings.

use libm::exp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{FARTHEST, HIGHEST_DENSITY};

/// Parameters of the factor of T.
///
/// Hurried people follow each other more closely. Calm people do so only where they are packed; in a queue they keep
/// longer gaps, but where others come toward them they do not queue. All keep longer gaps where the way becomes
/// narrower.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Gap {
    /// `headings`: the share of T that agents with a motivation of 1 do without.
    #[schemars(range(min = 0, max = 0.95))]
    pub hurry_share: f64,
    /// `headings`: the share of T that calm agents in packed crowds do without.
    #[schemars(range(min = 0, max = 0.95))]
    pub press_share: f64,
    /// `headings`, P/m²: the density from which on they do so.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub press_density: f64,
    /// `headings`, P/m²: they do so fully this far above that density.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub press_range: f64,
    /// `headings`: T of calm agents in a queue is longer by this share of it.
    #[schemars(range(min = 0, max = 10))]
    pub queue_share: f64,
    /// `headings`, P/m²: the density from which on it is longer; it is so fully 1 P/m² above it.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub queue_density: f64,
    /// `headings`: T is longer by this share of it at a narrowing.
    #[schemars(range(min = -0.9, max = 10))]
    pub narrowing_share: f64,
    /// `headings`, meters: the distance from a narrowing at which this share has fallen to 1/e.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub narrowing_range: f64,
}

impl Default for Gap {
    fn default() -> Self {
        Self {
            hurry_share: 0.0,
            press_share: 0.0,
            press_density: 4.5,
            press_range: 1.0,
            queue_share: 0.0,
            queue_density: 1.5,
            narrowing_share: 0.0,
            narrowing_range: 2.0,
        }
    }
}

/// Agents that come toward another one count in full at half of this distance and nearer, and not at all beyond it,
/// meters.
pub const OPPOSED_WITHIN: f64 = 3.0;

/// What the factor of T of an agent depends on.
#[derive(Debug, Clone, Copy, Default)]
pub struct Situation {
    /// How much it hurries, from 0 to 1.
    pub motivation: f64,
    /// The density at its place (Eq. 9), P/m².
    pub density: f64,
    /// How near agents that come toward it are, from 0 to 1.
    pub opposed: f64,
    /// The distance to the next narrowing, meters, and how much it counts, from 0 to 1.
    pub narrowing: Option<[f64; 2]>,
}

impl Gap {
    /// The factor of T.
    pub fn factor(&self, of: &Situation) -> f64 {
        let hurry = 1.0 - self.hurry_share * of.motivation;
        let calm = 1.0 - of.motivation;
        let pressed = (of.density - self.press_density) / self.press_range;
        let press = 1.0 - self.press_share * calm * pressed.clamp(0.0, 1.0);
        let queued = (of.density - self.queue_density).clamp(0.0, 1.0) * (1.0 - of.opposed);
        let queue = 1.0 + self.queue_share * calm * queued;
        let narrow = of.narrowing.map_or(1.0, |[distance, counts]| {
            let near = distance / self.narrowing_range;
            1.0 + self.narrowing_share * counts * exp(-near * near)
        });
        hurry * press * queue * narrow
    }

    /// Whether a queue would lengthen T of an agent with this motivation at this density, P/m²: only then it matters
    /// whether others come toward it.
    pub fn queues(&self, motivation: f64, density: f64) -> bool {
        self.queue_share != 0.0 && motivation < 1.0 && density > self.queue_density
    }

    /// The distance of the farthest agents that count, meters.
    pub fn sight(&self) -> f64 {
        match self.queue_share {
            0.0 => 0.0,
            _ => OPPOSED_WITHIN,
        }
    }

    /// Narrowings farther away than this do not count, meters.
    pub fn reach(&self) -> f64 {
        2.5 * self.narrowing_range
    }

    /// The greatest factor.
    pub fn longest(&self) -> f64 {
        (1.0 + self.narrowing_share.max(0.0)) * (1.0 + self.queue_share.max(0.0))
    }

    /// The least factor.
    pub fn shortest(&self) -> f64 {
        (1.0 - self.hurry_share).min(1.0 - self.press_share)
    }
}

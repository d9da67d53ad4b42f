//! Which pairs are left out: their force is certainly below the tolerance.

use super::SocialForce;
use crate::pairs::prelude::*;
use crate::pairs::{Lanes, Mask, Real, Simd, splat};
use libm::log;

/// The largest ratio of |d| and |a|, either way, of a pair that is left out, and the factor (√q + 1/√q)/2 of its force.
const LARGEST_RATIO: f64 = 4.0;
const LARGEST_FACTOR: f64 = 1.25;

/// More than the rounding errors of b², over the square of the avoidance radius: |d| is at most this radius, and |a|
/// at most [`LARGEST_RATIO`] times as long.
const ROUNDING: f64 = 1e-5;

/// Finds the pairs whose force is certainly below the tolerance.
///
/// With d = r_ij, s = T v_ij, a = d + s and q = |a|/|d|, the force is V₀/σ e^(−b/σ) (√q + 1/√q)/2, where b² = (|d||a| +
/// d·a)/2. It is below the tolerance if b exceeds a bound, and ¼ ≤ q ≤ 4. A pair is tested without roots: b² ≥ B² holds
/// if and only if |d||a| ≥ t with t = 2B² − d·a, that is, |d|²|a|² ≥ t |t|; and q + 1/q ≤ 4¼ if and only if
/// (|d|² + |a|²)² ≤ (4¼)² |d|²|a|².
///
/// For agents j at least r away from all of some agents i, and |s| ≤ S, b² ≥ r (r − S): a and d differ by s. They are
/// left out if r (r − S) ≥ B², that is, (r² − B²) |r² − B²| ≥ r² S², and S ≤ ¾ r. Then each of their pairs would be
/// left out by itself: which pairs are left out does not depend on clusters.
pub struct Cutoff<R: Real, S: Simd> {
    twice_b_squared: Lanes<R, S>,
    /// 1/(4 + ¼)
    per_ratio: Lanes<R, S>,
    group_b_squared: Lanes<R, S>,
    group_ratio: Lanes<R, S>,
    /// T², in coordinate units² per (m/s)².
    time_squared: Lanes<R, S>,
}

impl SocialForce {
    /// B², where V₀/σ e^(−B/σ) times the largest factor is the tolerance, plus some rounding errors of b², m².
    fn least_b_squared(&self, roundings: f64) -> f64 {
        let strength = LARGEST_FACTOR * self.agent_strength / self.agent_range;
        let b = self.agent_range * log((strength / self.avoidance_tolerance).max(1.0));
        b * b + roundings * ROUNDING * self.avoidance_radius * self.avoidance_radius
    }
}

impl<R: Real, S: Simd> Cutoff<R, S> {
    /// None without tolerance. A coordinate unit is `unit` meters.
    #[inline(always)]
    pub fn new(simd: S, social: &SocialForce, unit: f64) -> Option<Self> {
        if social.avoidance_tolerance == 0.0 {
            return None;
        }
        let b_squared = |roundings: f64| social.least_b_squared(roundings) / (unit * unit);
        let time = social.anticipation_time / unit;
        Some(Self {
            twice_b_squared: splat::<R, S>(simd, 2.0 * b_squared(1.0)),
            per_ratio: splat::<R, S>(simd, 1.0 / (LARGEST_RATIO + 1.0 / LARGEST_RATIO)),
            group_b_squared: splat::<R, S>(simd, b_squared(2.0)),
            group_ratio: splat::<R, S>(simd, 0.74 * 0.74), // below ¾, for rounding
            time_squared: splat::<R, S>(simd, time * time),
        })
    }

    /// Whether pairs count, given |d|², |a|² and d·a.
    #[inline(always)]
    pub fn counts(
        &self,
        d_squared: Lanes<R, S>,
        a_squared: Lanes<R, S>,
        dot: Lanes<R, S>,
    ) -> Mask<R, S> {
        let t = self.twice_b_squared - dot;
        let mean = (d_squared + a_squared) * self.per_ratio;
        // Not `simd_lt`: a pair counts if both sides overflow. The right side overflows only if the left one does.
        (d_squared * a_squared).simd_le((t * t.abs()).max(mean * mean))
    }

    /// Whether any pairs of groups of agents may count, given r² and the square of a bound on the relative speed.
    #[inline(always)]
    pub fn group_counts(&self, r_squared: Lanes<R, S>, speed_squared: Lanes<R, S>) -> Mask<R, S> {
        let s_squared = speed_squared * self.time_squared;
        let beyond = r_squared - self.group_b_squared;
        (beyond * beyond.abs()).simd_lt(r_squared * s_squared)
            | s_squared.simd_gt(r_squared * self.group_ratio)
    }
}

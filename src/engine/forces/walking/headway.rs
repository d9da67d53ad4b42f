//! The headway law: agents keep a time gap to the nearest agent in their lane.
//!
//! A. Tordeux, M. Chraibi, A. Seyfried, Collision-free speed model for pedestrian dynamics, Traffic and Granular Flow
//! '15 (2016): s = min(s₀, max(0, (d − ℓ)/T)), d the distance to the nearest agent in front within a lane. In their law
//! a lane has sharp edges, and the speed jumps when an agent crosses an edge. In ours the edges fade.
//!
//! Q. Xu, M. Chraibi, A. Seyfried, Anticipation in a velocity-based model for pedestrian dynamics, Transportation
//! Research C 133 (2021): people look at the distance that they expect after some time, d + t (v_j − v_i)·ê_i. In our
//! law they do so behind agents that walk away from them, so that they keep less distance than in a crowd that moves at
//! one velocity.
//!
//! Agents that want to walk against agent i do not count: two agents that wait for each other would stand forever,
//! whereas people step aside.

use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FADE, Motions, ROUNDING, View, Walkers};
use crate::forces::rates::Rates;
use crate::limits::FARTHEST;
use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, Lanes, PairSum, Real, Simd, add_pairs, load, splat};

/// Parameters of the headway law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Headway {
    /// T (`headway`), seconds: the time gap. An agent with d meters to the nearest agent ahead walks at (d - l)/T.
    /// Longer: slower crowds and smaller flows. Below about twice `relaxation_time` files stop and go.
    #[schemars(range(min = 0.01, max = 100))]
    pub headway_time: f64,
    /// l (`headway`), meters: the distance to the nearest agent ahead at which an agent stands. Longer: sparser queues.
    #[schemars(range(min = 0, max = FARTHEST))]
    pub headway_length: f64,
    /// w (`headway`), meters: the half-width of the lane; its edges fade over another half of it. Wider: slower crowds.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub lane_half_width: f64,
    /// t (`headway`), seconds: agents look at the distance to the nearest agent ahead that they expect after this time.
    /// Longer: faster behind agents that speed up, as before a door; no change in a crowd that moves as one.
    #[schemars(range(min = 0, max = 10))]
    pub headway_anticipation: f64,
}

impl Default for Headway {
    fn default() -> Self {
        Self {
            headway_time: 0.6,
            headway_length: 0.3,
            lane_half_width: 0.3,
            headway_anticipation: 0.0,
        }
    }
}

/// Agents count less the more they want to walk against agent i, and not at all where ê_i·ê_j is −1 over this number.
pub(super) const AGAINST: f64 = 4.0;

impl Headway {
    /// s^law, m/s: the speed of an agent with preferred speed `free`, m/s, if the nearest agent in its lane is at this
    /// distance, meters.
    pub fn speed(&self, free: f64, distance: f64) -> f64 {
        ((distance - self.headway_length) / self.headway_time).clamp(0.0, free)
    }

    /// R, meters: agents farther ahead do not slow an agent with this preferred speed, m/s.
    #[inline(always)]
    pub fn range(&self, speed: f64) -> f64 {
        self.headway_length + self.headway_time * speed
    }

    /// The distance in meters at which an agent counts, for an agent with range R, meters: its distance d, if it is in
    /// the lane; at the edges of the lane it grows continuously to R.
    ///
    /// d*² = (a + t max(0, u))² + c² + R² (max(0, (|c| − w)/f) + max(0, 1 − a/f) + 4 max(0, −ê_i·ê_j)), with the
    /// distances a `along` and c `across` the line ahead, the relative velocity u = (v_j − v_i)·ê_i, m/s, at which it
    /// moves `away`, the cosine ê_i·ê_j of both `headings`, and f = w/2. Agents behind, those farther than w + f from
    /// the line, and those that want to walk the other way have d* ≥ R.
    pub fn distance_in_lane(
        &self,
        range: f64,
        [along, across]: [f64; 2],
        [away, headings]: [f64; 2],
    ) -> f64 {
        let fade = FADE * self.lane_half_width;
        let outside = ((across.abs() - self.lane_half_width) / fade).max(0.0)
            + (1.0 - along / fade).max(0.0)
            + AGAINST * (-headings).max(0.0);
        let expected = along + self.headway_anticipation * away.max(0.0);
        (expected * expected + across * across + range * range * outside).sqrt()
    }

    pub(super) fn view(&self) -> View {
        View {
            length: self.headway_length,
            time: self.headway_time,
            aside: (1.0 + FADE) * self.lane_half_width,
            ..View::default()
        }
    }

    pub(super) fn rates(&self) -> Rates {
        Rates {
            steepness: 1.0 / self.headway_time,
            damping: self.headway_anticipation / self.headway_time,
            ..Rates::default()
        }
    }

    /// s_i − s_i^law, m/s; zero, to the last bit, without agents in range. `runs` contain all agents in view, and some
    /// out of view.
    #[inline(always)]
    pub(super) fn lost_speeds<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        walkers: &Walkers<R, S>,
        runs: &[Run],
    ) -> Lanes<R, S> {
        let (zero, unit) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, bodies.unit));
        let per_time = splat::<R, S>(simd, 1.0 / self.headway_time) / walkers.gap;
        let length = splat::<R, S>(simd, self.headway_length);
        let time = splat::<R, S>(simd, self.headway_time) * walkers.gap;
        let range = walkers.speed.mul_add_precise(time, length) / unit;
        let range_squared = range * range;
        let fade = FADE * self.lane_half_width;
        let velocity_x = load(simd, &bodies.velocity_x, walkers.start);
        let velocity_y = load(simd, &bodies.velocity_y, walkers.start);
        let [x, y] = walkers.backwards;
        let mut sum = Nearest {
            motions: Motions::of(bodies),
            backwards_speed: velocity_y.mul_add_precise(y, velocity_x * x),
            time: splat::<R, S>(simd, self.headway_anticipation / bodies.unit),
            backwards: walkers.backwards,
            range_squared,
            per_fade: splat::<R, S>(simd, bodies.unit / fade),
            edge: splat::<R, S>(simd, -self.lane_half_width / fade),
            squared: range_squared,
            farthest: range_squared * splat::<R, S>(simd, ROUNDING),
        };
        add_pairs(simd, bodies, (walkers.start, runs), &mut sum);
        let distance = sum.squared.sqrt() * unit;
        let speed = ((distance - length) * per_time)
            .max(zero)
            .min(walkers.speed);
        let slowed = sum.squared.simd_lt(range_squared);
        slowed.select(walkers.speed - speed, zero)
    }
}

/// The least d*² for eight agents i, at most R².
struct Nearest<'a, R: Real, S: Simd> {
    motions: Motions<'a, R>,
    /// −v_i·ê_i, m/s.
    backwards_speed: Lanes<R, S>,
    /// t, seconds times coordinate units per meter.
    time: Lanes<R, S>,
    /// −ê_i.
    backwards: [Lanes<R, S>; 2],
    /// R², coordinate units².
    range_squared: Lanes<R, S>,
    /// 1/f, per coordinate unit.
    per_fade: Lanes<R, S>,
    /// −w/f.
    edge: Lanes<R, S>,
    /// The least d*² so far, coordinate units².
    squared: Lanes<R, S>,
    /// A little more than it, coordinate units².
    farthest: Lanes<R, S>,
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for Nearest<'a, R, S> {
    type Run = Motions<'a, R>;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Motions<'a, R> {
        self.motions.run(run)
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], motions: Motions<'a, R>, j: usize) {
        // Ahead, d* is at least the distance, and behind at least R: most agents of a run are farther away.
        if dy
            .mul_add_precise(dy, dx * dx)
            .simd_lt(self.farthest)
            .all_false()
        {
            return;
        }
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let [x, y] = self.backwards;
        let along = dy.mul_add_precise(y, dx * x);
        let across = (dx * y - dy * x).abs();
        let aside = across.mul_add_precise(self.per_fade, self.edge).max(zero);
        let behind = (one - along * self.per_fade).max(zero);
        let [v_x, v_y] = motions.velocity(simd, j);
        let approach = v_y.mul_add_precise(y, v_x * x) - self.backwards_speed;
        let expected = along - self.time * approach.min(zero);
        let squared = across.mul_add_precise(across, expected * expected);
        let [e_x, e_y] = motions.heading(simd, j);
        let against = e_y.mul_add_precise(y, e_x * x).max(zero);
        let outside = against.mul_add_precise(splat::<R, S>(simd, AGAINST), aside + behind);
        let squared = self.range_squared.mul_add_precise(outside, squared);
        self.squared = self.squared.min(squared);
        self.farthest = self.squared * splat::<R, S>(simd, ROUNDING);
    }
}

//! The repulsion of bodies, and of legs, by other people: sums over pairs.

use libm::exp;
use std::f64::consts::LOG2_E;
use std::ops::Range;

use super::{Half, Legs, NAME, parts};
use crate::agents::{Agents, States};
use crate::frame::Frame;
use crate::math::Vector;
use crate::neighbors::BLOCK;
use crate::pairs::prelude::*;
use crate::pairs::{
    Bodies, LANES, Lanes, PairSum, Real, Simd, add_pairs, dispatch, each, lanes_from, level, splat,
    store,
};

impl Legs {
    /// Σ_j A f(|d|, B) d/|d|, m/s² for people of mass 1, of `agents`, which are of one block: with d = r_ij between
    /// bodies, or the vector between legs. Other people count if their bodies are near.
    pub(super) fn repulsions(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        half: Half,
    ) -> [Vector; BLOCK] {
        let mut sums = [Vector::zeros(); BLOCK];
        each!(frame.packed, columns => dispatch!(level(), simd => {
            self.add_repulsions(simd, frame, &columns.bodies, (agents, half), &mut sums);
        }));
        sums
    }

    #[inline(always)]
    fn add_repulsions<R: Real, S: Simd>(
        &self,
        simd: S,
        frame: &Frame,
        bodies: &Bodies<R>,
        (agents, half): (Range<usize>, Half),
        sums: &mut [Vector; BLOCK],
    ) {
        let leans = Leans {
            agents: frame.agents,
            states: match half {
                Half::Body => None,
                Half::Legs => frame.agents.states_of(NAME),
            },
        };
        let range = self.range_of(half);
        for (cluster, runs) in frame
            .neighbors
            .near()
            .block(agents.start / BLOCK)
            .clusters()
        {
            if cluster.end <= agents.start || agents.end <= cluster.start {
                continue;
            }
            let (x, y) = leans.of_cluster(cluster.clone());
            let mut sum = Repulsion {
                leans,
                own: [lanes_from::<R, S>(simd, &x), lanes_from::<R, S>(simd, &y)],
                unit: splat::<R, S>(simd, bodies.unit),
                reach_squared: splat::<R, S>(simd, self.legs_reach * self.legs_reach),
                per_range: splat::<R, S>(simd, -LOG2_E / range),
                at_reach: splat::<R, S>(simd, exp(-self.legs_reach / range)),
                along: [splat::<R, S>(simd, 0.0); 2],
            };
            add_pairs(simd, bodies, (cluster.start, runs), &mut sum);
            let [x, y] = sum.along.map(store::<R, S>);
            for (k, i) in cluster.enumerate() {
                sums[i % BLOCK] = Vector::new(x[k], y[k]) * self.legs_strength;
            }
        }
    }
}

/// The leans of people; all are zero without states.
#[derive(Clone, Copy)]
struct Leans<'a> {
    agents: &'a Agents,
    states: Option<&'a States>,
}

impl Leans<'_> {
    #[inline(always)]
    fn of(&self, i: usize) -> Vector {
        let state = self.states.and_then(|states| states.of(i));
        state.map_or(Vector::zeros(), |state| {
            self.agents.position[i] - parts(state)[0]
        })
    }

    /// Those of the agents of a cluster, along x and along y, padded with zeros.
    fn of_cluster(&self, cluster: Range<usize>) -> ([f64; LANES], [f64; LANES]) {
        let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
        for (k, i) in cluster.enumerate() {
            let lean = self.of(i);
            (x[k], y[k]) = (lean.x, lean.y);
        }
        (x, y)
    }
}

/// The sum for eight agents i.
struct Repulsion<'a, R: Real, S: Simd> {
    leans: Leans<'a>,
    /// ℓ_i, meters.
    own: [Lanes<R, S>; 2],
    /// Meters per coordinate unit.
    unit: Lanes<R, S>,
    /// R², m².
    reach_squared: Lanes<R, S>,
    /// −log₂e/B, 1/m.
    per_range: Lanes<R, S>,
    /// e^(−R/B).
    at_reach: Lanes<R, S>,
    /// Σ_j f(|d|, B) d/|d|.
    along: [Lanes<R, S>; 2],
}

impl<R: Real, S: Simd> PairSum<R, S> for Repulsion<'_, R, S> {
    /// The index of the first agent.
    type Run = usize;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> usize {
        run.start
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], first: usize, j: usize) {
        let (zero, tiny) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, R::TINY));
        let (dx, dy) = (dx * self.unit, dy * self.unit);
        let is_near = dy.mul_add_precise(dy, dx * dx).simd_lt(self.reach_squared);
        if is_near.all_false() {
            return;
        }
        let lean = self.leans.of(first + j);
        let x = dx - self.own[0] + splat::<R, S>(simd, lean.x);
        let y = dy - self.own[1] + splat::<R, S>(simd, lean.y);
        let distance = y.mul_add_precise(y, x * x).max(tiny).sqrt();
        let falling = R::exp2(simd, distance * self.per_range) - self.at_reach;
        let force = is_near.select(falling.max(zero), zero) / distance;
        self.along[0] = force.mul_add_precise(x, self.along[0]);
        self.along[1] = force.mul_add_precise(y, self.along[1]);
    }
}

//! Weighted moments of the velocities around each person.

use std::ops::Range;

use engine::math::Vector;
use engine::neighbors::{BLOCK, ClusterBlock};
use engine::pairs::prelude::*;
use engine::pairs::{
    Bodies, Lanes, PairSum, Simd, add_pairs, dispatch, level, load, splat, spread, store,
};

/// Σ W, Σ W v and Σ W |v|² over people with a known velocity; the scale of W does not matter.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    weight: f64,
    sum: Vector,
    squares: f64,
}

impl Moments {
    /// Adds a person.
    pub fn add(&mut self, weight: f64, velocity: Vector) {
        self.weight += weight;
        self.sum += velocity * weight;
        self.squares += velocity.norm_squared() * weight;
    }

    /// The variance of the velocities, m²/s², to about 1e-15 |v|²; `None` if none is known.
    pub fn variance(&self) -> Option<f64> {
        let mean = self.sum / self.weight;
        let variance = self.squares / self.weight - mean.norm_squared();
        (self.weight > 0.0).then(|| variance.max(0.0))
    }
}

/// The moments of each agent of a block over all agents within reach. Masses are 1, or 0 for unknown velocities.
pub fn of_block(bodies: &Bodies<f64>, block: &ClusterBlock, out: &mut [Moments]) {
    dispatch!(level(), simd => sums(simd, bodies, block, out));
}

#[inline(always)]
fn sums<S: Simd>(simd: S, bodies: &Bodies<f64>, block: &ClusterBlock, out: &mut [Moments]) {
    for (agents, runs) in block.clusters() {
        let per_h: Lanes<f64, S> = load(simd, &bodies.per_support, agents.start);
        let mut sum = Sum {
            bodies,
            scale: per_h * per_h * splat::<f64, S>(simd, -1.0),
            sums: [splat::<f64, S>(simd, 0.0); 4],
        };
        add_pairs(simd, bodies, (agents.start, runs), &mut sum);
        let [weight, x, y, squares] = sum.sums.map(store::<f64, S>);
        let own = agents.start % BLOCK;
        for (k, moments) in out[own..own + agents.len()].iter_mut().enumerate() {
            *moments = Moments {
                weight: weight[k],
                sum: Vector::new(x[k], y[k]),
                squares: squares[k],
            };
        }
    }
}

/// The sums for eight agents i.
struct Sum<'a, S: Simd> {
    bodies: &'a Bodies<f64>,
    /// −1/h².
    scale: Lanes<f64, S>,
    /// Σ W, Σ W v_x, Σ W v_y and Σ W |v|² without the factor of Eq. 13.
    sums: [Lanes<f64, S>; 4],
}

/// Mass and velocity of a run of agents j.
#[derive(Clone, Copy)]
struct Run<'a>(&'a [f64], &'a [f64], &'a [f64]);

impl<'a, S: Simd> PairSum<f64, S> for Sum<'a, S> {
    type Run = Run<'a>;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Run<'a> {
        Run(
            &self.bodies.mass[run.clone()],
            &self.bodies.velocity_x[run.clone()],
            &self.bodies.velocity_y[run],
        )
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<f64, S>; 2], Run(mass, x, y): Run, j: usize) {
        let (zero, one) = (splat::<f64, S>(simd, 0.0), splat::<f64, S>(simd, 1.0));
        let squared = dy.mul_add_precise(dy, dx * dx);
        let rest = squared.mul_add_precise(self.scale, one).max(zero);
        let weight = spread::<f64, S>(simd, mass[j]) * rest * rest * rest;
        let (x, y) = (x[j], y[j]);
        self.sums[0] = weight + self.sums[0];
        self.sums[1] = weight.mul_add_precise(spread::<f64, S>(simd, x), self.sums[1]);
        self.sums[2] = weight.mul_add_precise(spread::<f64, S>(simd, y), self.sums[2]);
        self.sums[3] = weight.mul_add_precise(spread::<f64, S>(simd, x * x + y * y), self.sums[3]);
    }
}

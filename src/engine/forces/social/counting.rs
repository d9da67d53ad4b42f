//! Eq. 18 for one agent, with only the pairs that count.

use std::ops::Range;

use super::SocialForce;
use super::cutoff::Cutoff;
use super::near::{Near, grow};
use super::sum::{Feeling, Pairs};
use crate::math::Vector;
use crate::pairs::prelude::*;
use crate::pairs::{
    Bodies, LANES, Lanes, Real, Simd, first_lanes, load, seen_from, splat, spread, store,
};

/// The pairs of one agent i whose force may exceed the tolerance, in their order, side by side. Few of the pairs of a
/// cluster count for each of its agents, in particular where agents walk toward each other.
#[derive(Default)]
pub struct Counting<R: Real> {
    dx: Vec<R>,
    dy: Vec<R>,
    velocity_x: Vec<R>,
    velocity_y: Vec<R>,
    steps: usize,
}

impl<R: Real> Counting<R> {
    /// The sum of Eq. 18 over the agents `near` that count for agent `i`.
    #[inline(always)]
    pub fn sum<S: Simd>(
        &mut self,
        simd: S,
        (social, cutoff): (&SocialForce, &Cutoff<R, S>),
        (bodies, near): (&Bodies<R>, &Near<R>),
        i: usize,
    ) -> Vector {
        let velocity = [
            spread(simd, bodies.velocity_x[i]),
            spread(simd, bodies.velocity_y[i]),
        ];
        let feeling = Feeling::new(simd, social, bodies.unit, velocity);
        let x = R::place(simd, bodies.x[i]);
        let y = R::place(simd, bodies.y[i]);
        let most = near.x.len();
        grow(&mut self.dx, most);
        grow(&mut self.dy, most);
        grow(&mut self.velocity_x, most);
        grow(&mut self.velocity_y, most);
        let (mut from, mut count) = (0, 0);
        for part in &near.parts {
            let at = seen_from(simd, bodies, [x, y], part.laps);
            count = self.take(simd, (&feeling, cutoff), (near, at, from..part.end), count);
            from = part.end;
        }
        // Agents at the same place exert no force.
        let zero = splat::<R, S>(simd, 0.0);
        zero.store_slice(&mut self.dx[count..count + LANES]);
        zero.store_slice(&mut self.dy[count..count + LANES]);
        self.steps = count.div_ceil(LANES);
        let mut sum = [zero; 2];
        feeling.add(simd, &*self, &mut sum);
        let (x, y) = (store::<R, S>(sum[0]), store::<R, S>(sum[1]));
        Vector::new(x.iter().sum(), y.iter().sum())
    }

    /// Appends the pairs with `others` that count, seen from `at`, to the first `count` pairs, and returns their new
    /// number.
    #[inline(always)]
    fn take<S: Simd>(
        &mut self,
        simd: S,
        (feeling, cutoff): (&Feeling<R, S>, &Cutoff<R, S>),
        (near, at, others): (&Near<R>, [R::Places<S>; 2], Range<usize>),
        mut count: usize,
    ) -> usize {
        let len = others.len();
        let padded = others.start..others.start + len + LANES;
        let (x, y) = (&near.x[padded.clone()], &near.y[padded.clone()]);
        let velocity_x = &near.velocity_x[padded.clone()];
        let velocity_y = &near.velocity_y[padded];
        let room = count + len + LANES;
        let (dx_out, dy_out) = (&mut self.dx[..room], &mut self.dy[..room]);
        let velocity_x_out = &mut self.velocity_x[..room];
        let velocity_y_out = &mut self.velocity_y[..room];
        for j in (0..len).step_by(LANES) {
            let dx = R::between(at[0], R::places(simd, &x[j..]));
            let dy = R::between(at[1], R::places(simd, &y[j..]));
            let (vx, vy) = (load(simd, velocity_x, j), load(simd, velocity_y, j));
            let [sx, sy] = feeling.shift([vx, vy]);
            let (ax, ay) = (dx + sx, dy + sy);
            let d_squared = dy.mul_add_precise(dy, dx * dx);
            let a_squared = ay.mul_add_precise(ay, ax * ax);
            let dot = dy.mul_add_precise(ay, dx * ax);
            let counts = cutoff.counts(d_squared, a_squared, dot) & feeling.is_in_range(d_squared);
            let here = count..count + LANES;
            dx.compress(counts).store_slice(&mut dx_out[here.clone()]);
            dy.compress(counts).store_slice(&mut dy_out[here.clone()]);
            vx.compress(counts)
                .store_slice(&mut velocity_x_out[here.clone()]);
            vy.compress(counts).store_slice(&mut velocity_y_out[here]);
            count += (counts.to_bitmask() & first_lanes(len - j)).count_ones() as usize;
        }
        count
    }
}

impl<R: Real, S: Simd> Pairs<R, S> for Counting<R> {
    #[inline(always)]
    fn steps(&self) -> usize {
        self.steps
    }

    #[inline(always)]
    fn pairs(&self, simd: S, step: usize) -> [[Lanes<R, S>; 2]; 2] {
        let start = step * LANES;
        [
            [load(simd, &self.dx, start), load(simd, &self.dy, start)],
            [
                load(simd, &self.velocity_x, start),
                load(simd, &self.velocity_y, start),
            ],
        ]
    }
}

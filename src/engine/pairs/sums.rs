//! Sums over runs of agents j for [`LANES`] agents i at a time: each agent j is read once for all of them.
//!
//! Closures do not inherit `#[target_feature]`: the loops are closure-free, and all they call is `#[inline(always)]`.

use std::ops::Range;

use fearless_simd::{Simd, dispatch, f64x2, f64x8, prelude::*};

use super::columns::Bodies;
use super::real::{LANES, Lanes, Real};
use super::vectors::level;
use crate::math::Vector;
use crate::neighbors::Run;

/// A sum over agents j, for [`LANES`] agents i.
pub trait PairSum<R: Real, S: Simd> {
    /// The columns that the sum reads besides positions, of a run of agents.
    type Run: Copy;

    /// These columns for the agents `run`.
    fn run(&self, run: Range<usize>) -> Self::Run;

    /// Adds agent `j` of a run, given r_ij = r_i − r_j in coordinate units. Agents out of reach must add zero.
    fn add(&mut self, simd: S, r_ij: [Lanes<R, S>; 2], run: Self::Run, j: usize);
}

/// Adds all agents of `runs` to the sum of the agents from `start` on.
#[inline(always)]
pub fn add_pairs<R: Real, S: Simd>(
    simd: S,
    bodies: &Bodies<R>,
    (start, runs): (usize, &[Run]),
    sum: &mut impl PairSum<R, S>,
) {
    let x_i = R::places(simd, &bodies.x[start..]);
    let y_i = R::places(simd, &bodies.y[start..]);
    for run in runs {
        let [x_i, y_i] = seen_from(simd, bodies, [x_i, y_i], run.laps);
        let run = run.indices();
        let (x, y) = (&bodies.x[run.clone()], &bodies.y[run.clone()]);
        let count = run.len();
        let others = sum.run(run);
        for j in 0..count {
            let dx = R::differences(simd, x_i, x[j]);
            let dy = R::differences(simd, y_i, y[j]);
            sum.add(simd, [dx, dy], others, j);
        }
    }
}

/// The coordinates from which agents at `places` see the agents of a run, across the ends of the period.
#[inline(always)]
pub fn seen_from<R: Real, S: Simd>(
    simd: S,
    bodies: &Bodies<R>,
    places: [R::Places<S>; 2],
    laps: i32,
) -> [R::Places<S>; 2] {
    if laps == 0 {
        return places;
    }
    [
        R::moved(simd, places[0], bodies.period[0], laps),
        R::moved(simd, places[1], bodies.period[1], laps),
    ]
}

/// `value` in all lanes, rounded.
#[inline(always)]
pub fn splat<R: Real, S: Simd>(simd: S, value: f64) -> Lanes<R, S> {
    spread(simd, R::of(value))
}

/// The bitmask of the first `count` lanes.
#[inline(always)]
pub fn first_lanes(count: usize) -> u64 {
    (1 << count.min(LANES)) - 1
}

/// `number` in all lanes.
#[inline(always)]
pub fn spread<R: Real, S: Simd>(simd: S, number: R) -> Lanes<R, S> {
    R::Lanes::splat(simd, number)
}

/// The numbers of a column from `start` on.
#[inline(always)]
pub fn load<R: Real, S: Simd>(simd: S, column: &[R], start: usize) -> Lanes<R, S> {
    R::Lanes::from_slice(simd, &column[start..start + LANES])
}

/// The first [`LANES`] of `numbers`, rounded, padded with zeros.
#[inline(always)]
pub fn lanes_from<R: Real, S: Simd>(simd: S, numbers: &[f64]) -> Lanes<R, S> {
    let mut padded = [R::default(); LANES];
    for (lane, &number) in padded.iter_mut().zip(numbers) {
        *lane = R::of(number);
    }
    R::Lanes::from_slice(simd, &padded)
}

/// The number in each lane, in double precision.
#[inline(always)]
pub fn store<R: Real, S: Simd>(lanes: Lanes<R, S>) -> [f64; LANES] {
    let mut numbers = [R::default(); LANES];
    lanes.store_slice(&mut numbers);
    let mut doubles = [0.0; LANES];
    for (double, number) in doubles.iter_mut().zip(numbers) {
        *double = number.into();
    }
    doubles
}

/// Adds `numerator` divided by each of `denominators` to `sums`.
pub fn add_quotients(numerator: f64, denominators: &[f64], sums: &mut [f64]) {
    dispatch!(level(), _simd => quotients(numerator, denominators, sums));
}

#[inline(always)]
fn quotients(numerator: f64, denominators: &[f64], sums: &mut [f64]) {
    for (sum, denominator) in sums.iter_mut().zip(denominators) {
        *sum += numerator / denominator;
    }
}

/// The coordinates of the first [`LANES`] of `vectors`, along x and along y.
#[inline(always)]
pub fn coordinates<S: Simd>(simd: S, vectors: &[Vector]) -> [f64x8<S>; 2] {
    let vectors = &vectors[..LANES];
    let (low, high) = (four(simd, &vectors[..4]), four(simd, &vectors[4..]));
    let (x, y) = low.deinterleave(high);
    [x, y]
}

/// The coordinates of four vectors, one after the other.
#[inline(always)]
fn four<S: Simd>(simd: S, vectors: &[Vector]) -> f64x8<S> {
    let [a, b, c, d] = [0, 1, 2, 3].map(
        #[inline(always)]
        |k: usize| f64x2::from_slice(simd, vectors[k].as_slice()),
    );
    a.combine(b).combine(c.combine(d))
}

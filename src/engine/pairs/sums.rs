//! The sums over near neighbors, for [`LANES`] agents at a time: each neighbor is read once for all of them.
//!
//! Distances are in coordinate units. Neighbors out of reach add zero.
//!
//! Closures do not inherit `#[target_feature]`: keep these loops closure-free.

use std::f64::consts::PI;

use fearless_simd::{Simd, prelude::*};

use super::columns::{Bodies, Columns};
use super::real::{LANES, Real};
use super::{PairCoefficients, Wanted};
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, ClusterBlock};

#[inline(always)]
pub(super) fn splat<R: Real, S: Simd>(simd: S, value: f64) -> R::Lanes<S> {
    R::Lanes::splat(simd, R::of(value))
}

#[inline(always)]
pub(super) fn load<R: Real, S: Simd>(simd: S, column: &[R], start: usize) -> R::Lanes<S> {
    R::Lanes::from_slice(simd, &column[start..start + LANES])
}

#[inline(always)]
pub(super) fn store<R: Real, S: Simd>(lanes: R::Lanes<S>) -> [R; LANES] {
    let mut numbers = [R::default(); LANES];
    lanes.store_slice(&mut numbers);
    numbers
}

/// Eq. 9 without walls: Σ_j m_j W(r_ij), including j = i, in P/m², for each agent of a block.
#[inline(always)]
pub fn densities<R: Real, S: Simd>(
    simd: S,
    bodies: &Bodies<R>,
    block: &ClusterBlock,
    out: &mut [f64],
) {
    let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
    let mut rest_of_out = out;
    for (agents, runs) in block.clusters() {
        let per_h = load(simd, bodies.per_support, agents.start);
        let per_h_squared = per_h * per_h;
        // −(meters per coordinate unit)²/h².
        let scale = per_h_squared * splat::<R, S>(simd, -bodies.unit * bodies.unit);
        let x_i = R::places(simd, &bodies.x[agents.start..]);
        let y_i = R::places(simd, &bodies.y[agents.start..]);
        let mut sum = zero;
        for run in runs {
            let run = run.start as usize..run.end as usize;
            let count = run.len();
            let (x, y) = (&bodies.x[run.clone()], &bodies.y[run.clone()]);
            let mass = &bodies.mass[run];
            for j in 0..count {
                let dx = R::differences(simd, x_i, x[j]);
                let dy = R::differences(simd, y_i, y[j]);
                let squared = dy.mul_add(dy, dx * dx);
                let rest = squared.mul_add(scale, one).max(zero);
                let m = R::Lanes::splat(simd, mass[j]);
                sum = (m * rest).mul_add(rest * rest, sum);
            }
        }
        let sums = store::<R, S>(sum * per_h_squared * splat::<R, S>(simd, 4.0 / PI)); // Eq. 13
        let (here, others) = rest_of_out.split_at_mut(agents.len());
        for (density, sum) in here.iter_mut().zip(sums) {
            *density = sum.double();
        }
        rest_of_out = others;
    }
}

/// The forces of Eqs. 7, 11 and 22, times their coefficients, summed for each agent of a block. Forces that are not
/// wanted must have coefficient 0: they may be skipped.
#[inline(always)]
pub fn accelerations<R: Real, S: Simd>(
    simd: S,
    columns: &Columns<R>,
    block: &ClusterBlock,
    coefficients: &PairCoefficients,
    wanted: Wanted,
    out: &mut [Vector],
) {
    let Wanted {
        pressure,
        viscosity,
        contact,
    } = wanted;
    match (pressure || viscosity, viscosity, contact) {
        (false, _, false) => out.fill(Vector::zeros()),
        (false, _, true) => {
            each_cluster::<R, S, false, false, true>(simd, columns, block, coefficients, out)
        }
        (true, false, _) => {
            each_cluster::<R, S, true, false, true>(simd, columns, block, coefficients, out)
        }
        (true, true, _) => {
            each_cluster::<R, S, true, true, true>(simd, columns, block, coefficients, out)
        }
    }
}

/// The first [`LANES`] of `numbers` at `from` and up, padded with zeros.
#[inline(always)]
fn lanes<R: Real, S: Simd>(simd: S, numbers: &[f64], from: usize) -> R::Lanes<S> {
    let mut padded = [R::default(); LANES];
    for (lane, &number) in padded.iter_mut().zip(&numbers[from..]) {
        *lane = R::of(number);
    }
    R::Lanes::from_slice(simd, &padded)
}

#[inline(always)]
fn each_cluster<
    R: Real,
    S: Simd,
    const PRESSURE: bool,
    const VISCOSITY: bool,
    const CONTACT: bool,
>(
    simd: S,
    columns: &Columns<R>,
    block: &ClusterBlock,
    coefficients: &PairCoefficients,
    mut out: &mut [Vector],
) {
    let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
    let tiny = splat::<R, S>(simd, R::TINY);
    let minus_unit = splat::<R, S>(simd, -columns.unit);
    for (agents, runs) in block.clusters() {
        let start = agents.start;
        let own = start % BLOCK;
        let x_i = R::places(simd, &columns.x[start..]);
        let y_i = R::places(simd, &columns.y[start..]);
        let per_h = load(simd, &columns.per_support, start);
        let minus_unit_per_h = minus_unit * per_h;

        let per_h_3 = per_h * per_h * per_h;
        // Half of Eq. 14, without the direction and with the opposite sign.
        let push = lanes::<R, S>(simd, &coefficients.pressure, own) * per_h_3;
        let push = push * splat::<R, S>(simd, 15.0 / PI);
        let push_p_i = push * load(simd, &columns.pressure, start);
        // Eq. 15.
        let drag = lanes::<R, S>(simd, &coefficients.viscosity, own) * per_h_3 * per_h;
        let drag = drag * splat::<R, S>(simd, 360.0 / (29.0 * PI));
        let vx_i = load(simd, &columns.velocity_x, start);
        let vy_i = load(simd, &columns.velocity_y, start);
        // Eq. 22.
        let stiffness = lanes::<R, S>(simd, &coefficients.contact, own);
        let radius_i = load(simd, &columns.radius, start);

        let (mut along_x, mut along_y) = (zero, zero);
        let (mut change_x, mut change_y) = (zero, zero);
        for run in runs {
            let run = run.start as usize..run.end as usize;
            let count = run.len();
            let (x, y) = (&columns.x[run.clone()], &columns.y[run.clone()]);
            let vx = &columns.velocity_x[run.clone()];
            let vy = &columns.velocity_y[run.clone()];
            let volume = &columns.volume[run.clone()];
            let pressure = &columns.pressure[run.clone()];
            let radius = &columns.radius[run];
            for j in 0..count {
                let dx = R::differences(simd, x_i, x[j]);
                let dy = R::differences(simd, y_i, y[j]);
                let distance = dy.mul_add(dy, dx * dx).max(tiny).sqrt();
                let inverse = one / distance;
                let mut force = zero;
                if PRESSURE {
                    let rest = minus_unit_per_h.mul_add(distance, one).max(zero);
                    let weight = R::Lanes::splat(simd, volume[j]) * rest;
                    let both = push.mul_add(R::Lanes::splat(simd, pressure[j]), push_p_i);
                    force = weight * rest * both;
                    if VISCOSITY {
                        let dvx = R::Lanes::splat(simd, vx[j]) - vx_i;
                        let dvy = R::Lanes::splat(simd, vy[j]) - vy_i;
                        change_x = weight.mul_add(dvx, change_x);
                        change_y = weight.mul_add(dvy, change_y);
                    }
                }
                if CONTACT {
                    let radius_j = R::Lanes::splat(simd, radius[j]);
                    let overlap = minus_unit.mul_add(distance, radius_i + radius_j).max(zero);
                    force = stiffness.mul_add(overlap, force);
                }
                let force = force * inverse;
                along_x = force.mul_add(dx, along_x);
                along_y = force.mul_add(dy, along_y);
            }
        }
        let sum_x = store::<R, S>(drag.mul_add(change_x, along_x));
        let sum_y = store::<R, S>(drag.mul_add(change_y, along_y));
        let (here, others) = out.split_at_mut(agents.len());
        for (k, sum) in here.iter_mut().enumerate() {
            *sum = Vector::new(sum_x[k].double(), sum_y[k].double());
        }
        out = others;
    }
}

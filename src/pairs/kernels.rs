//! The sums themselves, [`LANES`] neighbours at a time.
//!
//! Lengths are taken in units of h, so that single precision neither over- nor underflows; what is
//! constant in a sum is multiplied in at its end, in double precision.
//!
//! No closures here: they would not be compiled for the vectors that the function is.

use std::f64::consts::PI;
use std::ops::Range;

use fearless_simd::{Simd, prelude::*};

use super::PairSums;
use super::columns::Columns;
use super::real::{LANES, Real};
use crate::math::Vector;
use crate::neighbors::{Chunk, Chunks};

/// Lanes of chunks, the distances to an agent in units of its h.
struct Offsets<R: Real, S: Simd> {
    simd: S,
    /// Metres² per coordinate unit² over h².
    scale: R::Lanes<S>,
    lane: R::Lanes<S>,
    beyond: R::Lanes<S>,
}

impl<R: Real, S: Simd> Offsets<R, S> {
    #[inline(always)]
    fn new(simd: S, unit: f64, h: f64) -> Self {
        let mut lane = [R::of(0.0); LANES];
        for (k, number) in lane.iter_mut().enumerate() {
            *number = R::of(k as f64);
        }
        Self {
            simd,
            scale: splat::<R, S>(simd, (unit / h).powi(2)),
            lane: R::Lanes::from_slice(simd, &lane),
            beyond: splat::<R, S>(simd, 1e20),
        }
    }

    /// |r_ij|² / h², and far beyond reach in lanes that do not belong to the chunk.
    #[inline(always)]
    fn squared(&self, chunk: &Chunk, dx: R::Lanes<S>, dy: R::Lanes<S>) -> R::Lanes<S> {
        let count = splat::<R, S>(self.simd, f64::from(chunk.count));
        let squared = dy.mul_add(dy, dx * dx) * self.scale;
        self.lane.simd_lt(count).select(squared, self.beyond)
    }
}

#[inline(always)]
fn splat<R: Real, S: Simd>(simd: S, value: f64) -> R::Lanes<S> {
    R::Lanes::splat(simd, R::of(value))
}

#[inline(always)]
fn load<R: Real, S: Simd>(simd: S, column: &[R], chunk: &Chunk) -> R::Lanes<S> {
    let start = chunk.start as usize;
    R::Lanes::from_slice(simd, &column[start..start + LANES])
}

#[inline(always)]
fn differences<R: Real, S: Simd>(
    simd: S,
    from: R::Coordinate,
    to: &[R::Coordinate],
    chunk: &Chunk,
) -> R::Lanes<S> {
    let start = chunk.start as usize;
    R::differences(simd, from, &to[start..start + LANES])
}

/// Eq. 9, the agents' part with the agent itself: Σ_j m_j W(r_ij), P/m², for the agents in `block`, with
/// h in metres for each.
#[inline(always)]
pub fn densities<R: Real, S: Simd>(
    simd: S,
    columns: &Columns<R>,
    chunks: &Chunks,
    (block, support): (Range<usize>, &[f64]),
    out: &mut [f64],
) {
    let length = columns.x.len();
    let (x, y) = (&columns.x[..length], &columns.y[..length]);
    let mass = &columns.mass[..length];
    let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
    for ((i, &h), density) in block.zip(support).zip(out) {
        let offsets = Offsets::<R, S>::new(simd, columns.unit, h);
        let mut sum = zero;
        for chunk in chunks.of(i) {
            let dx = differences::<R, S>(simd, x[i], x, chunk);
            let dy = differences::<R, S>(simd, y[i], y, chunk);
            let rest = (one - offsets.squared(chunk, dx, dy)).max(zero);
            sum = (load(simd, mass, chunk) * rest).mul_add(rest * rest, sum);
        }
        *density = sum.reduce_sum().double() * (4.0 / (PI * h * h)); // Eq. 13
    }
}

/// Eqs. 7, 11 and 22 for the agents in `block`, with h in metres for each.
#[inline(always)]
pub fn forces<R: Real, S: Simd>(
    simd: S,
    columns: &Columns<R>,
    chunks: &Chunks,
    (block, support): (Range<usize>, &[f64]),
    out: &mut [PairSums],
) {
    let length = columns.x.len();
    let (x, y) = (&columns.x[..length], &columns.y[..length]);
    let (vx, vy) = (&columns.velocity_x[..length], &columns.velocity_y[..length]);
    let (radius, volume) = (&columns.radius[..length], &columns.volume[..length]);
    let pressure = &columns.pressure[..length];
    let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
    let tiny = splat::<R, S>(simd, R::TINY);
    for ((i, &h), out) in block.zip(support).zip(out) {
        let offsets = Offsets::<R, S>::new(simd, columns.unit, h);
        let per_h = splat::<R, S>(simd, 1.0 / h);
        let radius_i = splat::<R, S>(simd, radius[i].double() / h);
        let vx_i = R::Lanes::splat(simd, vx[i]);
        let vy_i = R::Lanes::splat(simd, vy[i]);
        let p_i = R::Lanes::splat(simd, pressure[i]);
        let (mut pressure_x, mut pressure_y) = (zero, zero);
        let (mut viscosity_x, mut viscosity_y) = (zero, zero);
        let (mut contact_x, mut contact_y) = (zero, zero);
        for chunk in chunks.of(i) {
            let dx = differences::<R, S>(simd, x[i], x, chunk);
            let dy = differences::<R, S>(simd, y[i], y, chunk);
            let distance = offsets.squared(chunk, dx, dy).max(tiny).sqrt();
            let inverse = one / distance;
            let rest = (one - distance).max(zero);

            let laplacian = load(simd, volume, chunk) * rest;
            viscosity_x = laplacian.mul_add(load(simd, vx, chunk) - vx_i, viscosity_x);
            viscosity_y = laplacian.mul_add(load(simd, vy, chunk) - vy_i, viscosity_y);

            let slope = laplacian * rest * (p_i + load(simd, pressure, chunk)) * inverse;
            pressure_x = slope.mul_add(dx, pressure_x);
            pressure_y = slope.mul_add(dy, pressure_y);

            let reach = load(simd, radius, chunk).mul_add(per_h, radius_i);
            let overlap = (reach * inverse - one).max(zero);
            contact_x = overlap.mul_add(dx, contact_x);
            contact_y = overlap.mul_add(dy, contact_y);
        }
        let slope = -30.0 / (PI * h.powi(4)); // Eq. 14, with one h in the direction
        let laplacian = 360.0 / (29.0 * PI * h.powi(4)); // Eq. 15
        *out = PairSums {
            pressure: total::<R, S>(pressure_x, pressure_y) * (0.5 * slope * columns.unit),
            viscosity: total::<R, S>(viscosity_x, viscosity_y) * laplacian,
            contact: total::<R, S>(contact_x, contact_y) * columns.unit,
        };
    }
}

#[inline(always)]
fn total<R: Real, S: Simd>(x: R::Lanes<S>, y: R::Lanes<S>) -> Vector {
    Vector::new(x.reduce_sum().double(), y.reduce_sum().double())
}

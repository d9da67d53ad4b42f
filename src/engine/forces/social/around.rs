//! The places and velocities that agents around a cluster must have to act on it.

use std::ops::Range;

use super::cutoff::Cutoff;
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, Lanes, Mask, Real, Simd, first_lanes, load, splat, spread};

/// More than the rounding errors of lengths, relative to the largest length, and of velocities.
const ROUNDING: f64 = 2e-6;

/// Bounds of a cluster, for eight agents j at a time.
pub struct Around<'a, R: Real, S: Simd> {
    /// The place of its first agent.
    pub origin: [R::Places<S>; 2],
    /// The bounding box of its places, from the origin, in coordinate units.
    places: [[Lanes<R, S>; 2]; 2],
    /// The bounding box of its velocities, m/s.
    velocities: [[Lanes<R, S>; 2]; 2],
    /// The square of the avoidance radius, in coordinate units².
    radius_squared: Lanes<R, S>,
    cutoff: Option<&'a Cutoff<R, S>>,
}

impl<'a, R: Real, S: Simd> Around<'a, R, S> {
    /// The bounds of `agents`, at most eight.
    #[inline(always)]
    pub fn new(
        simd: S,
        radius: f64,
        cutoff: Option<&'a Cutoff<R, S>>,
        bodies: &Bodies<R>,
        agents: Range<usize>,
    ) -> Self {
        let start = agents.start;
        let origin = [
            R::place(simd, bodies.x[start]),
            R::place(simd, bodies.y[start]),
        ];
        let own = Mask::<R, S>::from_bitmask(simd, first_lanes(agents.len()));
        let x = R::between(R::places(simd, &bodies.x[start..]), origin[0]);
        let y = R::between(R::places(simd, &bodies.y[start..]), origin[1]);
        let zero = splat::<R, S>(simd, 0.0);
        let (x, y) = (own.select(x, zero), own.select(y, zero));
        let (vx, vy) = (bodies.velocity_x[start], bodies.velocity_y[start]);
        let vx = own.select(load(simd, &bodies.velocity_x, start), spread(simd, vx));
        let vy = own.select(load(simd, &bodies.velocity_y, start), spread(simd, vy));

        let radius = radius / bodies.unit;
        let width =
            (x.reduce_max() - x.reduce_min()).into() + (y.reduce_max() - y.reduce_min()).into();
        Self {
            origin,
            places: [
                widened::<R, S>(simd, x, ROUNDING * (radius + width)),
                widened::<R, S>(simd, y, ROUNDING * (radius + width)),
            ],
            velocities: [
                widened::<R, S>(simd, vx, ROUNDING * vx.abs().reduce_max().into()),
                widened::<R, S>(simd, vy, ROUNDING * vy.abs().reduce_max().into()),
            ],
            radius_squared: splat::<R, S>(simd, radius * radius * (1.0 + ROUNDING)),
            cutoff,
        }
    }

    /// Whether agents at these places, from the origin in coordinate units, may act on any agent of the cluster.
    #[inline(always)]
    pub fn counts(
        &self,
        simd: S,
        [x, y]: [Lanes<R, S>; 2],
        [vx, vy]: [Lanes<R, S>; 2],
    ) -> Mask<R, S> {
        let x = outside::<R, S>(simd, x, self.places[0]);
        let y = outside::<R, S>(simd, y, self.places[1]);
        let r_squared = y.mul_add_precise(y, x * x);
        let mut counts = r_squared.simd_lt(self.radius_squared);
        if let Some(cutoff) = self.cutoff {
            let [[slowest_x, fastest_x], [slowest_y, fastest_y]] = self.velocities;
            let vx = (fastest_x - vx).max(vx - slowest_x);
            let vy = (fastest_y - vy).max(vy - slowest_y);
            counts &= cutoff.group_counts(r_squared, vy.mul_add_precise(vy, vx * vx));
        }
        counts
    }
}

/// The least and the greatest number of eight, and some more on either side.
#[inline(always)]
fn widened<R: Real, S: Simd>(simd: S, numbers: Lanes<R, S>, by: f64) -> [Lanes<R, S>; 2] {
    let (least, most): (f64, f64) = (numbers.reduce_min().into(), numbers.reduce_max().into());
    [
        splat::<R, S>(simd, least - by),
        splat::<R, S>(simd, most + by),
    ]
}

/// The distances of numbers from an interval; 0 inside.
#[inline(always)]
fn outside<R: Real, S: Simd>(
    simd: S,
    numbers: Lanes<R, S>,
    [low, high]: [Lanes<R, S>; 2],
) -> Lanes<R, S> {
    (low - numbers)
        .max(numbers - high)
        .max(splat::<R, S>(simd, 0.0))
}

//! The pressure of near agents on each other: the virial of pressure and contact.

use std::ops::Range;

use crate::forces::near::PairCoefficients;
use crate::forces::{contact, pressure};
use crate::neighbors::{BLOCK, ClusterBlock};
use crate::pairs::prelude::*;
use crate::pairs::{
    Columns, Lanes, PairSum, Real, Simd, add_pairs, dispatch, level, load, splat, spread, store,
};

/// Σ_j r_ij ⊗ a_ij as xx, xy and yy, m²/s², where a_ij is the acceleration of i by the pressure (Eq. 11) and contact
/// (Eq. 22) of j, of each agent of a block. A coordinate unit of `columns` is a meter.
pub fn virials(
    columns: &Columns<f64>,
    block: &ClusterBlock,
    felt: &PairCoefficients,
    out: &mut [[f64; 3]],
) {
    dispatch!(level(), simd => sums(simd, columns, block, felt, out));
}

#[inline(always)]
fn sums<S: Simd>(
    simd: S,
    columns: &Columns<f64>,
    block: &ClusterBlock,
    felt: &PairCoefficients,
    out: &mut [[f64; 3]],
) {
    for (agents, runs) in block.clusters() {
        let start = agents.start;
        let own = start % BLOCK;
        let mut sum = Virial::<f64, S> {
            columns,
            minus_per_h: splat::<f64, S>(simd, -1.0)
                * load(simd, &columns.bodies.per_support, start),
            pressure: pressure::FromAgents::new(simd, columns, start, &felt.pressure[own..]),
            contact: contact::FromAgents::new(simd, columns, start, &felt.contact[own..]),
            sums: [splat::<f64, S>(simd, 0.0); 3],
        };
        add_pairs(simd, &columns.bodies, (start, runs), &mut sum);
        let [xx, xy, yy] = sum.sums.map(store::<f64, S>);
        for (k, virial) in out[own..own + agents.len()].iter_mut().enumerate() {
            *virial = [xx[k], xy[k], yy[k]];
        }
    }
}

/// The virials of eight agents i.
struct Virial<'a, R: Real, S: Simd> {
    columns: &'a Columns<R>,
    /// −1/h.
    minus_per_h: Lanes<R, S>,
    pressure: pressure::FromAgents<R, S>,
    contact: contact::FromAgents<R, S>,
    /// xx, xy, yy.
    sums: [Lanes<R, S>; 3],
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for Virial<'a, R, S> {
    /// Volumes, pressures and radii.
    type Run = [&'a [R]; 3];

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> [&'a [R]; 3] {
        let Columns {
            volume,
            pressure,
            bodies,
            ..
        } = self.columns;
        [volume, pressure, &bodies.contact_radius].map(|column| &column[run.clone()])
    }

    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        [dx, dy]: [Lanes<R, S>; 2],
        [volume, pressure, radius]: [&'a [R]; 3],
        j: usize,
    ) {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let tiny = splat::<R, S>(simd, R::TINY);
        let distance = dy.mul_add_precise(dy, dx * dx).max(tiny).sqrt();
        let rest = self.minus_per_h.mul_add_precise(distance, one).max(zero);
        let weight = spread::<R, S>(simd, volume[j]) * rest;
        let p_j = spread(simd, pressure[j]);
        let along = self.pressure.along(weight, rest, p_j);
        let d_j = spread(simd, radius[j]);
        let force = self.contact.added_to(simd, along, distance, d_j) / distance;
        let (x, y) = (force * dx, force * dy);
        self.sums[0] = x.mul_add_precise(dx, self.sums[0]);
        self.sums[1] = x.mul_add_precise(dy, self.sums[1]);
        self.sums[2] = y.mul_add_precise(dy, self.sums[2]);
    }
}

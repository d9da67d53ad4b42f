//! The forces between near agents, summed in one pass over the pairs: pressure, viscosity, and contact. Each force's
//! equation is in its own file.

use std::ops::Range;

use crate::forces::{contact, pressure, viscosity};
use crate::frame::Frame;
use crate::math::Vector;
use crate::neighbors::{BLOCK, ClusterBlock};
use crate::pairs::prelude::*;
use crate::pairs::{
    Columns, Lanes, PairSum, Real, Simd, add_pairs, dispatch, each, level, load, splat, spread,
    store,
};

/// Factors that turn the sums over the near neighbors of a block's agents into accelerations; 0 for an agent that
/// does not feel the force.
#[derive(Debug, Clone, PartialEq)]
pub struct PairCoefficients {
    /// Factor of −Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W, Eq. 11: 1/ρ_i.
    pub pressure: [f64; BLOCK],
    /// Factor of Σ_j m_j (v_j − v_i)/ρ_j ∇²W, Eq. 7: μ/ρ_i.
    pub viscosity: [f64; BLOCK],
    /// Factor of Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, Eq. 22: K^ag/m_i.
    pub contact: [f64; BLOCK],
}

impl Default for PairCoefficients {
    fn default() -> Self {
        Self {
            pressure: [0.0; BLOCK],
            viscosity: [0.0; BLOCK],
            contact: [0.0; BLOCK],
        }
    }
}

/// Which sums the profiles of a scene read; other sums may be skipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Wanted {
    /// Eq. 11.
    pub pressure: bool,
    /// Eq. 7.
    pub viscosity: bool,
    /// Eq. 22.
    pub contact: bool,
}

impl Wanted {
    /// All sums.
    pub const ALL: Self = Self {
        pressure: true,
        viscosity: true,
        contact: true,
    };

    /// Whether any sum is wanted.
    pub fn any(self) -> bool {
        self.pressure || self.viscosity || self.contact
    }

    /// The sums that `self` or `other` contains.
    pub fn with(self, other: Self) -> Self {
        Self {
            pressure: self.pressure || other.pressure,
            viscosity: self.viscosity || other.viscosity,
            contact: self.contact || other.contact,
        }
    }
}

/// Accelerations of the agents of block `b` from their near neighbors, m/s². Forces that are not wanted must have
/// coefficient 0: they may be skipped.
pub fn accelerations(
    frame: &Frame,
    b: usize,
    coefficients: &PairCoefficients,
    wanted: Wanted,
    out: &mut [Vector],
) {
    let block = frame.neighbors.near().block(b);
    let sph = wanted.pressure || wanted.viscosity;
    each!(frame.packed, columns => dispatch!(level(), simd => {
        let input = (columns, block, coefficients);
        match (sph, wanted.viscosity, wanted.contact) {
            (false, _, false) => out.fill(Vector::zeros()),
            (false, _, true) => sums::<_, _, false, false>(simd, input, out),
            (true, false, _) => sums::<_, _, true, false>(simd, input, out),
            (true, true, _) => sums::<_, _, true, true>(simd, input, out),
        }
    }));
}

/// Accelerations of agent `i` from its near neighbors, m/s²: pressure, viscosity and contact.
pub fn accelerations_of(frame: &Frame, i: usize, coefficients: &PairCoefficients) -> [Vector; 3] {
    let &PairCoefficients {
        pressure,
        viscosity,
        contact,
    } = coefficients;
    let none = PairCoefficients::default;
    let each = [
        PairCoefficients { pressure, ..none() },
        PairCoefficients {
            viscosity,
            ..none()
        },
        PairCoefficients { contact, ..none() },
    ];
    each.map(|coefficients| {
        let mut out = [Vector::zeros(); BLOCK];
        accelerations(frame, i / BLOCK, &coefficients, Wanted::ALL, &mut out);
        out[i % BLOCK]
    })
}

#[inline(always)]
fn sums<R: Real, S: Simd, const PRESSURE: bool, const VISCOSITY: bool>(
    simd: S,
    (columns, block, felt): (&Columns<R>, &ClusterBlock, &PairCoefficients),
    out: &mut [Vector],
) {
    for (agents, runs) in block.clusters() {
        let start = agents.start;
        let own = start % BLOCK;
        let mut sum = NearSum::<R, S, PRESSURE, VISCOSITY> {
            columns,
            minus_unit_per_h: splat::<R, S>(simd, -columns.bodies.unit)
                * load(simd, &columns.bodies.per_support, start),
            pressure: pressure::FromAgents::new(simd, columns, start, &felt.pressure[own..]),
            viscosity: viscosity::FromAgents::new(simd, columns, start, &felt.viscosity[own..]),
            contact: contact::FromAgents::new(simd, columns, start, &felt.contact[own..]),
            along: [splat::<R, S>(simd, 0.0); 2],
        };
        add_pairs(simd, &columns.bodies, (start, runs), &mut sum);
        let [x, y] = sum.viscosity.added_to(sum.along);
        let (x, y) = (store::<R, S>(x), store::<R, S>(y));
        for (k, sum) in out[own..own + agents.len()].iter_mut().enumerate() {
            *sum = Vector::new(x[k], y[k]);
        }
    }
}

/// The forces on eight agents i. Contact is always summed.
struct NearSum<'a, R: Real, S: Simd, const PRESSURE: bool, const VISCOSITY: bool> {
    columns: &'a Columns<R>,
    /// −1/h, per coordinate unit.
    minus_unit_per_h: Lanes<R, S>,
    pressure: pressure::FromAgents<R, S>,
    viscosity: viscosity::FromAgents<R, S>,
    contact: contact::FromAgents<R, S>,
    /// The sum of the forces along r_ij.
    along: [Lanes<R, S>; 2],
}

/// The columns of a run of agents j.
#[derive(Clone, Copy)]
struct Run<'a, R> {
    volume: &'a [R],
    pressure: &'a [R],
    velocity_x: &'a [R],
    velocity_y: &'a [R],
    radius: &'a [R],
}

impl<'a, R: Real, S: Simd, const PRESSURE: bool, const VISCOSITY: bool> PairSum<R, S>
    for NearSum<'a, R, S, PRESSURE, VISCOSITY>
{
    type Run = Run<'a, R>;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Run<'a, R> {
        Run {
            volume: &self.columns.volume[run.clone()],
            pressure: &self.columns.pressure[run.clone()],
            velocity_x: &self.columns.bodies.velocity_x[run.clone()],
            velocity_y: &self.columns.bodies.velocity_y[run.clone()],
            radius: &self.columns.bodies.contact_radius[run.clone()],
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], run: Run<R>, j: usize) {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let tiny = splat::<R, S>(simd, R::TINY);
        let distance = dy.mul_add_precise(dy, dx * dx).max(tiny).sqrt();
        let inverse = one / distance;
        let mut force = zero;
        if PRESSURE {
            let rest = self
                .minus_unit_per_h
                .mul_add_precise(distance, one)
                .max(zero);
            let weight = spread::<R, S>(simd, run.volume[j]) * rest;
            let p_j = spread(simd, run.pressure[j]);
            force = self.pressure.along(weight, rest, p_j);
            if VISCOSITY {
                let v_x = spread(simd, run.velocity_x[j]);
                let v_y = spread(simd, run.velocity_y[j]);
                self.viscosity.add(weight, [v_x, v_y]);
            }
        }
        let radius_j = spread(simd, run.radius[j]);
        force = self.contact.added_to(simd, force, distance, radius_j);
        let force = force * inverse;
        self.along[0] = force.mul_add_precise(dx, self.along[0]);
        self.along[1] = force.mul_add_precise(dy, self.along[1]);
    }
}

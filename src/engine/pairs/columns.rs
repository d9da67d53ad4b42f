//! The agents' data that sums over pairs read, packed in columns.

use std::ops::Range;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::real::{LANES, Real};
use super::{PairCoefficients, SocialLaw, Wanted, kernels, social};
use crate::engine::agents::Agents;
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, ClusterBlock};

/// One array per quantity, in the agents' order, padded by [`LANES`] entries so that the last vector load stays in
/// bounds.
#[derive(Debug, Clone)]
pub struct Columns<R: Real> {
    /// Meters per coordinate unit.
    pub(super) unit: f64,
    pub(super) x: Vec<R::Coordinate>,
    pub(super) y: Vec<R::Coordinate>,
    /// m_j.
    pub(super) mass: Vec<R>,
    /// D_j, meters.
    pub(super) radius: Vec<R>,
    /// 1/h of each agent, 1/m.
    pub(super) per_support: Vec<R>,
    /// v_j, m/s.
    pub(super) velocity_x: Vec<R>,
    pub(super) velocity_y: Vec<R>,
    /// m_j/ρ_j, m².
    pub(super) volume: Vec<R>,
    /// p_j.
    pub(super) pressure: Vec<R>,
}

impl<R: Real> Default for Columns<R> {
    fn default() -> Self {
        Self {
            unit: 1.0,
            x: Vec::new(),
            y: Vec::new(),
            mass: Vec::new(),
            radius: Vec::new(),
            per_support: Vec::new(),
            velocity_x: Vec::new(),
            velocity_y: Vec::new(),
            volume: Vec::new(),
            pressure: Vec::new(),
        }
    }
}

impl<R: Real> Columns<R> {
    /// Allocates the columns and packs the bodies of all agents. A coordinate unit is `unit` meters; `support`
    /// returns the h of an agent in meters.
    pub fn take_bodies(&mut self, agents: &Agents, unit: f64, support: impl Fn(usize) -> f64) {
        self.unit = unit;
        let padded = agents.len() + LANES;
        self.x.resize(padded, R::Coordinate::default());
        self.y.resize(padded, R::Coordinate::default());
        let numbers = [
            &mut self.mass,
            &mut self.radius,
            &mut self.per_support,
            &mut self.velocity_x,
            &mut self.velocity_y,
            &mut self.volume,
            &mut self.pressure,
        ];
        for column in numbers {
            column.resize(padded, R::default());
        }
        for i in 0..agents.len() {
            self.mass[i] = R::of(agents.mass[i]);
            self.radius[i] = R::of(agents.radius[i]);
            self.per_support[i] = R::of(1.0 / support(i));
        }
    }

    /// Whether no agents are packed.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// For each block of agents, the slices that take its positions and velocities.
    pub fn motions(&mut self) -> impl IndexedParallelIterator<Item = Motion<'_, R>> {
        let per_meter = 1.0 / self.unit;
        (
            self.x.par_chunks_mut(BLOCK),
            self.y.par_chunks_mut(BLOCK),
            self.velocity_x.par_chunks_mut(BLOCK),
            self.velocity_y.par_chunks_mut(BLOCK),
        )
            .into_par_iter()
            .map(move |(x, y, velocity_x, velocity_y)| Motion {
                per_meter,
                x,
                y,
                velocity_x,
                velocity_y,
            })
    }

    /// The bodies that the density sums read, and for each block of agents the slices that take m/ρ (m²) and p.
    pub fn pressures(
        &mut self,
    ) -> (
        Bodies<'_, R>,
        impl IndexedParallelIterator<Item = (&mut [R], &mut [R])>,
    ) {
        let bodies = Bodies {
            unit: self.unit,
            x: &self.x,
            y: &self.y,
            mass: &self.mass,
            per_support: &self.per_support,
        };
        let places = (
            self.volume.par_chunks_mut(BLOCK),
            self.pressure.par_chunks_mut(BLOCK),
        );
        (bodies, places.into_par_iter())
    }

    /// The accelerations of a block's agents by their near neighbors, m/s².
    pub fn accelerations(
        &self,
        block: &ClusterBlock,
        coefficients: &PairCoefficients,
        wanted: Wanted,
        out: &mut [Vector],
    ) {
        dispatch!(Level::new(), simd => {
            kernels::accelerations(simd, self, block, coefficients, wanted, out);
        });
    }

    /// Adds the social forces on `agents`, which are one cluster, times their coefficients, m/s². `runs` contain all
    /// agents in reach, and some out of reach.
    pub fn add_social(
        &self,
        law: &SocialLaw,
        (agents, runs): (Range<usize>, &[Range<u32>]),
        coefficients: &[f64],
        out: &mut [Vector],
    ) {
        dispatch!(Level::new(), simd => {
            social::add_social(simd, self, law, (agents, runs), coefficients, out);
        });
    }
}

/// Positions, masses and support radii of all agents.
#[derive(Clone, Copy)]
pub struct Bodies<'a, R: Real> {
    pub(super) unit: f64,
    pub(super) x: &'a [R::Coordinate],
    pub(super) y: &'a [R::Coordinate],
    pub(super) mass: &'a [R],
    pub(super) per_support: &'a [R],
}

impl<R: Real> Bodies<'_, R> {
    /// Eq. 9 without walls: Σ_j m_j W(r_ij), including j = i, in P/m², for each agent of a block.
    pub fn densities(&self, block: &ClusterBlock, out: &mut [f64]) {
        dispatch!(Level::new(), simd => kernels::densities(simd, self, block, out));
    }
}

/// The slices that take the positions and velocities of a block of agents.
pub struct Motion<'a, R: Real> {
    per_meter: f64,
    x: &'a mut [R::Coordinate],
    y: &'a mut [R::Coordinate],
    velocity_x: &'a mut [R],
    velocity_y: &'a mut [R],
}

impl<R: Real> Motion<'_, R> {
    /// Packs the positions (meters) and velocities (m/s) of the block's agents.
    pub fn take(&mut self, positions: &[Vector], velocities: &[Vector]) {
        for (k, (r, v)) in positions.iter().zip(velocities).enumerate() {
            self.x[k] = R::coordinate(r.x, self.per_meter);
            self.y[k] = R::coordinate(r.y, self.per_meter);
            self.velocity_x[k] = R::of(v.x);
            self.velocity_y[k] = R::of(v.y);
        }
    }
}

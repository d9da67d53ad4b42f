//! The agents' data that sums over pairs read, packed in columns.

use rayon::prelude::*;

use super::real::{LANES, Real};
use super::{dispatch, level};
use crate::agents::Agents;
use crate::math::Vector;
use crate::neighbors::{BLOCK, TASK};

/// One array per quantity, in the agents' order, padded by [`LANES`] entries so that the last vector load stays in
/// bounds.
#[derive(Debug, Clone, Default)]
pub struct Columns<R: Real> {
    /// The input of the density sums.
    pub bodies: Bodies<R>,
    /// m_j/ρ_j, m² (1B).
    pub volume: Vec<R>,
    /// p_j, 1/s² (1B).
    pub pressure: Vec<R>,
}

/// Positions, velocities and bodies of all agents, padded like [`Columns`].
#[derive(Debug, Clone, Default)]
pub struct Bodies<R: Real> {
    /// Meters per coordinate unit.
    pub unit: f64,
    /// The way over one period along x and along y, coordinate units; 0 without period.
    pub period: [R::Coordinate; 2],
    /// r_j, coordinate units.
    pub x: Vec<R::Coordinate>,
    /// r_j, coordinate units.
    pub y: Vec<R::Coordinate>,
    /// v_j, m/s.
    pub velocity_x: Vec<R>,
    /// v_j, m/s.
    pub velocity_y: Vec<R>,
    /// m_j.
    pub mass: Vec<R>,
    /// The radius that D_j has in contacts with agents, meters.
    pub contact_radius: Vec<R>,
    /// 1/h of each agent, 1/m.
    pub per_support: Vec<R>,
    /// ê_j, zero without preferred velocity. Written where walking laws are due, and empty before.
    pub heading_x: Vec<R>,
    /// See `heading_x`.
    pub heading_y: Vec<R>,
}

/// The reach of the forces of an agent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// h, meters.
    pub support_radius: f64,
    /// The part of D_i that counts in contacts with agents.
    pub contact_scale: f64,
}

fn reset<T: Copy + Default>(column: &mut Vec<T>, agents: &Agents) {
    column.clear();
    column.resize(agents.len() + LANES, T::default());
}

impl<R: Real> Columns<R> {
    /// Packs the bodies of all agents (see [`Bodies::take`]), and resets their volumes and pressures to 0.
    pub fn take_bodies(
        &mut self,
        agents: &Agents,
        unit: f64,
        way: Vector,
        reach: impl Fn(usize) -> Reach + Sync,
    ) {
        self.bodies.take(agents, unit, way, reach);
        reset(&mut self.volume, agents);
        reset(&mut self.pressure, agents);
    }
}

impl<R: Real> Bodies<R> {
    /// Packs the bodies of all agents, and resets their positions and velocities to 0. A coordinate unit is `unit`
    /// meters.
    pub fn take(
        &mut self,
        agents: &Agents,
        unit: f64,
        way: Vector,
        reach: impl Fn(usize) -> Reach + Sync,
    ) {
        self.unit = unit;
        self.period = [way.x, way.y].map(|meters| R::coordinate(meters, 1.0 / unit));
        reset(&mut self.x, agents);
        reset(&mut self.y, agents);
        reset(&mut self.velocity_x, agents);
        reset(&mut self.velocity_y, agents);
        reset(&mut self.mass, agents);
        reset(&mut self.contact_radius, agents);
        reset(&mut self.per_support, agents);
        let blocks = (
            self.mass.par_chunks_mut(BLOCK),
            self.contact_radius.par_chunks_mut(BLOCK),
            self.per_support.par_chunks_mut(BLOCK),
            agents.mass.par_chunks(BLOCK),
            agents.radius.par_chunks(BLOCK),
        );
        let blocks = blocks.into_par_iter().with_min_len(TASK).enumerate();
        blocks.for_each(|(b, (mass, contact_radius, per_support, masses, radii))| {
            for (k, (&m, &radius)) in masses.iter().zip(radii).enumerate() {
                let reach = reach(b * BLOCK + k);
                mass[k] = R::of(m);
                contact_radius[k] = R::of(radius * reach.contact_scale);
                per_support[k] = R::of(1.0 / reach.support_radius);
            }
        });
    }

    /// Packs the directions of preferred velocities, one per agent.
    pub fn take_headings(&mut self, wishes: &[Vector]) {
        let padded = wishes.len() + LANES;
        self.heading_x.resize(padded, R::default());
        self.heading_y.resize(padded, R::default());
        let blocks = (
            self.heading_x.par_chunks_mut(BLOCK),
            self.heading_y.par_chunks_mut(BLOCK),
            wishes.par_chunks(BLOCK),
        );
        blocks
            .into_par_iter()
            .with_min_len(TASK)
            .for_each(|(x, y, wishes)| {
                dispatch!(level(), _simd => directions(wishes, [x, y]));
            });
    }

    /// Packs the positions and velocities of all agents.
    pub fn take_motions(&mut self, agents: &Agents) {
        let per_meter = 1.0 / self.unit;
        let blocks = (
            self.x.par_chunks_mut(BLOCK),
            self.y.par_chunks_mut(BLOCK),
            self.velocity_x.par_chunks_mut(BLOCK),
            self.velocity_y.par_chunks_mut(BLOCK),
            agents.position.par_chunks(BLOCK),
            agents.velocity.par_chunks(BLOCK),
        );
        blocks.into_par_iter().with_min_len(TASK).for_each(
            |(x, y, velocity_x, velocity_y, positions, velocities)| {
                dispatch!(level(), _simd => {
                    R::coordinates(positions, per_meter, [x, y]);
                    for ((x, y), v) in velocity_x.iter_mut().zip(velocity_y).zip(velocities) {
                        (*x, *y) = (R::of(v.x), R::of(v.y));
                    }
                });
            },
        );
    }
}

/// The directions of some wishes; zero for those that are zero. Without branches.
#[inline(always)]
fn directions<R: Real>(wishes: &[Vector], [x, y]: [&mut [R]; 2]) {
    for ((x, y), wish) in x.iter_mut().zip(y).zip(wishes) {
        let length = wish.norm();
        let along = |part: f64| R::of(if length > 0.0 { part / length } else { 0.0 });
        (*x, *y) = (along(wish.x), along(wish.y));
    }
}

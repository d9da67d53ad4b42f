//! Step 1B: density, personal rest density and pressure (§4.2, §4.3).
//!
//! Plain form: `update_density_and_pressure`, `density_by_agent`, `kernel`, `mean_density` and `pressure` in
//! `examples/paper.rs`.

use std::f64::consts::PI;
use std::ops::Range;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::agents::Agents;
use crate::boundary::WallMethod;
use crate::frame::Fields;
use crate::geometry::Walls;
use crate::limits::{FARTHEST, HIGHEST_DENSITY, STRONGEST};
use crate::math::Vector;
use crate::neighbors::{BLOCK, ClusterBlock, Neighbors};
use crate::pairs::prelude::*;
use crate::pairs::{
    Bodies, Columns, Lanes, PairSum, Real, Simd, add_pairs, dispatch, level, load, splat, spread,
    store,
};

/// Parameters of SPH density and pressure, shared by all profiles of a blend.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SphParameters {
    /// h (§5.2), meters: the support radius of the SPH kernels. Larger: smoother densities, at a cost that grows with
    /// its square. At 0.5 m an agent has four neighbors at 5 P/m², too few for a density.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub support_radius: f64,
    /// k (Eq. 5), m²/s²: the pressure per excess density; pressure alone carries waves at √(k/2). Higher: a stiffer
    /// crowd; 0: no pressure. From about 400 on, crowds between the paper's walls keep boiling at any time step.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub gas_constant: f64,
    /// ρ⁰min, P/m²: the lowest personal rest density. Higher: sparser crowds feel no pressure. If it equals
    /// `rest_density_max`, the rest density is static, and crowds at rest move more.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub rest_density_min: f64,
    /// ρ⁰max, P/m²: the highest personal rest density; above it, agents are always pushed apart. Higher: denser
    /// crowds. From about 5 on, discs of 0.24 m overlap in any packing.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub rest_density_max: f64,
    /// T^ρ (Eq. 8), seconds: the time in which the personal rest density adapts. Longer: changes of density cause
    /// pressure for longer. Below Δt it adapts within one frame, and only densities beyond its limits cause pressure.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub averaging_time: f64,
}

impl Default for SphParameters {
    fn default() -> Self {
        Self {
            support_radius: 1.0,
            gas_constant: 200.0,
            rest_density_min: 0.0,
            rest_density_max: 5.0,
            averaging_time: 0.1,
        }
    }
}

impl SphParameters {
    /// Eq. 8: the moving average ρ̂ after one step.
    #[inline]
    pub fn averaged(&self, mean_density: f64, density: f64, time_step: f64) -> f64 {
        let alpha = (time_step / self.averaging_time).min(1.0);
        (1.0 - alpha) * mean_density + alpha * density
    }

    /// ρ⁰: the moving average ρ̂, clamped to its allowed range (§4.2).
    #[inline]
    pub fn rest_density(&self, mean_density: f64) -> f64 {
        mean_density.clamp(self.rest_density_min, self.rest_density_max)
    }

    /// The density from walls (Eq. 10) and the moving average ρ̂ (Eq. 8), P/m². `hidden` is Σ_k ∫ W over P_k. `kept` is
    /// the average `time_step` seconds earlier; `None` for a newcomer.
    #[inline]
    pub fn from_walls_and_mean(
        &self,
        from_agents: f64,
        hidden: f64,
        kept: Option<f64>,
        time_step: f64,
    ) -> [f64; 2] {
        let before = mean_density_before(kept, from_agents);
        let from_walls = hidden * self.rest_density(before);
        let mean = self.averaged(before, from_agents + from_walls, time_step);
        [from_walls, mean]
    }

    /// Eq. 5: p_i, 1/s².
    #[inline]
    pub fn pressure(&self, density: f64, rest_density: f64) -> f64 {
        self.gas_constant * (density - rest_density)
    }
}

/// ρ̂ of the previous frame, P/m²: `kept` or, for a newcomer, the density `from_agents` alone (Eq. 9).
#[inline]
pub fn mean_density_before(kept: Option<f64>, from_agents: f64) -> f64 {
    kept.unwrap_or(from_agents)
}

/// Eq. 9 without walls for eight agents i: Σ_j m_j W(r_ij), including j = i.
struct FromAgents<'a, R: Real, S: Simd> {
    mass: &'a [R],
    /// −(meters per coordinate unit)²/h².
    scale: Lanes<R, S>,
    /// The sum without the factor 4/(π h²) of Eq. 13.
    sum: Lanes<R, S>,
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for FromAgents<'a, R, S> {
    type Run = &'a [R];

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> &'a [R] {
        &self.mass[run]
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], mass: &'a [R], j: usize) {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let squared = dy.mul_add_precise(dy, dx * dx);
        let rest = squared.mul_add_precise(self.scale, one).max(zero);
        self.sum = (spread::<R, S>(simd, mass[j]) * rest).mul_add_precise(rest * rest, self.sum);
    }
}

/// Eq. 9 without walls: Σ_j m_j W(r_ij), including j = i, in P/m², for each agent of a block.
pub fn from_agents<R: Real>(bodies: &Bodies<R>, block: &ClusterBlock, out: &mut [f64]) {
    dispatch!(level(), simd => sums(simd, bodies, block, out));
}

#[inline(always)]
fn sums<R: Real, S: Simd>(simd: S, bodies: &Bodies<R>, block: &ClusterBlock, out: &mut [f64]) {
    for (agents, runs) in block.clusters() {
        let per_h: Lanes<R, S> = load(simd, &bodies.per_support, agents.start);
        let per_h_squared = per_h * per_h;
        let mut sum = FromAgents {
            mass: &bodies.mass,
            scale: per_h_squared * splat::<R, S>(simd, -bodies.unit * bodies.unit),
            sum: splat::<R, S>(simd, 0.0),
        };
        add_pairs(simd, bodies, (agents.start, runs), &mut sum);
        let sums = sum.sum * per_h_squared * splat::<R, S>(simd, 4.0 / PI);
        let own = agents.start % BLOCK;
        for (density, sum) in out[own..own + agents.len()]
            .iter_mut()
            .zip(store::<R, S>(sums))
        {
            *density = sum;
        }
    }
}

/// The input for the densities of a block.
struct BlockInput<'a> {
    /// Seconds since the moving average was last stored.
    time_step: f64,
    /// Whether the moving average is still unset.
    newcomer: &'a [bool],
    /// The moving average, P/m².
    before: &'a [f64],
    mass: &'a [f64],
}

/// The densities of a block. Before they are complete, `density` is that from agents alone, and `from_walls` Σ_k ∫ W
/// over P_k.
struct BlockDensities<'a> {
    density: &'a mut [f64],
    from_walls: &'a mut [f64],
    mean: &'a mut [f64],
    rest: &'a mut [f64],
    pressure: &'a mut [f64],
}

/// Eqs. 10, 8 and 5 for the agents of a block, and their packed volumes and pressures.
#[inline(always)]
fn complete<R: Real>(
    parameters: impl Fn(usize) -> SphParameters,
    given: &BlockInput,
    found: BlockDensities,
    (volume, packed): (&mut [R], &mut [R]),
) {
    let count = given.mass.len();
    let (newcomer, before) = (&given.newcomer[..count], &given.before[..count]);
    let (density, from_walls) = (&mut found.density[..count], &mut found.from_walls[..count]);
    let (mean, rest) = (&mut found.mean[..count], &mut found.rest[..count]);
    let pressure = &mut found.pressure[..count];
    for k in 0..count {
        let sph = parameters(k);
        let kept = (!newcomer[k]).then_some(before[k]);
        [from_walls[k], mean[k]] =
            sph.from_walls_and_mean(density[k], from_walls[k], kept, given.time_step);
        density[k] += from_walls[k];
        rest[k] = sph.rest_density(mean[k]);
        pressure[k] = sph.pressure(density[k], rest[k]);
    }
    let (volume, packed) = (&mut volume[..count], &mut packed[..count]);
    for k in 0..count {
        volume[k] = R::of(given.mass[k] / density[k]);
        packed[k] = R::of(pressure[k]);
    }
}

/// The input of step 1B.
#[derive(Clone, Copy)]
pub struct Input<'a, P> {
    /// The state of the crowd.
    pub agents: &'a Agents,
    /// Neighbor lists.
    pub neighbors: &'a Neighbors,
    /// Walls of the obstacles, and how they enter SPH.
    pub walls: (&'a Walls, WallMethod),
    /// The parameters of a group.
    pub parameters: P,
    /// Seconds since the moving average was last stored.
    pub time_step: f64,
    /// The fewest blocks per parallel task.
    pub task: usize,
}

impl<'a, P: Fn(u16) -> &'a SphParameters + Sync> Input<'a, P> {
    /// Step 1B for all agents: Eqs. 9, 10, 8 and 5, in this order. Walls use the rest density of the previous frame.
    pub fn update<R: Real>(&self, columns: &mut Columns<R>, fields: &mut Fields) {
        let bodies = &columns.bodies;
        let blocks = (
            fields.density.par_chunks_mut(BLOCK),
            fields.density_from_walls.blocks_mut().par_iter_mut(),
            fields.mean_density.par_chunks_mut(BLOCK),
            fields.rest_density.par_chunks_mut(BLOCK),
            fields.pressure.par_chunks_mut(BLOCK),
            fields.wall_gradient.blocks_mut().par_iter_mut(),
            columns.volume.par_chunks_mut(BLOCK),
            columns.pressure.par_chunks_mut(BLOCK),
        );
        blocks
            .into_par_iter()
            .with_min_len(self.task)
            .enumerate()
            .for_each(|(b, block)| {
                let (density, from_walls, mean, rest, pressure, gradient, volume, packed) = block;
                let agents = b * BLOCK..b * BLOCK + density.len();
                from_agents(bodies, self.neighbors.near().block(b), density);
                self.see_walls(agents.clone(), from_walls, gradient);
                let mut nothing = [0.0; BLOCK];
                let from_walls = match from_walls.is_empty() {
                    true => &mut nothing[..],
                    false => &mut from_walls[..],
                };
                let group = &self.agents.group[agents.clone()];
                let same = group.iter().all(|&other| other == group[0]);
                let shared = same.then(|| *(self.parameters)(group[0]));
                let newcomer = &self.agents.newcomer[agents.clone()];
                let before = &self.agents.mean_density[agents.clone()];
                let mass = &self.agents.mass[agents];
                let given = BlockInput {
                    time_step: self.time_step,
                    newcomer,
                    before,
                    mass,
                };
                let found = BlockDensities {
                    density,
                    from_walls,
                    mean,
                    rest,
                    pressure,
                };
                match shared {
                    Some(sph) => dispatch!(level(), _simd => {
                        complete(|_| sph, &given, found, (volume, packed));
                    }),
                    None => {
                        let own = |k: usize| *(self.parameters)(group[k]);
                        complete(own, &given, found, (volume, packed));
                    }
                }
            });
    }

    /// Stores Σ_k ∫ W over P_k in `kernel` and Σ_k ∫ ∇W in `gradient`. Sorting empties both, and they stay empty if no
    /// walls are near these agents (see [`Fields::forget_walls`]).
    fn see_walls(&self, agents: Range<usize>, kernel: &mut Vec<f64>, gradient: &mut Vec<Vector>) {
        let (first, count) = (agents.start, agents.len());
        let mut near_walls = self.neighbors.agents_near_walls(agents).peekable();
        if near_walls.peek().is_none() {
            return;
        }
        kernel.clear();
        kernel.resize(count, 0.0);
        gradient.clear();
        gradient.resize(count, Vector::zeros());
        for (i, near) in near_walls {
            let r_i = self.agents.position[i];
            let h = (self.parameters)(self.agents.group[i]).support_radius;
            let (walls, method) = self.walls;
            method.shares(walls, near, r_i, h, |share| {
                kernel[i - first] += share.kernel;
                gradient[i - first] += share.gradient;
            });
        }
    }
}

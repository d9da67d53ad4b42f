//! Social force: avoidance of agents and walls (§5.3.1, Eqs. 18 and 19).
//!
//! Plain form: `social_force_by_agent`, `social_force_by_wall`, `weight_in_view` and `repelling_points` in
//! `examples/paper.rs`.

mod around;
mod counting;
mod cutoff;
mod near;
mod sum;

use libm::exp;
use std::f64::consts::SQRT_2;
use std::ops::Range;

use counting::Counting;
use cutoff::Cutoff;
use near::Near;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::limits::{FARTHEST, STRONGEST};
use crate::math::{Vector, direction};
use crate::neighbors::{BLOCK, Run};
use crate::pairs::{Bodies, Real, Simd, dispatch, each, level};

/// Parameters of Eqs. 18 and 19 and of the field of view.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SocialForce {
    /// V₀ (Eq. 18), m²/s²: the strength of the social force between agents. Higher: they keep more distance; 0: none.
    /// V₀/σ² acts like a stiffness and limits the time step like `agent_stiffness`.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_strength: f64,
    /// σ (Eq. 18), meters: the range over which the social force between agents falls by a factor e. Longer: agents
    /// react from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub agent_range: f64,
    /// T (Eq. 18), seconds: how far ahead the social force looks. Longer: agents avoid collisions earlier; 0: they
    /// react to distances alone.
    #[schemars(range(min = 0, max = 1000))]
    pub anticipation_time: f64,
    /// U₀ (Eq. 19), m²/s²: the strength of the social force of walls. Higher: agents keep more distance from walls;
    /// 0: none.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_strength: f64,
    /// R (Eq. 19), meters: the range over which the social force of walls falls by a factor e. Longer: agents react to
    /// walls from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub wall_range: f64,
    /// Social forces and RVO ignore agents and walls beyond this distance, meters. Longer: the cost grows with its
    /// square. If it is shorter than the distance walked in `anticipation_time`, agents notice others late.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub avoidance_radius: f64,
    /// Leaves out social forces that are certainly smaller than this, for an agent of mass 1, m/s². Higher: cheaper
    /// and less exact. 1e-3 moves agents by up to 2 cm in a second and saves up to a third of the time in crowds of
    /// 10,000.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub avoidance_tolerance: f64,
}

impl Default for SocialForce {
    fn default() -> Self {
        Self {
            agent_strength: 2.1,
            agent_range: 0.3,
            anticipation_time: 2.0,
            wall_strength: 2.1,
            wall_range: 0.1,
            avoidance_radius: 5.0,
            avoidance_tolerance: 0.0,
        }
    }
}

/// Buffers for the agents around a cluster, reused from cluster to cluster.
#[derive(Default)]
struct Buffers<R: Real> {
    runs: Vec<Run>,
    near: Near<R>,
    counting: Counting<R>,
}

/// The cosine of half the field of view, 100°: neighbors within this angle of the walking direction have full weight.
const FIELD_OF_VIEW: f64 = -0.173_648_177_666_930_3;
/// Weight of a neighbor outside the field of view.
const UNSEEN_WEIGHT: f64 = 0.5;

impl SocialForce {
    /// The stiffness of both forces where they are strongest.
    pub fn rates(&self, of: &Extremes) -> Rates {
        let stiffness = self.agent_strength / self.agent_range.powi(2)
            + self.wall_strength / self.wall_range.powi(2);
        Rates {
            other_springs: stiffness / of.mass,
            ..Rates::default()
        }
    }

    /// Eq. 18, summed over all agents in range and divided by the mass.
    pub fn from_agents(&self, frame: &Frame, i: usize) -> Vector {
        let mut coefficients = [0.0; BLOCK];
        coefficients[i % BLOCK] = 1.0 / frame.agents.mass[i];
        let mut accelerations = [Vector::zeros(); BLOCK];
        self.add_from_agents(frame, i / BLOCK, &coefficients, &mut accelerations);
        accelerations[i % BLOCK]
    }

    /// Adds Eq. 18, summed over all agents in range, times `coefficients`, to the accelerations of the agents of
    /// block `b`.
    pub fn add_from_agents(
        &self,
        frame: &Frame,
        b: usize,
        coefficients: &[f64; BLOCK],
        accelerations: &mut [Vector],
    ) {
        each!(frame.packed, columns => {
            self.add_to_block(frame, &columns.bodies, (b, coefficients), accelerations);
        });
    }

    fn add_to_block<R: Real>(
        &self,
        frame: &Frame,
        bodies: &Bodies<R>,
        (b, coefficients): (usize, &[f64; BLOCK]),
        accelerations: &mut [Vector],
    ) {
        let mut buffers = Buffers::default();
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            let coefficients = &coefficients[own.clone()];
            if coefficients.iter().all(|&coefficient| coefficient == 0.0) {
                continue;
            }
            let (positions, radius) = (&frame.agents.position, self.avoidance_radius);
            let runs = &mut buffers.runs;
            let neighbors = frame.neighbors;
            neighbors.around_cluster(agents.clone(), positions, radius, runs);
            let (buffers, out) = (&mut buffers, &mut accelerations[own]);
            dispatch!(level(), simd => {
                self.add_sums(simd, bodies, (agents, buffers), (coefficients, out));
            });
        }
    }

    /// Adds Eq. 18 on the agents of one cluster, times their coefficients, to their accelerations, m/s². The buffered
    /// runs contain all agents in reach, and some out of reach.
    #[inline(always)]
    fn add_sums<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (agents, buffers): (Range<usize>, &mut Buffers<R>),
        (coefficients, out): (&[f64], &mut [Vector]),
    ) {
        let Buffers {
            runs,
            near,
            counting,
        } = buffers;
        let start = agents.start;
        let cutoff = Cutoff::new(simd, self, bodies.unit);
        let limits = (self.avoidance_radius, cutoff.as_ref());
        near.take(simd, limits, bodies, (agents, runs));
        // 1/(4h) of the force, with √2 h in its place.
        let scale = self.agent_strength / self.agent_range * SQRT_2 / 4.0;
        let out = out.iter_mut().zip(coefficients).enumerate();
        let Some(cutoff) = &cutoff else {
            let [x, y] = near.sums(simd, self, bodies, start);
            for (k, (out, coefficient)) in out {
                *out += Vector::new(x[k], y[k]) * (scale * coefficient);
            }
            return;
        };
        for (k, (out, &coefficient)) in out {
            if coefficient != 0.0 {
                let sum = counting.sum(simd, (self, cutoff), (bodies, near), start + k);
                *out += sum * (scale * coefficient);
            }
        }
    }

    /// Eq. 19, summed over the walls in range whose free side the agent is on, divided by the mass.
    pub fn from_walls(&self, frame: &Frame, i: usize) -> Vector {
        let r_i = frame.agents.position[i];
        let seen = FieldOfView::new(frame.agents.velocity[i]);
        let walls = frame.walls.facing(r_i, frame.neighbors.far_walls(i));
        let force: Vector = walls
            .filter(|(_, away)| away.norm() < self.avoidance_radius)
            .map(|(_, away)| self.wall_force(away) * seen.weight(-away))
            .sum();
        force / frame.agents.mass[i]
    }

    /// Eq. 19 for `away` = r_i − r_k*.
    pub fn wall_force(&self, away: Vector) -> Vector {
        let strength = self.wall_strength / self.wall_range * exp(-away.norm() / self.wall_range);
        direction(away) * strength
    }
}

/// Full weight inside the field of view; an agent at rest sees in all directions.
struct FieldOfView {
    heading: Vector,
}

impl FieldOfView {
    fn new(velocity: Vector) -> Self {
        Self {
            heading: direction(velocity),
        }
    }

    fn weight(&self, towards: Vector) -> f64 {
        let ahead = self.heading.dot(&towards) >= FIELD_OF_VIEW * towards.norm();
        if ahead || self.heading == Vector::zeros() {
            1.0
        } else {
            UNSEEN_WEIGHT
        }
    }
}

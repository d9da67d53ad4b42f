//! Contact between discs, and of discs with walls (§5.4, Eqs. 22 and 23).
//!
//! In the paper the whole radius D_i counts. People turn their shoulders in narrow places, so only a fraction of D_i
//! may count in contacts with agents, and another fraction in contacts with walls. Masses and personal space (RVO,
//! entrances) use the whole D_i.
//!
//! Plain form: `contact_by_agent` and `contact_by_wall` in `examples/paper.rs`.

use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::limits::STRONGEST;
use crate::math::Vector;
use crate::pairs::prelude::*;
use crate::pairs::{Columns, Lanes, Real, Simd, add_quotients, lanes_from, load, splat};

/// Distance in meters below which a center is taken to lie on a wall. Coordinates up to 10⁶ m round by less;
/// without it, rounding would decide the direction of the push.
const ON_THE_WALL: f64 = 1e-9;

/// Contact in one profile; a stiffness `None` disables it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Contact {
    /// K^ag (Eq. 22), 1/s²: the stiffness of contacts between agents. Higher: agents overlap less; 0: no contact
    /// force. Above about 2000 the paper's time step is too long. Default: 1000; with SPH 50.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_stiffness: Option<f64>,
    /// K^obs (Eq. 23), 1/s²: the stiffness of contacts with walls. Higher: agents enter walls less deeply; 0: no
    /// contact force. Above about 4000 the paper's time step is too long. Default: 1000; with SPH 200.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_stiffness: Option<f64>,
    /// The part of D_i that counts in contacts between agents. Smaller: shoulders turn, crowds get denser before
    /// overlaps push. Masses, entrances and avoidance keep D_i.
    #[schemars(range(min = 0.1, max = 1))]
    pub contact_scale: f64,
    /// The part of D_i that counts in contacts with walls. Smaller: more room in narrow doors and corridors.
    #[schemars(range(min = 0.1, max = 1))]
    pub wall_contact_scale: f64,
}

impl Default for Contact {
    /// No contact forces, with the whole radius.
    fn default() -> Self {
        Self {
            agent_stiffness: None,
            wall_stiffness: None,
            contact_scale: 1.0,
            wall_contact_scale: 1.0,
        }
    }
}

/// Both edges of a corner push an agent in front of it in the same direction.
const EDGES_AT_A_CORNER: f64 = 2.0;

impl Contact {
    /// The stiffness of contacts, and of walls and their corners.
    pub fn rates(&self, of: &Extremes) -> Rates {
        let wall = self.wall_stiffness.unwrap_or(0.0);
        Rates {
            contact: self.agent_stiffness.unwrap_or(0.0) / of.mass,
            other_springs: wall / of.mass,
            corner: EDGES_AT_A_CORNER * wall / of.mass,
            ..Rates::default()
        }
    }
}

/// Eq. 22 for eight agents i: Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, times a coefficient.
pub struct FromAgents<R: Real, S: Simd> {
    stiffness: Lanes<R, S>,
    radius: Lanes<R, S>,
    /// Minus the meters per coordinate unit.
    minus_unit: Lanes<R, S>,
}

impl<R: Real, S: Simd> FromAgents<R, S> {
    /// The sum for the agents from `start` on, with their coefficients.
    #[inline(always)]
    pub fn new(simd: S, columns: &Columns<R>, start: usize, coefficients: &[f64]) -> Self {
        Self {
            stiffness: lanes_from::<R, S>(simd, coefficients),
            radius: load(simd, &columns.bodies.contact_radius, start),
            minus_unit: splat::<R, S>(simd, -columns.bodies.unit),
        }
    }

    /// `others` plus the force along r_ij of an agent j with radius `radius_j` at a distance in coordinate units.
    #[inline(always)]
    pub fn added_to(
        &self,
        simd: S,
        others: Lanes<R, S>,
        distance: Lanes<R, S>,
        radius_j: Lanes<R, S>,
    ) -> Lanes<R, S> {
        let touching = self.radius + radius_j;
        let overlap = self.minus_unit.mul_add_precise(distance, touching);
        let overlap = overlap.max(splat::<R, S>(simd, 0.0));
        self.stiffness.mul_add_precise(overlap, others)
    }
}

/// Adds the coefficient of the sum in Eq. 22, `stiffness` divided by the mass, for each of `agents`.
pub fn add_coefficients(
    frame: &Frame,
    agents: Range<usize>,
    stiffness: f64,
    coefficients: &mut [f64],
) {
    add_quotients(stiffness, &frame.agents.mass[agents], coefficients);
}

/// Eq. 23 for the part of the radius that counts, summed over all of `walls` that overlap the disc and divided by the
/// mass. Both faces of a wall push, and a corner counts once for each of its edges. An agent whose center is on a wall
/// is pushed along the outward normal.
pub fn from_walls(frame: &Frame, i: usize, walls: &[u32], contact: &Contact) -> Vector {
    let agents = frame.agents;
    let radius = agents.radius[i] * contact.wall_contact_scale;
    let r_i = agents.position[i];
    let mut force = Vector::zeros();
    for &k in walls {
        let wall = frame.walls.wall(k);
        if wall.is_beyond(r_i, radius) {
            continue;
        }
        let away = r_i - wall.nearest_point(r_i).point;
        let distance = away.norm();
        if distance < radius {
            let push = if distance > ON_THE_WALL {
                away / distance
            } else {
                wall.normal
            };
            force += push * (radius - distance);
        }
    }
    force * (contact.wall_stiffness.unwrap_or(0.0) / agents.mass[i])
}

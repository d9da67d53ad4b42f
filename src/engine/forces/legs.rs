//! Legs under bodies: people who sway, after Chatagnon, Chraibi, Pettré, Seyfried and Tordeux, *When legs and bodies
//! synchronize* (arXiv 2601.05867, 2026). Not part of the paper on SPH crowds, and none of its profiles has it.
//!
//! Each person consists of a body, at r_i with velocity v_i, and of legs, at y_i with velocity w_i. Its lean is
//! ℓ_i = r_i − y_i, with the direction e_i (zero if it stands upright). A body falls where it leans, and legs run after
//! it:
//!
//! dv_i/dt = λᵤ (v_s e_i + s_i − v_i) + A/m_i Σ_j f(|r_i − r_j|, B) n_ij + the same for walls + all other forces,
//! dw_i/dt = λ_b (v_s e_i + s_i − w_i) + A/m_i Σ_j f(|y_i − y_j|, B_l) n'_ij + the same for walls,
//! f(d, B) = e^(−d/B) − e^(−R/B) below R, and 0 beyond.
//!
//! This reading differs from the publication in five points. (1) Its damping −λ v_i is the goal force: a person who
//! stands brakes with K^goal/(τ m_i). (2) People of the publication go nowhere. Here they also walk: s_i is the part of
//! v_i along v_i^pref, between 0 and v_i^pref, so that a walk takes the legs along and people walk upright. It is zero
//! for those who stand, and for those who press forward in vain. (3) Forces end at R, without a jump between bodies.
//! People (and walls) are near each other if their bodies are. (4) The lean has a limit, at which the body pulls the
//! legs along. The pull does not act on the body. (5) No leg is behind a wall that its body is in front of.
//!
//! For points 2 and 4 the program JuPedSim has other rules (pull request 1613): a driving force on bodies alone, and
//! legs that are put back under a body which leans too far.

use std::f64::consts::LN_2;
use std::ops::Range;

use schemars::JsonSchema;

use crate::engine::forces::rates::{Extremes, Rates};
use crate::engine::frame::Frame;
use crate::engine::math::{Vector, direction};
use crate::engine::neighbors::{BLOCK, ClusterBlock};
use crate::engine::pairs::prelude::*;
use crate::engine::pairs::{
    Bodies, Lanes, Level, PairSum, Real, Simd, add_pairs, dispatch, each, load, splat, spread,
    store,
};

/// Parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema)]
#[schemars(default)]
pub struct Legs {
    /// λᵤ (`legs`), 1/s: the rate at which a body falls where it leans. Higher: people fall and sway faster.
    pub unbalancing_rate: f64,
    /// λ_b (`legs`), 1/s: the rate at which legs run after a body that leans. Higher: people regain their balance
    /// sooner.
    pub balancing_rate: f64,
    /// v_s (`legs`), m/s: the speed to which bodies fall and legs run. Higher: people lean farther.
    pub balance_speed: f64,
    /// A (`legs`), m/s²: the strength of the repulsion of bodies, and of legs, for people of mass 1. Higher: more
    /// distance; 0: bodies only touch, and legs do not.
    pub legs_strength: f64,
    /// B (`legs`), meters: the range over which the repulsion of bodies falls by a factor e.
    pub body_range: f64,
    /// B_l (`legs`), meters: the range over which the repulsion of legs falls by a factor e. Longer: legs find no room
    /// to run after the body.
    pub leg_range: f64,
    /// R (`legs`), meters: people farther apart do not repel each other. Longer: the cost grows with its square.
    pub legs_reach: f64,
    /// The longest lean (`legs`), meters, from legs to body. At this lean balance is lost, and the body pulls the legs
    /// along.
    pub lean_limit: f64,
}

impl Default for Legs {
    fn default() -> Self {
        Self {
            unbalancing_rate: 0.5,
            balancing_rate: 1.0,
            balance_speed: 1.0,
            legs_strength: 5.0,
            body_range: 0.5,
            leg_range: 0.3,
            legs_reach: 2.5,
            lean_limit: 0.55,
        }
    }
}

/// Accelerations of a body and of its legs, m/s².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Both {
    /// That of the body.
    pub body: Vector,
    /// That of the legs.
    pub legs: Vector,
}

impl Legs {
    /// The friction of falling, and the repulsion where it is steepest.
    pub fn rates(&self, of: &Extremes) -> Rates {
        let shortest = self.body_range.min(self.leg_range);
        Rates {
            contact: self.legs_strength / shortest / of.mass,
            corner: self.legs_strength / shortest / of.mass,
            friction: self.unbalancing_rate.max(self.balancing_rate),
            ..Rates::default()
        }
    }

    /// The terms of falling and of balance for agent `i`.
    pub fn balance(&self, frame: &Frame, i: usize) -> Both {
        let agents = frame.agents;
        let wish = frame.fields.preferred_velocity[i];
        let walk = walk(agents.velocity[i], wish);
        let aim = direction(agents.lean(i)) * self.balance_speed + walk;
        Both {
            body: (aim - agents.velocity[i]) * self.unbalancing_rate,
            legs: (aim - agents.legs_velocity[i]) * self.balancing_rate,
        }
    }

    /// The repulsion by the walls near agent `i`.
    pub fn from_walls(&self, frame: &Frame, i: usize) -> Both {
        let (agents, walls) = (frame.agents, frame.walls);
        let near = frame.neighbors.near_walls(i);
        if near.is_empty() {
            return Both::default();
        }
        let body = agents.position[i];
        let is_near = |&(k, _): &(u32, Vector)| {
            (body - walls.wall(k).nearest_point(body).point).norm() < self.legs_reach
        };
        let push = |from: Vector, range: f64| -> Vector {
            let facing = walls.facing(from, near).filter(is_near);
            let pushes = facing.map(|(_, away)| direction(away) * self.fall(away.norm(), range));
            pushes.sum::<Vector>() / agents.mass[i]
        };
        Both {
            body: push(body, self.body_range),
            legs: push(agents.legs[i], self.leg_range),
        }
    }

    /// A f(d, B), m/s².
    pub fn fall(&self, distance: f64, range: f64) -> f64 {
        let at_reach = (-self.legs_reach / range).exp();
        self.legs_strength * ((-distance / range).exp() - at_reach).max(0.0)
    }

    /// The repulsion by other agents on agent `i`.
    pub fn from_agents(&self, frame: &Frame, i: usize) -> Both {
        let mut coefficients = [0.0; BLOCK];
        coefficients[i % BLOCK] = 1.0 / frame.agents.mass[i];
        let mut sums = [Both::default(); BLOCK];
        self.add_from_agents(frame, i / BLOCK, &coefficients, &mut sums);
        sums[i % BLOCK]
    }

    /// Adds the repulsion by other agents, times `coefficients`, to the accelerations of the agents of block `b`.
    pub fn add_from_agents(
        &self,
        frame: &Frame,
        b: usize,
        coefficients: &[f64; BLOCK],
        sums: &mut [Both],
    ) {
        let block = frame.neighbors.near().block(b);
        each!(frame.packed, columns => dispatch!(Level::new(), simd => {
            self.add_sums(simd, (&columns.bodies, block), coefficients, sums);
        }));
    }

    #[inline(always)]
    fn add_sums<R: Real, S: Simd>(
        &self,
        simd: S,
        (bodies, block): (&Bodies<R>, &ClusterBlock),
        coefficients: &[f64; BLOCK],
        sums: &mut [Both],
    ) {
        let reach = self.legs_reach / bodies.unit;
        for (agents, runs) in block.clusters() {
            let start = agents.start;
            let own = start % BLOCK..start % BLOCK + agents.len();
            let mut sum = Repulsion::<R, S> {
                leans: Leans::of(bodies),
                lean: [
                    load(simd, &bodies.lean_x, start),
                    load(simd, &bodies.lean_y, start),
                ],
                reach_squared: splat::<R, S>(simd, reach * reach),
                body: Sum::new(simd, (self.body_range, self.legs_reach), bodies.unit),
                legs: Sum::new(simd, (self.leg_range, self.legs_reach), bodies.unit),
            };
            add_pairs(simd, bodies, (start, runs), &mut sum);
            let [body, legs] = [sum.body.sum, sum.legs.sum].map(
                #[inline(always)]
                |[x, y]| [store::<R, S>(x), store::<R, S>(y)],
            );
            let felt = coefficients[own.clone()].iter();
            for (k, (sum, felt)) in sums[own].iter_mut().zip(felt).enumerate() {
                let strength = self.legs_strength * felt;
                sum.body += Vector::new(body[0][k], body[1][k]) * strength;
                sum.legs += Vector::new(legs[0][k], legs[1][k]) * strength;
            }
        }
    }
}

/// s: the part of a velocity along the preferred one, between zero and that, m/s.
fn walk(velocity: Vector, wish: Vector) -> Vector {
    let squared = wish.norm_squared();
    match squared > 0.0 {
        true => wish * (velocity.dot(&wish) / squared).clamp(0.0, 1.0),
        false => Vector::zeros(),
    }
}

/// The leans of a run of agents, coordinate units.
#[derive(Clone, Copy)]
struct Leans<'a, R> {
    x: &'a [R],
    y: &'a [R],
}

impl<'a, R: Real> Leans<'a, R> {
    fn of(bodies: &'a Bodies<R>) -> Self {
        Self {
            x: &bodies.lean_x,
            y: &bodies.lean_y,
        }
    }
}

/// The repulsion of bodies and of legs for eight agents i.
struct Repulsion<'a, R: Real, S: Simd> {
    leans: Leans<'a, R>,
    lean: [Lanes<R, S>; 2],
    /// R², coordinate units².
    reach_squared: Lanes<R, S>,
    body: Sum<R, S>,
    legs: Sum<R, S>,
}

/// The sum of f(d, B) n for bodies or for legs.
struct Sum<R: Real, S: Simd> {
    /// −1/(B ln 2), per coordinate unit.
    falling: Lanes<R, S>,
    /// e^(−R/B)
    at_reach: Lanes<R, S>,
    sum: [Lanes<R, S>; 2],
}

impl<R: Real, S: Simd> Sum<R, S> {
    #[inline(always)]
    fn new(simd: S, (range, reach): (f64, f64), unit: f64) -> Self {
        let zero = splat::<R, S>(simd, 0.0);
        Self {
            falling: splat::<R, S>(simd, -unit / (LN_2 * range)),
            at_reach: splat::<R, S>(simd, (-reach / range).exp()),
            sum: [zero; 2],
        }
    }

    /// Adds an agent at this distance, coordinate units, whose square is given; `weight` is 1, or 0 for one that does
    /// not act.
    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        [dx, dy]: [Lanes<R, S>; 2],
        (squared, weight): (Lanes<R, S>, Lanes<R, S>),
    ) {
        let zero = splat::<R, S>(simd, 0.0);
        let distance = squared.max(splat::<R, S>(simd, R::TINY)).sqrt();
        let size = (R::exp2(simd, distance * self.falling) - self.at_reach).max(zero) * weight;
        let along = size / distance;
        self.sum[0] = along.mul_add(dx, self.sum[0]);
        self.sum[1] = along.mul_add(dy, self.sum[1]);
    }
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for Repulsion<'a, R, S> {
    type Run = Leans<'a, R>;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Leans<'a, R> {
        Leans {
            x: &self.leans.x[run.clone()],
            y: &self.leans.y[run],
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], leans: Leans<'a, R>, j: usize) {
        let squared = dy.mul_add(dy, dx * dx);
        let acts = squared.simd_lt(self.reach_squared);
        if acts.all_false() {
            return;
        }
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let weight = acts.select(one, zero);
        self.body.add(simd, [dx, dy], (squared, weight));
        let x = dx - (self.lean[0] - spread(simd, leans.x[j]));
        let y = dy - (self.lean[1] - spread(simd, leans.y[j]));
        self.legs.add(simd, [x, y], (y.mul_add(y, x * x), weight));
    }
}

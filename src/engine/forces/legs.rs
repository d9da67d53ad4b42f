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
//! v_i along v_i^pref, between 0 and v_i^pref, so that legs keep up with the walk. It is zero for agents that stand or
//! press forward in vain. (3) Forces end at R, without a jump between bodies.
//! People (and walls) are near each other if their bodies are. (4) The lean has a limit, at which the body pulls the
//! legs along. The pull does not act on the body. (5) No leg is behind a wall that its body is in front of.
//!
//! For points 2 and 4 the program JuPedSim has other rules (pull request 1613): a driving force on bodies alone, and
//! legs that are put back under a body which leans too far.

use std::ops::Range;

use schemars::JsonSchema;

use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::limits::{FARTHEST, STRONGEST};
use crate::math::{Vector, direction};
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, Lanes, Level, Real, Repulsion, Simd, dispatch, load, splat, spread};

/// Parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema)]
#[schemars(default)]
pub struct Legs {
    /// λᵤ (`legs`), 1/s: the rate at which a body falls where it leans. Higher: people fall and sway faster.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub unbalancing_rate: f64,
    /// λ_b (`legs`), 1/s: the rate at which legs run after a body that leans. Higher: people regain their balance
    /// sooner.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub balancing_rate: f64,
    /// v_s (`legs`), m/s: the speed to which bodies fall and legs run. Higher: people lean farther.
    #[schemars(range(min = 0, max = 100))]
    pub balance_speed: f64,
    /// A (`legs`), m/s²: the strength of the repulsion of bodies, and of legs, for people of mass 1. Higher: more
    /// distance; 0: bodies only touch, and legs do not.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub legs_strength: f64,
    /// B (`legs`), meters: the range over which the repulsion of bodies falls by a factor e.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub body_range: f64,
    /// B_l (`legs`), meters: the range over which the repulsion of legs falls by a factor e. Longer: legs find no room
    /// to run after the body.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub leg_range: f64,
    /// R (`legs`), meters: people farther apart do not repel each other. Longer: the cost grows with its square.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub legs_reach: f64,
    /// The longest lean (`legs`), meters, from legs to body. At this lean balance is lost, and the body pulls the legs
    /// along.
    #[schemars(range(min = 0.01, max = 2))]
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
        let (mut body, mut legs) = ([Vector::zeros()], [Vector::zeros()]);
        self.add_balance(frame, i..i + 1, (&mut body, &mut legs));
        Both {
            body: body[0],
            legs: legs[0],
        }
    }

    /// Adds the terms of falling and of balance of `agents` to the accelerations of their bodies and legs.
    pub fn add_balance(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        (bodies, legs): (&mut [Vector], &mut [Vector]),
    ) {
        let all = frame.agents;
        let positions = [&all.position, &all.legs].map(|column| &column[agents.clone()]);
        let velocities = [&all.velocity, &all.legs_velocity].map(|column| &column[agents.clone()]);
        let wishes = &frame.fields.preferred_velocity[agents];
        dispatch!(Level::new(), _simd => {
            self.balance_all(positions, velocities, wishes, [bodies, legs]);
        });
    }

    #[inline(always)]
    fn balance_all(
        &self,
        positions: [&[Vector]; 2],
        velocities: [&[Vector]; 2],
        wishes: &[Vector],
        [bodies, legs]: [&mut [Vector]; 2],
    ) {
        let positions = positions[0].iter().zip(positions[1]);
        let velocities = velocities[0].iter().zip(velocities[1]);
        let states = positions.zip(velocities).zip(wishes);
        for ((body, legs), (((r, y), (v, w)), &wish)) in bodies.iter_mut().zip(legs).zip(states) {
            let lean = r - y;
            let e = lean / lean.norm().max(f64::MIN_POSITIVE);
            let aim = e * self.balance_speed + walk(*v, wish);
            *body += (aim - v) * self.unbalancing_rate;
            *legs += (aim - w) * self.balancing_rate;
        }
    }

    /// The repulsion by the walls `near` agent `i`.
    pub fn from_walls(&self, frame: &Frame, i: usize, near: &[u32]) -> Both {
        let (agents, walls) = (frame.agents, frame.walls);
        let (body, legs) = (agents.position[i], agents.legs[i]);
        let strength = self.legs_strength / agents.mass[i];
        let push = |away: Vector, range: f64| {
            let [here, there] = [away.norm(), self.legs_reach].map(|d| (-d / range).exp());
            direction(away) * (strength * (here - there).max(0.0))
        };
        let mut both = Both::default();
        for k in near {
            let wall = walls.wall(*k);
            if wall.is_beyond(body, self.legs_reach) {
                continue;
            }
            let facing = |p: Vector| walls.facing(p, std::slice::from_ref(k)).next();
            let ahead = facing(body).map(|(_, away)| away);
            let away = ahead.unwrap_or_else(|| body - wall.nearest_point(body).point);
            if away.norm() >= self.legs_reach {
                continue;
            }
            both.body += ahead.map_or(Vector::zeros(), |away| push(away, self.body_range));
            if let Some((_, away)) = facing(legs) {
                both.legs += push(away, self.leg_range);
            }
        }
        both
    }

    /// The distance, meters, up to which the law needs agents and walls: without repulsion only the walls between a
    /// body and its legs.
    pub fn range(&self) -> f64 {
        match self.legs_strength {
            0.0 => self.lean_limit,
            _ => self.legs_reach.max(self.lean_limit),
        }
    }

    /// The repulsion by other agents.
    pub fn repulsion(&self) -> Repulsion {
        Repulsion {
            strength: self.legs_strength,
            reach: self.legs_reach,
            body_range: self.body_range,
            leg_range: self.leg_range,
        }
    }
}

/// s: the part of a velocity along the preferred one, between zero and that, m/s.
#[inline(always)]
fn walk(velocity: Vector, wish: Vector) -> Vector {
    let squared = wish.norm_squared().max(f64::MIN_POSITIVE);
    wish * (velocity.dot(&wish) / squared).clamp(0.0, 1.0)
}

/// The leans of a run of agents, coordinate units.
#[derive(Clone, Copy, Default)]
pub struct Leans<'a, R> {
    x: &'a [R],
    y: &'a [R],
}

impl<'a, R: Real> Leans<'a, R> {
    /// The leans of the agents `run`.
    #[inline(always)]
    pub fn of(bodies: &'a Bodies<R>, run: Range<usize>) -> Self {
        Self {
            x: &bodies.legs.lean_x[run.clone()],
            y: &bodies.legs.lean_y[run],
        }
    }
}

/// The repulsion of bodies and of legs for eight agents i, times A/m_i.
pub struct FromAgents<R: Real, S: Simd> {
    strength: Lanes<R, S>,
    lean: [Lanes<R, S>; 2],
    /// R², coordinate units².
    reach_squared: Lanes<R, S>,
    /// −1/(B ln 2) and −1/(B_l ln 2), per coordinate unit.
    rates: [Lanes<R, S>; 2],
    /// e^(−R/B) and e^(−R/B_l)
    at_reach: [Lanes<R, S>; 2],
    /// Σ_j f(|y_i − y_j|, B_l) n'_ij
    sum: [Lanes<R, S>; 2],
}

impl<R: Real, S: Simd> FromAgents<R, S> {
    /// The sum for the agents from `start` on.
    #[inline(always)]
    pub fn new(simd: S, bodies: &Bodies<R>, start: usize) -> Self {
        let legs = &bodies.legs;
        let reach = load(simd, &legs.reach, start);
        let body_rate = load(simd, &legs.body_rate, start);
        let legs_rate = load(simd, &legs.legs_rate, start);
        Self {
            strength: load(simd, &legs.strength, start),
            lean: [
                load(simd, &legs.lean_x, start),
                load(simd, &legs.lean_y, start),
            ],
            reach_squared: reach * reach,
            rates: [body_rate, legs_rate],
            at_reach: R::exp2_of_both(simd, [body_rate * reach, legs_rate * reach]),
            sum: [splat::<R, S>(simd, 0.0); 2],
        }
    }

    /// Adds agent j, at r_ij = r_i − r_j and this distance, coordinate units, with its lean. Returns `others` plus the
    /// force on bodies along r_ij.
    #[inline(always)]
    pub fn added_to(
        &mut self,
        simd: S,
        others: Lanes<R, S>,
        ([dx, dy], distance): ([Lanes<R, S>; 2], Lanes<R, S>),
        (leans, j): (Leans<R>, usize),
    ) -> Lanes<R, S> {
        let acts = dy.mul_add(dy, dx * dx).simd_lt(self.reach_squared);
        if acts.all_false() {
            return others;
        }
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let x = dx - (self.lean[0] - spread(simd, leans.x[j]));
        let y = dy - (self.lean[1] - spread(simd, leans.y[j]));
        let squared = y.mul_add(y, x * x);
        let between = squared.max(splat::<R, S>(simd, R::TINY)).sqrt();
        // The division does not wait for the exponentials.
        let inverse = one / between;
        let distances = [distance * self.rates[0], between * self.rates[1]];
        let [body, legs] = R::exp2_of_both(simd, distances);
        let legs = acts.select((legs - self.at_reach[1]).max(zero), zero) * inverse;
        self.sum[0] = legs.mul_add(x, self.sum[0]);
        self.sum[1] = legs.mul_add(y, self.sum[1]);
        let body = (body - self.at_reach[0]).max(zero);
        self.strength.mul_add(body, others)
    }

    /// The accelerations of the legs, m/s².
    #[inline(always)]
    pub fn of_legs(&self) -> [Lanes<R, S>; 2] {
        [self.sum[0] * self.strength, self.sum[1] * self.strength]
    }
}

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
//! The state of an agent is y_i and w_i. With velocity Verlet the legs move to first order only.
//!
//! For points 2 and 4 the program JuPedSim has other rules (pull request 1613): a driving force on bodies alone, and
//! legs that are put back under a body which leans too far.

mod repulsion;

use libm::exp;
use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::own::{Body, Force, Kept, Step};
use super::rates::{Extremes, Rates};
use crate::agents::{Agents, States};
use crate::clock::Integrator;
use crate::frame::Frame;
use crate::limits::{FARTHEST, STRONGEST};
use crate::math::{Vector, clamp_length, direction};
use crate::neighbors::BLOCK;
use crate::period::Axis;

/// Parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
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

/// The name of the force and of its state.
pub const NAME: &str = "legs";

/// y_i and w_i.
const STATE: [Kept; 4] = [
    kept("legs_x", "position of the legs, m", Some(Axis::X)),
    kept("legs_y", "position of the legs, m", Some(Axis::Y)),
    kept("legs_vel_x", "velocity of the legs, m/s", None),
    kept("legs_vel_y", "velocity of the legs, m/s", None),
];

/// The state, and |ℓ_i|.
const SHOWN: [Kept; 5] = [
    STATE[0],
    STATE[1],
    STATE[2],
    STATE[3],
    kept("lean", "distance from the legs to the body, m", None),
];

const fn kept(name: &'static str, about: &'static str, along: Option<Axis>) -> Kept {
    Kept { name, about, along }
}

/// The position of the legs of agent `i`, meters; `None` if it has none.
pub fn position(agents: &Agents, i: usize) -> Option<Vector> {
    Some(parts(agents.state(NAME, i)?)[0])
}

/// The velocity of the legs of agent `i`, m/s; `None` if it has none.
pub fn velocity(agents: &Agents, i: usize) -> Option<Vector> {
    Some(parts(agents.state(NAME, i)?)[1])
}

/// ℓ_i, from the legs to the body, meters; zero without legs.
pub fn lean(agents: &Agents, i: usize) -> Vector {
    position(agents, i).map_or(Vector::zeros(), |legs| agents.position[i] - legs)
}

/// y and w of a state, or their rates.
fn parts(state: &[f64]) -> [Vector; 2] {
    [0, 2].map(|k| Vector::new(state[k], state[k + 1]))
}

fn set(state: &mut [f64], position: Vector, velocity: Vector) {
    state.copy_from_slice(&[position.x, position.y, velocity.x, velocity.y]);
}

/// Of a person, the body or the legs.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Half {
    Body,
    Legs,
}

impl Legs {
    /// The law among the forces of a profile.
    pub fn among(forces: &[Arc<dyn Force>]) -> Option<&Self> {
        let mut all = forces.iter().map(|force| force.as_ref() as &dyn Any);
        all.find_map(<dyn Any>::downcast_ref)
    }

    /// Falling, or balance: the acceleration of the body or of the legs of agent `i`, m/s².
    fn balance(&self, frame: &Frame, i: usize, state: Option<&[f64]>, half: Half) -> Vector {
        let (r, v) = (frame.agents.position[i], frame.agents.velocity[i]);
        let [y, w] = state.map_or([r, v], parts);
        let lean = r - y;
        let e = lean / lean.norm().max(f64::MIN_POSITIVE);
        let aim = e * self.balance_speed + walk(v, frame.fields.preferred_velocity[i]);
        match half {
            Half::Body => (aim - v) * self.unbalancing_rate,
            Half::Legs => (aim - w) * self.balancing_rate,
        }
    }

    fn range_of(&self, half: Half) -> f64 {
        match half {
            Half::Body => self.body_range,
            Half::Legs => self.leg_range,
        }
    }

    /// A f(|d|, B) in the direction d, m/s², for people of mass 1.
    fn push(&self, half: Half) -> impl Fn(Vector) -> Vector {
        let range = self.range_of(half);
        let at_reach = exp(-self.legs_reach / range);
        let strength = self.legs_strength;
        move |d| {
            let distance = d.norm();
            let force = strength * (exp(-distance / range) - at_reach).max(0.0);
            d * (force / distance.max(f64::MIN_POSITIVE))
        }
    }

    /// The repulsion by walls, m/s². Walls act on legs if they are near the body.
    fn repulsion_by_walls(&self, frame: &Frame, i: usize, half: Half) -> Vector {
        let (agents, walls) = (frame.agents, frame.walls);
        let body = agents.position[i];
        let push = self.push(half);
        let mut sum = Vector::zeros();
        for k in frame.neighbors.near_walls(i) {
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
            let away = match half {
                Half::Body => ahead,
                Half::Legs => facing(body - lean(agents, i)).map(|(_, away)| away),
            };
            sum += away.map_or(Vector::zeros(), &push);
        }
        sum / agents.mass[i]
    }

    /// Passes `take` the accelerations by balance, by other agents and by walls, m/s², of each of `agents`, which are
    /// of one block.
    fn each_acceleration(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        half: Half,
        mut take: impl FnMut(usize, [Vector; 3]),
    ) {
        let states = frame.agents.states_of(NAME);
        let state = |i: usize| states.and_then(|states| states.of(i));
        if self.legs_strength == 0.0 {
            for i in agents {
                let balance = self.balance(frame, i, state(i), half);
                take(i, [balance, Vector::zeros(), Vector::zeros()]);
            }
            return;
        }
        let by_agents = self.repulsions(frame, agents.clone(), half);
        for i in agents {
            let balance = self.balance(frame, i, state(i), half);
            let by_agents = by_agents[i % BLOCK] / frame.agents.mass[i];
            let by_walls = self.repulsion_by_walls(frame, i, half);
            take(i, [balance, by_agents, by_walls]);
        }
    }

    /// The accelerations of agent `i`.
    fn accelerations(&self, frame: &Frame, i: usize, half: Half) -> [Vector; 3] {
        let mut parts = [Vector::zeros(); 3];
        self.each_acceleration(frame, i..i + 1, half, |_, found| parts = found);
        parts
    }
}

impl Force for Legs {
    fn name(&self) -> &str {
        NAME
    }

    /// Without repulsion only the walls between a body and its legs are needed.
    fn reach(&self) -> f64 {
        match self.legs_strength {
            0.0 => self.lean_limit,
            _ => self.legs_reach.max(self.lean_limit),
        }
    }

    /// The friction of falling, and the repulsion where it is steepest.
    fn rates(&self, of: &Extremes) -> Rates {
        let shortest = self.body_range.min(self.leg_range);
        Rates {
            contact: self.legs_strength / shortest / of.mass,
            corner: self.legs_strength / shortest / of.mass,
            friction: self.unbalancing_rate.max(self.balancing_rate),
            ..Rates::default()
        }
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        self.accelerations(frame, i, Half::Body).iter().sum()
    }

    fn add_accelerations(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        weight: f64,
        out: &mut [Vector],
    ) {
        let first = agents.start;
        self.each_acceleration(frame, agents, Half::Body, |i, parts| {
            out[i - first] += parts.iter().sum::<Vector>() * weight;
        });
    }

    fn term_names(&self) -> Vec<&str> {
        vec!["balance", "body_agents", "body_walls"]
    }

    fn terms(&self, frame: &Frame, i: usize) -> Vec<Vector> {
        self.accelerations(frame, i, Half::Body).to_vec()
    }

    fn kept(&self) -> &[Kept] {
        &STATE
    }

    /// Agents enter upright: the legs of those that walk are as fast as the body, and those of agents that still wait
    /// are at rest.
    fn begin(&self, agents: &Agents, i: usize, time: f64, state: &mut [f64]) {
        let waits = agents.walks_from.get(i).is_some_and(|&from| time < from);
        let velocity = if waits {
            Vector::zeros()
        } else {
            agents.velocity[i]
        };
        set(state, agents.position[i], velocity);
    }

    fn change(&self, frame: &Frame, i: usize, state: &[f64], rates: &mut [f64]) {
        let acceleration = self.accelerations(frame, i, Half::Legs).iter().sum();
        set(rates, parts(state)[1], acceleration);
    }

    fn changes(&self, frame: &Frame, agents: Range<usize>, states: &States, rates: &mut [f64]) {
        let first = agents.start;
        self.each_acceleration(frame, agents, Half::Legs, |i, parts_of| {
            let own = (i - first) * STATE.len()..(i + 1 - first) * STATE.len();
            if let Some(state) = states.of(i) {
                set(&mut rates[own], parts(state)[1], parts_of.iter().sum());
            }
        });
    }

    fn advance(&self, step: &Step, rates: &[f64], state: &mut [f64]) {
        let [mut y, w] = parts(state);
        let [w_of_frame, a] = parts(rates);
        let velocity = w + a * step.time;
        let way = match step.integrator {
            Integrator::SemiImplicit => velocity,
            Integrator::ForwardEuler | Integrator::Midpoint => w_of_frame,
            Integrator::VelocityVerlet => w + a * (0.5 * step.time),
        };
        y += clamp_length(way, step.max_speed) * step.time;
        set(state, y, clamp_length(velocity, step.max_speed));
    }

    /// The body pulls the legs along at the limit of the lean. Walls between a body and its legs stop the legs.
    fn fit(&self, body: &Body, state: &mut [f64]) {
        let [mut y, mut w] = parts(state);
        let lean = body.position - y;
        if lean.norm_squared() > self.lean_limit * self.lean_limit {
            let e = direction(lean);
            y = body.position - e * self.lean_limit;
            w += e * (body.velocity - w).dot(&e).max(0.0);
        }
        if let Some((point, wall)) = body.walls.stop(body.position, y, body.near_walls) {
            let normal = body.walls.wall(wall).normal;
            y = point;
            w -= normal * w.dot(&normal).min(0.0);
        }
        set(state, y, w);
    }

    fn shown(&self) -> &[Kept] {
        &SHOWN
    }

    fn values(&self, position: Vector, state: &[f64]) -> Vec<f64> {
        let lean = (position - parts(state)[0]).norm();
        state.iter().copied().chain([lean]).collect()
    }

    fn explained(&self, frame: &Frame, i: usize) -> Vec<(&str, Vector)> {
        let [balance, agents, walls] = self.accelerations(frame, i, Half::Legs);
        vec![
            ("legs_balance", balance),
            ("legs_agents", agents),
            ("legs_walls", walls),
            ("legs_total", balance + agents + walls),
        ]
    }

    fn equals(&self, other: &dyn Force) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }
}

/// s: the part of a velocity along the preferred one, between zero and that, m/s.
fn walk(velocity: Vector, wish: Vector) -> Vector {
    let squared = wish.norm_squared().max(f64::MIN_POSITIVE);
    wish * (velocity.dot(&wish) / squared).clamp(0.0, 1.0)
}

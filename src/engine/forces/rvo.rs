//! Reciprocal velocity obstacles (§5.3.2, Eqs. 20 and 21).
//!
//! Plain form: `rvo_acceleration`, `cost` and `time_to_collision` in `examples/paper.rs`.

mod candidates;
mod discs;
mod rings;
mod search;
mod surroundings;

pub use candidates::{Candidate, Candidates};
pub use discs::{Discs, Eight};
pub use search::Search;
pub use surroundings::{Limits, MovingDisc, Surroundings};

use candidates::Draws;
use surroundings::Around;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::clock::PAPER_COARSE_STEP;
use crate::forces::rates::Rates;
use crate::frame::Frame;
use crate::geometry::Wall;
use crate::limits::STRONGEST;
use crate::math::Vector;
use crate::random::{self, Purpose};

/// Parameters of Eq. 20 and of its sampling.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Rvo {
    /// w (Eq. 20), meters: the weight of the time to collision in RVO. Higher: agents avoid collisions earlier, with
    /// larger detours; 0: they do not avoid them.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub collision_weight: f64,
    /// The number of candidate velocities of RVO per agent and coarse frame. The cost grows with it. It is part of the
    /// model: 100 lower the density of the evacuation by 3.7 %, 5000 raise it by 1.6 %.
    #[schemars(range(min = 1, max = 1e6))]
    pub candidates: u32,
    /// As [`SocialForce::avoidance_radius`](super::social::SocialForce::avoidance_radius), meters.
    #[serde(skip)]
    pub avoidance_radius: f64,
}

impl Default for Rvo {
    fn default() -> Self {
        Self {
            collision_weight: 1.0,
            candidates: 250,
            avoidance_radius: 5.0,
        }
    }
}

/// Everything that an agent's choice of velocity depends on, except the moving discs around it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Situation {
    /// r_i, meters.
    pub position: Vector,
    /// v_i, m/s.
    pub velocity: Vector,
    /// v_i^pref, m/s.
    pub preferred_velocity: Vector,
    /// D_i, meters.
    pub radius: f64,
    /// s_max, m/s.
    pub max_speed: f64,
    /// Walls in range and not in contact, whose free side the agent is on.
    pub walls: Vec<Wall>,
}

/// The velocity that an agent wants, and the limits on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preference {
    /// v_i^pref, m/s.
    pub preferred_velocity: Vector,
    /// s_max, m/s.
    pub max_speed: f64,
}

impl Rvo {
    /// The rate at which the velocity becomes the chosen one.
    pub fn rates(&self) -> Rates {
        Rates {
            correction: 1.0 / PAPER_COARSE_STEP,
            ..Rates::default()
        }
    }

    /// Eq. 21: the acceleration, held until the next coarse frame.
    pub fn acceleration(
        &self,
        frame: &Frame,
        i: usize,
        wish: Preference,
        scratch: &mut Scratch,
    ) -> Vector {
        let Scratch {
            situation,
            draws,
            search,
        } = scratch;
        situation.see(frame, i, self.avoidance_radius, wish);
        let rng = random::stream(
            frame.seed,
            Purpose::Candidates,
            frame.agents.id[i],
            frame.clock.coarse_frame(),
        );
        let candidates = draws.draw(self.candidates, situation, rng);
        let around = Around::new(frame, i, self.avoidance_radius);
        let best = search.best(situation, &around, candidates, self.collision_weight);
        (best - situation.velocity) / frame.clock.coarse_step()
    }
}

/// Buffers, reused from agent to agent.
#[derive(Debug, Default)]
pub struct Scratch {
    situation: Situation,
    draws: Draws,
    search: Search,
}

impl Situation {
    /// Sets this to the state of agent `i` of a frozen frame, and the walls within `radius` meters.
    pub fn see(&mut self, frame: &Frame, i: usize, radius: f64, wish: Preference) {
        let agents = frame.agents;
        self.position = agents.position[i];
        self.velocity = agents.velocity[i];
        self.preferred_velocity = wish.preferred_velocity;
        self.radius = agents.radius[i];
        self.max_speed = wish.max_speed;
        self.walls.clear();
        for &k in frame.neighbors.far_walls(i) {
            let wall = frame.walls.wall(k);
            let distance = (wall.nearest_point(self.position).point - self.position).norm();
            if wall.faces(self.position) && distance < radius && distance > self.radius {
                self.walls.push(*wall);
            }
        }
    }

    /// The time in seconds until the disc, moving at `velocity`, first touches `wall`: its edge or an end point.
    /// Infinite if never.
    fn time_to_wall(&self, wall: &Wall, velocity: Vector) -> f64 {
        let ends = [wall.start, wall.end]
            .map(|end| time_to_contact(end - self.position, velocity, self.radius));
        let gap = wall.signed_distance(self.position) - self.radius;
        let approach = -velocity.dot(&wall.normal);
        let mut edge = f64::INFINITY;
        if gap >= 0.0 && approach > 0.0 {
            let time = gap / approach;
            let along = (self.position + velocity * time - wall.start).dot(&wall.tangent);
            if (0.0..=wall.length()).contains(&along) {
                edge = time;
            }
        }
        edge.min(ends[0]).min(ends[1])
    }
}

/// The integer part of a number from 0 to 255; of an odd integer, the integer below it. Branchless, so that loops over
/// this function use vectors.
#[inline(always)]
fn floor(number: f64) -> u8 {
    // Added to a small number, this leaves the nearest integer in the lowest bits.
    const TO_BITS: f64 = 1.5 * (1_u64 << 52) as f64;
    (number - 0.5 + TO_BITS).to_bits() as u8
}

/// The time in seconds until a point moving at `velocity` (m/s) first comes within `reach` of the point at
/// `offset` (meters). Infinite if never, or if it is within `reach` already.
pub fn time_to_contact(offset: Vector, velocity: Vector, reach: f64) -> f64 {
    let gap = offset.norm_squared() - reach * reach;
    let approach = offset.dot(&velocity);
    if gap <= 0.0 || approach <= 0.0 {
        return f64::INFINITY;
    }
    let discriminant = approach * approach - velocity.norm_squared() * gap;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // The smaller root of |velocity|² t² − 2 approach t + gap = 0, in a form without cancellation.
    gap / (approach + discriminant.sqrt())
}

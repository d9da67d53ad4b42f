//! The state of a crowd, its parameters, and its random numbers.

use rand::{Rng, RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::plane::{Vector, Wall};

/// A crowd among walls O_k.
pub struct Crowd {
    pub agents: Vec<Agent>,
    pub walls: Vec<Wall>,
    pub behavior: Behavior,
    pub seed: u64,
    pub frame: u64,
}

/// Agent i. Step 1B sets what belongs to SPH.
#[derive(Clone, Default)]
pub struct Agent {
    pub id: u32,
    pub position: Vector,          // r_i
    pub velocity: Vector,          // v_i
    pub goal: Vector,              // g_i
    pub radius: f64,               // D_i
    pub mass: f64,                 // m_i
    pub density: f64,              // ρ_i
    pub density_by_walls: f64,     // the second sum of Eq. 9
    pub mean_density: Option<f64>, // ρ̂_i; none before the first frame
    pub rest_density: f64,         // ρ_i⁰
    pub pressure: f64,             // p_i
    pub avoidance: Option<Vector>, // Eq. 21
}

/// P_k, the region that wall O_k hides from an agent (§4.3).
pub struct HiddenRegion {
    pub nearest_point: Vector,        // r_k*
    pub representative_point: Vector, // r_k^o
    pub area: f64,                    // a(P_k)
}

/// The sequence {(Π^j, ρ^j)} of §4.4, and the parameters that all profiles share.
pub struct Behavior {
    pub profiles: Vec<(Profile, f64)>,
    pub rest_density_max: f64, // ρ⁰max
    pub viscosity: f64,        // μ
}

/// A profile of §5.5.
pub struct Profile {
    pub name: String,
    pub navigation: Navigation,
    pub sph: bool,
    pub agent_stiffness: f64, // K^ag
    pub wall_stiffness: f64,  // K^obs
}

/// Step 3.
#[derive(Clone, Copy, PartialEq)]
pub enum Navigation {
    Goal,
    Social,
    Rvo,
}

impl Agent {
    /// At rest, with D_i uniform in [0.215, 0.265] and m_i = (D_i/0.24)² (§5.6).
    pub fn new(id: u32, position: Vector, goal: Vector, seed: u64) -> Self {
        let radius: f64 = random_numbers(seed, BODY, id).random_range(0.215..=0.265);
        Self {
            id,
            position,
            goal,
            radius,
            mass: (radius / 0.24).powi(2),
            ..Self::default()
        }
    }
}

/// The random numbers of the bodies of agents.
const BODY: u64 = 0;
/// The random numbers of RVO's candidates.
const CANDIDATE: u64 = 2;

/// The random numbers of RVO's candidates for an agent in a coarse frame.
pub fn candidate_numbers(seed: u64, id: u32, coarse_frame: u64) -> impl RngCore {
    let mut random = random_numbers(seed, CANDIDATE, id);
    random.set_word_pos(u128::from(coarse_frame) << 24);
    random
}

/// The random numbers of an agent: those of the engine.
fn random_numbers(seed: u64, purpose: u64, id: u32) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(purpose << 32 | u64::from(id));
    random
}

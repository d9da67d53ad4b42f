//! Counter-based random numbers: the draws of an agent depend only on the seed, its id, the purpose and the frame,
//! not on threads or on the order of agents.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The purpose of a stream. Streams of different purposes are independent.
#[derive(Debug, Clone, Copy)]
pub enum Purpose {
    /// Radius of an agent.
    Body = 0,
    /// Jitter of an agent's initial position.
    Placement = 1,
    /// Candidate velocities of RVO.
    Candidates = 2,
    /// Clearance at corners.
    Clearance = 3,
    /// Choices between places.
    Choice = 4,
    /// The times that agents wait or are served.
    Waiting = 5,
    /// Times at which agents compare their routes.
    Plan = 6,
    /// Preferred speed of an agent.
    Speed = 10,
    /// Time before an agent starts to walk.
    Premovement = 11,
    /// Places of a crowd.
    Crowd = 12,
    /// Times at which agents arrive at an entrance.
    Arrival = 13,
    /// Place at which an agent comes through an entrance.
    Entry = 14,
    /// Mass of an agent.
    Mass = 15,
}

/// Base-2 logarithm of the 32-bit words reserved per frame: enough for eight million draws of 64 bits.
const WORDS_PER_FRAME_LOG2: u32 = 24;

/// The stream of one agent for one purpose, positioned at `frame`.
pub fn stream(seed: u64, purpose: Purpose, agent: u32, frame: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((purpose as u64) << 32 | u64::from(agent));
    rng.set_word_pos(u128::from(frame) << WORDS_PER_FRAME_LOG2);
    rng
}

//! Random numbers by counter: what an agent draws depends on the seed, its id, the purpose and the
//! frame, and on nothing else; neither threads nor the order of agents can change it.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::math::Vector;

/// What a stream is for; streams of different purposes are independent.
#[derive(Debug, Clone, Copy)]
pub enum Purpose {
    /// Radius of an agent's disc.
    Body = 0,
    /// Jitter of an agent's first position.
    Placement = 1,
    /// Candidate velocities of RVO.
    Candidates = 2,
}

/// Words of a stream set aside for one frame: enough for four million draws.
const WORDS_PER_FRAME_LOG2: u32 = 24;

/// The stream of one agent for one purpose, wound to `frame`.
pub fn stream(seed: u64, purpose: Purpose, agent: u32, frame: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((purpose as u64) << 32 | u64::from(agent));
    rng.set_word_pos(u128::from(frame) << WORDS_PER_FRAME_LOG2);
    rng
}

/// 1/(2k)! and 1/(2k + 1)!; what follows is below 2⁻⁵³ of the first up to an eighth of a turn.
const SERIES: [[f64; 2]; 9] = {
    let mut series = [[1.0; 2]; 9];
    let mut k = 1;
    while k < series.len() {
        let n = 2.0 * k as f64;
        let even = series[k - 1][1] / n;
        series[k] = [even, even / (n + 1.0)];
        k += 1;
    }
    series
};

/// The unit vector at an angle of so many 2³²ths of a full turn.
///
/// Sine and cosine by their Taylor series up to an eighth of a turn, the rest by symmetry: the same bits
/// everywhere, as those of no library are.
pub fn direction(turn: u32) -> Vector {
    // The nearest quarter, and how far from there, radians.
    let quarter = turn.wrapping_add(1 << 29) >> 30;
    let rest = turn.wrapping_sub(quarter << 30) as i32;
    let x =
        f64::from(rest) * (std::f64::consts::TAU / f64::from(1_u32 << 16) / f64::from(1_u32 << 16));
    let minus_squared = -x * x;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for [even, odd] in SERIES.into_iter().rev() {
        cosine = cosine * minus_squared + even;
        sine = sine * minus_squared + odd;
    }
    let sine = sine * x;
    let [along, across] = QUARTERS[quarter as usize];
    Vector::new(
        along * cosine - across * sine,
        across * cosine + along * sine,
    )
}

/// Cosines and sines of the quarters of a turn.
const QUARTERS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;

    #[test]
    fn directions_are_the_sines_and_cosines_of_their_turns() {
        for k in 0..100_000_u32 {
            let turn = k.wrapping_mul(2_654_435_761);
            let v = direction(turn);
            let angle = f64::from(turn) / 2_f64.powi(32) * std::f64::consts::TAU;
            assert!((v - Vector::new(angle.cos(), angle.sin())).norm() < 2e-15);
            assert!((v.norm() - 1.0).abs() < 1e-15);
        }
        let quarters = [0, 1, 2, 3].map(|quarter| direction(quarter << 30));
        assert_eq!(quarters, QUARTERS.map(Vector::from));
    }

    #[test]
    fn every_key_has_its_own_stream_and_repeats_it() {
        let draw =
            |seed, purpose, agent, frame| -> u64 { stream(seed, purpose, agent, frame).random() };
        let base = draw(1, Purpose::Body, 2, 3);
        assert_eq!(base, draw(1, Purpose::Body, 2, 3));
        for other in [
            draw(2, Purpose::Body, 2, 3),
            draw(1, Purpose::Placement, 2, 3),
            draw(1, Purpose::Body, 3, 3),
            draw(1, Purpose::Body, 2, 4),
        ] {
            assert_ne!(base, other);
        }
    }
}

//! Reads any bytes as a checkpoint, and goes on with what is read: for tests and for fuzzing.

use std::path::Path;

use sandbox::runs::checkpoint::Checkpoint;
use sha2::{Digest, Sha256};

/// So many frames are computed.
const FRAMES: u64 = 2;
/// So long texts are short.
const SHORT: usize = 1000;

/// Ends in a run that goes on with finite numbers, or in a short error that is harmless to a terminal; returns
/// whether it went on.
pub fn read(bytes: &[u8]) -> bool {
    let harmless = |said: String| {
        let is_harmless = said.len() < SHORT && !said.contains(char::is_control);
        assert!(is_harmless, "{said:?}");
        false
    };
    let checkpoint = match Checkpoint::parse(bytes, Path::new("c")) {
        Ok(checkpoint) => checkpoint,
        Err(error) => {
            let said = error.to_string();
            assert!(said.starts_with("c: "), "{said}");
            return harmless(said);
        }
    };
    let scenario = match checkpoint.scenario(&[]) {
        Ok(scenario) => scenario,
        Err(error) => return harmless(error.to_string()),
    };
    let (mut simulation, mut metrics) = match checkpoint.resume(&scenario) {
        Ok(resumed) => resumed,
        Err(error) => return harmless(error.to_string()),
    };
    for _ in 0..FRAMES {
        // A fault names an agent whose numbers are not finite.
        if simulation.step().is_err() {
            return false;
        }
        metrics.observe(&simulation);
    }
    let positions = &simulation.frame().agents.position;
    assert!(positions.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
    true
}

/// The payload of a checkpoint with the head that belongs to it.
pub fn sealed(payload: &[u8]) -> Vec<u8> {
    let mut bytes = b"sandbox checkpoint\n".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend(Sha256::digest(payload));
    bytes.extend(payload);
    bytes
}

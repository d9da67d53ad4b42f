//! Reads any bytes as a checkpoint and resumes it, for tests and for fuzzing.

use std::path::Path;

use sandbox::runs::checkpoint::Checkpoint;
use sha2::{Digest, Sha256};

/// The number of frames to compute.
const FRAMES: u64 = 2;
/// Error messages must be shorter than this, bytes.
const MAX_MESSAGE: usize = 1000;

/// Checks that the resumed run has finite numbers, or that the error is short and without control characters.
/// Returns whether the run could be resumed without a fault.
pub fn read(bytes: &[u8]) -> bool {
    let harmless = |said: String| {
        let is_harmless = said.len() < MAX_MESSAGE && !said.contains(char::is_control);
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
    let mut run = match checkpoint.resume(scenario) {
        Ok(run) => run,
        Err(error) => return harmless(error.to_string()),
    };
    for _ in 0..FRAMES {
        // Numbers that are not finite are reported as a fault.
        if run.simulation.step().is_err() {
            return false;
        }
        run.metrics.observe(&run.simulation);
    }
    let positions = &run.simulation.frame().agents.position;
    assert!(positions.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
    true
}

/// A checkpoint with this payload and a valid header.
pub fn sealed(payload: &[u8]) -> Vec<u8> {
    let mut bytes = b"sandbox checkpoint\n".to_vec();
    bytes.extend(18_u32.to_le_bytes());
    bytes.extend(Sha256::digest(payload));
    bytes.extend(payload);
    bytes
}

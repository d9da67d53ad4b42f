//! The identity of a result: everything that it depends on.

use std::fmt;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use scenario::Scenario;

/// A hash of the sources of everything that a run depends on (engine, analysis, scenarios with their measurements,
/// runs), of all dependencies' versions and of the compiler: see `src/runs/build.rs`.
pub const ENGINE: &str = env!("SANDBOX_ENGINE");

/// A SHA-256 of the engine and of a job's input, 32 hexadecimal digits. Results with another identity are never
/// reused.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Identity(String);

/// The SHA-256 of a file's contents, 64 hexadecimal digits.
pub fn sha256(contents: &[u8]) -> String {
    let digest = Sha256::digest(contents);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Identity {
    /// The identity of the result of a job of this kind for this input.
    pub fn of(kind: &str, input: impl fmt::Display) -> Self {
        let digest = Sha256::digest(format!("{ENGINE} {kind} {input}"));
        let digits = digest[..16].iter().map(|byte| format!("{byte:02x}"));
        Self(digits.collect())
    }

    /// The identity of a run of this scenario: of all its settings and the contents of the files that it names.
    pub fn of_run(scenario: &Scenario) -> Self {
        Self::of("run", &scenario.document)
    }
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

//! Checkpoints: a run written down whole, to be gone on with after a crash as if it had never stopped.
//!
//! A file is a line of text, the format's version, a SHA-256 of what follows, and that: the scenario as JSON,
//! the state and what was measured so far, in postcard's encoding. It is written [whole](write_whole):
//! whatever happens, a checkpoint of before is not lost.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::engine::simulation::{Simulation, State, StateError};
use crate::runs::outputs::write_whole;
use crate::scenario::input;
use crate::scenario::metrics::Metrics;
use crate::scenario::{Need, Scenario, ScenarioError, Setting};

/// How every file begins.
const MAGIC: &[u8] = b"sandbox checkpoint\n";
/// To be raised with whatever changes what a file holds.
const VERSION: u32 = 2;
/// A longer file is refused, bytes: ten million agents, the most that may be, take 1 GB (99 bytes each, in the
/// plaza), and the text of their scenario 256 MiB at most.
const LONGEST: u64 = 1 << 32;
/// The engine's sources: another engine goes on otherwise.
const ENGINE: &str = env!("SANDBOX_ENGINE");

/// A run that can be gone on with.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The engine that wrote it.
    engine: String,
    /// What messages call the scenario's file.
    file: String,
    /// The scenario with all settings in it.
    document: String,
    state: State,
    densities: Vec<Option<(f64, f64)>>,
}

/// Why a checkpoint cannot be written or gone on with.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be written; one of before is as it was.
    #[error("{}: cannot be written: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// It is something else.
    #[error("{}: is no checkpoint", .0.display())]
    Foreign(PathBuf),
    /// It is of another version.
    #[error("{}: is a checkpoint of version {found}; this program reads version {VERSION}", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// It is not as it was written.
    #[error("{}: is damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What shows it.
        reason: String,
    },
    /// Its scenario makes no sense with the settings given now.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Its state and its scenario do not belong together.
    #[error(transparent)]
    State(#[from] StateError),
}

impl Checkpoint {
    /// Of an evaluated frame.
    pub fn of(scenario: &Scenario, simulation: &Simulation, metrics: &Metrics) -> Self {
        Self {
            engine: ENGINE.to_owned(),
            file: format!("{}.json", scenario.name),
            document: scenario.to_text(),
            state: simulation.state(),
            densities: metrics.taken().to_vec(),
        }
    }

    /// Was it written by this very engine? Another one goes on, but perhaps not to the same bits.
    pub fn is_of_this_engine(&self) -> bool {
        self.engine == ENGINE
    }

    /// How large its run becomes with some more settings.
    ///
    /// # Errors
    /// A setting makes no sense.
    pub fn need(&self, settings: &[Setting]) -> Result<Need, ScenarioError> {
        Need::parse(&self.document, &self.file, settings)
    }

    /// The scenario with some more settings.
    ///
    /// # Errors
    /// A setting makes no sense.
    pub fn scenario(&self, settings: &[Setting]) -> Result<Scenario, ScenarioError> {
        Scenario::parse(&self.document, &self.file, settings)
    }

    /// Goes on with `scenario`, which is the checkpoint's own but for when it ends.
    ///
    /// # Errors
    /// The scenario cannot have been in this state.
    pub fn resume(self, scenario: &Scenario) -> Result<(Simulation, Metrics), CheckpointError> {
        let mut simulation = Simulation::resumed(scenario.scene.clone(), self.state)?;
        let mut metrics = Metrics::new(scenario.measurements.clone(), &mut simulation);
        metrics.resume(&self.densities);
        Ok((simulation, metrics))
    }

    /// Writes it, whole or not at all, through symbolic links.
    ///
    /// # Errors
    /// The file cannot be written, or is no regular file.
    pub fn write(&self, path: &Path) -> Result<(), CheckpointError> {
        let failed = |reason: String| CheckpointError::Unwritable {
            path: path.to_owned(),
            reason,
        };
        let payload = postcard::to_stdvec(self).map_err(|error| failed(error.to_string()))?;
        let written = write_whole(path, |file| {
            file.write_all(MAGIC)?;
            file.write_all(&VERSION.to_le_bytes())?;
            file.write_all(&Sha256::digest(&payload))?;
            file.write_all(&payload)?;
            file.sync_all()
        });
        written.map_err(|error| failed(error.to_string()))
    }

    /// Reads it.
    ///
    /// # Errors
    /// There is no such file, or it is no checkpoint of this version that is as it was written.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let unreadable = |error: io::Error| CheckpointError::Unreadable {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        let mut file = File::open(path).map_err(unreadable)?;
        let start = Read::by_ref(&mut file).take(MAGIC.len() as u64);
        let start = input::rest(start, LONGEST).map_err(unreadable)?;
        if start != MAGIC {
            return Err(CheckpointError::Foreign(path.to_owned())); // however long it is
        }
        let bytes =
            input::rest(Read::chain(start.as_slice(), file), LONGEST).map_err(unreadable)?;
        Self::parse(&bytes, path)
    }

    /// Reads it from bytes; `path` is what messages call it.
    ///
    /// # Errors
    /// It is no checkpoint of this version that is as it was written.
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self, CheckpointError> {
        let damaged = |reason: &str| CheckpointError::Damaged {
            path: path.to_owned(),
            reason: reason.to_owned(),
        };
        let rest = bytes.strip_prefix(MAGIC);
        let rest = rest.ok_or_else(|| CheckpointError::Foreign(path.to_owned()))?;
        let (version, rest) = rest
            .split_first_chunk()
            .ok_or_else(|| damaged("cut short"))?;
        let version = u32::from_le_bytes(*version);
        if version != VERSION {
            return Err(CheckpointError::Version {
                path: path.to_owned(),
                found: version,
            });
        }
        let (sum, payload) = rest
            .split_first_chunk::<32>()
            .ok_or_else(|| damaged("cut short"))?;
        if Sha256::digest(payload).as_slice() != sum {
            return Err(damaged("its checksum is another"));
        }
        postcard::from_bytes(payload).map_err(|error| damaged(&error.to_string()))
    }
}

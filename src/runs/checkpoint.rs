//! Checkpoints: the complete state of a run, from which it resumes to the same bits as without interruption.
//!
//! A file consists of a line of text, the format's version, a SHA-256 of the payload, and the payload in postcard's
//! encoding: the scenario as JSON, the state, and the measurements so far. It is written [atomically](write_whole),
//! so an earlier checkpoint is never lost.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::drive::Run;
use crate::identity::ENGINE;
use crate::outputs::write_whole;
use engine::simulation::{Simulation, State, StateError};
use scenario::input;
use scenario::measurements::Metrics;
use scenario::{Draft, Scenario, ScenarioError, Setting};

/// The first bytes of every file.
const MAGIC: &[u8] = b"sandbox checkpoint\n";
/// Format version: increase it with every change to the contents of a file.
const VERSION: u32 = 18;
/// Longest file that is read, bytes. Ten million agents, the most allowed, take 1 GB (99 bytes each, in the plaza),
/// and the text of their scenario takes at most 256 MiB.
const LONGEST: u64 = 1 << 32;

/// A run that can be resumed.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint {
    /// `ENGINE` of the program that wrote it.
    engine: String,
    /// The name of the scenario's file in messages.
    file: String,
    /// The scenario as JSON, with all settings applied.
    document: String,
    state: State,
    /// The state of the measurements.
    seen: Vec<String>,
}

/// Why a checkpoint cannot be written or resumed.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be written; an existing one is unchanged.
    #[error("{}: cannot be written: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: String,
    },
    /// The file cannot be read, is not a checkpoint of this version, or is damaged.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The defect.
        reason: String,
    },
}

/// Why a checkpoint cannot be resumed.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// The state does not fit the scenario.
    #[error(transparent)]
    State(#[from] StateError),
    /// What the measurements have seen does not fit them.
    #[error("{0}")]
    Measurements(String),
}

impl Checkpoint {
    /// The checkpoint of an evaluated frame that the measurements have observed.
    pub fn of(scenario: &Scenario, simulation: &Simulation, metrics: &Metrics) -> Self {
        Self {
            engine: ENGINE.to_owned(),
            file: format!("{}.json", scenario.name),
            document: scenario.to_text(),
            state: simulation.state(),
            seen: metrics.seen(),
        }
    }

    /// Whether it was written by this version of the engine. Another version can resume it, but perhaps not to the same
    /// bits.
    pub fn is_of_this_engine(&self) -> bool {
        self.engine == ENGINE
    }

    /// The scenario with additional settings, before its agents are placed.
    ///
    /// # Errors
    /// A setting is invalid.
    pub fn draft(&self, settings: &[Setting]) -> Result<Draft, ScenarioError> {
        Draft::read(&self.document, &self.file, settings)
    }

    /// The scenario with additional settings.
    ///
    /// # Errors
    /// A setting is invalid.
    pub fn scenario(&self, settings: &[Setting]) -> Result<Scenario, ScenarioError> {
        self.draft(settings)?.scenario()
    }

    /// Resumes `scenario`, which is the checkpoint's own but may end at another time.
    ///
    /// # Errors
    /// The state, or that of a measurement, does not match the scenario.
    pub fn resume(self, scenario: Scenario) -> Result<Run, ResumeError> {
        let mut scene = scenario.scene.clone();
        if self.state.has_routes() && scene.routes.is_none() {
            // They are for goals and agents from outside.
            let floor = scenario.floor().map_err(|_| StateError)?;
            scene.later_routes = floor.map(Arc::new);
        }
        let mut simulation = Simulation::resumed(scene, self.state)?;
        let mut metrics = Metrics::new(&scenario.measurements, &mut simulation);
        let frame = simulation.frame().clock.frame();
        metrics
            .resume(&self.seen, frame)
            .map_err(ResumeError::Measurements)?;
        Ok(Run {
            scenario: Arc::new(scenario),
            simulation,
            metrics,
            end: None,
        })
    }

    /// Writes it atomically; follows symbolic links.
    ///
    /// # Errors
    /// The file cannot be written, or is not a regular file.
    pub fn write(&self, path: &Path) -> Result<(), CheckpointError> {
        let failed = |reason: String| CheckpointError::Unwritable {
            path: path.to_owned(),
            reason,
        };
        let parts = self.parts().map_err(|error| failed(error.to_string()))?;
        let written = write_whole(path, |file| {
            parts.iter().try_for_each(|part| file.write_all(part))?;
            file.sync_all()
        });
        written.map_err(|error| failed(error.to_string()))
    }

    /// The bytes of its file, in four parts.
    fn parts(&self) -> postcard::Result<[Vec<u8>; 4]> {
        let payload = postcard::to_stdvec(self)?;
        let sum = Sha256::digest(&payload).to_vec();
        let version = VERSION.to_le_bytes().to_vec();
        Ok([MAGIC.to_vec(), version, sum, payload])
    }

    /// The bytes of its file, which [`parse`](Self::parse) reads.
    ///
    /// # Errors
    /// There is not enough memory.
    pub fn bytes(&self) -> postcard::Result<Vec<u8>> {
        Ok(self.parts()?.concat())
    }

    /// Reads a checkpoint.
    ///
    /// # Errors
    /// The file cannot be read, is not a checkpoint of this version, or is damaged.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let unreadable = |error: io::Error| unreadable(path, format!("cannot be read: {error}"));
        let mut file = File::open(path).map_err(unreadable)?;
        let limited = Read::by_ref(&mut file).take(MAGIC.len() as u64);
        let start = input::rest(limited, LONGEST).map_err(unreadable)?;
        if start != MAGIC {
            return Self::parse(&start, path); // without reading the rest, which may be long
        }
        let bytes =
            input::rest(Read::chain(start.as_slice(), file), LONGEST).map_err(unreadable)?;
        Self::parse(&bytes, path)
    }

    /// Reads a checkpoint from bytes; messages call it `path`.
    ///
    /// # Errors
    /// The bytes are not a checkpoint of this version, or are damaged.
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self, CheckpointError> {
        let refused = |reason: &str| unreadable(path, reason.to_owned());
        let cut_short = || refused("is damaged: cut short");
        let stripped = bytes.strip_prefix(MAGIC);
        let rest = stripped.ok_or_else(|| refused("is not a checkpoint"))?;
        let (version, rest) = rest.split_first_chunk().ok_or_else(cut_short)?;
        let version = u32::from_le_bytes(*version);
        if version != VERSION {
            return Err(refused(&format!(
                "is a checkpoint of version {version}; this program reads version {VERSION}"
            )));
        }
        let (sum, payload) = rest.split_first_chunk::<32>().ok_or_else(cut_short)?;
        if Sha256::digest(payload).as_slice() != sum {
            return Err(refused("is damaged: its checksum does not match"));
        }
        postcard::from_bytes(payload).map_err(|error| refused(&format!("is damaged: {error}")))
    }
}

fn unreadable(path: &Path, reason: String) -> CheckpointError {
    let path = path.to_owned();
    CheckpointError::Unreadable { path, reason }
}

//! The runs of IMO's guidelines on evacuation analysis.

use runs::case::RunResult;

/// The runs of IMO's guidelines.
#[derive(Debug, Clone)]
pub struct Sample {
    /// The results; the error message of runs that failed.
    pub results: Vec<Result<RunResult, String>>,
    /// The number of runs of each population.
    pub repetitions: usize,
}

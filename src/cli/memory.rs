//! Rejects runs that need more memory than the machine has, before anything is allocated.

use std::path::Path;

use super::Failure;
use super::arguments::OutputOptions;
use crate::lab::machine::main_memory;
use crate::scenario::Need;

// Memory that output files take per agent, bytes. Measured as peak memory with 100,000 agents, where a run without
// output files took 47.5 MB.

/// Recording: 84.4 MB.
const RECORDED: u64 = 420;
/// Recording with the forces on every agent, in addition to [`RECORDED`]: 305 MB together.
const LAID_OPEN: u64 = 2_600;
/// Trajectory with every quantity: 150 MB.
const WITH_EVERYTHING: u64 = 1_200;
/// Other trajectories: 77.1 MB.
const TRAJECTORY: u64 = 360;
/// Checkpoint: 68.2 MB.
const CHECKPOINT: u64 = 260;

/// Memory that the output files of a run take, bytes per agent.
pub fn of_writing(options: &OutputOptions) -> u64 {
    let trajectory = |path: &Path| match path.extension() {
        Some(extension) if extension == "csv" => WITH_EVERYTHING,
        _ => TRAJECTORY,
    };
    let record = &options.record;
    let parts = [
        (record.save.is_some(), RECORDED),
        (record.debug_agents.as_deref() == Some("all"), LAID_OPEN),
        (options.checkpoint.checkpoint.is_some(), CHECKPOINT),
    ];
    let parts = parts.into_iter().filter(|&(asked, _)| asked);
    let files = options.trajectory.files.iter();
    parts.map(|(_, bytes)| bytes).sum::<u64>() + files.map(|path| trajectory(path)).sum::<u64>()
}

/// Memory that the recording of `inspect` takes, bytes per agent. Its printed output is made agent by agent.
pub fn of_inspecting(saves: bool, all: bool) -> u64 {
    let laid_open = if all { LAID_OPEN } else { 0 };
    if saves { RECORDED + laid_open } else { 0 }
}

/// Rejects a run that needs more memory than this machine has, if the system tells how much that is. Output files
/// take `writing` bytes per agent; messages call the scenario `file`.
pub fn check(file: &str, need: &Need, writing: u64) -> Result<(), Failure> {
    let fits = main_memory().map_or(Ok(()), |there| need.check(file, writing, there));
    fits.map_err(|error| Failure::Input(error.to_string()))
}

#[cfg(test)]
mod tests {
    use crate::scenario::Draft;

    #[test]
    fn the_shipped_scenarios_fit_into_a_small_machine() {
        for shipped in crate::scenario::SHIPPED {
            let draft = Draft::read(shipped.text, shipped.name, &[]).unwrap();
            let need = *draft.need();
            let need = need.with_lists(&draft.scenario().unwrap().scene);
            assert!(need.check(shipped.name, 0, 128 << 20).is_ok(), "{need:?}");
        }
    }
}

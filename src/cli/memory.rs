//! Runs that need more memory than there is: refused before anything is allocated.

use std::path::Path;

use super::Failure;
use super::arguments::OutputOptions;
use crate::lab::bench::main_memory;
use crate::scenario::Need;

/// What is written of an agent, bytes of memory in one frame: in a recording, laid open in it, in a
/// trajectory with every quantity and in another, in a checkpoint. Measured with 100,000 agents, where a run
/// took 47.5 MB: 84.4, 305 (all laid open, recording and all), 150, 77.1 and 68.2 MB.
const RECORDED: u64 = 420;
const LAID_OPEN: u64 = 2_600;
const WITH_EVERYTHING: u64 = 1_200;
const TRAJECTORY: u64 = 360;
const CHECKPOINT: u64 = 260;

/// Bytes of memory per agent that writing the files of a run takes.
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

/// Bytes of memory per agent that writing what `inspect` found takes; what it prints is printed agent by agent.
pub fn of_inspecting(saves: bool, all: bool) -> u64 {
    let laid_open = if all { LAID_OPEN } else { 0 };
    if saves { RECORDED + laid_open } else { 0 }
}

/// Refuses a run that needs more memory than this machine has, where the system says how much that is;
/// `file` is what messages call its scenario, and writing takes so many bytes per agent.
pub fn check(file: &str, need: &Need, writing: u64) -> Result<(), Failure> {
    let fits = main_memory().map_or(Ok(()), |there| need.check(file, writing, there));
    fits.map_err(|error| Failure::Input(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn the_shipped_scenarios_fit_into_a_small_machine() {
        for shipped in crate::scenario::SHIPPED {
            let scene = Scenario::parse(shipped.text, shipped.name, &[])
                .unwrap()
                .scene;
            let need = Need::parse(shipped.text, shipped.name, &[])
                .unwrap()
                .with_lists(&scene);
            assert!(need.check(shipped.name, 0, 128 << 20).is_ok(), "{need:?}");
        }
    }
}

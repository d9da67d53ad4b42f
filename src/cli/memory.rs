//! Memory that output files take per agent, bytes. Measured as peak memory with 100,000 agents, where a run without
//! output files took 47.5 MB.

use std::path::Path;

use super::arguments::OutputOptions;
use super::values::is_page;

/// Recording: 84.4 MB.
const RECORDED: u64 = 420;
/// Page: see the limit of its blocks.
const PAGE: u64 = 900;
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
    let (record, files) = (&options.record, options.trajectory.files.iter());
    let of = |asked: bool, bytes: u64| if asked { bytes } else { 0 };
    let pages = record.save.iter().filter(|path| is_page(path)).count();
    of(record.save.len() > pages, RECORDED)
        + of(pages > 0, PAGE)
        + of(record.debug_agents.as_deref() == Some("all"), LAID_OPEN)
        + of(options.checkpoint.checkpoint.is_some(), CHECKPOINT)
        + files.map(|path| trajectory(path)).sum::<u64>()
}

/// Memory that the recording of `inspect` takes, bytes per agent. Its printed output is produced agent by agent.
pub fn of_inspecting(saves: bool, all: bool) -> u64 {
    let laid_open = if all { LAID_OPEN } else { 0 };
    if saves { RECORDED + laid_open } else { 0 }
}

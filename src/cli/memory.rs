//! Runs that need more memory than there is: refused before anything is allocated.

use std::path::Path;

use super::Failure;
use super::arguments::OutputOptions;
use crate::bench::main_memory;
use crate::scenario::{Need, in_units};

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

/// Refuses a run that needs more memory than this machine has, where the system says how much that is;
/// `file` is what messages call its scenario, and writing takes so many bytes per agent.
pub fn check(file: &str, need: &Need, writing: u64) -> Result<(), Failure> {
    main_memory().map_or(Ok(()), |there| within(file, need, writing, there))
}

/// Refuses a run that needs more than `there` bytes.
fn within(file: &str, need: &Need, writing: u64, there: u64) -> Result<(), Failure> {
    let writing = need.entering.saturating_mul(writing);
    let estimate = need.bytes().saturating_add(writing);
    if estimate <= there {
        return Ok(());
    }
    let (later, agents) = (need.entering - need.initial, need.entering);
    let entering = match later {
        0 => String::new(),
        later => format!(" ({later} of them from sources)"),
    };
    let files = match writing {
        0 => String::new(),
        _ => format!(" ({} of them to write files)", in_units(writing)),
    };
    Err(Failure::Input(format!(
        "{file}: {agents} agents{entering} and {} walls would take {} of memory{files}, and this machine has {}: \
         take fewer agents, a shorter run (--until) if they come from sources, or another machine",
        need.walls,
        in_units(estimate),
        in_units(there),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEED: Need = Need {
        initial: 400_000,
        entering: 1_000_000,
        walls: 12,
        text: 1_000,
    };

    #[test]
    fn what_is_larger_than_the_machine_is_refused_with_the_estimate_and_the_fix() {
        let there = NEED.bytes();
        assert!(within("f.json", &NEED, 0, there).is_ok());
        let refused = within("f.json", &NEED, 100, 256_000_000).unwrap_err();
        assert_eq!(refused.exit_code(), 2);
        assert_eq!(
            refused.to_string(),
            "f.json: 1000000 agents (600000 of them from sources) and 12 walls would take 723 MB of memory \
             (100 MB of them to write files), and this machine has 256 MB: take fewer agents, a shorter run (--until) if they come from sources, \
             or another machine"
        );
    }

    #[test]
    fn the_shipped_scenarios_fit_into_a_small_machine() {
        for shipped in crate::scenario::SHIPPED {
            let need = Need::parse(shipped.text, shipped.name, &[]).unwrap();
            assert!(
                within(shipped.name, &need, 0, 128 << 20).is_ok(),
                "{need:?}"
            );
        }
    }
}

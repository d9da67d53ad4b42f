//! Prints notes on a run that has ended.

use super::arguments::RecordOptions;
use super::terminal::talk;
use super::values::ids;
use engine::simulation::Simulation;
use runs::drive::Run;
use runs::notes;

/// Prints the notes on a run.
pub fn print(run: &Run) {
    for note in notes::of(run) {
        talk(&format!("note: {note}"));
    }
}

/// Prints which agents of `--debug-agents` never entered.
pub fn print_absent(record: &RecordOptions, simulation: &Simulation) {
    let entered = simulation.frame().agents.entered();
    let typed = record.debug_agents.as_deref().map(ids);
    let asked = typed.and_then(Result::ok).unwrap_or_default();
    let absent: Vec<String> = asked
        .iter()
        .filter(|&&id| id >= entered)
        .map(u32::to_string)
        .collect();
    if !absent.is_empty() {
        talk(&format!(
            "note: --debug-agents: {} never entered: only {entered} agents entered, with ids from 0",
            absent.join(", ")
        ));
    }
}

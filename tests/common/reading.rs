//! Reads any text as a scenario and runs it for a few frames, for tests and for fuzzing.

use sandbox::engine::simulation::Fault;
use sandbox::runs::drive::{Observer, Run};
use sandbox::scenario::{Draft, Scenario, Setting};

/// Scenarios with more agents than this are not run.
const MAX_AGENTS: u64 = 500;
/// The number of frames to compute.
const FRAMES: u64 = 3;
/// Scenarios with more RVO candidates than this, summed over all agents, are not run.
const MAX_CANDIDATES: u64 = 20_000;

/// Runs the first frames of a valid scenario, or checks that the error names the file or setting. Returns the
/// number of agents that may have been created.
pub fn read(text: &str, settings: &[Setting]) -> u64 {
    let draft = Draft::read(text, "f.json", settings);
    let placed = draft.as_ref().map_or(0, |draft| draft.need().initial);
    let read = draft.and_then(|draft| Ok((*draft.need(), draft.scenario()?)));
    let (need, mut scenario) = match read {
        Ok(read) => read,
        Err(error) => {
            let said = error.to_string();
            assert!(
                said.starts_with("f.json") || said.starts_with("--set "),
                "{said}"
            );
            return placed;
        }
    };
    // The estimate of its needs is an upper bound.
    assert!(need.initial >= scenario.scene.agents.len() as u64);
    // Repeated corners are dropped. Walkable areas that overlap have additional corners.
    let walls = scenario.scene.walls.len() as u64;
    assert!(walls <= need.walls || scenario.document.get("walkable_area").is_some());
    assert!(need.entering >= scenario.entering);
    // Writing and reading the scenario gives the same document.
    let again = Scenario::parse(&scenario.to_text(), "f.json", &[]).unwrap();
    assert_eq!(again.document, scenario.document);
    if scenario.entering > MAX_AGENTS || scenario.entering * candidates(&scenario) > MAX_CANDIDATES
    {
        return need.initial;
    }
    let end = scenario.scene.clock.time_at(FRAMES);
    scenario.duration_secs = scenario.duration_secs.min(end);
    let Ok(mut run) = Run::new(scenario) else {
        return need.initial;
    };
    let driven = run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false);
    let frame = run.simulation.frame();
    if driven.is_ok() {
        let finite = |p: &sandbox::engine::math::Vector| p.x.is_finite() && p.y.is_finite();
        assert!(frame.agents.position.iter().all(finite));
    }
    assert!(u64::from(frame.agents.entered()) <= need.entering);
    for metric in run.metrics.results(&run.simulation) {
        assert!(!metric.name.is_empty());
    }
    need.entering
}

/// The largest number of RVO candidates of any agent.
fn candidates(scenario: &Scenario) -> u64 {
    let rvos = scenario
        .scene
        .groups
        .iter()
        .filter_map(|group| group.blend.rvo());
    rvos.map(|rvo| u64::from(rvo.candidates)).max().unwrap_or(1)
}

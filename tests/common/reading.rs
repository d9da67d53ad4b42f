//! Reads any text as a scenario, and runs what is read for some frames: for tests and for fuzzing.

use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::runs::drive::{Then, drive};
use sandbox::scenario::metrics::Metrics;
use sandbox::scenario::{Need, Scenario, Setting};

/// So many people are let in at most, and so many frames computed.
const FEW: u64 = 500;
const FRAMES: u64 = 3;
/// RVO's candidates of all of them at most.
const CANDIDATES: u64 = 20_000;

/// Ends in a scenario whose first frames are computed, or in an error that says something; returns how many
/// people entered.
pub fn read(text: &str, settings: &[Setting]) -> u64 {
    let need = Need::parse(text, "f.json", settings);
    let scenario = match Scenario::parse(text, "f.json", settings) {
        Ok(scenario) => scenario,
        Err(error) => {
            let said = error.to_string();
            assert!(
                said.starts_with("f.json") || said.starts_with("--set "),
                "{said}"
            );
            return 0;
        }
    };
    // What can be read has been counted before, and the count is an upper bound.
    let need = need.unwrap();
    assert_eq!(need.initial, scenario.scene.agents.len() as u64);
    // Corners given twice are dropped; where areas overlap, there are others.
    let walls = scenario.scene.walls.len() as u64;
    assert!(walls <= need.walls || scenario.document.get("walkable_area").is_some());
    assert_eq!(need.entering, scenario.entering);
    // What is read and written is the same scenario.
    let again = Scenario::parse(&scenario.to_text(), "f.json", &[]).unwrap();
    assert_eq!(again.document, scenario.document);
    if scenario.entering > FEW || scenario.entering * candidates(&scenario) > CANDIDATES {
        return need.initial;
    }
    let measurements = scenario.measurements.clone();
    let duration = scenario.duration_secs;
    let Ok(mut simulation) = Simulation::new(scenario.scene) else {
        return need.initial;
    };
    let mut metrics = Metrics::new(measurements, &mut simulation);
    let driven = drive(&mut simulation, duration, |simulation, _| {
        metrics.observe(simulation);
        let frame = simulation.frame();
        let over = frame.clock.frame() >= FRAMES;
        Ok::<Then, Fault>(if over { Then::Stop } else { Then::GoOn })
    });
    let frame = simulation.frame();
    if driven.is_ok() {
        let finite = |p: &sandbox::engine::math::Vector| p.x.is_finite() && p.y.is_finite();
        assert!(frame.agents.position.iter().all(finite));
    }
    assert!(u64::from(frame.agents.entered()) <= need.entering);
    for metric in metrics.results(&simulation) {
        assert!(!metric.name.is_empty());
    }
    need.entering
}

/// The most candidates that RVO tries for anybody.
fn candidates(scenario: &Scenario) -> u64 {
    let rvos = scenario
        .scene
        .groups
        .iter()
        .filter_map(|group| group.blend.rvo());
    rvos.map(|rvo| u64::from(rvo.candidates)).max().unwrap_or(1)
}

//! Simulations of scenario documents.

use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::runs::drive::{Observer, Run};
use sandbox::runs::summary::Summary;
use sandbox::scenario::Scenario;
use serde_json::Value;

/// The scenario `f.json` with this text.
pub fn scenario(document: &Value, settings: &[&str]) -> Result<Scenario, String> {
    let settings: Vec<_> = settings.iter().map(|text| text.parse().unwrap()).collect();
    Scenario::parse(&document.to_string(), "f.json", &settings).map_err(|error| error.to_string())
}

/// The simulation of a document before its first frame.
pub fn start(document: &Value, settings: &[&str]) -> Simulation {
    Simulation::new(scenario(document, settings).unwrap().scene).unwrap()
}

/// The simulation of a document after `secs` seconds.
pub fn after(document: &Value, settings: &[&str], secs: f64) -> Simulation {
    let mut simulation = start(document, settings);
    go_on(&mut simulation, secs);
    simulation
}

/// Simulates until `secs` seconds.
pub fn go_on(simulation: &mut Simulation, secs: f64) {
    let last = simulation.frame().clock.frame_at(secs);
    while simulation.frame().clock.frame() < last {
        simulation.step().unwrap();
    }
}

/// The whole run of this document.
pub fn driven(document: &Value) -> Run {
    let mut run = Run::new(scenario(document, &[]).unwrap()).unwrap();
    run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
        .unwrap();
    run
}

/// What a run of this document measures.
pub fn measured(document: Value) -> Summary {
    Summary::of(&driven(&document))
}

//! Random people on random journeys over random floor plans: every scenario is refused with its place, or runs without
//! panic, hang or fault, and no agent leaves the walkable area.
//!
//! 250 cases; more with `BAD_INPUT_TIMES=10 cargo test --release --test engine stages`.

use std::time::{Duration, Instant};

use sandbox::engine::math::Vector;
use sandbox::engine::routes::nearest_on;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::Watched;
use serde_json::Value;

use crate::common::bounded::cases;
use crate::common::plans::{Ring, contains, margin};
use crate::common::random_journeys::{RandomJourney, random_journeys};

/// Walls that an exit or entrance opens have floor behind them for this far, meters: 3 m out and 3 m aside.
const BEHIND_LINES: f64 = 4.25;
/// Agents stop in front of walls; rounding and uniting areas move walls by less than this, meters.
const ROUNDING: f64 = 1e-5;
/// A case that takes longer hangs.
const LONGEST: Duration = Duration::from_secs(120);
/// The most memory that a case holds at once, bytes.
const MEMORY: u64 = 64 << 20;

fn points(value: &Value) -> Vec<Vector> {
    serde_json::from_value::<Vec<[f64; 2]>>(value.clone())
        .unwrap()
        .into_iter()
        .map(Vector::from)
        .collect()
}

/// Checks that no agent stands in a wall, from the document alone.
fn check_places(simulation: &Simulation, journey: &RandomJourney) {
    let list = |key: &str| {
        journey.document[key]
            .as_array()
            .cloned()
            .unwrap_or_default()
    };
    let lines = [list("exits"), list("entrances")].concat();
    let lines: Vec<Vec<Vector>> = lines.iter().map(|part| points(&part["line"])).collect();
    let bodies: Vec<Ring> = list("obstacles")
        .iter()
        .map(|ring| serde_json::from_value(ring.clone()).unwrap())
        .collect();
    let agents = simulation.frame().agents;
    // Bodies that walk on behind an exit are on the floor behind it.
    for i in agents.present() {
        let (p, id) = (agents.position[i], agents.id[i]);
        let is_free = journey.plan.is_free(p, 0.0) || margin(&journey.plan.rings, p) < ROUNDING;
        let is_behind = || {
            lines
                .iter()
                .any(|line| (nearest_on(p, line[0], line[1]) - p).norm() < BEHIND_LINES)
        };
        assert!(
            is_free || is_behind(),
            "agent {id} has left the floor at {p}"
        );
        let is_inside =
            |body: &Ring| contains(body, p) && margin(std::slice::from_ref(body), p) > ROUNDING;
        assert!(
            !bodies.iter().any(is_inside),
            "agent {id} is in an obstacle at {p}"
        );
    }
}

/// Runs a scenario to its end. Returns what its last frame comes to.
fn run(mut simulation: Simulation, journey: &RandomJourney, secs: f64) -> Simulation {
    let mut watched = Watched::default();
    let last = simulation.frame().clock.frame_at(secs);
    while simulation.frame().clock.frame() < last {
        simulation.evaluate().unwrap();
        watched.observe(&simulation);
        simulation.integrate().unwrap();
        let frame = simulation.frame();
        if frame.clock.frame().is_multiple_of(10) || frame.clock.frame() == last {
            check_places(&simulation, journey);
        }
    }
    assert_eq!(watched.agents_through_walls(&simulation), 0);
    let (agents, outcome) = (simulation.frame().agents, simulation.outcome());
    assert_eq!(
        agents.count_present() + outcome.arrivals.len(),
        agents.entered() as usize
    );
    simulation
}

fn check(journey: &RandomJourney) {
    let scenario = match Scenario::parse(&journey.document.to_string(), "f.json", &[]) {
        Ok(scenario) => scenario,
        Err(error) => return assert!(error.to_string().starts_with("f.json"), "{error}"),
    };
    let scene = scenario.scene;
    let simulation = match Simulation::new(scene.clone()) {
        Err(Fault::NoFreePoint { .. }) => return,
        simulation => simulation.unwrap(),
    };
    let mut half = run(simulation, journey, 1.54);
    half.evaluate().unwrap();
    let resumed = Simulation::resumed(scene, half.state()).unwrap();
    let whole = run(half, journey, scenario.duration_secs).digest();
    assert_eq!(
        run(resumed, journey, scenario.duration_secs).digest(),
        whole
    );
}

#[test]
fn random_journeys_run_without_panic_or_hang_and_nobody_leaves_the_floor() {
    cases(250, random_journeys, |journey| {
        let start = Instant::now();
        check(&journey);
        assert!(start.elapsed() < LONGEST, "{:?}", start.elapsed());
        MEMORY
    });
}

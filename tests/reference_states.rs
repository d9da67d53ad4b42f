//! Small states with every term of the model. Those with representative points are from `examples/paper.rs`, those with
//! exact integrals over hidden regions from another independent implementation. The engine must agree to 1e-9.

use sandbox::engine::agents::NewAgent;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Term;
use sandbox::engine::scene::{Group, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, Parameters};
use serde::Deserialize;
use std::collections::BTreeMap;

const TOLERANCE: f64 = 1e-9;

#[derive(Deserialize)]
struct References {
    states: Vec<State>,
}

#[derive(Deserialize)]
struct State {
    title: String,
    profile: String,
    wall_method: WallMethod,
    viscosity: f64,
    obstacles: Vec<Vec<[f64; 2]>>,
    agents: Vec<Agent>,
    expected: Vec<Expected>,
}

#[derive(Deserialize)]
struct Agent {
    position: [f64; 2],
    velocity: [f64; 2],
    radius: f64,
    mass: f64,
    mean_density: f64,
    goal: [f64; 2],
}

#[derive(Deserialize)]
struct Expected {
    density: f64,
    density_from_agents: f64,
    density_from_walls: f64,
    mean_density: f64,
    rest_density: f64,
    pressure: f64,
    acceleration: [f64; 2],
    profiles: Vec<ExpectedProfile>,
    /// Given only for representative points, in the order of the walls.
    walls: Option<Vec<ExpectedWall>>,
}

#[derive(Deserialize)]
struct ExpectedProfile {
    name: String,
    weight: f64,
    /// Terms that are switched off (μ = 0) are zero.
    accelerations: BTreeMap<String, [f64; 2]>,
}

#[derive(Deserialize)]
struct ExpectedWall {
    nearest_point: [f64; 2],
    representative_point: [f64; 2],
    hidden_area: f64,
}

fn evaluated(state: &State) -> Simulation {
    let polygon = |points: &Vec<[f64; 2]>| {
        Polygon::new(points.iter().map(|&p| Vector::from(p)).collect()).unwrap()
    };
    let mut scene = Scene::with_obstacles(state.obstacles.iter().map(polygon).collect());
    scene.wall_method = state.wall_method;
    scene.precision = Precision::Double;
    let parameters = Parameters::of([("viscosity", state.viscosity)]).unwrap();
    let group = scene.add_group(Group {
        counted: false,
        ..Group::new("all", catalog::named(&state.profile, &parameters).unwrap())
    });
    scene.agents = state
        .agents
        .iter()
        .map(|agent| NewAgent {
            velocity: agent.velocity.into(),
            radius: Some(agent.radius),
            mass: Some(agent.mass),
            mean_density: Some(agent.mean_density),
            ..NewAgent::at(agent.position.into(), agent.goal.into(), group)
        })
        .collect();
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.request_density_until(1);
    simulation.evaluate().unwrap();
    simulation
}

fn assert_close(ours: f64, theirs: f64, what: &str) {
    let error = (ours - theirs).abs();
    assert!(
        error <= TOLERANCE * (1.0 + theirs.abs()),
        "{what}: ours {ours}, reference {theirs}, difference {error:e}"
    );
}

fn assert_close_vector(ours: [f64; 2], theirs: [f64; 2], what: &str) {
    assert_close(ours[0], theirs[0], &format!("{what}.x"));
    assert_close(ours[1], theirs[1], &format!("{what}.y"));
}

fn check_agent(ours: &Breakdown, theirs: &Expected, at: &str) {
    assert_close(ours.density, theirs.density, &format!("{at}: density"));
    let parts = [
        (
            ours.density_from_agents,
            theirs.density_from_agents,
            "density_from_agents",
        ),
        (
            ours.density_from_walls,
            theirs.density_from_walls,
            "density_from_walls",
        ),
        (ours.mean_density, theirs.mean_density, "mean_density"),
        (ours.rest_density, theirs.rest_density, "rest_density"),
        (ours.pressure, theirs.pressure, "pressure"),
    ];
    for (ours, theirs, name) in parts {
        assert_close(ours, theirs, &format!("{at}: {name}"));
    }
    assert_eq!(ours.profiles.len(), theirs.profiles.len(), "{at}");
    for (ours, theirs) in ours.profiles.iter().zip(&theirs.profiles) {
        assert_eq!(ours.name, theirs.name, "{at}");
        assert_close(ours.weight, theirs.weight, &format!("{at}: weight"));
        for &term in Term::ALL {
            let (name, value) = (term.name(), ours.accelerations.get(term));
            let expected = theirs.accelerations.get(name);
            let expected = expected.copied().unwrap_or_default();
            let ours = value.unwrap_or_default();
            assert_close_vector(ours.into(), expected, &format!("{at}: {name}"));
        }
    }
    assert_close_vector(
        ours.acceleration,
        theirs.acceleration,
        &format!("{at}: total"),
    );
    if let Some(expected) = &theirs.walls {
        assert_eq!(ours.walls.len(), expected.len(), "{at}: number of walls");
        for (wall, expected) in ours.walls.iter().zip(expected) {
            let at = format!("{at}: wall {}", wall.wall);
            assert_close(
                wall.hidden_area,
                expected.hidden_area,
                &format!("{at}: area"),
            );
            assert_close_vector(wall.nearest_point, expected.nearest_point, &at);
            let point = wall.representative_point.unwrap();
            assert_close_vector(point, expected.representative_point, &at);
        }
    }
}

fn check_file(file: &str, states: usize) {
    let references: References = serde_json::from_str(file).unwrap();
    assert_eq!(references.states.len(), states);
    for state in &references.states {
        let simulation = evaluated(state);
        let agents = simulation.frame().agents;
        assert_eq!(agents.len(), state.expected.len());
        for (id, expected) in state.expected.iter().enumerate() {
            let i = agents.index_of(id as u32).unwrap();
            let ours = Breakdown::of(&simulation, i).unwrap();
            let at = format!(
                "{} [{} {:?}] agent {id}",
                state.title, state.profile, state.wall_method
            );
            check_agent(&ours, expected, &at);
            assert_close_vector(ours.weighted_sum().into(), ours.acceleration, &at);
        }
    }
}

#[test]
fn every_term_agrees_with_the_plain_model() {
    check_file(include_str!("data/reference_states.json"), 35);
}

#[test]
fn terms_with_exact_walls_agree_with_the_independent_implementation() {
    check_file(include_str!("data/reference_exact_walls.json"), 10);
}

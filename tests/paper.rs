//! The engine, compared with the model of the paper in plain arithmetic: `examples/paper.rs`, a module of this test.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::Path;

use crate::common::drawn::Drawn;
use crate::common::social::condition;
use crate::common::{run, vector};
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Term;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use sandbox::scenario::catalog::{ALIASES, NAMES};
use serde_json::Value;

#[path = "../examples/paper.rs"]
mod plain;

/// The program of the example; the tests call the functions that it calls.
const _: fn() -> Result<(), Box<dyn Error>> = plain::main;

/// The largest error of densities and of the terms of accelerations in double precision, relative to the sum of the
/// magnitudes of all that is added.
const DOUBLE: f64 = 1e-12;
/// The largest error of accelerations that [`Precision::Mixed`] promises, relative to the same.
const MIXED: f64 = 1e-5;
/// Distances in meters from which on this promise holds: of agents, and of r_ij + T v_ij from 0.
const APART: f64 = 5e-4;
const APART_AHEAD: f64 = 0.05;

/// Nearer to a wall than this, in meters, rounding turns the direction away from it by more than [`DOUBLE`].
const NEAR_WALL: f64 = 1e-3;

/// Random states of all profiles.
fn states() -> impl Iterator<Item = (String, Drawn)> {
    let aliases = ALIASES.into_iter().map(|(alias, _)| alias);
    let profiles = NAMES.into_iter().chain(aliases);
    let seeds = profiles.flat_map(|profile| (0..STATES).map(move |seed| (profile, seed)));
    seeds.map(|(profile, seed)| (format!("{profile} {seed}"), Drawn::new(profile, seed)))
}

const STATES: u64 = 50;

/// A state in the plain model, evaluated.
fn plain_crowd(state: &Drawn) -> plain::Crowd {
    let mut behavior = plain::behavior(state.profile).unwrap();
    let given = |name| state.parameters.get(name).and_then(Value::as_f64).unwrap();
    behavior.viscosity = given("viscosity");
    behavior.rest_density_max = given("rest_density_max");
    let around = |corners: &Vec<[f64; 2]>| plain::Wall::around(corners);
    let mut crowd = plain::Crowd {
        agents: agents_of(&state.simulation(Precision::Double)),
        walls: state.obstacles.iter().flat_map(around).collect(),
        behavior,
        seed: state.scene.seed,
        frame: state.scene.clock.frame(),
    };
    plain::evaluate(&mut crowd);
    crowd
}

/// The agents of a simulation, for the plain model.
fn agents_of(simulation: &Simulation) -> Vec<plain::Agent> {
    let agents = simulation.frame().agents;
    let vector = |v: Vector| plain::Vector { x: v.x, y: v.y };
    let agent = |k: usize| plain::Agent {
        id: agents.id[k],
        position: vector(agents.position[k]),
        velocity: vector(agents.velocity[k]),
        goal: vector(agents.goal[k]),
        radius: agents.radius[k],
        mass: agents.mass[k],
        mean_density: (!agents.newcomer[k]).then_some(agents.mean_density[k]),
        avoidance: agents.avoidance.get(k).copied().flatten().map(vector),
        ..plain::Agent::default()
    };
    (0..agents.len()).map(agent).collect()
}

fn engine_vector(v: plain::Vector) -> Vector {
    vector(v.x, v.y)
}

/// For each term, the sum of the magnitudes of all that it adds, m/s². `rounding` is that of Eq. 18 for r_ij and v_ij,
/// relative to the tolerance.
fn magnitudes(
    crowd: &plain::Crowd,
    i: &plain::Agent,
    profile: &plain::Profile,
    rounding: fn(Vector, Vector) -> f64,
) -> BTreeMap<&'static str, f64> {
    let absolute = |a: &plain::Agent| plain::Agent {
        pressure: a.pressure.abs(),
        ..a.clone()
    };
    let terms = plain::terms(crowd, i, profile).into_iter();
    let mut sizes: BTreeMap<_, _> = terms.map(|(name, term)| (name, term.norm())).collect();
    let to_wall = |wall: &plain::Wall| (i.position - wall.nearest_point(i.position)).norm();
    let nearest = crowd.walls.iter().map(to_wall);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    for name in ["social_walls", "contact_walls"] {
        if let Some(size) = sizes.get_mut(name) {
            *size *= 1.0 + NEAR_WALL / nearest;
        }
    }
    for j in crowd.agents.iter().filter(|j| j.id != i.id) {
        let r_ij = engine_vector(i.position - j.position);
        let v_ij = engine_vector(i.velocity - j.velocity);
        let social = plain::social_force_by_agent(i, j).norm() / i.mass;
        let social = (social > 0.0).then(|| social * (1.0 + rounding(r_ij, v_ij)));
        let pressure = plain::pressure_by_agent(&absolute(i), &absolute(j)).norm();
        let viscosity = plain::viscosity_by_agent(i, j).norm() * crowd.behavior.viscosity;
        let contact = plain::contact_by_agent(i, j, profile).norm();
        let parts = [
            ("social_agents", social.unwrap_or_default()),
            ("pressure_agents", pressure / i.density),
            ("viscosity", viscosity / i.density),
            ("contact_agents", contact / i.mass),
        ];
        for (name, part) in parts {
            if let Some(size) = sizes.get_mut(name) {
                *size += part;
            }
        }
    }
    sizes
}

/// The rounding of Eq. 18 in double precision, relative to [`DOUBLE`].
fn social_rounding(r_ij: Vector, v_ij: Vector) -> f64 {
    8.0 * f64::EPSILON * condition(&SocialForce::default(), r_ij, v_ij) / DOUBLE
}

/// The rounding of Eq. 18 in mixed precision, relative to [`MIXED`]: agents that come close to the place of the other
/// are outside of its promise.
fn mixed_rounding(r_ij: Vector, v_ij: Vector) -> f64 {
    let social = SocialForce::default();
    let ahead = r_ij + v_ij * social.anticipation_time;
    if ahead.norm() < APART_AHEAD {
        1.0 / MIXED
    } else {
        0.0
    }
}

fn assert_near(ours: f64, plain: f64, size: f64, what: &str) {
    let error = (ours - plain).abs();
    assert!(
        error <= DOUBLE * size,
        "{what}: {ours} and {plain}, {error:e} of {size}"
    );
}

/// Compares everything that the engine says about one agent.
fn check(ours: &Breakdown, crowd: &plain::Crowd, i: &plain::Agent, at: &str) {
    let densities = [
        (ours.density, i.density),
        (ours.density_from_walls, i.density_by_walls),
        (ours.mean_density, i.mean_density.unwrap()),
        (ours.rest_density, i.rest_density),
    ];
    for (ours, plain) in densities {
        assert_near(ours, plain, plain.max(i.density), &format!("{at}: density"));
    }
    let size = 200.0 * (i.density + i.rest_density); // k, of two densities
    assert_near(ours.pressure, i.pressure, size, &format!("{at}: pressure"));
    let acting = plain::acting(&crowd.behavior, i.density);
    assert_eq!(ours.profiles.len(), acting.len(), "{at}");
    let mut total = 0.0;
    for (share, (profile, weight)) in ours.profiles.iter().zip(acting) {
        assert_eq!(share.name, profile.name, "{at}");
        assert_near(
            share.weight,
            weight,
            1.0 + i.density,
            &format!("{at}: weight"),
        );
        let sizes = magnitudes(crowd, i, profile, social_rounding);
        total += sizes.values().sum::<f64>();
        let terms: BTreeMap<_, _> = plain::terms(crowd, i, profile).into_iter().collect();
        for &term in Term::ALL {
            let (name, value) = (term.name(), share.accelerations.get(term));
            let plain = terms.get(name).copied().unwrap_or_default();
            let error = (value.unwrap_or_default() - engine_vector(plain)).norm();
            let size = sizes.get(name).copied().unwrap_or_default();
            let what = format!("{at}: {name}: {value:?}, {plain:?}");
            assert!(error <= DOUBLE * size, "{what}, {error:e} of {size}");
        }
    }
    let sum = Vector::from(ours.acceleration) - engine_vector(plain::acceleration(crowd, i));
    let allowed = DOUBLE * (1.0 + i.density) * total; // κ has the rounding of ρ_i
    assert!(sum.norm() <= allowed, "{at}: {sum}");
}

#[test]
fn every_term_of_random_states_is_that_of_the_plain_model() {
    for (name, state) in states() {
        let mut simulation = state.simulation(Precision::Double);
        simulation.evaluate().unwrap();
        let crowd = plain_crowd(&state);
        for i in &crowd.agents {
            let k = simulation.frame().agents.index_of(i.id).unwrap();
            let ours = Breakdown::of(&simulation, k).unwrap();
            check(&ours, &crowd, i, &format!("{name} agent {}", i.id));
        }
    }
}

#[test]
fn mixed_precision_keeps_its_promise() {
    let states = states().filter(|(_, state)| state.closest() >= APART);
    let mut count = 0;
    for (name, state) in states {
        count += 1;
        let mut simulation = state.simulation(Precision::Mixed);
        let frame = simulation.evaluate().unwrap();
        let crowd = plain_crowd(&state);
        for i in &crowd.agents {
            let k = frame.agents.index_of(i.id).unwrap();
            let acting = plain::acting(&crowd.behavior, i.density).into_iter();
            let sizes = acting.map(|(profile, weight)| {
                let sizes = magnitudes(&crowd, i, profile, mixed_rounding);
                sizes.values().sum::<f64>() * weight
            });
            let plain = engine_vector(plain::acceleration(&crowd, i));
            let error = (frame.fields.acceleration[k] - plain).norm();
            let size: f64 = sizes.sum();
            assert!(
                error <= MIXED * size,
                "{name} agent {}: {error:e} of {size}",
                i.id
            );
        }
    }
    assert!(count > 300, "{count}");
}

/// The evacuation of a scenario file, in double precision.
fn evacuation(profile: &str) -> Simulation {
    let settings = [format!("profile={profile}"), "precision=double".to_owned()];
    let settings = settings.map(|setting| setting.parse().unwrap());
    let file = include_str!("../scenarios/evacuation.json");
    let scenario = Scenario::parse(file, "evacuation.json", &settings).unwrap();
    Simulation::new(scenario.scene).unwrap()
}

/// Simulates both for some frames, and compares all positions after each: they may be up to `drift` meters apart. In a
/// frame of 0.02 s, velocities may change by 100 times as much.
fn follow(simulation: &mut Simulation, crowd: &mut plain::Crowd, frames: u64, drift: f64) {
    for _ in 0..frames {
        simulation.step().unwrap();
        let accelerations = plain::evaluate(crowd);
        plain::integrate(crowd, &accelerations);
        plain::evacuation::remove_arrived(crowd);
        let frame = simulation.frame();
        assert_eq!(frame.agents.len(), crowd.agents.len());
        for i in &crowd.agents {
            let k = frame.agents.index_of(i.id).unwrap();
            let way = (frame.agents.position[k] - engine_vector(i.position)).norm();
            let change = (frame.agents.velocity[k] - engine_vector(i.velocity)).norm();
            let at = format!("frame {} agent {}", frame.clock.frame(), i.id);
            assert!(
                way < drift && change < 100.0 * drift,
                "{at}: {way:e}, {change:e}"
            );
        }
    }
}

#[test]
fn the_evacuation_begins_as_in_the_plain_model() {
    for profile in NAMES {
        let mut crowd = plain::evacuation::crowd(plain::behavior(profile).unwrap(), 1);
        follow(&mut evacuation(profile), &mut crowd, 50, 1e-12);
    }
}

/// In a dense crowd, b in Eq. 18 cancels for some agents on a collision course, and stiff contacts let any difference
/// grow by a factor e in some two frames. So the plain model starts anew every five frames.
#[test]
fn a_crowd_at_the_door_goes_on_as_in_the_plain_model() {
    for profile in NAMES {
        let mut simulation = evacuation(profile);
        run(&mut simulation, 503); // between coarse frames, RVO's accelerations are held
        for _ in 0..10 {
            let mut crowd = plain::evacuation::crowd(plain::behavior(profile).unwrap(), 1);
            crowd.agents = agents_of(&simulation);
            crowd.frame = simulation.frame().clock.frame();
            follow(&mut simulation, &mut crowd, 5, 1e-9);
        }
        let arrivals = simulation.outcome().arrivals.len();
        assert!(arrivals > 0 || profile == "rvo", "{profile}: none has left");
    }
}

fn assert_same(ours: &Value, theirs: &Value, at: &str) {
    match (ours, theirs) {
        (Value::Array(a), Value::Array(b)) => {
            assert_eq!(a.len(), b.len(), "{at}");
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                assert_same(a, b, &format!("{at}[{k}]"));
            }
        }
        (Value::Object(a), Value::Object(b)) => {
            assert!(a.keys().eq(b.keys()), "{at}");
            for (key, value) in a {
                assert_same(value, &b[key], &format!("{at}.{key}"));
            }
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            assert!((a - b).abs() <= DOUBLE * (1.0 + b.abs()), "{at}: {a}, {b}");
        }
        _ => assert_eq!(ours, theirs, "{at}"),
    }
}

#[test]
fn the_reference_states_are_those_of_the_plain_model() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/reference_states.json"
    );
    let file: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let answer = plain::states::answer([path.to_owned()].into_iter()).unwrap();
    assert_same(&answer, &file, "file");
    let alone = plain::states::evaluated(file["states"][0].clone()).unwrap();
    assert_same(&alone, &file["states"][0], "the first state alone");
}

/// The names in backticks of every line of the engine that begins with "Plain form".
fn plain_forms(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(plain_forms(&path));
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let Some((_, rest)) = text.split_once("//! Plain form") else {
            continue;
        };
        let (names, _) = rest.split_once("`examples/paper.rs`").unwrap();
        found.extend(names.split('`').skip(1).step_by(2).map(str::to_owned));
    }
    found
}

#[test]
fn the_files_of_the_engine_name_functions_of_the_plain_model() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let plain = fs::read_to_string(root.join("examples/paper.rs")).unwrap();
    let names = plain_forms(&root.join("src/engine"));
    assert!(names.len() > 20, "{names:?}");
    for name in names {
        assert!(plain.contains(&format!("fn {name}(")), "{name}");
    }
}

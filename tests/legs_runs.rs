//! Runs of crowds on legs: walls, threads, resumed runs, periodic scenes, breakdowns, measurements, errors.

use sandbox::engine::density::SphParameters;
use sandbox::engine::forces::legs::{self, lean};
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::period::{Axis, Period};
use sandbox::engine::profile::{Blend, BlendError, BlendStep};
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, Parameters};
use serde_json::json;

use crate::common::legs::{alone, standing};
use crate::common::simulated::{measured, scenario};
use crate::common::{blend_with, block, breakdown, on_threads, room, run, scene, vector};

/// A crowd in a room that presses to a corner, where it has no way out.
fn pressed(integrator: Integrator, precision: Precision) -> Scene {
    let parameters = Parameters::of([("balance_speed", 0.5), ("legs_reach", 1.0)])
        .unwrap()
        .with("legs", true)
        .unwrap();
    let mut scene = scene(vec![room(9.0, 1.0)], blend_with("sph", &parameters));
    (scene.integrator, scene.precision) = (integrator, precision);
    scene.agents = block(vector(0.4, 0.4), 22, 22, 0.38, vector(9.5, 9.5));
    scene
}

#[test]
fn legs_stay_in_the_room_and_within_the_limit_of_the_lean() {
    let scene = pressed(Integrator::SemiImplicit, Precision::Mixed);
    let mut simulation = Simulation::new(scene).unwrap();
    let mut leaning = 0;
    for _ in 0..150 {
        run(&mut simulation, 1);
        let agents = simulation.frame().agents;
        for i in 0..agents.len() {
            let legs = legs::position(agents, i).unwrap();
            let is_inside = simulation.scene().walls.obstacle_at(legs).is_none();
            assert!(is_inside, "{legs} is in a wall");
            let lean = lean(agents, i).norm();
            assert!(lean < 0.55 + 1e-12, "{lean}");
            leaning += usize::from(lean > 0.05);
        }
    }
    assert!(leaning > 1000, "{leaning}");
}

#[test]
fn runs_on_any_number_of_threads_and_resumed_ones_have_the_same_bits() {
    for integrator in Integrator::ALL {
        for precision in [Precision::Double, Precision::Mixed] {
            let scene = pressed(integrator, precision);
            let digest = |simulation: &Simulation| simulation.digest();
            let ends = [1, 2, 3].map(|threads| {
                let mut simulation = Simulation::new(scene.clone()).unwrap();
                on_threads(threads, || run(&mut simulation, 90));
                digest(&simulation)
            });
            let mut first = Simulation::new(scene.clone()).unwrap();
            run(&mut first, 37);
            first.evaluate().unwrap();
            let state = postcard::to_stdvec(&first.state()).unwrap();
            let state = postcard::from_bytes(&state).unwrap();
            let mut second = Simulation::resumed(scene.clone(), state).unwrap();
            run(&mut second, 53);
            assert!(
                ends.iter().all(|end| *end == digest(&second)),
                "{integrator:?}, {precision:?}"
            );
        }
    }
}

#[test]
fn a_crowd_without_legs_has_no_state_of_legs() {
    let mut scene = scene(Vec::new(), blend_with("sph", &Parameters::default()));
    scene.agents = block(Vector::zeros(), 4, 4, 0.4, vector(9.0, 0.0));
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 3);
    let frame = simulation.frame();
    assert!(frame.agents.states.is_empty());
    assert_eq!(lean(frame.agents, 0), Vector::zeros());
}

#[test]
fn legs_come_along_across_the_ends_of_a_period() {
    let at = |from: f64| {
        let mut scene = standing(
            Parameters::of([("legs_reach", 1.5)])
                .unwrap()
                .or(&alone(0.0)),
            block(vector(0.3, 0.0), 10, 4, 0.6, vector(9.0, 0.0)),
        );
        for (k, agent) in scene.agents.iter_mut().enumerate() {
            agent.velocity = vector(1.0 + 0.1 * (k % 4) as f64, 0.0);
        }
        scene.period = Some(Period {
            axis: Axis::X,
            from,
            length: 6.0,
        });
        let mut simulation = Simulation::new(scene).unwrap();
        run(&mut simulation, 200);
        let agents = simulation.frame().agents;
        let of = |id: u32| {
            let i = agents.index_of(id).unwrap();
            (
                agents.velocity[i],
                legs::velocity(agents, i).unwrap(),
                lean(agents, i),
            )
        };
        (0..40).map(of).collect::<Vec<_>>()
    };
    // The period may begin anywhere: nothing else may change.
    for (one, other) in at(0.0).into_iter().zip(at(-2.5)) {
        let off = (one.0 - other.0).norm() + (one.1 - other.1).norm() + (one.2 - other.2).norm();
        assert!(off < 1e-9, "{one:?}, {other:?}");
        assert!(one.2.norm() > 1e-3);
    }
}

#[test]
fn the_terms_of_bodies_and_of_legs_add_up() {
    let mut simulation =
        Simulation::new(pressed(Integrator::SemiImplicit, Precision::Double)).unwrap();
    run(&mut simulation, 20);
    simulation.evaluate_with_density().unwrap();
    for id in [0, 21, 230, 483] {
        let found = breakdown(&simulation, id);
        let off = (found.weighted_sum() - Vector::from(found.acceleration)).norm();
        assert!(off < 1e-9, "{id}: {off}");
        let legs = &found.states[0];
        let parts = legs.vectors.iter().map(|(_, part)| Vector::from(*part));
        let parts: Vec<Vector> = parts.collect();
        let sum: Vector = parts[..3].iter().sum();
        assert!((sum - parts[3]).norm() < 1e-9, "{id}");
        let frame = simulation.frame();
        let i = frame.agents.index_of(id).unwrap();
        let rates = &frame.fields.state_rates[0][4 * i..4 * i + 4];
        assert!((sum - vector(rates[2], rates[3])).norm() < 1e-12, "{id}");
        assert!(found.to_string().contains("legs_walls"), "{found}");
    }
}

#[test]
fn profiles_of_a_blend_share_their_legs() {
    let profile = |parameters: &Parameters| catalog::plain("sph", parameters).unwrap();
    let steps = [Parameters::default(), alone(1.0)].map(|parameters| BlendStep {
        at_density: (parameters.get("goal_scale")).map_or(3.0, |scale| scale.as_f64().unwrap()),
        profile: profile(&parameters),
    });
    let [plain, with_legs] = steps;
    let blend = Blend::new(
        "b".to_owned(),
        SphParameters::default(),
        vec![with_legs, plain],
    );
    assert_eq!(
        blend.unwrap_err(),
        BlendError::DifferentForces("legs".to_owned())
    );
}

#[test]
fn people_at_the_limit_of_their_lean_count_as_unbalanced() {
    let document = |agents| {
        json!({
            "duration_secs": 2, "preferred_speed": 0.1, "agents": agents,
            "profile": {"base": "sph", "parameters": {"legs": true, "lean_limit": 0.1, "legs_strength": 0,
                        "gas_constant": 0, "goal_scale": 0}},
            "measurements": [{"unbalanced": {"every_secs": 0.5}}],
        })
    };
    let summary = measured(document(json!([
        {"position": [0, 0], "goal": [50, 0], "velocity": [0, 1.5]},
        {"position": [5, 0], "goal": [50, 0]},
        {"position": [9, 0], "goal": [50, 0]},
        {"position": [7, 4], "goal": [50, 0]},
    ])));
    let value = |name: &str| summary.metric(&format!("unbalanced_{name}")).unwrap();
    // One of four from 0.5 s on, in four of five samples.
    assert!(
        value("share") <= 0.2 + 1e-12 && value("share") > 0.0,
        "{}",
        value("share")
    );
    assert_eq!((value("max_share"), value("agents")), (0.25, 1.0));
    assert_eq!(value("x_m"), 0.0);
    assert!(value("y_m") > 0.3 && value("mean_lean_m") < 0.03);
}

#[test]
fn wrong_parameters_of_legs_are_refused() {
    let document = |parameters| {
        json!({"duration_secs": 1, "goal": [9, 9], "agents": [{"position": [1, 1]}],
               "profile": {"base": "sph", "parameters": parameters}})
    };
    let error = |parameters| scenario(&document(parameters), &[]).err().unwrap();
    assert!(error(json!({"legs": 1})).contains("legs"));
    assert!(error(json!({"legs": true, "lean_limit": 0})).contains("lean_limit"));
    assert!(scenario(&document(json!({"legs": true})), &[]).is_ok());
}

#[test]
fn people_on_legs_who_walk_get_a_note() {
    let floor = json!([[[[0, 0], [12, 0], [12, 10], [0, 10]]]]);
    let is_noted = |document: &serde_json::Value| {
        let notes = scenario(document, &[]).unwrap().notes;
        let on_legs = |note: &&String| note.contains("not of walks and evacuations");
        let found = notes.iter().filter(on_legs).count();
        assert!(found <= 1, "{notes:?}");
        found == 1
    };
    let mut room = json!({
        "profile": "legs", "duration_secs": 60, "walkable_area": floor,
        "exits": [{"name": "east", "line": [[12, 4], [12, 6]]}],
        "crowds": [{"area": [[0, 0], [11, 0], [11, 10], [0, 10]], "number": 20}],
    });
    assert!(is_noted(&room), "they walk to an exit");
    room["crowds"][0]["premovement_secs"] = json!(60);
    assert!(!is_noted(&room), "they stand until the end");
    room["crowds"][0]["premovement_secs"] = json!(30);
    assert!(is_noted(&room));
    room["profile"] = json!("sph");
    assert!(!is_noted(&room), "they have no legs");
    let mut lone = json!({
        "profile": "legs+sph", "duration_secs": 10, "walkable_area": floor,
        "agents": [{"position": [2, 2], "goal": [2, 2]}],
    });
    assert!(!is_noted(&lone), "it is where it wants to be");
    lone["agents"][0]["goal"] = json!([9, 2]);
    assert!(is_noted(&lone));
    lone["agents"][0]["premovement_secs"] = json!(11);
    assert!(!is_noted(&lone), "it is pushed at most");
    let sway = include_str!("../scenarios/questions/sway.json");
    assert!(!is_noted(&serde_json::from_str(sway).unwrap()));
}

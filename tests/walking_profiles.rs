//! Walking laws in profiles: beside the goal force and RVO, in blends, on many threads, in resumed runs.

use crate::common::walking::{crowd, walking, with};
use crate::common::{
    acceleration, bits, blend_with, block, breakdown, evaluated, on_threads, room, run, scene,
    vector, walker,
};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::density::SphParameters;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Term;
use sandbox::engine::profile::{Blend, BlendStep};
use sandbox::engine::scene::Group;
use sandbox::engine::simulation::Simulation;
use sandbox::engine::stability::time_step;
use sandbox::scenario::catalog::{Parameters, WalkingLawKind};

/// A single profile under another law, as a step of a blend.
fn step(at_density: f64, parameters: &Parameters) -> BlendStep {
    BlendStep {
        at_density,
        profile: blend_with("sph", parameters).steps()[0].profile.clone(),
    }
}

#[test]
fn the_law_adds_to_the_goal_force_what_lowers_its_speed() {
    let simulation = evaluated(crowd(WalkingLawKind::Headway, 2));
    for id in 0..300 {
        let breakdown = breakdown(&simulation, id);
        let terms = breakdown.profiles[0].accelerations.clone();
        let i = simulation.frame().agents.index_of(id).unwrap();
        let frame = simulation.frame();
        let wish = frame.fields.preferred_velocity[i]
            + simulation
                .blend(i)
                .walking_law()
                .unwrap()
                .lost_velocity(&frame, i);
        let velocity = Vector::from(breakdown.velocity);
        let expected = (wish - velocity) * 2.0 / breakdown.mass;
        let sum = terms.get(Term::Goal).unwrap() + terms.get(Term::Walking).unwrap();
        assert!((sum - expected).norm() < 1e-12);
        let total = Vector::from(breakdown.acceleration);
        assert!((breakdown.weighted_sum() - total).norm() < 1e-11);
    }
}

#[test]
fn a_blend_with_and_without_a_law_interpolates() {
    let [lawless, lawful] = [Parameters::default(), with(WalkingLawKind::Headway)];
    let steps = vec![step(0.0, &lawless), step(20.0, &lawful)];
    let both = Blend::new("both".to_owned(), lawless.part(), steps).unwrap();
    let simulated = |blend: Blend| {
        let mut scene = crowd(WalkingLawKind::Headway, 6);
        scene.groups = vec![Group::new("all", blend)];
        evaluated(scene)
    };
    let [none, blended, full] = [
        blend_with("sph", &lawless),
        both,
        blend_with("sph", &lawful),
    ]
    .map(simulated);
    for id in 0..300 {
        let share = breakdown(&blended, id).density / 20.0;
        let expected = acceleration(&none, id) * (1.0 - share) + acceleration(&full, id) * share;
        assert!(
            (acceleration(&blended, id) - expected).norm() < 1e-10,
            "{id}"
        );
    }
}

#[test]
fn rvo_prefers_the_lowered_speed_and_has_no_term_of_its_own() {
    let terms = |law| {
        let mut scene = scene(vec![], blend_with("rvo", &with(law)));
        let (speed, goal) = (vector(1.4, 0.0), vector(60.0, 0.0));
        scene.agents = [0.0, 0.6]
            .map(|x| walker(vector(x, 0.0), speed, goal))
            .to_vec();
        breakdown(&evaluated(scene), 0).profiles[0]
            .accelerations
            .clone()
    };
    // Two agents at the same speed do not collide.
    let [free, lawful] = [WalkingLawKind::None, WalkingLawKind::Headway].map(terms);
    assert!(free.get(Term::Rvo).unwrap().norm() < 2.0);
    let expected = vector((0.6 - 0.3) / 0.6 - 1.4, 0.0) / 0.1;
    assert!((lawful.get(Term::Rvo).unwrap() - expected).norm() < 2.0);
    assert_eq!(lawful.get(Term::Walking), None);
}

#[test]
fn profiles_with_rvo_share_their_law_in_a_blend() {
    let rvo = |law, at_density| BlendStep {
        at_density,
        profile: blend_with("rvo", &with(law)).steps()[0].profile.clone(),
    };
    let made = |laws: [WalkingLawKind; 2]| {
        let steps = vec![rvo(laws[0], 1.0), rvo(laws[1], 2.0)];
        Blend::new("both".to_owned(), SphParameters::default(), steps)
    };
    assert!(made([WalkingLawKind::Headway; 2]).is_ok());
    let error = made([WalkingLawKind::Headway, WalkingLawKind::None]).unwrap_err();
    assert!(error.to_string().contains("walking law"), "{error}");
}

#[test]
fn profiles_of_a_blend_share_the_law_that_looks_ahead() {
    let made = |steps| Blend::new("both".to_owned(), SphParameters::default(), steps);
    let other = Parameters::of([("headway_time", 0.9)])
        .unwrap()
        .or(&with(WalkingLawKind::Headway));
    let headway = || step(1.0, &with(WalkingLawKind::Headway));
    let drag = step(2.0, &with(WalkingLawKind::Drag));
    let error = made(vec![headway(), step(2.0, &other)]).unwrap_err();
    assert!(error.to_string().contains("one walking law"), "{error}");
    let blend = made(vec![step(0.0, &Parameters::default()), headway(), drag]).unwrap();
    assert_eq!(blend.walking_law().copied(), headway().profile.walking);
}

#[test]
fn agents_hold_their_speed_until_the_next_coarse_frame() {
    let mut scene = scene(vec![], blend_with("sph", &with(WalkingLawKind::Headway)));
    let goal = vector(60.0, 0.0);
    scene.agents = vec![
        walker(vector(0.0, 0.0), vector(0.6, 0.0), goal),
        NewAgent {
            preferred_speed: Some(0.01),
            ..walker(vector(0.7, 0.0), Vector::zeros(), goal)
        },
    ];
    let mut simulation = evaluated(scene);
    let held = |simulation: &Simulation| {
        let frame = simulation.frame();
        frame.agents.allowed_speed[frame.agents.index_of(0).unwrap()].unwrap()
    };
    for frame in 0..20_u64 {
        let before = held(&simulation);
        let expected = (before - 1.4).min(0.0) * 2.0 / breakdown(&simulation, 0).mass;
        assert!((walking(&simulation, 0).x - expected).abs() < 1e-12);
        run(&mut simulation, 1);
        simulation.evaluate().unwrap();
        let now = held(&simulation);
        let is_coarse = (frame + 1) % 5 == 0;
        assert_eq!(now != before, is_coarse, "{frame}: {before:?} {now:?}");
    }
}

#[test]
fn a_lane_with_a_law_is_the_same_on_any_number_of_threads() {
    for law in WalkingLawKind::laws() {
        let simulated = |threads| {
            on_threads(threads, || {
                let mut scene = scene(vec![room(12.0, 1.2)], blend_with("rvo->sph", &with(law)));
                scene.precision = Precision::Mixed;
                scene.agents = block(vector(0.4, 0.4), 28, 22, 0.42, vector(13.5, 6.0));
                let mut simulation = Simulation::new(scene).unwrap();
                run(&mut simulation, 30);
                bits(&simulation)
            })
        };
        assert_eq!(simulated(1), simulated(8), "{law:?}");
    }
}

#[test]
fn a_resumed_run_with_a_law_goes_on_with_the_same_bits() {
    for law in WalkingLawKind::laws() {
        let scene = crowd(law, 9);
        let mut whole = Simulation::new(scene.clone()).unwrap();
        run(&mut whole, 17);
        whole.evaluate().unwrap();
        let mut resumed = Simulation::resumed(scene, whole.state()).unwrap();
        for simulation in [&mut whole, &mut resumed] {
            run(simulation, 30);
        }
        assert_eq!(bits(&whole), bits(&resumed), "{law:?}");
    }
}

#[test]
fn steep_laws_and_strong_drag_shorten_the_automatic_time_step() {
    let step = |parameters: &Parameters| {
        let mut scene = scene(vec![], blend_with("sph", parameters));
        scene.agents = block(vector(0.0, 0.0), 2, 2, 1.0, vector(9.0, 0.0));
        time_step(&scene).unwrap()
    };
    let free = step(&Parameters::default());
    let steep = step(
        &Parameters::of([("headway_time", 0.01)])
            .unwrap()
            .or(&with(WalkingLawKind::Headway)),
    );
    let rough = step(
        &Parameters::of([("drag_per_density", 10.0)])
            .unwrap()
            .or(&with(WalkingLawKind::Drag)),
    );
    assert!(steep < 0.9 * free && steep > 0.2 * free, "{steep} {free}");
    assert!(rough < 0.9 * free && rough > 0.2 * free, "{rough} {free}");
    let default = step(&with(WalkingLawKind::Headway));
    assert!((0.95 * free..=free).contains(&default), "{default} {free}");
}

//! Quantities that a scene does not need are not computed and are absent.

use crate::common;
use crate::common::walking::with;
use crate::common::{blend, blend_with, block, person, rectangle, room, scene, vector};
use sandbox::engine::agents::Agents;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::forces::near::Wanted;
use sandbox::engine::profile::Blend;
use sandbox::engine::scene::Needs;
use sandbox::engine::simulation::{Simulation, Stage};
use sandbox::scenario::catalog::{Parameters, WalkingLawKind};

fn crowd(blend: Blend) -> Simulation {
    let mut scene = scene(vec![room(8.0, 1.0)], blend);
    scene.agents = block(vector(1.0, 1.0), 5, 5, 0.5, vector(9.0, 4.0));
    Simulation::new(scene).unwrap()
}

fn stages(simulation: &Simulation) -> Vec<Stage> {
    simulation
        .stages()
        .ms_per_frame()
        .map(|(stage, _)| stage)
        .collect()
}

#[test]
fn stages_that_a_profile_does_not_need_never_run() {
    for (name, density, rvo) in [
        ("sf", false, false),
        ("rvo", false, true),
        ("sf+sph", true, false),
        ("rvo+sph", true, true),
        ("sph", true, false),
        ("sf->sph", true, false),
        ("rvo->sph", true, true),
    ] {
        let mut simulation = crowd(blend(name));
        common::run(&mut simulation, 10);
        let ran = stages(&simulation);
        assert_eq!(ran.contains(&Stage::DensityAndPressure), density, "{name}");
        assert_eq!(ran.contains(&Stage::Rvo), rvo, "{name}");
        // All profiles sum contacts, and no agent leaves, enters or pushes.
        assert_eq!(
            ran.len(),
            6 + usize::from(density) + usize::from(rvo),
            "{name}"
        );
        let fields = simulation.evaluate().unwrap().fields;
        assert_eq!(fields.density.is_empty(), !density, "{name}");
    }
}

#[test]
fn needs_follow_from_the_profiles() {
    let needs = |name: &str| *crowd(blend(name)).needs();
    let sph = Wanted {
        pressure: true,
        contact: true,
        ..Wanted::default()
    };
    let goal_only = Needs {
        density: true,
        pairs: sph,
        rvo: false,
        social: false,
        walking: false,
        headings: false,
        reach: 0.0,
        avoidance: None,
        removal: false,
        paces: false,
        directions: false,
    };
    assert_eq!(needs("sph"), goal_only);
    let wide = Needs {
        avoidance: Some(5.0),
        ..goal_only
    };
    let social = |needs: Needs| Needs {
        social: true,
        ..needs
    };
    let rvo = |needs: Needs| Needs { rvo: true, ..needs };
    assert_eq!(needs("sf+sph"), social(wide));
    assert_eq!(needs("sf->sph"), social(wide));
    let apart = Needs {
        density: false,
        pairs: Wanted {
            pressure: false,
            ..sph
        },
        ..wide
    };
    assert_eq!(needs("sf"), social(apart));
    assert_eq!(needs("rvo"), rvo(apart));
    assert_eq!(needs("rvo+sph"), rvo(wide));
    assert_eq!(needs("rvo->sph"), rvo(wide));
}

#[test]
fn switched_off_terms_need_nothing() {
    let none = Parameters::of([("gas_constant", 0.0), ("agent_stiffness", 0.0)]).unwrap();
    let needs = *crowd(blend_with("sph", &none)).needs();
    assert!(!needs.density && !needs.pairs.contact && needs.avoidance.is_none());
    let viscous = Parameters::of([("viscosity", 5.0)]).unwrap().or(&none);
    assert!(crowd(blend_with("sph", &viscous)).needs().density);
}

#[test]
fn scenes_without_removal_skip_the_search_for_arrivals() {
    let mut simulation = crowd(blend("sph"));
    common::run(&mut simulation, 3);
    assert!(!stages(&simulation).contains(&Stage::Removal));
    let removal = Needs {
        removal: true,
        ..*simulation.needs()
    };
    simulation.pay_for(&removal);
    common::run(&mut simulation, 3);
    assert!(stages(&simulation).contains(&Stage::Removal));
}

#[test]
fn agents_without_forces_still_walk() {
    let none = Parameters::of([("gas_constant", 0.0), ("agent_stiffness", 0.0)]).unwrap();
    let mut simulation = crowd(blend_with("sph", &none));
    for _ in 0..50 {
        simulation.step().unwrap();
    }
    for velocity in &simulation.frame().agents.velocity {
        assert!(velocity.norm() > 1.0, "{velocity}");
    }
}

#[test]
fn without_avoidance_no_neighbors_within_five_meters_are_searched() {
    let scene = crowd(blend("sph")).scene().clone();
    assert_eq!(
        scene.ranges(&scene.needs(), &Agents::default()).avoidance,
        None
    );
    let scene = crowd(blend("sf")).scene().clone();
    assert_eq!(
        scene.ranges(&scene.needs(), &Agents::default()).avoidance,
        Some(5.0)
    );
}

#[test]
fn scenes_without_a_law_search_no_farther() {
    let ranges = |blend: Blend| {
        let scene = scene(vec![], blend);
        let agents = sandbox::engine::agents::Agents::default();
        scene.ranges(&scene.needs(), &agents).wide
    };
    assert_eq!(ranges(blend("sph")), None);
    assert_eq!(ranges(blend_with("sph", &with(WalkingLawKind::Drag))), None);
    let headway = ranges(blend_with("sph", &with(WalkingLawKind::Headway))).unwrap();
    assert!((headway - 1.14_f64.hypot(0.45)).abs() < 1e-12);
    let both = blend_with("sf", &with(WalkingLawKind::Headway));
    assert_eq!(ranges(both), Some(5.0));
}

#[test]
fn densities_exist_as_long_as_they_are_requested() {
    for name in ["sf", "rvo"] {
        let mut simulation = crowd(blend(name));
        simulation.request_density_until(7);
        for frame in 0..12 {
            simulation.evaluate().unwrap();
            let found = simulation.frame().fields.density.len();
            assert_eq!(
                found,
                if frame < 7 { 25 } else { 0 },
                "{name}, frame {frame}"
            );
            simulation.integrate().unwrap();
        }
        assert!(stages(&simulation).contains(&Stage::DensityAndPressure));
        simulation.reset_stages();
        common::run(&mut simulation, 3);
        assert!(!stages(&simulation).contains(&Stage::DensityAndPressure));
    }
}

#[test]
fn agents_far_from_walls_have_empty_lists_of_walls() {
    let mut scene = scene(vec![room(60.0, 1.0)], blend("sph"));
    scene.wall_method = WallMethod::Union;
    scene.agents = block(vector(25.0, 25.0), 5, 5, 0.5, vector(61.0, 30.0));
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.evaluate().unwrap();
    let frame = simulation.frame();
    assert!((0..25).all(|i| frame.neighbors.near_walls(i).is_empty()));
    assert!((0..25).all(|i| frame.neighbors.far_walls(i).is_empty()));
    assert!((0..25).all(|i| frame.fields.density_from_walls[i] == 0.0));
}

#[test]
fn an_interrupted_moving_average_restarts() {
    // Two agents meet after the last requested density, so that the old average is out of date.
    let mut scene = scene(Vec::new(), blend("sf"));
    scene.agents = vec![
        person(vector(0.0, 0.0), vector(20.0, 0.0)),
        person(vector(1.6, 0.0), vector(1.6, 0.0)),
    ];
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.request_density_until(10);
    common::run(&mut simulation, 120);
    simulation.request_density_until(121);
    simulation.evaluate().unwrap();
    for id in 0..2 {
        let agent = common::breakdown(&simulation, id);
        assert!(
            agent.neighbors.len() == 1 && agent.density > 1.28,
            "{agent:?}"
        );
        assert!((agent.mean_density - agent.density).abs() < 1e-12);
    }
}

#[test]
fn agents_that_leave_a_wall_feel_nothing_of_it() {
    let obstacle = || vec![rectangle([-1.0, 0.0], [-20.0, 20.0])];
    let crowd = |x: f64| block(vector(x, 0.0), 6, 6, 0.6, vector(30.0, 1.5));
    let mut walking = scene(obstacle(), blend("sph"));
    walking.agents = crowd(0.4);
    let mut walking = Simulation::new(walking).unwrap();
    let mut touched = false;
    for _ in 0..200 {
        walking.step().unwrap();
        walking.evaluate().unwrap();
        let frame = walking.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        for i in 0..agents.len() {
            let away = agents.position[i].x >= 1.0;
            let nothing =
                fields.density_from_walls[i] == 0.0 && fields.wall_gradient[i].norm() == 0.0;
            touched |= !nothing;
            assert!(!away || nothing, "{}", agents.position[i]);
        }
    }
    let last = walking
        .frame()
        .agents
        .position
        .iter()
        .map(|p| p.x)
        .fold(f64::INFINITY, f64::min);
    assert!(touched && last > 1.0, "{last}");
}

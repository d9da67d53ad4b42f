//! Every force acts, and none may make the automatic time step too long.

use std::sync::Arc;

use crate::common::walking::with;
use crate::common::{
    blend, blend_with, block, breakdown, evaluated, person, rectangle, run, scene, vector,
};
use sandbox::engine::clock::Clock;
use sandbox::engine::forces::own::Force;
use sandbox::engine::forces::rates::{Extremes, Rates};
use sandbox::engine::frame::Frame;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::Term;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::engine::stability::time_step;
use sandbox::scenario::catalog::{NAMES, Parameters, WalkingLawKind};
use sandbox::scenario::schema;

/// Pulls every agent to the x axis and brakes it.
#[derive(Debug, Clone, Copy)]
struct Rail {
    stiffness: f64,
    friction: f64,
}

impl Force for Rail {
    fn name(&self) -> &str {
        "rail"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates {
            everywhere: self.stiffness,
            friction: self.friction,
            ..Rates::default()
        }
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let pull = vector(0.0, -self.stiffness * frame.agents.position[i].y);
        pull - frame.agents.velocity[i] * self.friction
    }
}

/// One agent, so near to the axis that its speed is not clamped.
fn on_rail(rail: Rail, integrator: Integrator) -> Scene {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.integrator = integrator;
    scene.agents = vec![person(vector(0.0, 1e-4), vector(50.0, 0.0))];
    scene.own_forces.push(Arc::new(rail));
    scene
}

/// The change of the velocity in a frame after 10 s with this step, m/s.
fn shaking(mut scene: Scene, step: f64) -> f64 {
    scene.clock = Clock::new(step, 1);
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, (10.0 / step) as u64);
    let before = simulation.frame().agents.velocity[0];
    run(&mut simulation, 1);
    (simulation.frame().agents.velocity[0] - before).norm()
}

#[test]
fn an_agent_on_a_stiff_rail_walks_steadily_with_the_automatic_step_and_shakes_with_twice_that() {
    for [stiffness, friction] in [[1e4, 0.0], [1e6, 0.0], [0.0, 100.0], [1e4, 100.0]] {
        let rail = Rail {
            stiffness,
            friction,
        };
        for integrator in [Integrator::SemiImplicit, Integrator::VelocityVerlet] {
            let scene = on_rail(rail, integrator);
            let step = time_step(&scene).unwrap();
            let [short, long] = [step, 2.0 * step].map(|step| shaking(scene.clone(), step));
            assert!(short < 0.01, "{rail:?}, {integrator:?}, {step} s: {short}");
            assert!(long > 1.0, "{rail:?}, {integrator:?}, {step} s: {long}");
        }
    }
}

const MUCH: f64 = 1e3;
const MORE: f64 = 1e6;

/// Stiff parameters of a term; none if no parameter changes how fast it acts.
fn stiff(term: Term) -> Vec<Parameters> {
    let stiff = match term {
        Term::Goal => ("goal_scale", MUCH),
        Term::Walking => return WalkingLawKind::laws().map(walking).collect(),
        Term::SocialAgents => ("agent_strength", MORE),
        Term::SocialWalls => ("wall_strength", MORE),
        Term::Rvo => return Vec::new(),
        Term::PressureAgents | Term::PressureWalls => ("gas_constant", MORE),
        Term::Viscosity => ("viscosity", MUCH),
        Term::ContactAgents => ("agent_stiffness", MORE),
        Term::ContactWalls => ("wall_stiffness", MORE),
    };
    vec![Parameters::of([stiff]).unwrap()]
}

/// A walking law that brakes much sooner than by default.
fn walking(law: WalkingLawKind) -> Parameters {
    let stiff = match law {
        WalkingLawKind::None => return Parameters::default(),
        WalkingLawKind::Headway | WalkingLawKind::Headings => ("headway_time", 0.01),
        WalkingLawKind::DensityAhead => ("jam_density", 0.01),
        WalkingLawKind::Drag => ("drag_per_density", MUCH),
    };
    with(law).or(&Parameters::of([stiff]).unwrap())
}

/// The automatic step of one agent with this profile, seconds.
fn step(name: &str, parameters: &Parameters) -> f64 {
    let mut scene = scene(Vec::new(), blend_with(name, parameters));
    scene.agents = vec![person(Vector::zeros(), vector(9.0, 0.0))];
    time_step(&scene).unwrap()
}

#[test]
fn every_stiff_force_that_is_not_in_the_paper_shortens_the_automatic_step() {
    // Each parameter that is true or false is the switch of one such force.
    let properties = &schema()["$defs"]["Parameters"]["properties"];
    let switches = properties.as_object().unwrap().iter();
    let switches = switches.filter(|(_, property)| property["type"][0] == "boolean");
    let switches: Vec<&String> = switches.map(|(name, _)| name).collect();
    assert_eq!(switches, ["legs"]);
    let legs = |stiff| {
        let parameters = Parameters::of([stiff]).unwrap();
        parameters.with("legs", true).unwrap()
    };
    let all = [
        walking(WalkingLawKind::Drag),
        legs(("unbalancing_rate", MUCH)),
        legs(("legs_strength", MORE)),
    ];
    for parameters in all {
        let [soft, stiff] = [&Parameters::default(), &parameters].map(|of| step("sph", of));
        assert!(stiff < soft, "{parameters:?}: {stiff} s, {soft} s");
    }
}

#[test]
fn every_stiff_force_shortens_the_automatic_step() {
    for &term in Term::ALL {
        let mut found = 0;
        for parameters in stiff(term) {
            for name in NAMES {
                let blend = blend_with(name, &parameters);
                if blend.steps().iter().any(|step| step.profile.has(term)) {
                    let [soft, stiff] = [&Parameters::default(), &parameters];
                    let (soft, stiff) = (step(name, soft), step(name, stiff));
                    assert!(stiff < soft, "{term:?}, {name}: {stiff} s, {soft} s");
                    found += 1;
                }
            }
        }
        assert!(found > 0 || term == Term::Rvo, "{term:?}");
    }
}

#[test]
fn every_term_that_a_profile_has_acts_in_a_crowd_at_a_wall() {
    let plain = [Parameters::default()];
    for &term in Term::ALL {
        for parameters in stiff(term).iter().chain(&plain) {
            for name in NAMES {
                let blend = blend_with(name, parameters);
                if !matches!(blend.steps(), [step] if step.profile.has(term)) {
                    continue;
                }
                let mut scene = scene(vec![rectangle([-1.0, 0.0], [-1.0, 3.0])], blend);
                scene.agents = block(vector(0.2, 0.2), 4, 4, 0.28, vector(9.0, 0.5));
                for (k, agent) in scene.agents.iter_mut().enumerate() {
                    agent.velocity = vector(0.3, 0.1 * (k % 3) as f64);
                }
                let simulation = evaluated(scene);
                let acts = |id| {
                    let profiles = breakdown(&simulation, id).profiles;
                    let mut terms = profiles.iter().filter_map(|of| of.accelerations.get(term));
                    terms.any(|acceleration| acceleration.norm() > 0.0)
                };
                assert!((0..16).any(acts), "{term:?}, {name}, {parameters:?}");
            }
        }
    }
}

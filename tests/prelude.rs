//! Every item of `sandbox::prelude` for the engine in its documented role: constructed, called, its public fields read.
//! A name, an argument or a field that is removed or renamed does not compile here, as in the code of users. Patterns
//! without `..` are those of structs that users write as literals: they break at a new field, too.

use std::sync::Arc;

use sandbox::engine::agents::Agents;
use sandbox::engine::forces::own::{Body, Kept, Step};
use sandbox::prelude::*;
use serde_json::json;

fn sph() -> Blend {
    catalog::named("sph", &Parameters::default()).unwrap()
}

#[test]
fn profiles_come_from_the_catalog_or_are_put_together() {
    let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
    let parameters = parameters.with("gas_constant", 100.0).unwrap();
    assert_eq!(parameters.get("viscosity"), Some(&json!(5.0)));
    let Profile {
        name,
        navigation,
        walking,
        pressure,
        viscosity,
        contact,
        forces,
    } = catalog::plain("sf+sph", &parameters).unwrap();
    assert!(catalog::names().contains(&&name[..]));
    let part = |name: &str, is_fluid: bool| Profile {
        name: name.to_owned(),
        navigation,
        walking,
        pressure: pressure && is_fluid,
        viscosity: viscosity.filter(|_| is_fluid),
        contact,
        forces: forces.clone(),
    };
    let steps = [
        BlendStep {
            at_density: 2.0,
            profile: part("sparse", false),
        },
        BlendStep {
            at_density: 4.0,
            profile: part("dense", true),
        },
    ];
    let fluid = catalog::named("sph", &parameters).unwrap().sph;
    let blend = Blend::new("both".to_owned(), fluid, steps.to_vec()).unwrap();
    assert_eq!(blend.steps(), steps);
    assert_eq!((&blend.name[..], blend.sph.gas_constant), ("both", 100.0));
    let weights = blend.weights(3.5);
    let weights: Vec<_> = weights
        .map(|(profile, weight)| (&profile.name[..], weight))
        .collect();
    assert_eq!(weights, [("sparse", 0.25), ("dense", 0.75)]);
    match navigation {
        Navigation::Social(goal, social) => {
            assert!(goal.goal_scale > 0.0 && social.avoidance_radius > 0.0);
        }
        Navigation::Goal(_) | Navigation::Rvo(_) => panic!("{navigation:?}"),
    }
    let rvo = catalog::plain("rvo", &Parameters::default()).unwrap();
    let single = Blend::single(rvo, fluid);
    let navigation = single.steps()[0].profile.navigation;
    assert!(matches!(navigation, Navigation::Rvo(_)));
}

/// Seven people who walk past a pillar to a goal.
fn scene() -> Scene {
    let corners = [[4.0, -1.0], [5.0, -1.0], [5.0, 1.0], [4.0, 1.0]];
    let pillar = Polygon::new(corners.map(Vector::from).to_vec()).unwrap();
    let mut scene = Scene {
        seed: 3,
        clock: Clock::new(0.02, 5),
        integrator: Integrator::SemiImplicit,
        ..Scene::with_obstacles(vec![pillar])
    };
    let group = scene.add_group(Group {
        name: "walkers".to_owned(),
        blend: sph(),
        removal_radius: Some(0.5),
        counted: true,
        journey: None,
        direction: None,
        motivation: 0.0,
        traits: Default::default(),
    });
    let grid = Grid {
        min: Vector::new(0.0, 2.0),
        max: Vector::new(3.0, 4.0),
        columns: 3,
        rows: 2,
        jitter: 0.1,
    };
    assert_eq!(grid.len(), 6);
    let goal = Vector::new(9.0, 3.0);
    let places = grid.positions(scene.seed, 0);
    scene.agents = places
        .map(|place| NewAgent::at(place, goal, group))
        .collect();
    scene.agents.push(NewAgent {
        position: Vector::new(1.5, 5.0),
        velocity: Vector::zeros(),
        goal,
        radius: Some(0.25),
        mass: Some(1.0),
        mean_density: None,
        preferred_speed: Some(1.2),
        premovement: Some(0.5),
        group,
    });
    scene
}

#[test]
fn a_scene_has_settings_walls_people_and_what_happens_to_them() {
    let Scene {
        seed: _,
        behavior_seed,
        clock,
        integrator,
        wall_method: _,
        precision: _,
        neighbor_lists: _,
        preferred_speed,
        max_speed,
        max_speed_ratio: _,
        walls,
        behind,
        period,
        groups,
        agents,
        sources,
        entrances,
        scheduled,
        pushes,
        journeys: _,
        routes,
        routing: _,
        own_forces,
        ..
    } = scene();
    assert!(behavior_seed.is_none() && period.is_none() && routes.is_none());
    assert!(behind.is_empty() && sources.is_empty() && entrances.is_empty());
    assert!(scheduled.is_empty() && pushes.is_empty() && own_forces.is_empty());
    assert_eq!((walls.len(), groups.len(), agents.len()), (4, 1, 7));
    assert_eq!([preferred_speed, max_speed], [1.4, 1.8]);
    assert_eq!(clock, Clock::default());
    assert_eq!((clock.time_step(), clock.coarse_every()), (0.02, 5));
    assert_eq!((clock.frame_at(1.0), clock.is_coarse()), (50, true));
    match integrator {
        Integrator::SemiImplicit => {}
        Integrator::ForwardEuler | Integrator::VelocityVerlet | Integrator::Midpoint => {
            panic!("{integrator:?}")
        }
    }
}

#[test]
fn a_simulation_goes_frame_by_frame() {
    let mut simulation = Simulation::new(scene()).unwrap();
    let Frame {
        clock,
        walls,
        agents,
        fields,
        seed,
        ..
    } = simulation.evaluate().unwrap();
    assert_eq!((clock.frame(), clock.time(), seed), (0, 0.0, 3));
    assert_eq!((walls.len(), agents.len()), (4, 7));
    let start = Region {
        min: Vector::new(0.0, 2.0),
        max: Vector::new(3.0, 5.0),
    };
    assert_eq!(start.area(), 9.0);
    for i in agents.present() {
        assert!(start.contains(agents.position[i]) && agents.velocity[i].norm() == 0.0);
        assert!(agents.radius[i] > 0.2 && agents.mass[i] > 0.5);
        assert!(fields.density[i] > 0.0 && fields.acceleration[i].norm() < 1e3);
    }
    simulation.integrate().unwrap();
    while !simulation.frame().agents.is_empty() && simulation.frame().clock.time() < 30.0 {
        simulation.step().unwrap();
    }
    let Outcome {
        arrivals,
        moves,
        contained,
        clamped: _,
        displaced,
        removed,
    } = simulation.outcome();
    assert_eq!(
        (
            arrivals.len(),
            displaced.len(),
            removed.len(),
            contained.count
        ),
        (7, 0, 0, 0)
    );
    assert!(*moves > 7 && arrivals[0].time <= arrivals[6].time && arrivals[0].counted);
    assert!(!simulation.expects_agents());
    assert_eq!(simulation.scene().seed, 3);
}

/// What a user may do about a fault.
fn place_of(fault: &Fault) -> Option<Vector> {
    match fault {
        Fault::NotFinite {
            frame: _,
            time: _,
            agent: _,
            position,
            quantity: _,
        } => Some(*position),
        Fault::NoFreePoint {
            agent: _,
            obstacle: _,
        }
        | Fault::Model { .. }
        | Fault::DifferentStates { force: _ } => None,
    }
}

#[test]
fn a_fault_names_the_agent_and_the_obstacle() {
    let corners = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
    let block = Polygon::new(corners.map(Vector::from).to_vec()).unwrap();
    let fault = Fault::NoFreePoint {
        agent: 5,
        obstacle: 0,
    };
    assert_eq!(place_of(&fault), None);
    assert!(
        fault
            .to_string()
            .contains("agent 5 enters inside obstacle 0")
    );
    assert!(block.contains(Vector::zeros()));
}

/// A wind along x, weaker behind others, that knows for how long it has blown at each agent.
#[derive(Debug)]
struct Wind {
    strength: f64,
}

const BLOWN: [Kept; 1] = [Kept {
    name: "blown_secs",
    about: "time in the wind, s",
    along: None,
}];

impl Force for Wind {
    fn name(&self) -> &str {
        "wind"
    }

    fn reach(&self) -> f64 {
        1.0
    }

    fn needs_density(&self) -> bool {
        false
    }

    fn rates(&self, of: &Extremes) -> Rates {
        let Extremes { mass, speed, sph } = *of;
        Rates {
            pressure: 0.0,
            contact: 0.0,
            other_springs: 0.0,
            corner: 0.0,
            viscosity: 0.0,
            correction: 0.0,
            steepness: 0.0,
            damping: 0.0,
            everywhere: 0.0,
            friction: self.strength * speed / (mass * sph.support_radius),
        }
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let shelter = frame.near(i, self.reach()).count();
        Vector::new(self.strength / (1.0 + shelter as f64), 0.0)
    }

    fn term_names(&self) -> Vec<&str> {
        vec!["wind"]
    }

    fn terms(&self, frame: &Frame, i: usize) -> Vec<Vector> {
        vec![self.acceleration(frame, i)]
    }

    fn kept(&self) -> &[Kept] {
        &BLOWN
    }

    fn begin(&self, agents: &Agents, i: usize, _time: f64, state: &mut [f64]) {
        assert!(i < agents.len());
        state[0] = 0.0;
    }

    fn change(&self, _: &Frame, _: usize, _state: &[f64], rates: &mut [f64]) {
        rates[0] = 1.0;
    }

    fn advance(&self, step: &Step, rates: &[f64], state: &mut [f64]) {
        assert!(step.max_speed > 0.0 && step.integrator == Integrator::SemiImplicit);
        state[0] += rates[0] * step.time;
    }

    fn fit(&self, body: &Body, _state: &mut [f64]) {
        assert!(body.position.norm() < 99.0 && body.velocity.norm() < 99.0);
    }

    fn shown(&self) -> &[Kept] {
        &BLOWN
    }

    fn values(&self, _position: Vector, state: &[f64]) -> Vec<f64> {
        state.to_vec()
    }

    fn explained(&self, frame: &Frame, i: usize) -> Vec<(&str, Vector)> {
        vec![("wind", self.acceleration(frame, i))]
    }

    fn equals(&self, other: &dyn Force) -> bool {
        other.name() == "wind"
    }
}

#[test]
fn a_force_of_ones_own_acts_keeps_a_state_and_is_explained() {
    let wind = Wind { strength: 0.5 };
    let blend = sph();
    let extremes = Extremes {
        mass: 1.0,
        speed: 1.4,
        sph: &blend.sph,
    };
    let rates = wind.rates(&extremes).plus(Rates::default());
    assert_eq!(rates.max(Rates::default()).friction, 0.7);
    let mut scene = scene();
    scene.own_forces.push(Arc::new(wind));
    let mut simulation = Simulation::new(scene).unwrap();
    for _ in 0..50 {
        simulation.step().unwrap();
    }
    simulation.evaluate().unwrap();
    let breakdown = Breakdown::of(&simulation, 0).unwrap();
    let sum = breakdown.weighted_sum();
    assert!((sum - Vector::from(breakdown.acceleration)).norm() < 1e-9);
    assert!(breakdown.to_string().contains("wind"));
    let Breakdown {
        id: _,
        position: _,
        velocity: _,
        radius,
        mass,
        goal,
        density,
        density_from_agents,
        density_from_walls,
        mean_density: _,
        rest_density: _,
        pressure: _,
        acceleration: _,
        profiles,
        way,
        route_choice,
        walks_from_secs,
        visit,
        choice,
        states,
        own_forces,
        neighbors: _,
        walls: _,
        ..
    } = breakdown;
    assert!(radius > 0.0 && mass > 0.0 && goal == [9.0, 3.0]);
    assert!((density - density_from_agents - density_from_walls).abs() < 1e-9);
    assert_eq!((&profiles[0].name[..], profiles[0].weight), ("sph", 1.0));
    assert!(way.is_none() && route_choice.is_none() && walks_from_secs.is_none());
    assert!(visit.is_none() && choice.is_none());
    assert_eq!(
        (&own_forces[0].name[..], &states[0].force[..]),
        ("wind", "wind")
    );
    let (name, blown) = states[0].values[0];
    assert!(name == "blown_secs" && (blown - 1.0).abs() < 1e-9);
}

#[test]
fn a_simulation_is_controlled_and_records_what_was_done() {
    let mut simulation = Simulation::new(scene()).unwrap();
    simulation.evaluate().unwrap();
    let goal = Vector::new(9.0, 3.0);
    let free = NewAgent::at(Vector::new(7.0, 6.0), goal, 0);
    let Added { ids, without_room } = simulation.add(&[free, free]).unwrap();
    assert_eq!((ids, without_room), (vec![7], vec![1]));
    simulation.intervene(Action::Remove(vec![0])).unwrap();
    let refused = simulation.intervene(Action::Speeds(vec![(99, 1.0)]));
    assert!(matches!(refused, Err(ActionError::Absent(99, _))));
    simulation.set_goals(&[(7, Vector::zeros())]).unwrap();
    simulation.integrate().unwrap();
    simulation.evaluate().unwrap();
    assert!(simulation.present(7).is_ok() && simulation.present(0).is_err());
    let frames = simulation
        .interventions()
        .iter()
        .map(|Intervention { frame, action: _ }| *frame);
    assert_eq!(frames.collect::<Vec<_>>(), [1, 1, 1]);
}

/// All people are pushed along x.
#[derive(Debug)]
struct Breeze;

impl Model for Breeze {
    fn name(&self) -> &str {
        "breeze"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn vectors(&self, frame: &Frame) -> Result<Vec<Vector>, String> {
        Ok(vec![Vector::x(); frame.agents.len()])
    }
}

#[test]
fn a_model_of_ones_own_gives_accelerations_or_velocities() {
    let given = [
        Gives::Accelerations,
        Gives::AllAccelerations,
        Gives::Velocities,
    ];
    let first = given.map(|gives| {
        let mut scene = scene();
        scene.set_model(OwnModel {
            model: Arc::new(Breeze),
            gives,
            coarse: true,
        });
        let mut simulation = Simulation::new(scene).unwrap();
        let frame = simulation.evaluate().unwrap();
        let fields = frame.fields;
        (fields.acceleration[0], fields.preferred_velocity[0])
    });
    assert_ne!(first[0].0, Vector::x());
    assert_eq!((first[1].0, first[2].1), (Vector::x(), Vector::x()));
}

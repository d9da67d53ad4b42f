//! The law of legs under bodies: against an independent implementation, and against closed forms.

use std::sync::Arc;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::agents::Agents;
use sandbox::engine::clock::Clock;
use sandbox::engine::forces::legs::{self, lean};
use sandbox::engine::forces::own::Force;
use sandbox::engine::forces::rates::{Extremes, Rates};
use sandbox::engine::frame::Frame;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

use crate::common::legs::{alone, standing};
use crate::common::{blend_with, block, person, rectangle, run, scene, vector, walker};

fn legs_of(agents: &Agents, id: u32) -> (Vector, Vector) {
    let i = agents.index_of(id).unwrap();
    (
        legs::position(agents, i).unwrap(),
        legs::velocity(agents, i).unwrap(),
    )
}

/// A person as the law has it.
#[derive(Clone, Copy)]
struct Person {
    mass: f64,
    body: [Vector; 2],
    legs: [Vector; 2],
}

/// The obstacle beside the crowd.
const BLOCK: [[f64; 2]; 2] = [[2.5, 4.0], [0.5, 2.0]];

/// The law, written from its equations: λᵤ, λ_b, v_s, A, B, B_l, R and the limit of the lean.
struct Law {
    falling: f64,
    recovery: f64,
    speed: f64,
    strength: f64,
    ranges: [f64; 2],
    reach: f64,
    limit: f64,
    /// K^goal/τ, 1/s.
    friction: f64,
    /// Where all people want to go, and how fast, m/s.
    goal: (Vector, f64),
}

impl Law {
    fn repulsion(&self, from: Vector, range: f64) -> Vector {
        let d = from.norm();
        if d >= self.reach || d == 0.0 {
            return Vector::zeros();
        }
        from / d * self.strength * ((-d / range).exp() - (-self.reach / range).exp())
    }

    /// From the nearest point of the obstacle, for a point outside of it.
    fn from_block(p: Vector) -> Vector {
        let near = |k: usize| p[k].clamp(BLOCK[k][0], BLOCK[k][1]);
        p - vector(near(0), near(1))
    }

    fn next(&self, people: &[Person], k: usize, dt: f64) -> Person {
        let Person { mass, body, legs } = people[k];
        let ([r, v], [y, w]) = (body, legs);
        let lean = r - y;
        let e = if lean == Vector::zeros() {
            lean
        } else {
            lean / lean.norm()
        };
        let wish = (self.goal.0 - r).normalize() * self.goal.1;
        let walk = wish * (v.dot(&wish) / wish.dot(&wish)).clamp(0.0, 1.0);
        let mut a =
            (wish - v) * (self.friction / mass) + (e * self.speed + walk - v) * self.falling;
        let mut b = (e * self.speed + walk - w) * self.recovery;
        for (j, other) in people.iter().enumerate() {
            let between = r - other.body[0];
            if j != k && between.norm() < self.reach {
                a += self.repulsion(between, self.ranges[0]) / mass;
                b += self.repulsion(y - other.legs[0], self.ranges[1]) / mass;
            }
        }
        if Self::from_block(r).norm() < self.reach {
            a += self.repulsion(Self::from_block(r), self.ranges[0]) / mass;
            b += self.repulsion(Self::from_block(y), self.ranges[1]) / mass;
        }
        let (v, mut w) = (v + a * dt, w + b * dt);
        let (r, mut y) = (r + v * dt, y + w * dt);
        let lean = r - y;
        if lean.norm() > self.limit {
            let e = lean / lean.norm();
            y = r - e * self.limit;
            w += e * (v - w).dot(&e).max(0.0);
        }
        Person {
            mass,
            body: [r, v],
            legs: [y, w],
        }
    }
}

#[test]
fn the_law_agrees_with_an_independent_implementation() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let parameters = Parameters::of([
        ("unbalancing_rate", 0.7),
        ("balancing_rate", 0.9),
        ("balance_speed", 0.8),
        ("legs_strength", 6.0),
        ("body_range", 0.4),
        ("leg_range", 0.25),
        ("legs_reach", 1.3),
        ("lean_limit", 0.2),
    ])
    .unwrap()
    .or(&alone(0.6));
    let goal = vector(9.0, 1.0);
    let mut scene = scene(
        vec![rectangle(BLOCK[0], BLOCK[1])],
        blend_with("sph", &parameters),
    );
    scene.preferred_speed = 0.4;
    scene.max_speed = 100.0;
    scene.agents = block(vector(0.2, 0.2), 5, 8, 0.45, goal);
    for agent in &mut scene.agents {
        agent.velocity = vector(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
        agent.mass = Some(rng.random_range(0.7..1.4));
    }
    let law = Law {
        falling: 0.7,
        recovery: 0.9,
        speed: 0.8,
        strength: 6.0,
        ranges: [0.4, 0.25],
        reach: 1.3,
        limit: 0.2,
        friction: 0.6,
        goal: (goal, 0.4),
    };
    let dt = scene.clock.time_step();
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 1);
    let people = |simulation: &Simulation| -> Vec<Person> {
        let agents = simulation.frame().agents;
        let of = |id: u32| {
            let i = agents.index_of(id).unwrap();
            Person {
                mass: agents.mass[i],
                body: [agents.position[i], agents.velocity[i]],
                legs: legs_of(agents, id).into(),
            }
        };
        (0..40).map(of).collect()
    };
    let (mut limited, mut stopped) = (0, 0);
    for _ in 0..200 {
        let before = people(&simulation);
        let contained = simulation.outcome().contained.count;
        run(&mut simulation, 1);
        let after = people(&simulation);
        if simulation.outcome().contained.count > contained {
            stopped += 1;
            continue; // the independent implementation has no walls that stop moves
        }
        for (k, found) in after.iter().enumerate() {
            let expected = law.next(&before, k, dt);
            let behind_a_wall = Law::from_block(found.legs[0]).norm() < 1e-5;
            if behind_a_wall {
                continue;
            }
            let pairs =
                (found.body.iter().zip(expected.body)).chain(found.legs.iter().zip(expected.legs));
            for (found, expected) in pairs {
                let off = (found - expected).norm();
                assert!(off < 1e-9, "person {k}: {found} instead of {expected}");
            }
            let lean = (found.body[0] - found.legs[0]).norm();
            limited += usize::from(lean > 0.2 - 1e-9);
        }
    }
    assert!(limited > 10 && stopped < 50, "{limited}, {stopped}");
}

#[test]
fn the_lean_of_a_lone_person_follows_its_closed_form() {
    // λᵤ, λ_b, v_s and λ; the body is pushed, and the legs run after it.
    let [falling, recovery, speed, friction] = [0.5, 1.0, 1.0, 0.5];
    let pushed = 1.0;
    let lean_at = |t: f64| {
        let all = falling + friction;
        let last = falling * speed / all;
        let body = last * t + (pushed - last) * (1.0 - (-all * t).exp()) / all;
        body - speed * (t - (1.0 - (-recovery * t).exp()) / recovery)
    };
    let off = |dt: f64, at: f64| {
        let agents = vec![person(Vector::zeros(), Vector::zeros())];
        let mut scene = standing(alone(friction), agents);
        scene.clock = Clock::new(dt, 1);
        // In the first step the body gets its velocity; the legs are at rest.
        let acceleration = vector(pushed / dt, 0.0);
        scene.own_forces.push(Arc::new(Kick {
            acceleration,
            until: 0.5 * dt,
        }));
        let mut simulation = Simulation::new(scene).unwrap();
        run(&mut simulation, (at / dt).round() as u64);
        let lean = lean(simulation.frame().agents, 0);
        assert_eq!(lean.y, 0.0);
        lean.x - lean_at(at)
    };
    for at in [0.5, 1.0, 1.6] {
        assert!(lean_at(at) > 0.1, "{}", lean_at(at));
        let [coarse, fine] = [0.004, 0.002].map(|dt| off(dt, at));
        assert!(coarse.abs() < 3e-3, "{at} s: {coarse} m");
        let order = coarse / fine;
        assert!((order - 2.0).abs() < 0.05, "{at} s: first order, {order}");
    }
    // The legs have caught up, and the person stays upright.
    let end = (0..4000)
        .map(|k| f64::from(k) * 1e-3 + 1.0)
        .find(|&t| lean_at(t) < 0.0);
    let upright = off(0.002, end.unwrap() + 4.0) + lean_at(end.unwrap() + 4.0);
    assert!(upright.abs() < 0.05, "{upright} m");
}

/// Pushes the bodies of all agents from the start on.
#[derive(Debug)]
struct Kick {
    acceleration: Vector,
    /// Seconds.
    until: f64,
}

impl Force for Kick {
    fn name(&self) -> &str {
        "kick"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn acceleration(&self, frame: &Frame, _: usize) -> Vector {
        match frame.clock.time() < self.until {
            true => self.acceleration,
            false => Vector::zeros(),
        }
    }
}

/// A force without a state that has the name of one with a state.
#[derive(Debug)]
struct Namesake;

impl Force for Namesake {
    fn name(&self) -> &str {
        "legs"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn acceleration(&self, _: &Frame, _: usize) -> Vector {
        Vector::zeros()
    }
}

#[test]
fn forces_of_one_name_must_keep_the_same_numbers() {
    let agents = vec![walker(Vector::zeros(), vector(0.3, 0.0), Vector::zeros())];
    let mut scene = standing(alone(0.5), agents);
    assert!(Simulation::new(scene.clone()).is_ok());
    scene.own_forces.push(Arc::new(Namesake));
    let fault = Simulation::new(scene).err().unwrap();
    assert_eq!(
        fault.to_string(),
        "two forces are named legs, and they keep different numbers for agents; give one another name"
    );
}

#[test]
fn a_lone_person_with_slow_legs_turns_at_the_frequency_of_the_closed_form() {
    let [falling, recovery, speed, friction] = [0.2, 0.3, 0.5, 0.5];
    let parameters = Parameters::of([
        ("unbalancing_rate", falling),
        ("balancing_rate", recovery),
        ("balance_speed", speed),
    ])
    .unwrap()
    .or(&alone(friction));
    let agents = vec![walker(Vector::zeros(), vector(0.3, 0.0), Vector::zeros())];
    let mut scene = standing(parameters, agents);
    scene.clock = Clock::new(0.01, 1);
    scene.own_forces.push(Arc::new(Kick {
        acceleration: vector(0.0, 0.2),
        until: 1.0,
    }));
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 30_000);
    // Body and legs are circles of the frequency ω, in phase with the direction of the lean.
    let all = falling + friction;
    let omega = recovery * (all * friction / (falling * all - recovery * recovery)).sqrt();
    let square = omega * omega;
    let expected =
        speed * (recovery / (square + recovery * recovery) - falling / (square + all * all));
    let (mut turned, mut leans, steps) = (0.0, 0.0, 400);
    for _ in 0..steps {
        let before = lean(simulation.frame().agents, 0);
        run(&mut simulation, 10);
        let after = lean(simulation.frame().agents, 0);
        turned += before.perp(&after).atan2(before.dot(&after));
        leans += after.norm();
    }
    let found = f64::abs(turned) / (0.1 * f64::from(steps));
    let mean = leans / f64::from(steps);
    assert!(
        (found / omega - 1.0).abs() < 0.01,
        "{found} instead of {omega} rad/s"
    );
    assert!(
        (mean / expected - 1.0).abs() < 0.02,
        "{mean} instead of {expected} m"
    );
}

#[test]
fn momentum_decays_with_the_friction_of_bodies_and_of_legs() {
    // Without a speed of balance, only frictions change the momentum. Legs begin with their bodies and repel each
    // other.
    let parameters = Parameters::of([
        ("balance_speed", 0.0),
        ("unbalancing_rate", 0.3),
        ("legs_strength", 0.2),
        ("lean_limit", 2.0),
    ])
    .unwrap()
    .or(&alone(0.0));
    let mut agents = block(Vector::zeros(), 7, 7, 0.4, vector(9.0, 0.0));
    for (k, agent) in agents.iter_mut().enumerate() {
        agent.velocity = vector(0.2, 0.1 * (k % 5) as f64);
    }
    let scene = standing(parameters, agents);
    let dt = scene.clock.time_step();
    let mut simulation = Simulation::new(scene).unwrap();
    let momentum = |simulation: &Simulation| -> [Vector; 2] {
        let agents = simulation.frame().agents;
        let sum = |velocity: &dyn Fn(usize) -> Vector| {
            let all = 0..agents.len();
            all.map(|i| velocity(i) * agents.mass[i]).sum()
        };
        [
            sum(&|i| agents.velocity[i]),
            sum(&|i| legs::velocity(agents, i).unwrap_or_default()),
        ]
    };
    let [start, _] = momentum(&simulation);
    run(&mut simulation, 50);
    let [bodies, legs] = momentum(&simulation);
    for (found, rate) in [(bodies, 0.3), (legs, 1.0)] {
        let expected = start * (1.0 - rate * dt).powi(50);
        assert!(
            (found - expected).norm() < 1e-10 * start.norm(),
            "{found} instead of {expected}"
        );
    }
    let agents = simulation.frame().agents;
    let moved = (0..agents.len()).any(|i| legs::velocity(agents, i).unwrap().norm() > 0.01);
    assert!(moved);
}

#[test]
fn a_lone_person_walks_upright_if_its_legs_are_fast_and_sways_if_they_are_slow() {
    // λᵤ (λᵤ + λ) = 1.25 1/s²: with λ_b² above that people do not sway, whether they stand or walk.
    let walked = |balancing_rate: f64| {
        let parameters = Parameters::of([("balancing_rate", balancing_rate)])
            .unwrap()
            .or(&alone(2.0));
        let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
        let mut walker = person(Vector::zeros(), vector(500.0, 0.0));
        walker.velocity = vector(1.3, 0.01);
        scene.agents = vec![walker];
        let mut simulation = Simulation::new(scene).unwrap();
        run(&mut simulation, 1500);
        let agents = simulation.frame().agents;
        (agents.velocity[0], lean(agents, 0).norm())
    };
    let (velocity, lean) = walked(2.0);
    assert!((velocity.x - 1.4).abs() < 0.05, "{velocity}");
    assert!(lean < 0.1, "{lean}");
    let (_, lean) = walked(0.3);
    assert!(lean > 0.3, "{lean}");
}

#[test]
fn people_enter_upright_with_legs_as_fast_as_their_bodies_unless_they_wait() {
    let velocity = vector(0.8, -0.6);
    for (premovement, expected) in [(None, velocity), (Some(3.0), Vector::zeros())] {
        let mut crowd = standing(alone(1.0), vec![person(Vector::zeros(), Vector::zeros())]);
        (crowd.agents[0].velocity, crowd.agents[0].premovement) = (velocity, premovement);
        let mut simulation = Simulation::new(crowd).unwrap();
        simulation.evaluate().unwrap();
        let agents = simulation.frame().agents;
        assert_eq!(legs::velocity(agents, 0).unwrap(), expected);
        assert_eq!(lean(agents, 0), Vector::zeros());
    }
}

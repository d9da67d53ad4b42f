//! The choices of RVO in crowds of all sizes, compared with an exhaustive search among all agents.

use crate::common::{blend, evaluated, scene, vector, walker};
use crate::rvo::{Case, exhaustive};
use rand::{Rng, RngCore};
use sandbox::engine::forces::rvo::{Candidate, MovingDisc, Rvo, Situation};
use sandbox::engine::frame::Frame;
use sandbox::engine::math::Vector;
use sandbox::engine::period::{Axis, Period};
use sandbox::engine::random::{Purpose, stream};

const MAX_SPEED: f64 = 1.8;

/// What agent `i` sees. Without index or grid: all agents, and all their images.
fn case(frame: &Frame, i: usize) -> Case {
    let agents = frame.agents;
    let own = agents.position[i];
    let laps = if frame.neighbors.way() != Vector::zeros() {
        -1..=1
    } else {
        0..=0
    };
    let mut discs = Vec::new();
    for j in 0..agents.len() {
        for laps in laps.clone() {
            let disc = MovingDisc {
                offset: agents.position[j] - frame.neighbors.seen_from(own, laps),
                velocity: agents.velocity[j],
                reach: agents.radius[i] + agents.radius[j],
            };
            let distance = disc.offset.norm();
            if disc.reach < distance && distance < Rvo::default().avoidance_radius {
                discs.push(disc);
            }
        }
    }
    let situation = Situation {
        position: own,
        velocity: agents.velocity[i],
        preferred_velocity: frame.fields.preferred_velocity[i],
        radius: agents.radius[i],
        max_speed: MAX_SPEED,
        walls: Vec::new(),
    };
    Case { situation, discs }
}

/// The candidates of agent `i`.
fn candidates(frame: &Frame, i: usize) -> Vec<Candidate> {
    let frame_number = frame.clock.coarse_frame();
    let mut rng = stream(
        frame.seed,
        Purpose::Candidates,
        frame.agents.id[i],
        frame_number,
    );
    let farthest = frame.agents.velocity[i].norm() + MAX_SPEED;
    let draws = (0..Rvo::default().candidates).map(|_| {
        let turn = rng.next_u32();
        let length = 2.0 * MAX_SPEED / f64::from(u32::MAX) * f64::from(rng.next_u32());
        Candidate { length, turn }
    });
    draws.filter(|draw| draw.length <= farthest).collect()
}

fn check(agents: u32, period: Option<Period>) {
    let mut rng = stream(3, Purpose::Placement, agents, 0);
    let mut next = |from: f64, to: f64| rng.random_range(from..to);
    let mut scene = scene(Vec::new(), blend("rvo"));
    scene.period = period;
    let all = (0..agents).map(|_| {
        let place = vector(next(0.0, 12.0), next(0.0, 3.0 + 0.1 * f64::from(agents)));
        let velocity = vector(next(-1.2, 1.2), next(-1.2, 1.2));
        walker(place, velocity, place + vector(50.0, next(-9.0, 9.0)))
    });
    scene.agents = all.collect();
    let simulation = evaluated(scene);
    let frame = simulation.frame();
    for i in 0..frame.agents.len() {
        let chosen = exhaustive(&case(&frame, i), &candidates(&frame, i), 1.0);
        let acceleration: Vector = (chosen - frame.agents.velocity[i]) / frame.clock.coarse_step();
        assert_eq!(
            frame.agents.avoidance[i],
            Some(acceleration),
            "{agents} {i}"
        );
    }
}

#[test]
fn agents_of_a_crowd_of_any_size_choose_as_by_exhaustive_search() {
    for agents in (1..40).chain([150]) {
        check(agents, None);
    }
}

#[test]
fn agents_of_a_periodic_crowd_choose_as_by_exhaustive_search() {
    let period = Period {
        axis: Axis::X,
        from: 0.0,
        length: 12.0,
    };
    for agents in [1, 2, 7, 30, 150] {
        check(agents, Some(period));
    }
}

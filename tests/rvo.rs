//! The choice of RVO compared with an exhaustive search, and which agents and walls it considers.

use std::ops::Range;

use crate::common;
use crate::common::{
    acceleration, blend, block, breakdown, evaluated, person, rectangle, run, scene, vector, walker,
};
use crate::rvo_contact::{meeting, meeting_wall};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::rvo::{
    Candidate, Candidates, Discs, Eight, Limits, MovingDisc, Preference, Rvo, Scratch, Search,
    Situation, Surroundings,
};
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::prelude::*;
use sandbox::engine::pairs::{Simd, f64x8};
use sandbox::engine::profile::Term;
use sandbox::engine::simulation::Simulation;

/// A situation with discs at known places.
#[derive(Debug, Clone)]
pub struct Case {
    pub situation: Situation,
    pub discs: Vec<MovingDisc>,
}

impl Surroundings for Case {
    fn limits(&self) -> Limits {
        let greatest = |of: fn(&MovingDisc) -> f64| self.discs.iter().map(of).fold(0.0, f64::max);
        Limits {
            longest_reach: greatest(|disc| disc.reach),
            highest_speed: greatest(|disc| disc.velocity.norm()),
            farthest: greatest(|disc| disc.offset.norm()),
        }
    }

    fn read<S: Simd>(&self, simd: S, squared: Range<f64>, discs: &mut Discs) {
        let all = |value: f64| f64x8::splat(simd, value);
        for (number, disc) in (0..).zip(&self.discs) {
            let distance = disc.offset.norm_squared();
            if squared.contains(&distance) {
                let eight = Eight {
                    offset: [all(disc.offset.x), all(disc.offset.y)],
                    velocity: [all(disc.velocity.x), all(disc.velocity.y)],
                    gap: all(distance - disc.reach * disc.reach),
                };
                discs.add(simd, &eight, 1, number);
            }
        }
    }

    fn disc(&self, number: u32) -> MovingDisc {
        self.discs[number as usize]
    }
}

/// Evaluates Eq. 20 for every candidate; returns the first one with the lowest cost.
pub fn exhaustive(case: &Case, candidates: &[Candidate], collision_weight: f64) -> Vector {
    let situation = &case.situation;
    let mut costs = Vec::new();
    for candidate in candidates {
        let candidate = candidate.velocity(situation.velocity);
        if candidate.norm() > situation.max_speed {
            continue;
        }
        let velocity = 2.0 * candidate - situation.velocity;
        let mut contact = f64::INFINITY;
        for disc in &case.discs {
            contact = contact.min(meeting(disc.offset, velocity - disc.velocity, disc.reach));
        }
        for wall in &situation.walls {
            let time = meeting_wall(wall, situation.position, velocity, situation.radius);
            contact = contact.min(time);
        }
        let deviation = (candidate - situation.preferred_velocity).norm();
        costs.push((deviation + collision_weight / contact, candidate));
    }
    let least = costs
        .iter()
        .map(|(cost, _)| *cost)
        .fold(f64::INFINITY, f64::min);
    let cheapest = costs.iter().find(|(cost, _)| *cost == least);
    cheapest.map_or(Vector::zeros(), |(_, candidate)| *candidate)
}

fn disc_of(rng: &mut ChaCha8Rng, radius: f64) -> Vector {
    let (angle, length) = (
        rng.random_range(0.0..6.3_f64),
        rng.random_range(0.0..radius),
    );
    vector(angle.cos(), angle.sin()) * length
}

fn random_case(rng: &mut ChaCha8Rng) -> Case {
    let position = disc_of(rng, 50.0);
    let radius = rng.random_range(0.215..0.265);
    // Few or hundreds of discs, fast or nearly still, some nearly touching: errors of single precision must not
    // change the choice.
    let most = if rng.random_bool(0.02) { 300 } else { 30 };
    let fastest = 1.8 * 10_f64.powf(rng.random_range(-5.0..1.0_f64).min(0.0));
    let nearest = rng.random_bool(0.1);
    let discs = (0..rng.random_range(0..most)).map(|_| {
        let reach = radius + 0.24;
        let offset = disc_of(rng, 5.0);
        MovingDisc {
            offset: if nearest {
                offset.normalize() * (reach + 1e-7)
            } else {
                offset
            },
            velocity: disc_of(rng, fastest),
            reach,
        }
    });
    let discs: Vec<MovingDisc> = discs
        .filter(|disc| disc.offset.norm() > disc.reach)
        .collect();
    let boxes = (0..rng.random_range(0..4)).map(|_| {
        let corner = position + disc_of(rng, 5.0);
        let size = vector(rng.random_range(0.1..2.0), rng.random_range(0.1..2.0));
        rectangle([corner.x, corner.x + size.x], [corner.y, corner.y + size.y])
    });
    let walls = Walls::new(boxes.collect());
    let free = walls.iter().filter(|wall| {
        wall.faces(position) && (wall.nearest_point(position).point - position).norm() > radius
    });
    let situation = Situation {
        position,
        velocity: disc_of(rng, fastest),
        preferred_velocity: disc_of(rng, 1.8),
        radius,
        max_speed: 1.8,
        walls: free.copied().collect(),
    };
    Case { situation, discs }
}

#[test]
fn the_choice_is_that_of_an_exhaustive_search() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut search = Search::default();
    for round in 0..100_000 {
        let case = random_case(&mut rng);
        let candidates = candidates(&mut rng, 120);
        let drawn = Candidates::from_iter(candidates.iter().copied());
        let weight = [1.0, 0.2, 5.0][round % 3];
        let found = search.best(&case.situation, &case, &drawn, weight);
        assert_eq!(found, exhaustive(&case, &candidates, weight), "{case:?}");
    }
}

fn candidates(rng: &mut ChaCha8Rng, count: usize) -> Vec<Candidate> {
    let any = |_| Candidate {
        length: rng.random_range(0.0..3.6),
        turn: rng.random(),
    };
    (0..count).map(any).collect()
}

fn best(case: &Case, candidates: &[Candidate]) -> Vector {
    let candidates = candidates.iter().copied().collect();
    Search::default().best(&case.situation, case, &candidates, 1.0)
}

fn open_field() -> Case {
    let situation = Situation {
        position: Vector::zeros(),
        velocity: Vector::zeros(),
        preferred_velocity: Vector::zeros(),
        radius: 0.24,
        max_speed: 1.8,
        walls: Vec::new(),
    };
    Case {
        situation,
        discs: Vec::new(),
    }
}

#[test]
fn the_first_of_equal_costs_is_chosen() {
    let quarter = |number: u32| Candidate {
        length: 1.0,
        turn: number << 30,
    };
    for first in 0..4 {
        let around = [first, first + 1, first + 2].map(|number| quarter(number % 4));
        let velocity = around[0].velocity(Vector::zeros());
        assert_eq!(best(&open_field(), &around), velocity);
    }
}

#[test]
fn the_order_of_neighbors_does_not_change_the_choice() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..500 {
        let case = random_case(&mut rng);
        let candidates = candidates(&mut rng, 60);
        let mut turned = case.clone();
        turned.discs.reverse();
        turned.situation.walls.reverse();
        let [a, b] = [&case, &turned].map(|case| best(case, &candidates));
        assert_eq!(a, b);
    }
}

#[test]
fn if_all_candidates_are_too_fast_the_agent_stops() {
    let fast = [1.9, 2.0].map(|length| Candidate { length, turn: 0 });
    assert_eq!(best(&open_field(), &fast), Vector::zeros());
    let mut scene = scene(Vec::new(), blend("rvo"));
    // Candidates lie within 3.6 m/s of the current velocity.
    let velocity = vector(5.0, -4.0);
    scene.agents = vec![walker(Vector::zeros(), velocity, vector(9.0, 0.0))];
    let simulation = evaluated(scene);
    assert_eq!(acceleration(&simulation, 0), -velocity / (5.0 * 0.02));
}

/// The acceleration of an agent that walks to the right, among `others`.
fn among(profile: &str, others: &[NewAgent], obstacles: Vec<Polygon>) -> Vector {
    let mut scene = scene(obstacles, blend(profile));
    let own = walker(Vector::zeros(), vector(1.4, 0.0), vector(90.0, 0.0));
    scene.agents = vec![own];
    scene.agents.extend(others);
    acceleration(&evaluated(scene), 0)
}

#[test]
fn neighbors_count_only_within_five_meters() {
    for profile in ["rvo", "sf"] {
        let alone = among(profile, &[], Vec::new());
        let with = |distance: f64, angle: f64| {
            let place = vector(angle.cos(), angle.sin()) * distance;
            among(
                profile,
                &[walker(place, -place * 0.2, vector(0.0, 9.0))],
                Vec::new(),
            )
        };
        for angle in [0.0, 0.05, -0.03] {
            assert_ne!(with(4.999, angle), alone, "{profile} {angle}");
            assert_eq!(with(5.001, angle), alone, "{profile} {angle}");
        }
        assert_eq!(with(5.0, 0.0), alone, "{profile}: the range is strict");
    }
}

#[test]
fn walls_count_only_within_five_meters() {
    let facing = |profile: &str, x: f64, seed: u64| {
        let mut scene = scene(vec![rectangle([x, x + 1.0], [-9.0, 9.0])], blend(profile));
        scene.seed = seed;
        // For RVO the agent is fast, so that it would meet the wall soon. For the social force it walks at its
        // preferred speed: next to a goal force, e^(−50) would be lost in rounding.
        let speed = if profile == "rvo" { 1.8 } else { 1.4 };
        scene.agents = vec![walker(
            Vector::zeros(),
            vector(speed, 0.0),
            vector(90.0, 0.0),
        )];
        acceleration(&evaluated(scene), 0)
    };
    for profile in ["rvo", "sf"] {
        let differ = |a: f64, b: f64| {
            let seeds = (0..40).filter(|&s| facing(profile, a, s) != facing(profile, b, s));
            seeds.count()
        };
        assert!(differ(4.999, 900.0) > 0, "{profile}");
        assert_eq!(differ(5.0, 900.0), 0, "{profile}");
        assert_eq!(differ(5.001, 900.0), 0, "{profile}");
    }
}

#[test]
fn agents_that_already_touch_are_ignored() {
    let alone = among("rvo+sph", &[], Vec::new());
    let with = |distance: f64| {
        let other = person(vector(distance, 0.0), vector(0.0, 9.0));
        let mut scene = scene(Vec::new(), blend("rvo+sph"));
        scene.agents = vec![
            walker(Vector::zeros(), vector(1.4, 0.0), vector(90.0, 0.0)),
            other,
        ];
        breakdown(&evaluated(scene), 0).profiles[0]
            .accelerations
            .get(Term::Rvo)
            .unwrap()
    };
    assert_eq!(with(0.479), alone);
    assert_ne!(with(0.481), alone);
}

#[test]
fn a_wall_that_already_touches_is_ignored() {
    let rvo = |x: f64| {
        let mut scene = scene(vec![rectangle([x, x + 1.0], [-9.0, 9.0])], blend("rvo"));
        scene.agents = vec![walker(Vector::zeros(), vector(1.4, 0.0), vector(90.0, 0.0))];
        breakdown(&evaluated(scene), 0).profiles[0]
            .accelerations
            .get(Term::Rvo)
            .unwrap()
    };
    let alone = among("rvo", &[], Vec::new());
    assert_eq!(rvo(0.239), alone);
    assert_ne!(rvo(0.241), alone);
}

fn current_choice(simulation: &Simulation, id: u32) -> Option<Vector> {
    let agents = simulation.frame().agents;
    agents.avoidance[agents.index_of(id).unwrap()]
}

#[test]
fn a_choice_is_held_for_five_frames() {
    let mut scene = scene(Vec::new(), blend("rvo"));
    scene.agents = block(Vector::zeros(), 3, 3, 0.8, vector(9.0, 1.0));
    let mut simulation = Simulation::new(scene).unwrap();
    let mut before = None;
    for frame in 0..30 {
        simulation.evaluate().unwrap();
        let now: Vec<Option<Vector>> = (0..9).map(|id| current_choice(&simulation, id)).collect();
        assert!(now.iter().all(Option::is_some));
        match before {
            Some(before) if frame % 5 != 0 => assert_eq!(now, before),
            Some(before) => assert_ne!(now, before),
            None => {}
        }
        before = Some(now);
        simulation.integrate().unwrap();
    }
}

#[test]
fn a_choice_exists_only_while_its_weight_is_positive() {
    // A dense block with more than 4 P/m² that disperses.
    let mut scene = scene(Vec::new(), blend("rvo->sph"));
    let center = vector(1.8, 1.8);
    scene.agents = block(Vector::zeros(), 10, 10, 0.4, center);
    for agent in &mut scene.agents {
        agent.velocity = (agent.position - center) * 0.6;
        agent.goal = center + (agent.position - center) * 40.0;
    }
    let mut simulation = Simulation::new(scene).unwrap();
    let (mut in_between, mut before) = (0, vec![None; 100]);
    for frame in 0..100 {
        simulation.evaluate().unwrap();
        let view = simulation.frame();
        for id in 0..100 {
            let i = view.agents.index_of(id).unwrap();
            let (now, last) = (view.agents.avoidance[i], before[id as usize]);
            assert_eq!(now.is_some(), view.fields.density[i] < 4.0);
            let wish = Preference {
                preferred_velocity: view.fields.preferred_velocity[i],
                max_speed: 1.8,
            };
            let chosen = Rvo::default().acceleration(&view, i, wish, &mut Scratch::default());
            match (now, last) {
                (Some(now), None) if frame % 5 != 0 => {
                    in_between += 1;
                    assert_eq!(now, chosen);
                }
                (Some(now), Some(last)) if frame % 5 != 0 => assert_eq!(now, last),
                (Some(now), _) => assert_eq!(now, chosen),
                (None, _) => {}
            }
            before[id as usize] = now;
        }
        simulation.integrate().unwrap();
    }
    assert!(in_between > 10, "{in_between}");
}

#[test]
fn candidates_depend_on_the_coarse_frame() {
    let mut scene = scene(Vec::new(), blend("rvo"));
    scene.agents = vec![person(Vector::zeros(), vector(900.0, 0.0))];
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 100);
    let mut choices = Vec::new();
    for _ in 0..10 {
        simulation.evaluate().unwrap();
        let (_, velocity) = common::state(&simulation, 0);
        choices.push(current_choice(&simulation, 0).unwrap() * 0.1 + velocity);
        run(&mut simulation, 5);
    }
    // For a lone agent, the best of 250 candidates is close to the preferred velocity, but never equal.
    for (k, choice) in choices.iter().enumerate() {
        assert!((choice - vector(1.4, 0.0)).norm() < 0.6);
        assert!(choices[..k].iter().all(|other| other != choice));
    }
}

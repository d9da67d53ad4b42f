//! The choice of headings: agents choose a direction by the room that it offers.

use crate::common::walking::{crowd, walking};
use crate::common::{blend_with, evaluated, person, run, scene, vector, walker};
use rand::Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::walking::headings::{
    COUNT, STRAIGHT, Situation, before_wall, rotated,
};
use sandbox::engine::forces::walking::{Headings, Headway};
use sandbox::engine::geometry::{Polygon, Wall};
use sandbox::engine::math::{Vector, direction, perpendicular};
use sandbox::engine::pairs::Precision;
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, Parameters, WalkingLawKind};

fn parameters() -> Parameters {
    Parameters::of([("headway_anticipation", 0.4)])
        .unwrap()
        .with("walking_law", "headings")
        .unwrap()
}

/// With this preference for the right side, meters.
fn evading(side_preference: f64) -> Parameters {
    Parameters::of([("side_preference", side_preference)])
        .unwrap()
        .or(&parameters())
}

fn law() -> Headings {
    law_of(&parameters())
}

fn law_of(parameters: &Parameters) -> Headings {
    let profile = catalog::plain("sph", parameters).unwrap();
    *profile.walking.unwrap().headings().unwrap()
}

fn lone(agents: Vec<NewAgent>, walls: Vec<Polygon>) -> Scene {
    let mut scene = scene(walls, blend_with("sph", &parameters()));
    scene.agents = agents;
    scene
}

/// The utilities of agent `i`, agent by agent, from the positions and velocities of all.
fn utilities(simulation: &Simulation, i: usize, law: &Headings) -> [f64; COUNT] {
    let frame = simulation.frame();
    let (agents, wish) = (frame.agents, frame.fields.preferred_velocity[i]);
    let (way, speed) = (direction(wish), wish.norm());
    let time = law.headway.headway_time;
    let far = law.headway.headway_length + time * speed + law.look_ahead;
    std::array::from_fn(|k| {
        let angle = (k as f64 - 3.0) * law.heading_angle.to_radians() / 3.0;
        let heading = way * angle.cos() + perpendicular(way) * angle.sin();
        let mut least = far;
        for j in (0..agents.len()).filter(|&j| j != i) {
            let d = agents.position[j] - agents.position[i];
            let u = (agents.velocity[j] - agents.velocity[i]).dot(&heading);
            let cosine = direction(frame.fields.preferred_velocity[j]).dot(&way);
            let oncoming = (-4.0 * cosine).clamp(0.0, 1.0);
            let left = heading.perp(&d) + law.side_preference * oncoming;
            let (along, across) = (d.dot(&heading), left.abs());
            let fade = 0.5 * law.heading_half_width;
            let outside =
                ((across - law.heading_half_width) / fade).max(0.0) + (1.0 - along / fade).max(0.0);
            let expected = along
                + law.headway.headway_anticipation * u.max(0.0)
                + law.evasion_time * oncoming * u.clamp(-2.0 * speed, 0.0);
            let squared = expected.max(0.0).powi(2) + across.powi(2) + far * far * outside;
            least = least.min(squared.sqrt());
        }
        let room = ((least - law.headway.headway_length) / time).max(0.0);
        room * angle.cos() - law.heading_persistence * angle.abs()
    })
}

#[test]
fn agents_choose_the_heading_with_the_greatest_utility() {
    let cases = [
        (Precision::Double, 1e-12, 0.3),
        (Precision::Mixed, 1e-4, 0.0),
        (Precision::Mixed, 1e-4, -0.2),
    ];
    for (precision, exact, side) in cases {
        let parameters = evading(side);
        let law = law_of(&parameters);
        let (mut turned, mut all) = (0, 0);
        for seed in 0..10 {
            let mut scene = crowd(WalkingLawKind::Headings, seed);
            scene.precision = precision;
            scene.groups[0].blend = blend_with("sph", &parameters);
            let simulation = evaluated(scene);
            let frame = simulation.frame();
            for i in 0..frame.agents.len() {
                let held = frame.agents.heading[i];
                if frame.fields.preferred_velocity[i].norm() == 0.0 {
                    assert_eq!(held, 0);
                    continue;
                }
                let all_utilities = utilities(&simulation, i, &law);
                let best = all_utilities.iter().copied().fold(f64::MIN, f64::max);
                let chosen = all_utilities[(STRAIGHT as i32 + i32::from(held)) as usize];
                assert!(
                    best - chosen <= exact,
                    "{precision:?}, agent {i}: {all_utilities:?}, {held}"
                );
                turned += usize::from(held != 0);
                all += 1;
            }
        }
        assert!(turned > all / 10 && turned < all, "{turned} of {all}");
    }
}

/// Found by crowds whose choices depended on how agents were grouped: the edge of the lane along the outermost heading
/// begins behind the agent, where the search for others did not reach.
#[test]
fn agents_see_others_beside_their_outermost_headings() {
    let law = law();
    let mut kept_away = 0;
    for (place, side) in (0..30).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
        let back = 0.02 * f64::from(place);
        for aside in [0.1, 0.2, 0.3, 0.4] {
            let others = [0.6, 0.3, 0.0, -0.3].map(|y| vector(0.5, side * y));
            let others = others.into_iter().chain([vector(-back, side * aside)]);
            let all = [Vector::zeros()].into_iter().chain(others);
            let agents = all.map(|place| person(place, place + vector(100.0, 0.0)));
            let simulation = evaluated(lone(agents.collect(), Vec::new()));
            let frame = simulation.frame();
            let i = frame.agents.id.iter().position(|&id| id == 0).unwrap();
            let all = utilities(&simulation, i, &law);
            let best = all.iter().copied().fold(f64::MIN, f64::max);
            let held = frame.agents.heading[i];
            let chosen = all[(STRAIGHT as i32 + i32::from(held)) as usize];
            assert!(
                best - chosen <= 1e-4,
                "{back} {aside} {side}: {all:?}, {held}"
            );
            kept_away += usize::from(held.abs() < 3);
        }
    }
    assert!(kept_away > 0);
}

#[test]
fn agents_keep_the_time_gap_along_their_heading() {
    let law = law();
    let mut slowed = 0;
    for seed in 0..5 {
        let simulation = evaluated(crowd(WalkingLawKind::Headings, seed));
        let frame = simulation.frame();
        let agents = frame.agents;
        for i in 0..agents.len() {
            let wish = frame.fields.preferred_velocity[i];
            if wish.norm() == 0.0 {
                continue;
            }
            let heading = rotated(direction(wish), law.turned(law.followed(&frame, i)));
            let headway: Headway = law.headway;
            let range = headway.range(wish.norm());
            let distances = (0..agents.len()).filter(|&j| j != i).map(|j| {
                let d = agents.position[j] - agents.position[i];
                let away = (agents.velocity[j] - agents.velocity[i]).dot(&heading);
                let alike = direction(frame.fields.preferred_velocity[j]).dot(&heading);
                let place = [d.dot(&heading), d.dot(&perpendicular(heading))];
                headway.distance_in_lane(range, place, [away, alike])
            });
            let speed = headway.speed(wish.norm(), distances.fold(range, f64::min));
            let found = walking(&simulation, agents.id[i]) * (agents.mass[i] / 2.0) + wish;
            assert!(
                (found - heading * speed).norm() < 1e-9,
                "agent {i}: {found}, {}",
                heading * speed
            );
            slowed += usize::from(speed < wish.norm());
        }
    }
    assert!(slowed > 100, "{slowed}");
}

#[test]
fn agents_keep_their_headings_between_choices() {
    // Fine steps of 0.02 s and coarse steps of 0.1 s: a choice every ten frames.
    let mut simulation = evaluated(crowd(WalkingLawKind::Headings, 1));
    let held = |simulation: &Simulation| {
        let agents = simulation.frame().agents;
        let mut held: Vec<_> = agents
            .id
            .iter()
            .copied()
            .zip(agents.heading.clone())
            .collect();
        held.sort_unstable();
        held
    };
    let (mut last, mut changes) = (held(&simulation), 0);
    for frame in 1..=50 {
        simulation.integrate().unwrap();
        simulation.evaluate().unwrap();
        let now = held(&simulation);
        match frame % 10 {
            0 => changes += usize::from(now != last),
            _ => assert_eq!(now, last, "frame {frame}"),
        }
        last = now;
    }
    assert_eq!(changes, 5);
}

#[test]
fn a_fan_shows_what_the_agent_has_chosen() {
    let law = law();
    let mut ends = 0;
    for seed in 0..5 {
        let simulation = evaluated(crowd(WalkingLawKind::Headings, seed));
        for i in 0..simulation.frame().agents.len() {
            let Some(fan) = simulation.fan(i) else {
                assert_eq!(
                    simulation.frame().fields.preferred_velocity[i],
                    Vector::zeros()
                );
                continue;
            };
            let best = fan
                .headings
                .iter()
                .map(|of| of.utility)
                .fold(f64::MIN, f64::max);
            assert!(best - fan.headings[fan.followed].utility < 1e-9);
            for heading in &fan.headings {
                let free = law.sight(simulation.frame().fields.preferred_velocity[i].norm(), 1.0);
                let most = (free - law.headway.headway_length) / law.headway.headway_time;
                assert!(heading.room <= most + 1e-12);
                assert_eq!(
                    heading.ends_at.is_some(),
                    heading.room < most - 1e-12,
                    "{heading:?}, {most}"
                );
                ends += usize::from(heading.ends_at.is_some());
            }
        }
    }
    assert!(ends > 1000, "{ends}");
}

#[test]
fn a_lone_agent_walks_straight_at_its_preferred_speed() {
    let mut simulation = evaluated(lone(
        vec![person(Vector::zeros(), vector(100.0, 30.0))],
        vec![],
    ));
    run(&mut simulation, 500);
    let agents = simulation.frame().agents;
    assert!((agents.velocity[0].norm() - 1.4).abs() < 1e-6);
    assert!(agents.position[0].perp(&vector(100.0, 30.0)).abs() < 1e-9);
}

/// How far agent 0, which starts 2 m behind a slow one, is ahead of it after 20 s, meters.
fn lead(parameters: &Parameters) -> f64 {
    let mut scene = scene(vec![], blend_with("sph", parameters));
    let slow = NewAgent {
        preferred_speed: Some(0.5),
        ..person(vector(2.0, 0.01), vector(200.0, 0.01))
    };
    scene.agents = vec![person(Vector::zeros(), vector(200.0, 0.0)), slow];
    let mut simulation = evaluated(scene);
    run(&mut simulation, 1000);
    let agents = simulation.frame().agents;
    let at = |id| agents.position[agents.index_of(id).unwrap()].x;
    at(0) - at(1)
}

#[test]
fn a_fast_agent_overtakes_a_slow_one_and_with_the_headway_law_stays_behind() {
    let free = 20.0 * (1.4 - 0.5) - 2.0;
    let lead_with = lead(&parameters());
    assert!(
        lead_with > 0.9 * free && lead_with < free,
        "{lead_with} of {free}"
    );
    let behind = lead(
        &Parameters::default()
            .with("walking_law", "headway")
            .unwrap(),
    );
    assert!(behind < 0.0, "{behind}");
}

#[test]
fn two_agents_that_meet_pass_each_other() {
    let (left, right) = (vector(-6.0, 0.0), vector(6.0, 0.02));
    let agents = vec![
        walker(left, vector(1.4, 0.0), vector(100.0, 0.0)),
        walker(right, vector(-1.4, 0.0), vector(-100.0, 0.0)),
    ];
    let mut simulation = evaluated(lone(agents, vec![]));
    let mut nearest = f64::INFINITY;
    for _ in 0..500 {
        simulation.step().unwrap();
        let at = &simulation.frame().agents.position;
        nearest = nearest.min((at[0] - at[1]).norm());
    }
    let agents = simulation.frame().agents;
    let at = |id: u32| agents.position[agents.index_of(id).unwrap()].x;
    assert!(nearest > 0.45, "{nearest}: they touch");
    assert!(at(0) > 6.0 && at(1) < -6.0, "{} {}", at(0), at(1));
}

#[test]
fn a_mirrored_crowd_chooses_mirrored_headings() {
    let mirror = |v: Vector| vector(v.x, -v.y);
    for seed in 0..5 {
        let original = crowd(WalkingLawKind::Headings, seed);
        let mut mirrored = original.clone();
        for agent in &mut mirrored.agents {
            agent.position = mirror(agent.position);
            agent.velocity = mirror(agent.velocity);
            agent.goal = mirror(agent.goal);
        }
        let [one, two] = [original, mirrored].map(evaluated);
        let [one, two] = [&one, &two].map(|simulation| simulation.frame().agents);
        for i in 0..one.len() {
            let j = two.index_of(one.id[i]).unwrap();
            assert_eq!(one.heading[i], -two.heading[j], "agent {}", one.id[i]);
        }
    }
}

#[test]
fn motivation_and_density_shorten_the_gap_and_narrowings_lengthen_it() {
    let gap = Parameters::of([
        ("hurry_share", 0.5),
        ("press_share", 0.4),
        ("press_density", 4.0),
        ("press_range", 2.0),
        ("queue_share", 0.2),
        ("queue_density", 10.0),
        ("narrowing_share", 0.6),
        ("narrowing_range", 2.0),
    ])
    .unwrap()
    .or(&parameters());
    let gap = law_of(&gap).gap;
    let factor = |motivation, density, narrowing| {
        let calm = Situation::default();
        gap.factor(&Situation {
            motivation,
            density,
            narrowing,
            ..calm
        })
    };
    assert_eq!(factor(0.0, 0.0, None), 1.0);
    assert_eq!(factor(1.0, 0.0, None), 0.5);
    assert!((factor(0.0, 9.0, None) - 0.6).abs() < 1e-12);
    assert!((factor(0.0, 4.5, None) - 0.9).abs() < 1e-12);
    assert!((factor(0.0, 10.5, None) - 0.6 * 1.1).abs() < 1e-12);
    assert!((factor(0.0, 20.0, None) - 0.6 * 1.2).abs() < 1e-12);
    assert_eq!(factor(1.0, 20.0, None), 0.5);
    let met = gap.factor(&Situation {
        density: 20.0,
        opposed: 0.75,
        ..Situation::default()
    });
    assert!(
        (met - 0.6 * 1.05).abs() < 1e-12,
        "a quarter of the queue's share"
    );
    assert!((factor(0.0, 0.0, Some([0.0, 1.0])) - 1.6).abs() < 1e-12);
    assert_eq!(factor(0.0, 0.0, Some([0.0, 0.0])), 1.0);
    let at_range = factor(0.0, 0.0, Some([2.0, 1.0]));
    assert!((at_range - 1.0 - 0.6 * (-1.0_f64).exp()).abs() < 1e-12);
    for motivation in [0.0, 0.3, 1.0] {
        for density in [0.0, 4.7, 10.3] {
            for narrowing in [None, Some([0.5, 0.7])] {
                let factor = factor(motivation, density, narrowing);
                assert!(factor >= gap.shortest() && factor <= gap.longest());
            }
        }
    }
    // The agent behind another one walks faster if it hurries.
    let allowed = |motivation: f64| {
        let all = Parameters::of([("hurry_share", 0.5), ("heading_angle", 0.0)])
            .unwrap()
            .or(&parameters());
        let mut scene = scene(vec![], blend_with("sph", &all));
        scene.groups[0].motivation = motivation;
        scene.agents = vec![
            person(Vector::zeros(), vector(100.0, 0.0)),
            person(vector(0.6, 0.0), vector(100.0, 0.0)),
        ];
        let simulation = evaluated(scene);
        let agents = simulation.frame().agents;
        agents.allowed_speed[agents.index_of(0).unwrap()].unwrap()
    };
    let law = law().headway;
    let expected = (0.6 - law.headway_length) / law.headway_time;
    assert!((allowed(0.0) - expected).abs() < 1e-9);
    assert!((allowed(1.0) - 2.0 * expected).abs() < 1e-9);
}

#[test]
fn the_room_before_a_wall_is_where_the_body_touches_it() {
    let mut rng = stream(3, Purpose::Placement, 0, 0);
    let mut random = |size: f64| rng.random_range(-size..size);
    let (mut touched, mut missed) = (0, 0);
    for _ in 0..5_000 {
        let wall = Wall::new(
            vector(random(3.0), random(3.0)),
            vector(random(3.0), random(3.0)),
            0,
            0,
        );
        let p = vector(random(3.0), random(3.0));
        let heading = direction(vector(random(1.0), random(1.0)));
        let radius = 0.1 + 0.2 * random(1.0).abs();
        let gap =
            |s: f64| (wall.nearest_point(p + heading * s).point - p - heading * s).norm() - radius;
        if wall.signed_distance(p) < 0.0 || gap(0.0) < 1e-6 {
            continue;
        }
        let room = before_wall(&wall, p, radius, heading);
        let until = room.min(20.0);
        for k in 0..200 {
            let s = until * f64::from(k) / 200.0;
            assert!(
                gap(s) > -1e-9,
                "the body is in the wall before its end: {s} of {room}"
            );
        }
        if room.is_finite() {
            assert!(gap(room).abs() < 1e-9, "{}", gap(room));
            touched += 1;
        } else {
            missed += 1;
        }
    }
    assert!(touched > 300 && missed > 1000, "{touched}, {missed}");
}

#[test]
fn a_lone_agent_that_rests_stays_at_rest() {
    let place = vector(1.0, 1.0);
    let mut simulation = evaluated(lone(vec![person(place, place)], vec![]));
    run(&mut simulation, 100);
    assert_eq!(simulation.frame().agents.position[0], place);
    assert!(simulation.fan(0).is_none());
}

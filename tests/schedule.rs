//! The clock, and when agents enter, push and leave.

use crate::common::{acceleration, blend, block, breakdown, run, scene, state, vector, walker};
use sandbox::engine::clock::Clock;
use sandbox::engine::math::Vector;
use sandbox::engine::placement::Grid;
use sandbox::engine::profile::Override;
use sandbox::engine::profile::Term;
use sandbox::engine::scene::{Goal, Push, Region, Scene, Source};
use sandbox::engine::simulation::{EventKind, Simulation};

#[test]
fn agents_arrive_after_moving_and_leave_in_the_same_frame() {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.groups[0].removal_radius = Some(0.5);
    // 1.4 m/s, 0.028 m per frame: within 0.5 m of the goal after 18 moves (0.504 m), not 17.
    scene.agents = vec![
        walker(Vector::zeros(), vector(1.4, 0.0), vector(1.0, 0.0)),
        walker(vector(0.0, 40.0), vector(1.4, 0.0), vector(90.0, 40.0)),
    ];
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 17);
    assert_eq!(simulation.frame().agents.len(), 2);
    assert!(simulation.outcome().arrivals.is_empty());
    run(&mut simulation, 1);
    assert_eq!(simulation.frame().agents.id, [1]);
    let arrival = simulation.outcome().arrivals[0];
    assert_eq!((arrival.id, arrival.counted), (0, true));
    assert!((arrival.time - 18.0 * 0.02).abs() < 1e-12);
    run(&mut simulation, 10);
    assert_eq!(simulation.outcome().arrivals.len(), 1);
}

fn row(start: f64, every: f64, times: Option<u32>) -> Source {
    Source {
        name: "row".to_owned(),
        grid: Grid {
            min: vector(0.0, 0.0),
            max: vector(0.0, 5.0),
            columns: 1,
            rows: 5,
            jitter: 0.0,
        },
        group: 0,
        goal: Goal::Offset(vector(100.0, 0.0)),
        start,
        every,
        times,
    }
}

#[test]
fn a_source_adds_its_rows_on_time_and_then_stops() {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.sources = vec![row(0.25, 1.0, Some(3))];
    let mut simulation = Simulation::new(scene).unwrap();
    for frame in 0..200 {
        simulation.evaluate().unwrap();
        // Agents enter in coarse frames only: those due at 0.25, 1.25 and 2.25 s enter at 0.3, 1.3 and 2.3 s.
        let rows = [15, 65, 115].iter().filter(|&&due| due <= frame).count();
        assert_eq!(simulation.frame().agents.len(), 5 * rows, "frame {frame}");
        assert_eq!(simulation.expects_agents(), rows < 3);
        simulation.integrate().unwrap();
    }
    let entries: Vec<(u64, EventKind)> = simulation
        .events()
        .iter()
        .map(|event| (event.frame, event.kind))
        .collect();
    let five = EventKind::Entered(5);
    assert_eq!(entries, [(15, five), (65, five), (115, five)]);
    let agents = simulation.frame().agents;
    for i in 0..15 {
        let lane = f64::from(agents.id[i] % 5) + 0.5;
        assert_eq!(agents.goal[i], vector(100.0, lane));
    }
}

#[test]
fn a_source_faster_than_the_coarse_step_catches_up() {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.sources = vec![row(0.0, 0.04, None)];
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.evaluate().unwrap();
    run(&mut simulation, 51);
    assert_eq!(
        simulation.frame().agents.entered(),
        5 * 26,
        "entries due at 0, 0.04, …, 1 s"
    );
    assert!(simulation.expects_agents());
}

fn push_scene(change: Override) -> Scene {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.agents = block(Vector::zeros(), 6, 4, 0.4, vector(80.0, 0.6));
    scene.pushes = vec![Push {
        name: "push".to_owned(),
        at: 0.2,
        lasting: 0.3,
        region: Region {
            min: vector(-1.0, -1.0),
            max: vector(1.0, 3.0),
        },
        change,
    }];
    scene
}

#[test]
fn a_push_changes_agents_in_its_region_and_others_still_feel_them() {
    let change = Override {
        goal_scale: Some(2.5),
        ignore_contact: true,
        ignore_sph: true,
    };
    let mut simulation = Simulation::new(push_scene(change)).unwrap();
    let mut pushing = Vec::new();
    for frame in 0..40 {
        simulation.evaluate().unwrap();
        let region = simulation.scene().pushes[0].region;
        if frame == 10 {
            pushing = (0..24)
                .filter(|&id| region.contains(state(&simulation, id).0))
                .collect();
            assert!(!pushing.is_empty() && pushing.len() < 24);
        }
        for id in 0..24 {
            let agent = breakdown(&simulation, id);
            let terms = agent.profiles[0].accelerations.clone();
            let active = (10..25).contains(&frame) && pushing.contains(&id);
            assert_eq!(
                terms.get(Term::PressureAgents).is_none(),
                active,
                "frame {frame}, agent {id}"
            );
            assert_eq!(terms.get(Term::ContactAgents).is_none(), active);
            assert_eq!(terms.get(Term::ContactWalls).is_none(), active);
            let view = simulation.frame();
            let i = view.agents.index_of(id).unwrap();
            let wish = view.fields.preferred_velocity[i] - view.agents.velocity[i];
            let scale = if active { 2.5 } else { 1.0 };
            let expected = wish * (scale / 0.5 / agent.mass);
            assert!((terms.get(Term::Goal).unwrap() - expected).norm() < 1e-12);
            assert!(agent.neighbors.len() > 1);
        }
        if frame == 10 {
            // Agents that do not push still have pushing agents among their neighbors.
            let agents = simulation.frame().agents;
            let others = (0..24).filter(|id| !pushing.contains(id));
            let feels = others.filter(|&id| {
                let near = breakdown(&simulation, id).neighbors;
                near.iter().any(|neighbor| pushing.contains(&neighbor.id))
            });
            assert!(feels.count() > 0 && agents.len() == 24);
        }
        simulation.integrate().unwrap();
    }
    let kinds: Vec<(u64, EventKind)> = simulation
        .events()
        .iter()
        .map(|event| (event.frame, event.kind))
        .collect();
    assert_eq!(
        kinds,
        [
            (10, EventKind::PushBegan(pushing.len())),
            (25, EventKind::PushEnded)
        ]
    );
}

#[test]
fn a_push_does_not_change_the_forces_on_other_agents() {
    let nothing = Override {
        goal_scale: None,
        ignore_contact: false,
        ignore_sph: false,
    };
    let ignoring = Override {
        goal_scale: Some(9.0),
        ignore_contact: true,
        ignore_sph: true,
    };
    let [mut calm, mut pushed] =
        [nothing, ignoring].map(|c| Simulation::new(push_scene(c)).unwrap());
    for simulation in [&mut calm, &mut pushed] {
        run(simulation, 10);
        simulation.evaluate().unwrap();
    }
    let mut changed = 0;
    for id in 0..24 {
        let i = pushed.frame().agents.index_of(id).unwrap();
        if pushed.change(i).is_some() {
            changed += 1;
        } else {
            assert_eq!(acceleration(&calm, id), acceleration(&pushed, id));
        }
    }
    assert!(changed > 0);
}

#[test]
fn a_coarse_frame_comes_every_fifth_frame_for_ever() {
    let mut clock = Clock::default();
    for frame in 0..100_000 {
        assert_eq!(clock.is_coarse(), frame % 5 == 0);
        assert_eq!(clock.coarse_frame(), frame / 5);
        clock.advance();
    }
    assert_eq!(clock.time(), 2000.0);
}

#[test]
fn times_in_between_act_at_the_next_coarse_frame() {
    let clock = Clock::default();
    assert_eq!(clock.coarse_frame_at(150.0), 7500);
    assert_eq!(clock.coarse_frame_at(0.12), 10);
    assert_eq!(clock.coarse_frame_at(0.101), 10);
    assert_eq!(clock.coarse_frame_at(0.1), 5);
    for k in 0..10_000 {
        assert_eq!(
            clock.coarse_frame_at(0.1 * f64::from(k)),
            5 * u64::from(k as u32)
        );
    }
    assert_eq!(clock.frame_at(15.0), 750);
}

#[test]
fn the_coarse_step_stays_near_a_tenth_of_a_second() {
    let frames = [0.0025, 0.02, 0.03, 0.08, 0.5].map(Clock::nearest_coarse_every);
    assert_eq!(frames, [40, 5, 3, 1, 1]);
}

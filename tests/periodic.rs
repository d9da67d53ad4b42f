//! Periodic scenes: what happens at the ends of the period is what happens anywhere.

use crate::common::{bits, blend, blend_with, evaluated, go_to, person, run, scene, vector};
use rand::Rng;
use sandbox::engine::agents::{Agents, NewAgent};
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::{ListPolicy, Neighbors, Ranges, SKIN};
use sandbox::engine::period::{Axis, Period};
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::runs::drive::Run;
use sandbox::scenario::Scenario;
use sandbox::scenario::catalog::{NAMES, Parameters};
use serde_json::{Value, json};

fn along_x(from: f64, length: f64) -> Period {
    Period {
        axis: Axis::X,
        from,
        length,
    }
}

fn parsed(document: &Value) -> Scenario {
    Scenario::parse(&document.to_string(), "f", &[]).unwrap()
}

fn message(document: &Value) -> String {
    let error = Scenario::parse(&document.to_string(), "f", &[]).unwrap_err();
    error.to_string()
}

/// `count` people at random in a box, moving, at least 0.2 m apart. Their density rises: at rest density, rounding decides
/// on the sign of the pressure, and the sign on the force.
fn people(count: usize, extent: Vector) -> Vec<NewAgent> {
    let mut random = stream(3, Purpose::Crowd, 0, 0);
    let mut number = |low: f64, high: f64| random.random_range(low..high);
    let mut agents: Vec<NewAgent> = Vec::new();
    while agents.len() < count {
        let position = vector(number(0.1, extent.x - 0.1), number(0.0, extent.y));
        let is_near = |other: &NewAgent| (other.position - position).norm() < 0.2;
        if agents.iter().any(is_near) {
            continue;
        }
        agents.push(NewAgent {
            velocity: vector(number(-1.0, 1.0), number(-1.0, 1.0)),
            mean_density: Some(1.0),
            ..person(position, Vector::zeros())
        });
    }
    agents
}

/// A ring of people without walls, who walk along the axis.
fn ring(profile: &str) -> Scene {
    let mut scene = scene(Vec::new(), blend(profile));
    scene.period = Some(along_x(2.0, 12.0));
    scene.groups[0].direction = Some(Vector::x());
    scene.agents = people(150, vector(12.0, 4.0));
    scene
}

#[test]
fn images_lie_in_the_period() {
    let period = along_x(-0.3, 0.7);
    for x in [
        -0.3,
        0.4,
        0.399_999,
        -0.3 - 1e-18,
        1e6,
        -1e6,
        -0.300_000_000_1,
    ] {
        let (image, laps) = period.wrapped(vector(x, 5.0));
        assert!(period.contains(image), "{x} {image}");
        assert!((image + period.way(laps) - vector(x, 5.0)).norm() < 1e-9);
        assert_eq!(period.wrapped(image), (image, 0));
    }
}

#[test]
fn the_density_of_a_lattice_is_the_same_everywhere() {
    for axis in [Axis::X, Axis::Y] {
        let mut scene = scene(Vec::new(), blend("sph"));
        let (from, length) = (-3.0, 8.0);
        scene.groups[0].direction = Some(Vector::x());
        scene.period = Some(Period { axis, from, length });
        let at = |k: u32| match axis {
            Axis::X => vector(0.5 * f64::from(k % 16), 0.5 * f64::from(k / 16)),
            Axis::Y => vector(0.5 * f64::from(k / 16), 0.5 * f64::from(k % 16)),
        };
        scene.agents = (0..96).map(|k| person(at(k), Vector::zeros())).collect();
        let simulation = evaluated(scene);
        let frame = simulation.frame();
        for row in 0..6 {
            let ids = 16 * row..16 * (row + 1);
            let densities = ids.map(|id| {
                let i = frame.agents.index_of(id).unwrap();
                (frame.fields.density[i], frame.fields.acceleration[i])
            });
            let all: Vec<_> = densities.collect();
            for (density, acceleration) in &all {
                assert!((density - all[0].0).abs() < 1e-13, "{all:?}");
                assert!((acceleration - all[0].1).norm() < 1e-10, "{all:?}");
            }
        }
    }
}

/// A corridor with a pillar and a body across the ends of the period, and a crowd in it. Three of them in a row without
/// `periodic`; the middle one has the lowest ids.
fn corridor(profile: &str, axis: &str, periodic: bool) -> Value {
    let turned = |[x, y]: [f64; 2]| if axis == "x" { [x, y] } else { [y, x] };
    let length = 11.0;
    let copies = if periodic {
        &[0.0][..]
    } else {
        &[0.0, -length, length]
    };
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
        json!(corners.map(turned))
    };
    let crowd = people(70, vector(length, 3.0));
    let agents = copies.iter().flat_map(|shift| {
        crowd.iter().map(move |agent| {
            let position: [f64; 2] = agent.position.into();
            let velocity: [f64; 2] = agent.velocity.into();
            json!({"position": turned([position[0] + shift, position[1]]), "velocity": turned(velocity),
                   "radius": 0.25, "mass": 1.1, "mean_density": 1})
        })
    });
    let bodies = copies.iter().flat_map(|shift| {
        let pillar = rectangle([3.0 + shift, 3.5 + shift], [1.0, 1.5]);
        let across = rectangle([10.0 + shift, 11.6 + shift], [2.5, 3.0]);
        [pillar, across]
    });
    let ends = if periodic {
        [0.0, length]
    } else {
        [-length, 2.0 * length]
    };
    let mut document = json!({"profile": profile, "goal": {"direction": turned([1.0, 0.0])}, "precision": "double",
        "agents": agents.collect::<Vec<_>>(), "obstacles": bodies.collect::<Vec<_>>(),
        "walkable_area": [[rectangle(ends, [0.0, 3.0])]]});
    if periodic {
        document["periodic"] = json!({"axis": axis, "length": length});
    }
    document
}

#[test]
fn forces_are_those_in_the_middle_of_three_crowds() {
    for profile in NAMES {
        for axis in ["x", "y"] {
            let [one, three] = [true, false]
                .map(|periodic| evaluated(parsed(&corridor(profile, axis, periodic)).scene));
            let (one, three) = (one.frame(), three.frame());
            for id in 0..70 {
                let [i, j] = [one, three].map(|frame| frame.agents.index_of(id).unwrap());
                let difference = (one.fields.density[i] - three.fields.density[j]).abs();
                assert!(difference < 1e-12, "{profile} {axis} {id}: {difference}");
                let [a, b] = [one.fields.acceleration[i], three.fields.acceleration[j]];
                let difference = (a - b).norm() / (1.0 + b.norm());
                assert!(difference < 1e-12, "{profile} {axis} {id}: {a} {b}");
            }
        }
    }
}

#[test]
fn mixed_precision_sees_the_same_forces_across_the_ends() {
    for profile in ["sph", "sf"] {
        let mut document = corridor(profile, "x", true);
        let double = evaluated(parsed(&document).scene);
        document["precision"] = json!("mixed");
        let mixed = evaluated(parsed(&document).scene);
        let [double, mixed] =
            [double.frame(), mixed.frame()].map(|frame| &frame.fields.acceleration);
        for (a, b) in double.iter().zip(mixed) {
            assert!(
                (a - b).norm() < 1e-3 * (1.0 + a.norm()),
                "{profile}: {a} {b}"
            );
        }
    }
}

#[test]
fn lists_hold_all_agents_across_the_ends() {
    for (count, length, width) in [(300, 6.0, 4.0), (40, 300.0, 300.0), (2, 3.0, 0.3)] {
        for axis in [Axis::X, Axis::Y] {
            let extent = match axis {
                Axis::X => vector(length, width),
                Axis::Y => vector(width, length),
            };
            let period = Period {
                axis,
                from: 0.0,
                length,
            };
            let mut agents = Agents::default();
            for new in people(count, extent) {
                agents.enter(new, 1);
            }
            let ranges = Ranges {
                support: 1.0,
                drift: 0.5 * SKIN,
                margin: 0.5 * SKIN,
                period: Some(period),
                ..Ranges::default()
            };
            let mut neighbors = Neighbors::default();
            neighbors.sort(&mut agents, ranges);
            neighbors.list_agents();
            for i in 0..agents.len() {
                let r_i = agents.position[i];
                let near = |found: &mut dyn Iterator<Item = (usize, i32)>, reach: f64| {
                    let offset = |(j, laps)| agents.position[j] + period.way(laps) - r_i;
                    let mut found: Vec<_> = found.filter(|&at| offset(at).norm() < reach).collect();
                    found.sort_unstable();
                    found
                };
                let all = || (0..agents.len()).flat_map(|j| [-1, 0, 1].map(|laps| (j, laps)));
                let listed = near(&mut neighbors.near().near(i), 1.0 + SKIN);
                assert_eq!(listed, near(&mut all(), 1.0 + SKIN));
                let runs = neighbors.around(r_i, 1.5);
                let seen = runs.flat_map(|run| run.indices().map(move |j| (j, run.laps)));
                assert_eq!(near(&mut { seen }, 1.5), near(&mut all(), 1.5));
            }
        }
    }
}

#[test]
fn moving_everything_along_the_axis_changes_nothing() {
    for profile in ["sph", "sf", "sf->sph"] {
        let velocities = |shift: f64| {
            let mut scene = ring(profile);
            for agent in &mut scene.agents {
                agent.position.x += shift;
            }
            let mut simulation = Simulation::new(scene).unwrap();
            run(&mut simulation, 60);
            let agents = simulation.frame().agents;
            let of = |id| agents.velocity[agents.index_of(id).unwrap()];
            (0..150).map(of).collect::<Vec<_>>()
        };
        let still = velocities(0.0);
        for (a, b) in still.iter().zip(velocities(7.3)) {
            assert!((a - b).norm() < 1e-7, "{profile}: {a} {b}");
        }
    }
}

#[test]
fn agents_go_round_and_keep_their_ids() {
    for integrator in Integrator::ALL {
        for (heading, lists) in [(1.0, ListPolicy::Complete), (-1.0, ListPolicy::Coarse)] {
            let mut scene = scene(Vec::new(), blend("sph"));
            scene.integrator = integrator;
            scene.neighbor_lists = lists;
            scene.period = Some(along_x(0.0, 3.0));
            scene.groups[0].direction = Some(Vector::x() * heading);
            scene.agents = vec![NewAgent {
                velocity: vector(1.4 * heading, 0.0),
                ..person(vector(1.0, 0.0), Vector::zeros())
            }];
            let period = scene.period.unwrap();
            let mut simulation = Simulation::new(scene).unwrap();
            for _ in 0..500 {
                simulation.step().unwrap();
                simulation.evaluate().unwrap();
                assert!(period.contains(simulation.frame().agents.position[0]));
            }
            let agents = simulation.frame().agents;
            let walked = 1.4 * simulation.frame().clock.time() * heading;
            let unwrapped = agents.position[0] + period.way(agents.laps[0]);
            assert_eq!(agents.id, [0]);
            assert!((unwrapped.x - 1.0 - walked).abs() < 1e-9, "{unwrapped}");
            assert!(agents.laps[0].abs() > 1);
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits_and_a_resumed_run_too() {
    for profile in ["sph", "rvo", "sf->sph"] {
        let on = |threads: usize, stop: u64| {
            let pool = rayon::ThreadPoolBuilder::new();
            pool.num_threads(threads).build().unwrap().install(|| {
                let mut simulation = Simulation::new(ring(profile)).unwrap();
                go_to(&mut simulation, stop);
                let state = simulation.state();
                let mut simulation = Simulation::resumed(ring(profile), state).unwrap();
                go_to(&mut simulation, 60);
                (simulation.digest(), bits(&simulation))
            })
        };
        let first = on(1, 60);
        for (threads, stop) in [(2, 60), (1, 13), (2, 38)] {
            assert_eq!(on(threads, stop), first, "{profile}");
        }
    }
}

#[test]
fn walls_go_on_without_a_joint() {
    let walls = |document: &Value| parsed(document).scene.walls;
    let area = |x: [f64; 2]| json!([[[[x[0], 0], [x[1], 0], [x[1], 3], [x[0], 3]]]]);
    for x in [[0.0, 20.0], [-1.0, 21.0], [3.0, 23.0]] {
        let document = json!({"periodic": {"axis": "x", "length": 20}, "walkable_area": area(x)});
        assert_eq!(walls(&document).len(), 4, "{x:?}");
    }
    // A wall as long as the period is one body; a pillar has copies.
    let bar = json!([[0, 3], [20, 3], [20, 3.2], [0, 3.2]]);
    let pillar = json!([[5, 1], [6, 1], [6, 2]]);
    let document = json!({"periodic": {"axis": "x", "length": 20}, "obstacles": [bar, pillar]});
    let walls = walls(&document);
    assert_eq!(walls.obstacles()[0].points().len(), 4);
    assert_eq!(walls.obstacles()[1].points().len(), 3);
    for x in [-20.0, 0.0, 20.0] {
        assert_eq!(walls.obstacle_at(vector(19.9, 3.1)), Some(0));
        assert!(walls.obstacle_at(vector(5.5 + x, 1.2)).is_some());
        assert!(walls.obstacle_at(vector(7.0 + x, 1.2)).is_none());
    }
}

#[test]
fn measurements_see_no_jump_and_walls_hold() {
    let mut document = corridor("sph", "x", true);
    document["duration_secs"] = json!(20);
    document["measurements"] =
        json!([{"integrity": {}}, {"walks": {"from_secs": 10, "region": [[0, 0], [11, 3]]}}]);
    document["agents"].as_array_mut().unwrap().truncate(25);
    let mut run = Run::new(parsed(&document)).unwrap();
    while run.simulation.frame().clock.time() < 20.0 {
        run.simulation.evaluate().unwrap();
        run.metrics.observe(&run.simulation);
        run.simulation.integrate().unwrap();
    }
    run.simulation.evaluate().unwrap();
    run.metrics.observe(&run.simulation);
    let results = run.metrics.results(&run.simulation);
    let value = |name: &str| {
        let found = results.iter().find(|metric| metric.name == name);
        found.unwrap().value.unwrap()
    };
    assert_eq!(value("agents_through_walls"), 0.0);
    assert!((value("walks_density_per_m2") - 25.0 / 33.0).abs() < 1e-12);
    let speed = value("walks_speed_m_per_s");
    assert!((0.8..1.4).contains(&speed), "{speed}");
    let flow = value("walks_flow_per_m_per_s");
    assert!((flow - speed * 25.0 / 33.0).abs() < 1e-12);
}

#[test]
fn crowds_do_not_overlap_across_the_ends() {
    for (spacing, density) in [("random", 2.5), ("grid", 3.5)] {
        let document = json!({"periodic": {"axis": "x", "length": 10, "from": 1}, "profile": "sph",
            "crowds": [{"area": [[-5, 0], [20, 0], [20, 3], [-5, 3]], "density": density, "spacing": spacing}],
            "walkable_area": [[[[0, -0.5], [12, -0.5], [12, 3.5], [0, 3.5]]]]});
        let scene = parsed(&document).scene;
        let period = scene.period.unwrap();
        assert_eq!(scene.agents.len(), (30.0 * density) as usize);
        for (k, one) in scene.agents.iter().enumerate() {
            assert!(period.contains(one.position));
            for other in &scene.agents[..k] {
                let offset = period.shortest(one.position - other.position);
                let touching = one.radius.unwrap() + other.radius.unwrap();
                assert!(offset.norm() > touching, "{spacing}");
            }
        }
    }
}

#[test]
fn a_uniform_flow_has_the_preferred_speed_at_any_density() {
    // Equal neighbors on all sides cancel: only the goal force is left.
    let parameters = Parameters::default();
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    scene.period = Some(along_x(0.0, 4.0));
    scene.groups[0].direction = Some(Vector::x());
    let at = |k: u32| vector(0.5 * f64::from(k), 0.0);
    scene.agents = (0..8).map(|k| person(at(k), Vector::zeros())).collect();
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 500);
    for velocity in &simulation.frame().agents.velocity {
        assert!((velocity - vector(1.4, 0.0)).norm() < 1e-3, "{velocity}");
    }
}

#[test]
fn what_a_periodic_scene_cannot_have_is_refused_by_name() {
    let agent = json!([{"position": [1, 1]}]);
    let area = |corners: Value| json!([[corners]]);
    let line = json!([[5, 0], [5, 3]]);
    for (changes, expected) in [
        (
            json!({"exits": [{"name": "e", "line": line}]}),
            "f: exits: in a periodic scene agents walk",
        ),
        (
            json!({"entrances": [{"line": line, "per_sec": 1}]}),
            "f: entrances: in a periodic scene",
        ),
        (
            json!({"goal": [1, 1]}),
            "f: agents[0].goal: in a periodic scene agents walk in a direction, not to a point",
        ),
        (
            json!({"goal": {"direction": [0, 0]}}),
            "f: agents[0].goal.direction: must not be [0, 0]",
        ),
        (json!({"goal": {"way": [0, 0]}}), "f: goal"),
        (
            json!({"agents": [{"position": [1, 1], "remove_within": 1}]}),
            "f: agents[0].remove_within: agents that walk in a direction reach no goal",
        ),
        (
            json!({"grids": [{"min": [0, 0], "max": [1, 1], "columns": 1, "rows": 1, "goal_offset": [1, 0]}]}),
            "f: grids[0].goal_offset: in a periodic scene",
        ),
        (
            json!({"profile": "sf", "periodic": {"axis": "x", "length": 9}}),
            "f: periodic.length: must be at least 10 m, not 9",
        ),
        (
            json!({"periodic": {"axis": "x", "length": 1.9}}),
            "f: periodic.length: must be at least 2 m, not 1.9",
        ),
        (
            json!({"periodic": {"axis": "z", "length": 9}}),
            "f: periodic.axis: unknown value `z`",
        ),
        (
            json!({"walkable_area": area(json!([[0, 0], [20, 0], [20, 2], [10, 3], [0, 3]]))}),
            "f: walkable_area: the two ends of the period do not fit together: at x = 20 a wall remains from",
        ),
        (
            json!({"walkable_area": area(json!([[0, 0], [19, 0], [19, 3], [0, 3]]))}),
            "f: walkable_area: ",
        ),
        (
            json!({"walkable_area": area(json!([[1, 0], [19, 0], [19, 3], [1, 3]]))}),
            "f: walkable_area: there is no floor at x = 20, where the period ends",
        ),
        (
            json!({"measurements": [{"walks": {"region": [[15, 0], [25, 1]]}}]}),
            "f: measurements[0].walks.region: reaches out of the period from 0 to 20 m",
        ),
    ] {
        let mut document = json!({"periodic": {"axis": "x", "length": 20}, "agents": agent});
        for (key, value) in changes.as_object().unwrap() {
            document[key] = value.clone();
        }
        let message = message(&document);
        assert!(message.starts_with(expected), "{message}\n{expected}");
    }
}

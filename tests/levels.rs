//! Levels of a building, side by side in one plane, and the joins through which people pass and see.

use std::sync::Arc;

use sandbox::engine::geometry::Polygon;
use sandbox::engine::levels::{Join, Levels};
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Floor, Routes};
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::NAMES;
use sandbox::scenario::floor_plan::FloorPlan;

use crate::common;
use crate::common::{bits, blend, on_threads, person, scene, vector};

/// The ends of rectangles in meters, along x and along y.
type Sides = [[f64; 2]; 2];

fn corners([[x0, x1], [y0, y1]]: Sides) -> Vec<[f64; 2]> {
    vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// A scene on levels: for each, the rectangles of its own floor and of those that continue it behind its joins, in the
/// building. Agents follow path maps to `goals`, places in the plane of the engine.
fn on_levels(profile: &str, levels: Levels, floors: &[Vec<Sides>], goals: &[Vector]) -> Scene {
    let plans = floors.iter().zip(0..).map(|(floor, level)| {
        let way = levels.way(level);
        let ring = |sides: &Sides| {
            let points = corners(*sides).into_iter();
            vec![points.map(|[x, y]| [x + way.x, y + way.y]).collect()]
        };
        let rings: Vec<Vec<Vec<[f64; 2]>>> = floor.iter().map(ring).collect();
        FloorPlan::walkable(&rings).unwrap().walkable
    });
    let areas: Vec<_> = plans.flatten().collect();
    let floor = Floor::new(&areas, 0.4).unwrap();
    let mut scene = scene(vec![Polygon::enclosing(areas).unwrap()], blend(profile));
    let routes = Routes::on_levels(floor, &levels, &[], goals.to_vec()).unwrap();
    scene.routes = Some(Arc::new(routes));
    scene.levels = Some(Arc::new(levels));
    scene
}

/// A corridor of 30 m × 3 m that is cut into three levels at x = 10 and 20, each of which goes on 10 m into the next.
fn cut_corridor(profile: &str) -> Scene {
    let y = [0.0, 3.0];
    let levels = Levels::new(
        1000.0,
        &[
            Join {
                line: [vector(10.0, 0.0), vector(10.0, 3.0)],
                to: 1,
            },
            Join {
                line: [vector(1020.0, 0.0), vector(1020.0, 3.0)],
                to: 1,
            },
        ],
    );
    let floors = [[0.0, 20.0], [0.0, 30.0], [10.0, 30.0]].map(|x| vec![[x, y]]);
    let goals = [vector(0.5, 1.5), vector(2029.5, 1.5)];
    on_levels(profile, levels, &floors, &goals)
}

/// The same corridor in one piece.
fn whole_corridor(profile: &str) -> Scene {
    let areas = FloorPlan::walkable(&[vec![corners([[0.0, 30.0], [0.0, 3.0]])]])
        .unwrap()
        .walkable;
    let floor = Floor::new(&areas, 0.4).unwrap();
    let mut scene = scene(vec![Polygon::enclosing(areas).unwrap()], blend(profile));
    let goals = vec![vector(0.5, 1.5), vector(29.5, 1.5)];
    scene.routes = Some(Arc::new(Routes::new(floor, &[], goals).unwrap()));
    scene
}

/// Two streams that meet around both cuts of the corridor; `place` maps a place in the building to the plane.
fn streams(mut scene: Scene, place: impl Fn(Vector) -> Vector) -> Scene {
    for row in 0..5 {
        for column in 0..36 {
            let shift = 0.05 * f64::from((7 * row + 3 * column) % 5);
            let p = vector(
                6.0 + 0.5 * f64::from(column) + shift,
                0.4 + 0.55 * f64::from(row),
            );
            let end = if (row + column) % 3 == 0 { 0.5 } else { 29.5 };
            scene.agents.push(person(place(p), place(vector(end, 1.5))));
        }
    }
    scene
}

/// The place of somebody in the plane of the cut corridor.
fn on_cut(p: Vector) -> Vector {
    p + vector(1000.0, 0.0) * (p.x / 10.0).floor().min(2.0)
}

#[test]
fn a_corridor_that_is_cut_into_levels_is_the_whole_one() {
    for profile in NAMES {
        let cut = streams(cut_corridor(profile), on_cut);
        let levels = cut.levels.clone().unwrap();
        let mut cut = Simulation::new(cut).unwrap();
        let mut whole = Simulation::new(streams(whole_corridor(profile), |p| p)).unwrap();
        let mut changes = 0;
        for frame in 0..40 {
            for simulation in [&mut cut, &mut whole] {
                simulation.request_density_until(frame + 1);
                simulation.evaluate().unwrap();
            }
            let (own, other) = (cut.frame(), whole.frame());
            changes = 0;
            for (i, id) in own.agents.id.iter().enumerate() {
                let j = other.agents.index_of(*id).unwrap();
                let p = own.agents.position[i];
                let at = format!("{profile}, frame {frame}, {id} at {p}");
                let difference = levels.in_building(p) - other.agents.position[j];
                assert!(difference.norm() < 1e-6, "{at}: {difference}");
                let [dense, accelerates] = [
                    (own.fields.density.get(i).copied().unwrap_or_default()
                        - other.fields.density.get(j).copied().unwrap_or_default())
                    .abs(),
                    (own.fields.acceleration[i] - other.fields.acceleration[j]).norm(),
                ];
                assert!(
                    dense < 1e-6 && accelerates < 1e-3,
                    "{at}: {dense}, {accelerates}"
                );
                let began = 6.0 + 0.5 * f64::from(*id % 36);
                changes += i32::from((p.x / 1000.0).floor() != (began / 10.0).floor().min(2.0));
            }
            for simulation in [&mut cut, &mut whole] {
                simulation.integrate().unwrap();
            }
        }
        assert!(changes > 10, "{profile}: {changes} people on another level");
    }
}

/// A house: a floor, a flight of stairs, a landing, a flight back, and a floor above the first one.
fn house(profile: &str) -> Scene {
    let line = |level: f64, x: f64, [from, to]: [f64; 2]| {
        [
            vector(1000.0 * level + x, from),
            vector(1000.0 * level + x, to),
        ]
    };
    let levels = Levels::new(
        1000.0,
        &[
            Join {
                line: line(0.0, 10.0, [0.0, 1.8]),
                to: 1,
            },
            Join {
                line: line(1.0, 14.0, [0.0, 1.8]),
                to: 1,
            },
            // The landing lies on the right of the second flight.
            Join {
                line: line(2.0, 14.0, [4.0, 2.2]),
                to: 1,
            },
            Join {
                line: line(3.0, 10.0, [4.0, 2.2]),
                to: 1,
            },
        ],
    );
    let (story, landing) = ([[0.0, 10.0], [0.0, 4.0]], [[14.0, 16.0], [0.0, 4.0]]);
    let [up, on] = [[0.0, 1.8], [2.2, 4.0]].map(|y| [[10.0, 14.0], y]);
    let floors = [
        vec![story, up],
        vec![story, up, landing],
        vec![up, landing, on],
        vec![landing, on, story],
        vec![on, story],
    ];
    on_levels(profile, levels, &floors, &[vector(4001.0, 1.0)])
}

fn people_below(scene: &mut Scene) {
    scene.groups[0].removal_radius = Some(0.6);
    let places = (0..30).map(|k| vector(3.0 + f64::from(k % 10) * 0.6, 0.8 + f64::from(k / 10)));
    scene
        .agents
        .extend(places.map(|p| person(p, vector(4001.0, 1.0))));
}

#[test]
fn all_climb_the_stairs_and_change_levels_at_joins_only() {
    let mut scene = house("steer+sph");
    people_below(&mut scene);
    let levels = scene.levels.clone().unwrap();
    let mut simulation = Simulation::new(scene).unwrap();
    let mut before: Vec<Option<Vector>> = vec![None; 30];
    let mut changes = vec![0; 30];
    for _ in 0..6000 {
        simulation.evaluate().unwrap();
        let agents = simulation.frame().agents;
        for (id, &p) in agents.id.iter().zip(&agents.position) {
            let id = *id as usize;
            if let Some(last) = before[id].replace(p) {
                let way = levels.in_building(p) - levels.in_building(last);
                assert!(way.norm() < 0.04, "{id} jumps from {last} to {p}");
                let change = levels.level(p) - levels.level(last);
                if change != 0 {
                    changes[id] += change;
                    let at_join = levels
                        .joins()
                        .iter()
                        .any(|join| join.distance_squared(last) < 0.05 * 0.05);
                    assert!(
                        change.abs() == 1 && at_join,
                        "{id} changes from {last} to {p}"
                    );
                }
            }
        }
        if agents.is_empty() {
            break;
        }
        simulation.integrate().unwrap();
    }
    assert_eq!(simulation.outcome().arrivals.len(), 30);
    assert_eq!(changes, vec![4; 30]);
    assert_eq!(simulation.outcome().contained.count, 0);
}

#[test]
fn people_on_other_levels_change_no_bit() {
    for profile in NAMES {
        let mut below = house(profile);
        people_below(&mut below);
        let mut both = below.clone();
        // Above, at the same places and between them.
        let above =
            (0..60).map(|k| vector(4000.5 + f64::from(k % 20) * 0.4, 0.6 + f64::from(k / 20)));
        both.agents
            .extend(above.map(|p| person(p, vector(4001.0, 1.0))));
        let frames = 60;
        let [below, both] = [below, both].map(|scene| {
            let mut simulation = Simulation::new(scene).unwrap();
            common::run(&mut simulation, frames);
            bits(&simulation)
        });
        assert_eq!(below.len(), 30);
        let with = both.into_iter().filter(|(id, _)| *id < 30);
        assert!(below == with.collect::<Vec<_>>(), "{profile}");
    }
}

#[test]
fn threads_and_resumed_runs_give_the_same_bits() {
    let scene = || {
        let mut scene = house("steer+sph");
        people_below(&mut scene);
        scene
    };
    let run = |threads: usize| {
        on_threads(threads, || {
            let mut simulation = Simulation::new(scene()).unwrap();
            common::run(&mut simulation, 600);
            simulation
        })
    };
    let one = run(1);
    let levels = scene().levels.unwrap();
    let climbed = one
        .frame()
        .agents
        .position
        .iter()
        .filter(|p| levels.level(**p) > 0)
        .count();
    assert!(climbed > 5, "{climbed} on the stairs");
    for threads in [2, 3] {
        assert!(bits(&one) == bits(&run(threads)), "{threads} threads");
    }
    let mut resumed = Simulation::new(scene()).unwrap();
    common::run(&mut resumed, 300);
    let mut resumed = Simulation::resumed(scene(), resumed.state()).unwrap();
    common::run(&mut resumed, 300);
    assert!(bits(&one) == bits(&resumed));
}

#[test]
fn ways_over_joins_are_as_long_as_taut_strings() {
    let scene = house("sph");
    let routes = scene.routes.unwrap();
    let goal = Destination::Goal(vector(4001.0, 1.0));
    let length = |x: f64, y: f64| routes.length(vector(x, y), goal);
    // From the second flight straight to a corner of the upper floor, or past it.
    let to_end = |[x, y]: [f64; 2]| {
        // The string from the goal at (1, 1) to (x, y) on the second flight bends at (10, 2.2) if it must.
        let at_edge = 1.0 + (y - 1.0) * 9.0 / (x - 1.0);
        let corner: f64 = 2.2;
        let leg = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        match at_edge >= corner {
            true => leg([1.0, 1.0], [x, y]),
            false => leg([1.0, 1.0], [10.0, corner]) + leg([10.0, corner], [x, y]),
        }
    };
    for [x, y] in [[11.0, 3.0], [13.0, 2.5], [12.0, 3.8], [10.5, 2.4]] {
        let (own, taut) = (length(3000.0 + x, y), to_end([x, y]));
        assert!(
            (own - taut).abs() < 0.01,
            "({x}, {y}): {own} instead of {taut}"
        );
    }
    // From below: over both corners of the landing, (14, 1.8) and (14, 2.2).
    let taut = to_end([14.0, 2.2]) + 0.4 + 3.0;
    let own = length(1011.0, 1.8 - 1e-3);
    assert!((own - taut).abs() < 0.01, "{own} instead of {taut}");
}

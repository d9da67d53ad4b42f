//! Levels of a building, side by side in one plane, and the joins through which people pass and see.

use std::sync::Arc;

use sandbox::engine::agents::NewAgent;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::levels::{Level, Levels};
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Floor, Routes};
use sandbox::engine::scene::{Group, Scene};
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

/// A level at this height, with these rectangles.
fn flat(elevation: f64, floor: &[Sides]) -> Level {
    let rings: Vec<Vec<Vec<[f64; 2]>>> = floor.iter().map(|sides| vec![corners(*sides)]).collect();
    Level {
        name: "floor".to_owned(),
        at: Vector::zeros(),
        elevation,
        rise: Vector::zeros(),
        speed_factors: [1.0; 2],
        carries: Vector::zeros(),
        floor: FloorPlan::walkable(&rings).unwrap().walkable,
    }
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
    let levels = Arc::new(levels);
    let floor = Floor::on_levels(&areas, 0.4, levels.clone()).unwrap();
    let mut scene = scene(vec![Polygon::enclosing(areas).unwrap()], blend(profile));
    let routes = Routes::new(floor, &[], goals.to_vec()).unwrap();
    scene.routes = Some(Arc::new(routes));
    scene.levels = Some(levels);
    scene
}

/// The levels of a corridor of 30 m × 3 m that is cut into three at x = 10 and 20.
fn cuts() -> Levels {
    let parts = [[0.0, 10.0], [10.0, 20.0], [20.0, 30.0]];
    let mut levels = Levels::new(parts.map(|x| flat(0.0, &[[x, [0.0, 3.0]]])).to_vec());
    for (x, between) in [(10.0, [0, 1]), (20.0, [1, 2])] {
        levels.join([vector(x, 0.0), vector(x, 3.0)], between);
    }
    levels
}

/// A corridor that is cut into three levels, each of which goes on 10 m into the next.
fn cut_corridor(profile: &str) -> Scene {
    let y = [0.0, 3.0];
    let floors = [[0.0, 20.0], [0.0, 30.0], [10.0, 30.0]].map(|x| vec![[x, y]]);
    on_levels(profile, cuts(), &floors, &[])
}

/// The same corridor in one piece.
fn whole_corridor(profile: &str) -> Scene {
    let areas = FloorPlan::walkable(&[vec![corners([[0.0, 30.0], [0.0, 3.0]])]])
        .unwrap()
        .walkable;
    scene(vec![Polygon::enclosing(areas).unwrap()], blend(profile))
}

/// The distance of people in a row, meters.
const SPACING: f64 = 509.0 / 1024.0;

/// Two streams that meet around both cuts of the corridor; `place` maps a place in the building to the plane.
fn streams(mut scene: Scene, place: impl Fn(Vector) -> Vector) -> Scene {
    for row in 0..5 {
        for column in 0..36 {
            // Binary fractions, so that moving a level changes no digit. Nobody is exactly as far away as social forces
            // reach.
            let shift = 45.0 / 1024.0 * f64::from((7 * row + 3 * column) % 5);
            let p = vector(
                6.0 + SPACING * f64::from(column) + shift,
                0.4 + 0.55 * f64::from(row),
            );
            let group = u16::from((row + column) % 3 == 0);
            scene.agents.push(NewAgent {
                group,
                ..person(place(p), Vector::zeros())
            });
        }
    }
    // On paths, the triangles differ, and with them how far people keep from walls.
    scene.routes = None;
    scene.add_group(Group::new("left", scene.groups[0].blend.clone()));
    for (group, x) in scene.groups.iter_mut().zip([1.0, -1.0]) {
        group.direction = Some(vector(x, 0.0));
    }
    scene
}

/// The place of somebody in the plane of the cut corridor.
fn on_cut(p: Vector) -> Vector {
    p + cuts().way((p.x / 10.0).floor().min(2.0) as i32)
}

#[test]
fn a_corridor_that_is_cut_into_levels_is_the_whole_one() {
    for profile in NAMES {
        let cut = streams(cut_corridor(profile), on_cut);
        let whole = streams(whole_corridor(profile), |p| p);
        let levels = cut.levels.clone().unwrap();
        let mut cut = Simulation::new(cut).unwrap();
        let mut whole = Simulation::new(whole).unwrap();
        let mut changes = 0;
        for frame in 0..24 {
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
                // Rounding grows from frame to frame.
                let is_equal = dense < 1e-9 && accelerates < 1e-9;
                assert!(frame > 0 || is_equal, "{at}: {dense}, {accelerates}");
                let began = 6.0 + SPACING * f64::from(*id % 36);
                changes += i32::from(levels.level(p) as f64 != (began / 10.0).floor().min(2.0));
            }
            for simulation in [&mut cut, &mut whole] {
                simulation.integrate().unwrap();
            }
        }
        assert!(changes > 5, "{profile}: {changes} people on another level");
    }
}

/// A house: a floor, a flight of stairs, a landing, a flight back, and a floor above the first one.
fn house(profile: &str) -> Scene {
    let [up, back] = [[0.0, 1.8], [2.2, 4.0]];
    let (story, landing) = ([[0.0, 10.0], [0.0, 4.0]], [[14.0, 16.0], [0.0, 4.0]]);
    let flights = [up, back].map(|y| [[10.0, 14.0], y]);
    let own = [story, flights[0], landing, flights[1], story].into_iter();
    let own = own.zip([0.0, 0.0, 1.5, 1.5, 3.0]);
    let mut levels = Levels::new(own.map(|(sides, height)| flat(height, &[sides])).collect());
    let line = |x: f64, [from, to]: [f64; 2]| [vector(x, from), vector(x, to)];
    levels.join(line(10.0, up), [0, 1]);
    levels.join(line(14.0, up), [1, 2]);
    // The landing lies on the right of the second flight.
    levels.join(line(14.0, [back[1], back[0]]), [2, 3]);
    levels.join(line(10.0, [back[1], back[0]]), [3, 4]);
    let [up, back] = flights;
    let floors = [
        vec![story, up],
        vec![story, up, landing],
        vec![up, landing, back],
        vec![landing, back, story],
        vec![back, story],
    ];
    let goal = levels.way(4) + vector(1.0, 1.0);
    on_levels(profile, levels, &floors, &[goal])
}

/// The goal of people in a house, on its upper floor.
fn upstairs(scene: &Scene) -> Vector {
    scene.routes.as_ref().unwrap().goals()[0]
}

fn people_below(scene: &mut Scene) {
    scene.groups[0].removal_radius = Some(0.6);
    let places = (0..30).map(|k| vector(3.0 + f64::from(k % 10) * 0.6, 0.8 + f64::from(k / 10)));
    let goal = upstairs(scene);
    scene.agents.extend(places.map(|p| person(p, goal)));
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
                let [before, after] = [last, p].map(|p| levels.level(p) as i32);
                let change = after - before;
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
        let goal = upstairs(&both);
        let above = (0..60).map(|k| vector(f64::from(k % 20) * 0.4 - 0.5, f64::from(k / 20) - 0.4));
        both.agents.extend(above.map(|p| person(goal + p, goal)));
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
    let levels = scene.levels.clone().unwrap();
    let goal = Destination::Goal(upstairs(&scene));
    let routes = scene.routes.unwrap();
    let length =
        |level: i32, [x, y]: [f64; 2]| routes.length(vector(x, y) + levels.way(level), goal);
    let leg = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    // From the second flight straight to the goal at (1, 1), or past the corner of the upper floor.
    let to_end = |[x, y]: [f64; 2]| {
        let at_edge = 1.0 + (y - 1.0) * 9.0 / (x - 1.0);
        match at_edge >= 2.2 {
            true => leg([1.0, 1.0], [x, y]),
            false => leg([1.0, 1.0], [10.0, 2.2]) + leg([10.0, 2.2], [x, y]),
        }
    };
    for [x, y] in [[11.0, 3.0], [13.0, 2.5], [12.0, 3.8], [10.5, 2.4]] {
        let (own, taut) = (length(3, [x, y]), to_end([x, y]));
        assert!((own - taut).abs() < 1e-9, "({x}, {y}): {own}, {taut}");
    }
    // From below: over the end of the first flight and both corners of the landing.
    let up = |[x, y]: [f64; 2]| leg([x, y], [14.0, 1.8]) + 0.4 + to_end([14.0, 2.2]);
    for (level, p) in [
        (1, [11.0, 1.2]),
        (1, [13.0, 0.1]),
        (0, [3.0, 1.0]),
        (0, [9.0, 0.5]),
    ] {
        let (own, taut) = (length(level, p), up(p));
        assert!((own - taut).abs() < 1e-9, "{p:?}: {own}, {taut}");
    }
    // Around the corner at the foot of the stairs.
    let corner = [10.0, 1.8];
    let (own, taut) = (
        length(0, [8.0, 3.5]),
        leg([8.0, 3.5], corner) + 4.0 + 0.4 + to_end([14.0, 2.2]),
    );
    assert!((own - taut).abs() < 1e-9, "{own}, {taut}");
}

//! The walkable area in a trajectory file is where the engine lets people walk, point by point.

use crate::common::plans::{Ring, contains, margin, rings};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::output::trajectory::Trajectory;
use sandbox::scenario::Scenario;
use serde_json::json;

/// The number of plans in one scene, in rows of ten.
const PLANS: usize = 50;
/// The side of a plan's cells, meters.
const CELL: f64 = 1.5;
/// The distance from one plan to the next, meters.
const APART: f64 = 20.0;

/// A room whose holes are cells and half cells of a grid, which touch each other and the outline at corners and
/// along edges. Every other plan is rotated.
fn plan(random: &mut ChaCha8Rng, k: usize) -> Vec<Ring> {
    let turn = if k.is_multiple_of(2) {
        0.0
    } else {
        random.random_range(0.0..1.5)
    };
    let (sine, cosine) = f64::sin_cos(turn);
    let corner = [k % 10, k / 10].map(|c| APART * c as f64);
    let place = |[x, y]: [i32; 2]| {
        let [x, y] = [x, y].map(|c| CELL * f64::from(c));
        [
            corner[0] + cosine * x - sine * y,
            corner[1] + sine * x + cosine * y,
        ]
    };
    let count = random.random_range(3..7);
    let ring = |corners: &[[i32; 2]]| corners.iter().map(|&p| place(p)).collect();
    let mut rings = vec![ring(&[[0, 0], [count, 0], [count, count], [0, count]])];
    for (x, y) in (0..count).flat_map(|x| (0..count).map(move |y| (x, y))) {
        let [a, b, c, d] = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
        match random.random_range(0..9) {
            0 | 1 => rings.push(ring(&[a, b, c, d])),
            2 => rings.push(ring(&[a, b, c])),
            3 => rings.push(ring(&[b, d, a])),
            _ => {}
        }
    }
    rings
}

#[test]
fn the_written_area_is_where_people_can_walk() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let folder = tempfile::tempdir().unwrap();
    for scene in 0..2000 / PLANS {
        let plans: Vec<Vec<Ring>> = (0..PLANS).map(|k| plan(&mut random, k)).collect();
        let mut places = Vec::new();
        for (k, rings) in plans.iter().enumerate() {
            let corner = Vector::from([k % 10, k / 10].map(|c| APART * c as f64));
            for _ in 0..12 {
                let from_corner = [0; 2].map(|_| random.random_range(-1.0..9.0));
                let p = corner + Vector::from(from_corner);
                if margin(rings, p) > 1e-3 {
                    let in_hole = rings[1..].iter().any(|hole| contains(hole, p));
                    places.push((p, contains(&rings[0], p) && !in_hole));
                }
            }
        }
        // A person stands at every free place, because empty areas are not written.
        let free = places.iter().filter(|(_, free)| *free);
        let person = |(p, _): &(Vector, bool)| json!({"position": [p.x, p.y], "goal": [p.x, p.y]});
        let people: Vec<_> = free.map(person).collect();
        let document = json!({"walkable_area": plans, "agents": people}).to_string();
        let scenario = Scenario::parse(&document, "plans.json", &[]).unwrap();
        let engine = scenario.scene.walls.clone();
        let mut simulation = Simulation::new(scenario.scene).unwrap();
        let path = folder.path().join(format!("{scene}.sqlite"));
        let view = scenario.view.region;
        let file = Trajectory::create(&path, &mut simulation, view, 10.0).unwrap();
        file.finish().unwrap();
        let text: String = rusqlite::Connection::open(&path)
            .and_then(|file| file.query_row("SELECT wkt FROM geometry", [], |row| row.get(0)))
            .unwrap();
        let written = rings(&text);
        for (p, free) in places {
            // The area consists of the points inside an odd number of rings (outlines and holes).
            let around = written.iter().filter(|ring| contains(ring, p)).count();
            assert_eq!(around % 2 == 1, free, "scene {scene}: {p}");
            assert_eq!(engine.obstacle_at(p).is_none(), free, "scene {scene}: {p}");
        }
    }
}

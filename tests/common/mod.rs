//! Scenes and helpers for the tests. Each test file uses only some of them.
#![allow(dead_code)]

pub mod bounded;
#[cfg(feature = "program")]
pub mod building_files;
pub mod buildings;
pub mod busy;
pub mod documents;
pub mod drawn;
pub mod exits;
pub mod floors;
pub mod html;
pub mod json_schema;
pub mod legs;
#[cfg(all(feature = "program", unix))]
pub mod outputs;
#[cfg(feature = "program")]
pub mod page;
#[cfg(feature = "program")]
pub mod pdf;
#[cfg(feature = "program")]
pub mod pictures;
pub mod plan_files;
pub mod plan_reading;
pub mod plans;
#[cfg(feature = "program")]
pub mod program;
pub mod quadrature;
pub mod random_buildings;
pub mod random_journeys;
pub mod random_stairs;
pub mod reading;
pub mod reading_checkpoints;
#[cfg(feature = "program")]
pub mod reading_studies;
#[cfg(feature = "program")]
pub mod reading_trajectories;
#[cfg(feature = "program")]
pub mod recorded;
#[cfg(feature = "program")]
pub mod recording;
#[cfg(feature = "program")]
pub mod reports;
pub mod ring;
#[cfg(feature = "program")]
pub mod room;
pub mod sheets;
pub mod simulated;
pub mod social;
#[cfg(feature = "program")]
pub mod studio;
pub mod suite;
#[cfg(feature = "program")]
pub mod sweep;
pub mod taut;
#[cfg(feature = "program")]
pub mod tracks;
pub mod visibility;
pub mod waits;
pub mod walking;
pub mod wall_checks;
#[path = "../../experiments/src/walls/integrals.rs"]
pub mod wall_integrals;
pub mod whole;
#[cfg(feature = "program")]
pub mod zips;

use sandbox::engine::agents::NewAgent;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Blend;
use sandbox::engine::scene::{Group, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, Parameters};

pub fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

pub fn polygon(points: &[[f64; 2]]) -> Polygon {
    Polygon::new(points.iter().map(|&p| Vector::from(p)).collect()).unwrap()
}

pub fn rectangle(x: [f64; 2], y: [f64; 2]) -> Polygon {
    polygon(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]])
}

/// A square room [0, side]² with walls 1 m thick and a doorway in the middle of the right wall.
pub fn room(side: f64, door: f64) -> Polygon {
    let [low, high] = [0.5 * (side - door), 0.5 * (side + door)];
    let (inner, outer) = (side, side + 1.0);
    polygon(&[
        [-1.0, -1.0],
        [outer, -1.0],
        [outer, low],
        [inner, low],
        [inner, 0.0],
        [0.0, 0.0],
        [0.0, side],
        [inner, side],
        [inner, high],
        [outer, high],
        [outer, outer],
        [-1.0, outer],
    ])
}

pub fn blend(name: &str) -> Blend {
    blend_with(name, &Parameters::default())
}

pub fn blend_with(name: &str, parameters: &Parameters) -> Blend {
    catalog::named(name, parameters).unwrap()
}

/// A scene in double precision with one group, number 0, whose agents are never removed.
pub fn scene(obstacles: Vec<Polygon>, blend: Blend) -> Scene {
    let mut scene = Scene::with_obstacles(obstacles);
    scene.precision = Precision::Double;
    scene.add_group(Group::new("all", blend));
    scene
}

/// A person of average size in group 0, at rest.
pub fn person(position: Vector, goal: Vector) -> NewAgent {
    NewAgent {
        radius: Some(0.24),
        mass: Some(1.0),
        ..NewAgent::at(position, goal, 0)
    }
}

/// As [`person`], but moving.
pub fn walker(position: Vector, velocity: Vector, goal: Vector) -> NewAgent {
    NewAgent {
        velocity,
        ..person(position, goal)
    }
}

/// `columns` × `rows` people, `spacing` meters apart, the first at `corner`. Their bodies depend on the seed.
pub fn block(corner: Vector, columns: u32, rows: u32, spacing: f64, goal: Vector) -> Vec<NewAgent> {
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    cells
        .map(|(column, row)| {
            let step = vector(f64::from(column), f64::from(row));
            NewAgent::at(corner + step * spacing, goal, 0)
        })
        .collect()
}

/// A simulation with its first frame evaluated, including densities.
pub fn evaluated(scene: Scene) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.request_density_until(1);
    simulation.evaluate().unwrap();
    simulation
}

pub fn run(simulation: &mut Simulation, frames: u64) {
    for _ in 0..frames {
        simulation.step().unwrap();
    }
}

/// Runs to `frame` and evaluates it.
pub fn go_to(simulation: &mut Simulation, frame: u64) {
    while simulation.frame().clock.frame() < frame {
        simulation.step().unwrap();
    }
    simulation.evaluate().unwrap();
}

pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// The breakdown of agent `id` in an evaluated frame.
pub fn breakdown(simulation: &Simulation, id: u32) -> Breakdown {
    let i = simulation.frame().agents.index_of(id).unwrap();
    Breakdown::of(simulation, i).unwrap()
}

/// Total acceleration of agent `id` of an evaluated frame.
pub fn acceleration(simulation: &Simulation, id: u32) -> Vector {
    let frame = simulation.frame();
    frame.fields.acceleration[frame.agents.index_of(id).unwrap()]
}

/// Position and velocity of agent `id`.
pub fn state(simulation: &Simulation, id: u32) -> (Vector, Vector) {
    let agents = simulation.frame().agents;
    let i = agents.index_of(id).unwrap();
    (agents.position[i], agents.velocity[i])
}

/// The ids of all agents, with the bits of their positions, velocities and mean densities, sorted by id.
pub fn bits(simulation: &Simulation) -> Vec<(u32, [u64; 5])> {
    let agents = simulation.frame().agents;
    let mut bits: Vec<(u32, [u64; 5])> = (0..agents.len())
        .map(|i| {
            let (r, v) = (agents.position[i], agents.velocity[i]);
            let numbers = [r.x, r.y, v.x, v.y, agents.mean_density[i]];
            (agents.id[i], numbers.map(f64::to_bits))
        })
        .collect();
    bits.sort_unstable();
    bits
}

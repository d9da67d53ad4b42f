//! Random states of crowds among walls.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

use super::{blend_with, polygon, vector};

/// A random state: agents among walls, some of them near corners, behind thin walls, in contact, or at rest.
pub struct Drawn {
    pub profile: &'static str,
    pub parameters: Parameters,
    /// The corners of the obstacles.
    pub obstacles: Vec<Vec<[f64; 2]>>,
    pub scene: Scene,
}

impl Drawn {
    pub fn new(profile: &'static str, seed: u64) -> Self {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let parameters = Parameters::of([
            ("viscosity", if rng.random() { 5.0 } else { 0.0 }),
            ("rest_density_max", rng.random_range(2.0..8.0)),
        ])
        .unwrap();
        let boxes = rng.random_range(1..5);
        let obstacles: Vec<_> = match rng.random_range(0..4) {
            0 => Vec::new(),
            1 => vec![room()],
            _ => (0..boxes).map(|_| turned_box(rng)).collect(),
        };
        let polygons = obstacles.iter().map(|corners| polygon(corners));
        let mut scene = super::scene(polygons.collect(), blend_with(profile, &parameters));
        scene.seed = rng.random();
        scene.clock.go_to(rng.random_range(0..1000));
        for _ in 0..rng.random_range(2..50) {
            let position = free_place(rng, &scene);
            let speed = if rng.random_bool(0.2) { 0.0 } else { 1.8 };
            scene.agents.push(NewAgent {
                velocity: direction(rng) * rng.random_range(0.0..=speed),
                mean_density: Some(rng.random_range(0.0..8.0)),
                ..NewAgent::at(position, direction(rng) * 10.0, 0)
            });
        }
        Self {
            profile,
            parameters,
            obstacles,
            scene,
        }
    }

    /// Before its first evaluation.
    pub fn simulation(&self, precision: Precision) -> Simulation {
        let mut scene = self.scene.clone();
        scene.precision = precision;
        let frame = scene.clock.frame();
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.request_density_until(frame + 1);
        simulation
    }

    /// The smallest distance of two agents, meters.
    pub fn closest(&self) -> f64 {
        let agents = &self.scene.agents;
        let distances = agents.iter().enumerate().flat_map(|(k, agent)| {
            let others = agents[..k].iter();
            others.map(|other| (agent.position - other.position).norm())
        });
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// The corners of a room with a door.
fn room() -> Vec<[f64; 2]> {
    let corners = super::room(4.0, 0.8);
    let points = corners.points().iter();
    points.map(|p| [p.x - 2.0, p.y - 2.0]).collect()
}

/// The corners of a box, in either order. Some boxes are thinner than people.
fn turned_box(rng: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
    let (center, along) = (anywhere(rng), direction(rng));
    let across = vector(-along.y, along.x);
    let [width, height] = [0, 1].map(|_| 10_f64.powf(rng.random_range(-1.5..0.2)));
    let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = signs.map(|(a, b)| center + along * (a * width) + across * (b * height));
    let mut corners: Vec<_> = corners.into_iter().map(<[f64; 2]>::from).collect();
    if rng.random() {
        corners.reverse();
    }
    corners
}

fn direction(rng: &mut ChaCha8Rng) -> Vector {
    let angle: f64 = rng.random_range(0.0..std::f64::consts::TAU);
    vector(angle.cos(), angle.sin())
}

fn anywhere(rng: &mut ChaCha8Rng) -> Vector {
    vector(rng.random_range(-3.0..3.0), rng.random_range(-3.0..3.0))
}

/// A place outside of all obstacles: near another agent, a corner or a wall, or anywhere.
fn free_place(rng: &mut ChaCha8Rng, scene: &Scene) -> Vector {
    let walls: Vec<_> = scene.walls.iter().collect();
    loop {
        let some_wall = (!walls.is_empty()).then(|| walls[rng.random_range(0..walls.len())]);
        let agents = scene.agents.len();
        let other = (agents > 0).then(|| scene.agents[rng.random_range(0..agents)].position);
        let (near, reach) = match (rng.random_range(0..5), some_wall, other) {
            (0, Some(wall), _) => (wall.start, 0.4),
            (1, Some(wall), _) => (
                wall.start + (wall.end - wall.start) * rng.random::<f64>(),
                0.3,
            ),
            (2, _, Some(other)) => (other, 0.3),
            (3, _, Some(other)) if rng.random_bool(0.02) => (other, 0.0),
            _ => (anywhere(rng), 0.0),
        };
        let place = near + direction(rng) * (reach * rng.random::<f64>());
        if scene.walls.obstacle_at(place).is_none() {
            return place;
        }
    }
}

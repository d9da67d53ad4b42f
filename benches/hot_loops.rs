//! Each hot loop on one thread, through the public API. The crowd has 10,000 agents, at the density of the concert or
//! of streams that avoid each other.
//!
//! Throughput is in agents: `--bench hot_loops density` gives densities per second.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::density::from_agents;
use sandbox::engine::forces::near::{self, PairCoefficients, Wanted};
use sandbox::engine::forces::rvo::{Preference, Rvo, Scratch};
use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::{BLOCK, Neighbors};
use sandbox::engine::pairs::{Packed, Precision};
use sandbox::engine::simulation::Simulation;
use sandbox::lab::bench::Crowd;

const AGENTS: u32 = 10_000;
/// RVO is slow, so a sample of agents is enough.
const SOME: usize = 100;

/// The evaluated frame after the first second.
fn evaluated(crowd: &Crowd, precision: Precision) -> Simulation {
    let mut simulation = crowd.settled(50).unwrap();
    simulation.set_precision(precision);
    simulation.evaluate().unwrap();
    simulation
}

/// Eq. 9 for all agents.
fn density(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("density");
    group.throughput(Throughput::Elements(u64::from(AGENTS)));
    for precision in [Precision::Mixed, Precision::Double] {
        let simulation = evaluated(&Crowd::concert(AGENTS), precision);
        let frame = simulation.frame();
        let mut densities = vec![0.0; AGENTS as usize];
        group.bench_function(
            BenchmarkId::from_parameter(format!("{precision:?}")),
            |bencher| {
                bencher.iter(|| {
                    for (b, out) in densities.chunks_mut(BLOCK).enumerate() {
                        let block = frame.neighbors.near().block(b);
                        match frame.packed {
                            Packed::Double(columns) => from_agents(&columns.bodies, block, out),
                            Packed::Mixed(columns) => from_agents(&columns.bodies, block, out),
                        }
                    }
                    black_box(densities[0])
                });
            },
        );
    }
    group.finish();
}

/// Eqs. 7, 11 and 22 for all agents.
fn pair_forces(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pair forces");
    group.throughput(Throughput::Elements(u64::from(AGENTS)));
    let simulation = evaluated(&Crowd::concert(AGENTS), Precision::Mixed);
    let frame = simulation.frame();
    let coefficients = PairCoefficients {
        pressure: [1.0; BLOCK],
        viscosity: [1.0; BLOCK],
        contact: [1.0; BLOCK],
    };
    let pressure = Wanted {
        pressure: true,
        ..Wanted::default()
    };
    for (name, wanted) in [("pressure", pressure), ("all", Wanted::ALL)] {
        let mut out = vec![Vector::zeros(); AGENTS as usize];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for (b, out) in out.chunks_mut(BLOCK).enumerate() {
                    near::accelerations(&frame, b, &coefficients, wanted, out);
                }
                black_box(out[0])
            });
        });
    }
    group.finish();
}

/// Eq. 18 for all agents, with avoidance radii of 5 m and 2.5 m.
fn social_forces(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("social forces");
    group.throughput(Throughput::Elements(u64::from(AGENTS)));
    let simulation = evaluated(&Crowd::streams(AGENTS, "sf"), Precision::Mixed);
    let frame = simulation.frame();
    let coefficients = [1.0; BLOCK];
    let mut out = vec![Vector::zeros(); AGENTS as usize];
    group.sample_size(20);
    for radius in [5.0, 2.5] {
        let social = SocialForce {
            avoidance_radius: radius,
            ..SocialForce::default()
        };
        group.bench_function(format!("{radius} m"), |bencher| {
            bencher.iter(|| {
                for (b, out) in out.chunks_mut(BLOCK).enumerate() {
                    social.add_from_agents(&frame, b, &coefficients, out);
                }
                black_box(out[0])
            });
        });
    }
    group.finish();
}

/// Eqs. 20 and 21: a choice among 250 candidates, for a sample of agents.
fn rvo(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rvo");
    group.throughput(Throughput::Elements(SOME as u64));
    let simulation = evaluated(&Crowd::streams(AGENTS, "rvo"), Precision::Mixed);
    let (frame, max_speed) = (simulation.frame(), simulation.scene().max_speed);
    let (rvo, mut scratch) = (Rvo::default(), Scratch::default());
    let every = AGENTS as usize / SOME;
    group.sample_size(20);
    group.bench_function("choice", |bencher| {
        bencher.iter(|| {
            for i in (0..AGENTS as usize).step_by(every) {
                let preferred_velocity = frame.fields.preferred_velocity[i];
                let wish = Preference {
                    preferred_velocity,
                    max_speed,
                };
                black_box(rvo.acceleration(&frame, i, wish, &mut scratch));
            }
        });
    });
    group.finish();
}

/// Step 1.
fn neighbors(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("neighbors");
    group.throughput(Throughput::Elements(u64::from(AGENTS)));
    let simulation = evaluated(&Crowd::concert(AGENTS), Precision::Mixed);
    let ranges = simulation
        .scene()
        .ranges(simulation.needs(), simulation.frame().agents);
    let mut agents = simulation.frame().agents.clone();
    let mut neighbors = Neighbors::default();
    group.bench_function("sort", |bencher| {
        bencher.iter(|| neighbors.sort(&mut agents, ranges));
    });
    group.bench_function("list", |bencher| bencher.iter(|| neighbors.list_agents()));
    group.finish();
}

/// Eqs. 10 and 12 for people along a wall and around its corner, by each method.
fn walls(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("walls");
    let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    let square = Polygon::new(corners.map(Vector::from).to_vec()).unwrap();
    let walls = Walls::new(vec![square]);
    let places: Vec<Vector> = (0..SOME)
        .map(|k| Vector::new(0.11 * k as f64, -0.3 - 0.006 * k as f64))
        .collect();
    let near: Vec<Vec<u32>> = places
        .iter()
        .map(|&place| {
            let mut found = Vec::new();
            walls.near(place, 1.0, &mut found);
            found
        })
        .collect();
    group.throughput(Throughput::Elements(SOME as u64));
    for method in [
        WallMethod::Representative,
        WallMethod::Exact,
        WallMethod::Union,
    ] {
        group.bench_function(
            BenchmarkId::from_parameter(format!("{method:?}")),
            |bencher| {
                bencher.iter(|| {
                    let mut kernel = 0.0;
                    for (&place, near) in places.iter().zip(&near) {
                        method.shares(&walls, near, place, 1.0, |share| kernel += share.kernel);
                    }
                    black_box(kernel)
                });
            },
        );
    }
    group.finish();
}

/// Uses one thread, to measure the loops and not their parallel scheduling.
fn hot_loops(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .unwrap();
    density(criterion);
    pair_forces(criterion);
    social_forces(criterion);
    rvo(criterion);
    neighbors(criterion);
    walls(criterion);
}

criterion_group!(benches, hot_loops);
criterion_main!(benches);

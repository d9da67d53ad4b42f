//! The time of one frame of a dense crowd, by size, through the public API.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::Vector;
use sandbox::engine::placement::Grid;
use sandbox::engine::scene::{Group, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, Parameters};

/// `count` agents on a jittered grid of 4 P/m², each with its own start as its goal, after 50 frames.
fn crowd(count: u32, profile: &str) -> Simulation {
    let side = f64::from(count).sqrt().ceil();
    let grid = Grid {
        min: Vector::zeros(),
        max: Vector::new(side, side) * 0.5,
        columns: side as u32,
        rows: side as u32,
        jitter: 0.05,
    };
    let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
    let mut scene = Scene::default();
    let group = scene.add_group(Group {
        counted: false,
        ..Group::new("crowd", catalog::named(profile, &parameters).unwrap())
    });
    let places = grid.positions(1, 0);
    scene.agents = places.map(|p| NewAgent::at(p, p, group)).collect();
    let mut simulation = Simulation::new(scene).unwrap();
    for _ in 0..50 {
        simulation.step().unwrap();
    }
    simulation
}

fn frames(criterion: &mut Criterion) {
    for profile in ["sph", "sf", "rvo->sph"] {
        let mut group = criterion.benchmark_group(profile);
        group.sample_size(20);
        for count in [400_u32, 2_500, 10_000] {
            let mut simulation = crowd(count, profile);
            group.throughput(Throughput::Elements(u64::from(count)));
            group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
                bencher.iter(|| simulation.step().unwrap());
            });
        }
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);

//! The estimate of a run's memory, before its agents are placed.

use crate::common::{blend_with, polygon, scene};
use rand::Rng;
use sandbox::engine::agents::Agents;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::scene::Scene;
use sandbox::scenario::catalog::Parameters;
use sandbox::scenario::{Draft, Need, SHIPPED, in_units};

#[test]
fn amounts_have_three_digits() {
    for (bytes, text) in [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1_000, "1.00 kB"),
        (16_500_000_000, "16.5 GB"),
        (999_499_999, "999 MB"),
        (999_500_000, "1.00 GB"),
        (u64::MAX, "18447 PB"),
    ] {
        assert_eq!(in_units(bytes), text);
    }
}

const NEED: Need = Need {
    initial: 400_000,
    entering: 1_000_000,
    walls: 12,
    text: 1_000,
    listed: 0,
    routes: 0,
};

#[test]
fn what_is_larger_than_the_machine_is_refused_with_the_estimate_and_the_fix() {
    assert_eq!(NEED.check("f.json", 0, NEED.bytes()), Ok(()));
    assert_eq!(
        NEED.check("f.json", 100, 256_000_000)
            .unwrap_err()
            .to_string(),
        "f.json: 1000000 agents (600000 of them from sources and entrances) and 12 walls would take 779 MB of memory \
         (100 MB of it to write files), and this machine has 256 MB: use fewer agents, a shorter run \
         (--until) if they enter later, or a larger machine"
    );
}

#[test]
fn lists_of_walls_count() {
    let need = Need {
        listed: 1_000_000_000,
        ..NEED
    };
    let said = need.check("f.json", 0, 1 << 30).unwrap_err().to_string();
    assert!(
        said.contains("5.68 GB of memory (5.00 GB of it to list walls near agents)"),
        "{said}"
    );
    assert!(
        said.contains("use smaller avoidance_radius and support_radius, "),
        "{said}"
    );
}

#[test]
fn what_is_without_bounds_needs_all_there_is() {
    let need = Need {
        initial: u64::MAX,
        entering: u64::MAX,
        ..Need::default()
    };
    assert_eq!(need.bytes(), u64::MAX);
}

#[test]
fn the_shipped_scenarios_fit_into_a_small_machine() {
    for shipped in SHIPPED {
        let draft = Draft::read(shipped.text, shipped.name, &[]).unwrap();
        assert!(draft.within(Some(128 << 20), 0).is_ok(), "{}", shipped.name);
    }
}

/// A scene with `count` squares at random places in [0, span]², and the reach of the lists of walls near its agents.
fn squares(count: usize, side: f64, span: f64, support_radius: f64) -> (Scene, f64) {
    let mut rng = stream(3, Purpose::Placement, 0, 0);
    let square = |_| -> Polygon {
        let [x, y] = [0; 2].map(|_| rng.random_range(0.0..span));
        polygon(&[[x, y], [x + side, y], [x + side, y + side], [x, y + side]])
    };
    let solids = (0..count).map(square).collect();
    let parameters = Parameters::of([("support_radius", support_radius)]).unwrap();
    let scene = scene(solids, blend_with("sph", &parameters));
    let ranges = scene.ranges(&scene.needs(), &Agents::default());
    (scene, ranges.support + ranges.drift)
}

/// The estimated entries in the lists of walls near `agents` agents.
fn listed(scene: &Scene, agents: u64) -> u64 {
    let need = Need {
        entering: agents,
        ..Need::default()
    };
    need.with_lists(scene).listed
}

/// The number of walls within reach of each place, summed.
fn near(scene: &Scene, reach: f64, places: impl Iterator<Item = [f64; 2]>) -> u64 {
    let count = |place: [f64; 2]| {
        let mut near = Vec::new();
        scene.walls.near(place.into(), reach, &mut near);
        near.len() as u64
    };
    places.map(count).sum()
}

#[test]
fn no_dense_crowd_has_longer_lists_than_estimated() {
    for (count, side, span, support_radius) in [
        (300, 0.5, 40.0, 3.0),
        (20, 30.0, 40.0, 3.0),
        (40, 1.0, 5000.0, 2.0),
    ] {
        let (scene, reach) = squares(count, side, span, support_radius);
        // Agents times walls exceeds the limit up to which this product is the estimate.
        let agents = (1 << 20) / scene.walls.len() as u64 + 1;
        let bound = listed(&scene, agents);
        let mut rng = stream(4, Purpose::Placement, 0, 0);
        for _ in 0..20 {
            // A square block of agents with 16 per square meter.
            let columns = (agents as f64).sqrt().ceil() as u64;
            let corner = [0; 2].map(|_| rng.random_range(-1.0..span));
            let place = |k: u64| {
                let cell = [k % columns, k / columns].map(|k| 0.25 * k as f64);
                [corner[0] + cell[0], corner[1] + cell[1]]
            };
            let found = near(&scene, reach, (0..agents).map(place));
            assert!(found <= bound, "{found} {bound}");
        }
    }
}

#[test]
fn the_estimate_is_at_most_three_times_the_lists_of_a_uniform_scene() {
    let (scene, reach) = squares(2000, 0.5, 100.0, 10.0);
    let mut rng = stream(5, Purpose::Placement, 0, 0);
    let places = std::iter::repeat_with(|| [0; 2].map(|_| rng.random_range(20.0..80.0)));
    let found = near(&scene, reach, places.take(1000));
    // 1000 agents fill several cells, so the bound is not just the longest list times 1000.
    let bound = listed(&scene, 1000);
    assert!((found..3 * found).contains(&bound), "{found} {bound}");
}

#[test]
fn walls_without_agents_and_agents_without_walls_have_no_lists() {
    assert_eq!(listed(&squares(3, 1.0, 9.0, 5.0).0, 0), 0);
    assert_eq!(listed(&squares(0, 1.0, 9.0, 5.0).0, 9), 0);
    assert_eq!(listed(&squares(1, 1.0, 9.0, 5.0).0, 9), 36);
}

//! No agent passes through a wall, however thin it is and however hard the crowd presses.

use crate::common;
use crate::common::{
    blend, blend_with, block, person, polygon, rectangle, run, scene, vector, walker,
};
use proptest::prelude::*;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Integrator;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

/// A ring of wall around [0, side]², with a slit 1 µm wide on the left.
fn cell(side: f64, thickness: f64) -> Polygon {
    let (low, high) = (-thickness, side + thickness);
    let [below, above] = [0.5 * side, 0.5 * side + 1e-6];
    polygon(&[
        [low, low],
        [high, low],
        [high, high],
        [low, high],
        [low, above],
        [0.0, above],
        [0.0, side],
        [side, side],
        [side, 0.0],
        [0.0, 0.0],
        [0.0, below],
        [low, below],
    ])
}

fn turned(polygon: &Polygon, angle: f64, shift: Vector) -> Polygon {
    let (sine, cosine) = angle.sin_cos();
    let place = |p: &Vector| vector(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y) + shift;
    Polygon::new(polygon.points().iter().map(place).collect()).unwrap()
}

fn all_agents_in(simulation: &Simulation, inside: impl Fn(Vector) -> bool) -> bool {
    simulation
        .frame()
        .agents
        .position
        .iter()
        .all(|&p| inside(p))
}

#[test]
fn a_wall_of_one_centimeter_holds_three_hundred_people() {
    let parameters = Parameters::of([("goal_scale", 10.0)]).unwrap();
    let thin = rectangle([6.0, 6.01], [-1.0, 7.0]);
    let sides = [
        rectangle([-2.0, 6.5], [-2.0, -1.0]),
        rectangle([-2.0, 6.5], [7.0, 8.0]),
        rectangle([-3.0, -2.0], [-2.0, 8.0]),
    ];
    for profile in ["sph", "sf"] {
        let obstacles = std::iter::once(thin.clone()).chain(sides.clone()).collect();
        let mut scene = scene(obstacles, blend_with(profile, &parameters));
        scene.agents = block(vector(0.2, -0.6), 15, 20, 0.37, vector(20.0, 3.0));
        let mut simulation = Simulation::new(scene).unwrap();
        run(&mut simulation, 1000);
        let inside = |p: Vector| p.x <= 6.0 && p.x >= -2.0 && p.y >= -1.0 && p.y <= 7.0;
        assert!(all_agents_in(&simulation, inside), "{profile}");
        assert_eq!(simulation.frame().agents.len(), 300);
    }
}

#[test]
fn a_stopped_move_is_counted_and_loses_its_inward_velocity() {
    // Without contact and social forces, only containment stops the agent.
    let parameters = Parameters::of([("wall_stiffness", 0.0)]).unwrap();
    let mut scene = scene(
        vec![rectangle([1.0, 1.01], [-9.0, 9.0])],
        blend_with(
            "sf",
            &Parameters::of([("wall_strength", 0.0)])
                .unwrap()
                .or(&parameters),
        ),
    );
    scene.agents = vec![walker(
        vector(0.98, 0.0),
        vector(1.4, 0.0),
        vector(9.0, 0.0),
    )];
    let mut simulation = Simulation::new(scene).unwrap();
    assert_eq!(simulation.outcome().contained.count, 0);
    run(&mut simulation, 1);
    assert_eq!(simulation.outcome().contained.count, 1);
    let (r, v) = common::state(&simulation, 0);
    assert!(r.x < 1.0 && r.x > 1.0 - 1e-5);
    assert_eq!(v.x, 0.0);
    run(&mut simulation, 1000);
    assert!(common::state(&simulation, 0).0.x < 1.0);
    assert_eq!(simulation.outcome().contained.count, 1001);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn no_agent_slips_through_a_corner(
        angle in proptest::sample::select(vec![0.0, 0.5, std::f64::consts::FRAC_PI_4, 1.1, 2.9]),
        shift in proptest::sample::select(vec![0.0, 0.3, 17.7, -1234.5]),
        start in 0.1..1.9_f64,
        corner in 0..4_usize,
    ) {
        let none = Parameters::of([
            ("wall_stiffness", 0.0),
            ("agent_stiffness", 0.0),
            ("wall_strength", 0.0),
            ("goal_scale", 30.0),
        ])
        .unwrap();
        let shift = vector(shift, -shift);
        let ring = turned(&cell(2.0, 0.01), angle, shift);
        let [middle, target] = [7, 9, 6, 8].map(|k| ring.points()[k])[corner..]
            .first()
            .map(|&c| [shift, c])
            .unwrap();
        // One agent starts on the diagonal to the corner, the other at a random place. Their goals lie far beyond
        // the corner.
        let (sine, cosine) = angle.sin_cos();
        let center = middle + vector(cosine - sine, sine + cosine);
        let starts = [
            center + (target - center) * (start / 2.0),
            middle + vector(cosine * start - sine * 0.7, sine * start + cosine * 0.7),
        ];
        let mut scene = scene(vec![ring], blend_with("sf", &none));
        scene.agents = starts.map(|from| person(from, from + (target - from) * 1e3)).to_vec();
        let mut simulation = Simulation::new(scene).unwrap();
        prop_assert!(simulation.outcome().displaced.is_empty());
        for frame in 0..250 {
            run(&mut simulation, 1);
            for id in 0..2 {
                let p = common::state(&simulation, id).0 - shift;
                let own = vector(cosine * p.x + sine * p.y, cosine * p.y - sine * p.x);
                prop_assert!(
                    own.x >= -1e-9 && own.x <= 2.0 + 1e-9 && own.y >= -1e-9 && own.y <= 2.0 + 1e-9,
                    "agent {id} at {own:?} in frame {frame}"
                );
            }
        }
    }
}

#[test]
fn no_agent_slips_through_joints_of_collinear_walls() {
    // Many short collinear walls at an odd angle, and agents that press against them while they slide along.
    let none = Parameters::of([("wall_stiffness", 0.0), ("wall_strength", 0.0)]).unwrap();
    for k in 0..40 {
        let angle = 0.1 + 0.15 * f64::from(k);
        let pieces = (0..60).map(|piece| f64::from(piece) * 0.1).map(|x| {
            turned(
                &rectangle([x, x + 0.1], [-0.05, 0.0]),
                angle,
                vector(7.0, -3.0),
            )
        });
        let (sine, cosine) = angle.sin_cos();
        let place =
            |x: f64, y: f64| vector(cosine * x - sine * y + 7.0, sine * x + cosine * y - 3.0);
        let mut scene = scene(pieces.collect(), blend_with("sf", &none));
        for slope in [0.01, 0.1, 0.5, 1.0] {
            let agent = person(place(0.3, 0.02), place(0.3 + 900.0, -900.0 * slope));
            scene.agents.push(agent);
        }
        scene.groups[0].blend = blend_with(
            "sph",
            &Parameters::of([("gas_constant", 0.0), ("agent_stiffness", 0.0)])
                .unwrap()
                .or(&none),
        );
        let mut simulation = Simulation::new(scene).unwrap();
        for frame in 0..300 {
            run(&mut simulation, 1);
            for id in 0..4 {
                let p = common::state(&simulation, id).0 - vector(7.0, -3.0);
                let (x, y) = (cosine * p.x + sine * p.y, cosine * p.y - sine * p.x);
                let over = (0.0..=6.0).contains(&x);
                assert!(
                    !over || y >= -1e-9,
                    "angle {angle}, agent {id}, frame {frame}: {x} {y}"
                );
            }
        }
    }
}

#[test]
fn an_agent_above_the_maximum_speed_cannot_jump_a_wall() {
    for integrator in Integrator::ALL {
        for speed in [1.8, 20.0, 400.0] {
            let mut scene = scene(vec![rectangle([2.0, 2.01], [-9.0, 9.0])], blend("sph"));
            scene.integrator = integrator;
            scene.agents = vec![walker(
                Vector::zeros(),
                vector(speed, 0.0),
                vector(9.0, 0.0),
            )];
            let mut simulation = Simulation::new(scene).unwrap();
            run(&mut simulation, 200);
            let x = common::state(&simulation, 0).0.x;
            assert!(x < 2.0, "{integrator:?} at {speed} m/s: {x}");
        }
    }
}

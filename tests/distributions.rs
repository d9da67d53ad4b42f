//! Distributions of traits: draws follow them, truncation is exact, and agents have the traits that were drawn.

use crate::common::{bits, blend, go_to, run, scene, vector};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::distribution::{Distribution, Family};
use sandbox::engine::random::Purpose;
use sandbox::engine::scene::{SLOWEST_MAX_SPEED, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::engine::traits::Traits;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};
use statrs::distribution::{ContinuousCDF, Gamma, LogNormal, Normal};

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const COUNT: u32 = 4000;
/// The Kolmogorov–Smirnov statistic times √n at p = 0.01.
const CRITICAL: f64 = 1.628;

fn draws(family: &Family, bounds: [f64; 2]) -> Vec<f64> {
    let distribution = Distribution::new(family, bounds).unwrap();
    let draw = |agent| distribution.draw(7, Purpose::Premovement, agent);
    let mut draws: Vec<f64> = (0..COUNT).map(draw).collect();
    draws.sort_by(f64::total_cmp);
    draws
}

/// The Kolmogorov–Smirnov statistic of sorted draws, times √n.
fn deviation(draws: &[f64], cdf: impl Fn(f64) -> f64) -> f64 {
    let n = draws.len() as f64;
    let off = draws.iter().enumerate().map(|(k, &x)| {
        let (below, at) = (k as f64 / n, (k as f64 + 1.0) / n);
        (cdf(x) - below).max(at - cdf(x))
    });
    off.fold(0.0, f64::max) * n.sqrt()
}

#[test]
fn draws_follow_the_premovement_distributions_of_iso_20414() {
    let gamma = Gamma::new(1.291, 1.0 / 103.901).unwrap();
    let lognormal = LogNormal::new(4.586, 0.967).unwrap();
    let weibull = |x: f64| 1.0 - (-(x / 139.285).powf(1.195)).exp();
    let checks = [
        deviation(&draws(&Family::Uniform([10.0, 100.0]), ALL), |x| {
            (x - 10.0) / 90.0
        }),
        deviation(&draws(&Family::Gamma([1.291, 103.901]), ALL), |x| {
            gamma.cdf(x)
        }),
        deviation(&draws(&Family::LogNormal([4.586, 0.967]), ALL), |x| {
            lognormal.cdf(x)
        }),
        deviation(&draws(&Family::Weibull([139.285, 1.195]), ALL), weibull),
    ];
    assert!(checks.iter().all(|&check| check < CRITICAL), "{checks:?}");
}

#[test]
fn draws_follow_truncated_normal_and_exponential_distributions() {
    let normal = Normal::new(1.34, 0.26).unwrap();
    for [low, high] in [[0.5, 2.2], [1.2, 1.3], [2.0, 9.0], [-5.0, 0.8]] {
        let draws = draws(&Family::Normal([1.34, 0.26]), [low, high]);
        assert!(low <= draws[0] && draws[draws.len() - 1] <= high);
        let [from, to] = [low, high].map(|x| normal.cdf(x));
        let off = deviation(&draws, |x| (normal.cdf(x) - from) / (to - from));
        assert!(off < CRITICAL, "{low} to {high}: {off}");
    }
    let draws = draws(&Family::Exponential(20.0), [0.0, 50.0]);
    let cdf = |x: f64| (1.0 - (-x / 20.0).exp()) / (1.0 - (-2.5_f64).exp());
    assert!(deviation(&draws, cdf) < CRITICAL);
}

#[test]
fn a_log_normal_variable_has_the_mean_and_deviation_asked_for() {
    let distribution = Distribution::new(&Family::log_normal_with(60.0, 20.0), ALL).unwrap();
    let n = 1_000_000;
    let quantile = |k| distribution.quantile((f64::from(k) + 0.5) / f64::from(n));
    let mean = (0..n).map(quantile).sum::<f64>() / f64::from(n);
    let square = (0..n).map(|k| (quantile(k) - mean).powi(2)).sum::<f64>();
    let std = (square / f64::from(n)).sqrt();
    assert!((mean - 60.0).abs() < 0.01, "{mean}");
    assert!((std - 20.0).abs() < 0.02, "{std}");
}

#[test]
fn values_are_drawn_by_weight() {
    let values = Family::Values(vec![[40.0, 1.0], [20.0, 3.0], [30.0, 0.0]]);
    let draws = draws(&values, ALL);
    let twenty = draws.iter().filter(|&&x| x == 20.0).count();
    let forty = draws.iter().filter(|&&x| x == 40.0).count();
    assert_eq!(twenty + forty, draws.len());
    let share = twenty as f64 / draws.len() as f64;
    assert!((share - 0.75).abs() < 0.02, "{share}");
}

#[test]
fn speeds_by_age_fall_from_the_age_of_twenty_on() {
    let speed = |age: f64| {
        let of_age = Family::WeidmannAge([age, age]);
        Distribution::new(&of_age, [0.0, 100.0])
            .unwrap()
            .quantile(0.5)
    };
    assert!((speed(20.0) - 1.6).abs() < 1e-9 && (speed(80.0) - 0.7).abs() < 1e-9);
    let speeds: Vec<f64> = (20..=85).map(|age| speed(f64::from(age))).collect();
    assert!(speeds.windows(2).all(|pair| pair[1] < pair[0]));
    let draws = draws(&Family::WeidmannAge([20.0, 80.0]), [0.0, 100.0]);
    let mean = draws.iter().sum::<f64>() / f64::from(COUNT);
    assert!((mean - 1.32).abs() < 0.01, "{mean}"); // Weidmann's mean is 1.34 m/s
}

#[test]
fn quantiles_grow_and_stay_finite_up_to_the_ends() {
    for family in [
        Family::Normal([0.0, 1.0]),
        Family::LogNormal([0.0, 1.0]),
        Family::Weibull([1.0, 0.3]),
        Family::Gamma([0.2, 3.0]),
        Family::Exponential(1.0),
    ] {
        let distribution = Distribution::new(&family, ALL).unwrap();
        let shares = [1e-16, 1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9, 1.0 - 1e-16];
        let quantiles = shares.map(|u| distribution.quantile(u));
        assert!(quantiles.iter().all(|x| x.is_finite()), "{quantiles:?}");
        assert!(quantiles.is_sorted(), "{family:?}: {quantiles:?}");
    }
}

#[test]
fn extreme_parameters_give_draws_between_the_bounds_or_an_error() {
    let sizes = [1e-300, 1e-9, 1e-3, 0.7, 40.0, 1e4, 1e9, 1e300];
    let ends = [0.0, 1e-320, 1e-9, 1.0, 100.0, 1e9, f64::INFINITY];
    let mut known = 0;
    for (first, second) in sizes.into_iter().flat_map(|a| sizes.map(|b| (a, b))) {
        for family in [
            Family::Normal([first, second]),
            Family::LogNormal([first.ln(), second]),
            Family::log_normal_with(first, second),
            Family::Weibull([first, second]),
            Family::Gamma([first, second]),
            Family::Exponential(first),
        ] {
            for bounds in ends
                .into_iter()
                .flat_map(|low| ends.map(|high| [low, high]))
            {
                let Ok(distribution) = Distribution::new(&family, bounds) else {
                    continue;
                };
                known += 1;
                let draws = [1e-16, 0.3, 0.5, 1.0 - 1e-16].map(|u| distribution.quantile(u));
                let inside = draws.iter().all(|x| (bounds[0]..=bounds[1]).contains(x));
                assert!(
                    inside && draws.is_sorted(),
                    "{family:?} {bounds:?}: {draws:?}"
                );
            }
        }
    }
    assert!(known > 1000, "{known}");
}

fn crowd(traits: Traits) -> Scene {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.groups[0].traits = traits;
    let place = |k: u32| vector(0.0, 2.0 * f64::from(k));
    let goal = vector(500.0, 0.0);
    scene.agents = (0..50)
        .map(|k| NewAgent::at(place(k), goal + place(k), 0))
        .collect();
    scene
}

fn uniform(low: f64, high: f64) -> Option<Distribution> {
    Some(Distribution::new(&Family::Uniform([low, high]), [0.0, 1e9]).unwrap())
}

#[test]
fn agents_walk_at_their_own_speeds() {
    let mut simulation = Simulation::new(crowd(Traits {
        preferred_speed: uniform(0.5, 2.5),
        ..Traits::default()
    }))
    .unwrap();
    run(&mut simulation, 500);
    let agents = simulation.frame().agents;
    for i in 0..agents.len() {
        let (own, speed) = (agents.preferred_speed[i], agents.velocity[i].norm());
        assert!((speed - own).abs() < 1e-6, "{own} {speed}");
        assert_eq!(agents.max_speed[i], own * (1.8 / 1.4));
    }
    assert_eq!(simulation.outcome().clamped.count, 0);
}

#[test]
fn the_largest_speed_of_slow_agents_and_of_scenarios_is_bounded() {
    let mut scene = Scene::default();
    assert_eq!(scene.own_speeds(0.0), [0.0, SLOWEST_MAX_SPEED]);
    assert_eq!(scene.own_speeds(1.4), [1.4, 1.4 * (1.8 / 1.4)]);
    scene.max_speed_ratio = None;
    assert_eq!(scene.own_speeds(2.0), [2.0, scene.max_speed]);
}

#[test]
fn agents_start_to_walk_when_their_premovement_time_is_over() {
    let traits = Traits {
        premovement: uniform(0.0, 3.0),
        ..Traits::default()
    };
    let mut simulation = Simulation::new(crowd(traits)).unwrap();
    for _ in 0..170 {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        for i in 0..50 {
            let waits = frame.clock.time() < frame.agents.walks_from[i];
            let wish = frame.fields.preferred_velocity[i].norm();
            assert_eq!(wish == 0.0, waits);
            assert!(!waits || frame.agents.velocity[i].norm() == 0.0);
        }
        simulation.integrate().unwrap();
    }
    let starts = &simulation.frame().agents.walks_from;
    assert!(starts.iter().all(|start| (0.0..=3.0).contains(start)));
    assert!(simulation.frame().agents.velocity.iter().all(|v| v.x > 0.0));
}

#[test]
fn a_waiting_agent_is_pushed_and_comes_to_rest() {
    let mut scene = scene(Vec::new(), blend("sph"));
    let goal = vector(500.0, 0.0);
    let waiting = NewAgent {
        premovement: Some(100.0),
        ..NewAgent::at(vector(2.0, 0.05), goal, 0)
    };
    scene.agents = vec![waiting, NewAgent::at(vector(0.0, 0.0), goal, 0)];
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 500);
    let agents = simulation.frame().agents;
    let i = agents.index_of(0).unwrap();
    assert!((agents.position[i] - vector(2.0, 0.05)).norm() > 0.02);
    assert!(agents.velocity[i].norm() < 1e-3);
}

fn busy() -> Scene {
    let text = json!({
        "seed": 5, "goal": [30, 5], "preferred_speed": 1.2,
        "obstacles": [[[12, 0], [13, 0], [13, 4], [12, 4]], [[12, 5.2], [13, 5.2], [13, 10], [12, 10]]],
        "agents": [{"position": [0, 11], "preferred_speed": 0.9, "premovement_secs": 0.55}],
        "grids": [{"min": [0, 0], "max": [6, 6], "columns": 10, "rows": 10, "jitter": 0.1, "remove_within": 1,
                   "preferred_speed": {"normal": {"mean": 1.34, "std": 0.26, "min": 0.5, "max": 2.2}},
                   "radius": {"uniform": [0.2, 0.25]}, "premovement_secs": {"exponential": 1}}],
        "crowds": [{"area": [[7, 0], [11, 0], [11, 10], [7, 10]], "number": 50, "remove_within": 1}],
        "sources": [{"min": [0, 8], "max": [0, 9.5], "columns": 1, "rows": 3, "every_secs": 0.5, "remove_within": 1,
                     "preferred_speed": "weidmann_age"}]
    });
    Scenario::parse(&text.to_string(), "f", &[]).unwrap().scene
}

#[test]
fn traits_resume_bit_identically() {
    for profile in ["sph", "rvo->sph"] {
        let mut scene = busy();
        for group in &mut scene.groups {
            group.blend = blend(profile);
        }
        let mut whole = Simulation::new(scene.clone()).unwrap();
        let mut resumed = whole.clone();
        go_to(&mut whole, 160);
        for stop in [0, 3, 27, 60, 101] {
            go_to(&mut resumed, stop);
            let written = postcard::to_stdvec(&resumed.state()).unwrap();
            let state = postcard::from_bytes(&written).unwrap();
            resumed = Simulation::resumed(scene.clone(), state).unwrap();
        }
        go_to(&mut resumed, 160);
        assert!(bits(&whole) == bits(&resumed), "{profile}");
        let agents = resumed.frame().agents;
        assert_eq!(agents.preferred_speed.len(), agents.len());
        assert_eq!(agents.walks_from.len(), agents.len());
    }
}

#[test]
fn traits_do_not_depend_on_agents_that_are_added_later() {
    let [few, many] = [0, 3].map(|times| {
        let mut scene = busy();
        scene.sources[0].times = Some(times);
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.evaluate().unwrap();
        simulation
    });
    let traits = |simulation: &Simulation, id: u32| {
        let agents = simulation.frame().agents;
        let i = agents.index_of(id).unwrap();
        (
            agents.preferred_speed[i],
            agents.radius[i],
            agents.walks_from[i],
        )
    };
    let count = few.frame().agents.entered();
    assert!(many.frame().agents.entered() > count);
    for id in 0..count {
        assert_eq!(traits(&few, id), traits(&many, id));
    }
}

#[test]
fn scenes_without_traits_have_no_arrays_for_them() {
    let mut simulation = Simulation::new(crowd(Traits::default())).unwrap();
    run(&mut simulation, 20);
    let agents = simulation.frame().agents;
    assert!(agents.walk_alike() && agents.max_speed.is_empty());
}

/// The groups' traits of a scenario with this grid.
fn grid_traits(keys: Value) -> Traits {
    let mut grid = json!({"min": [0, 0], "max": [9, 9], "columns": 2, "rows": 2});
    grid.as_object_mut()
        .unwrap()
        .extend(keys.as_object().unwrap().clone());
    let text = json!({"goal": [5, 5], "grids": [grid]}).to_string();
    let scene = Scenario::parse(&text, "f", &[]).unwrap().scene;
    scene.groups[0].traits.clone()
}

#[test]
fn all_kinds_of_distributions_can_be_given() {
    let of = |family: Family, bounds| Some(Distribution::new(&family, bounds).unwrap());
    let (speeds, waits) = ([0.0, 100.0], [0.0, 1e7]);
    for (given, expected) in [
        (json!(1.5), of(Family::Constant(1.5), speeds)),
        (
            json!("weidmann_age"),
            of(Family::WeidmannAge([20.0, 80.0]), speeds),
        ),
        (
            json!({"weidmann_age": [20, 30]}),
            of(Family::WeidmannAge([20.0, 30.0]), speeds),
        ),
        (
            json!({"normal": {"mean": 1.2, "std": 0.2}}),
            of(Family::Normal([1.2, 0.2]), speeds),
        ),
    ] {
        assert_eq!(
            grid_traits(json!({"preferred_speed": given})).preferred_speed,
            expected
        );
    }
    for (given, expected) in [
        (
            json!({"lognormal": {"mean": 60, "std": 20}}),
            of(Family::log_normal_with(60.0, 20.0), waits),
        ),
        (
            json!({"lognormal": {"log_mean": 4.586, "log_std": 0.967, "max": 900}}),
            of(Family::LogNormal([4.586, 0.967]), [0.0, 900.0]),
        ),
        (
            json!({"weibull": {"scale": 139.285, "shape": 1.195, "min": 10}}),
            of(Family::Weibull([139.285, 1.195]), [10.0, 1e7]),
        ),
        (
            json!({"gamma": {"shape": 1.291, "scale": 103.901}}),
            of(Family::Gamma([1.291, 103.901]), waits),
        ),
        (
            json!({"exponential": 20}),
            of(Family::Exponential(20.0), waits),
        ),
        (
            json!({"exponential": {"mean": 20, "max": 60}}),
            of(Family::Exponential(20.0), [0.0, 60.0]),
        ),
        (
            json!({"values": [[20, 3], [40, 1]]}),
            of(Family::Values(vec![[20.0, 3.0], [40.0, 1.0]]), waits),
        ),
        (json!(null), None),
    ] {
        assert_eq!(
            grid_traits(json!({"premovement_secs": given})).premovement,
            expected
        );
    }
}

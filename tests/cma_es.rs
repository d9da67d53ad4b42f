//! CMA-ES: convergence, invariance and reproducibility.

use proptest::prelude::*;
use sandbox::analysis::cma_es::{CmaEs, reflected};

/// Evaluations until a value is below `target`; `None` after 40,000.
fn evaluations(
    start: &[f64],
    seed: u64,
    target: f64,
    function: impl Fn(&[f64]) -> f64,
) -> Option<usize> {
    let population = CmaEs::usual_population(start.len());
    let mut search = CmaEs::new(start, 0.5, population, seed);
    for generation in 1..=40_000 / population {
        let points = search.ask();
        let values: Vec<f64> = points.iter().map(|x| function(x)).collect();
        search.tell(&points, &values);
        if values.iter().any(|&value| value < target) {
            return Some(generation * population);
        }
    }
    None
}

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// Axes from 1 to 1000: condition number 10⁶.
fn ellipsoid(x: &[f64]) -> f64 {
    let last = (x.len() - 1) as f64;
    let term = |(k, x): (usize, &f64)| 1e6_f64.powf(k as f64 / last) * x * x;
    x.iter().enumerate().map(term).sum()
}

/// The vector reflected at a plane that is oblique to all axes: an orthogonal map.
fn turned(x: &[f64]) -> Vec<f64> {
    let normal: Vec<f64> = (0..x.len()).map(|k| 1.0 + k as f64).collect();
    let along: f64 = normal.iter().zip(x).map(|(n, x)| n * x).sum();
    let part = 2.0 * along / sphere(&normal);
    x.iter().zip(&normal).map(|(x, n)| x - part * n).collect()
}

fn rosenbrock(x: &[f64]) -> f64 {
    let term =
        |pair: &[f64]| 100.0 * (pair[1] - pair[0] * pair[0]).powi(2) + (1.0 - pair[0]).powi(2);
    x.windows(2).map(term).sum()
}

#[test]
fn it_finds_the_minima_of_smooth_functions() {
    for seed in 1..=3 {
        let start = [1.0; 6];
        assert!(evaluations(&start, seed, 1e-12, sphere).unwrap() < 2_000);
        assert!(evaluations(&start, seed, 1e-12, ellipsoid).unwrap() < 8_000);
        let start = [0.0; 6];
        assert!(evaluations(&start, seed, 1e-12, rosenbrock).unwrap() < 16_000);
        assert!(evaluations(&[1.0], seed, 1e-12, sphere).unwrap() < 1_000);
    }
}

#[test]
fn a_rotated_function_takes_as_many_evaluations() {
    let mean = |function: &dyn Fn(&[f64]) -> f64, start: &[f64]| -> f64 {
        let counts = (1..=10).map(|seed| evaluations(start, seed, 1e-9, function).unwrap() as f64);
        counts.sum::<f64>() / 10.0
    };
    let straight = mean(&ellipsoid, &[1.0; 6]);
    // `turned` is its own inverse: both searches start at the same place relative to the ellipsoid.
    let oblique = mean(&|x: &[f64]| ellipsoid(&turned(x)), &turned(&[1.0; 6]));
    assert!(
        (0.85..1.15).contains(&(oblique / straight)),
        "{oblique} {straight}"
    );
}

/// The points of the first generations.
fn points(start: &[f64], step: f64, function: impl Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    let mut search = CmaEs::new(start, step, 8, 5);
    let mut all = Vec::new();
    for _ in 0..30 {
        let points = search.ask();
        let values: Vec<f64> = points.iter().map(|x| function(x)).collect();
        search.tell(&points, &values);
        all.extend(points);
    }
    all
}

#[test]
fn only_the_order_of_values_matters() {
    let plain = points(&[1.0; 4], 0.5, ellipsoid);
    assert_eq!(points(&[1.0; 4], 0.5, |x| ellipsoid(x).sqrt() - 7.0), plain);
    assert_eq!(points(&[1.0; 4], 0.5, |x| ellipsoid(x).powi(3)), plain);
    assert_ne!(points(&[1.0; 4], 0.5, sphere), plain);
}

#[test]
fn a_scaled_space_gives_scaled_points() {
    // Powers of two: no rounding.
    let plain = points(&[1.0; 4], 0.5, ellipsoid);
    let scaled = points(&[8.0; 4], 4.0, |x| {
        ellipsoid(&x.iter().map(|x| x / 8.0).collect::<Vec<_>>())
    });
    let back = scaled.iter().map(|x| x.iter().map(|x| x / 8.0).collect());
    assert_eq!(back.collect::<Vec<Vec<f64>>>(), plain);
}

#[test]
fn values_that_are_no_numbers_are_the_worst() {
    let with = |bad: f64| {
        points(
            &[1.0; 3],
            0.5,
            move |x| if x[0] > 1.2 { bad } else { sphere(x) },
        )
    };
    assert_eq!(with(f64::NAN), with(f64::INFINITY));
    assert_eq!(with(-f64::NAN), with(f64::INFINITY));
    assert!(with(f64::NAN).iter().flatten().all(|x| x.is_finite()));
}

#[test]
fn the_spread_adapts_to_the_function() {
    let mut search = CmaEs::new(&[1.0, 1.0], 0.5, 10, 1);
    for _ in 0..80 {
        let points = search.ask();
        let value = |x: &Vec<f64>| x[0] * x[0] + 1e4 * x[1] * x[1];
        search.tell(&points, &points.iter().map(value).collect::<Vec<_>>());
    }
    let spread = search.spread();
    let ratio = spread[0] / spread[1];
    assert!((30.0..300.0).contains(&ratio), "{spread:?}");
}

#[test]
fn an_optimum_at_a_bound_is_found_by_reflection() {
    let mut search = CmaEs::new(&[0.5, 0.5], 0.2, 8, 1);
    for _ in 0..60 {
        let points = search.ask().into_iter();
        let points = points.map(|point| point.into_iter().map(reflected).collect());
        let points: Vec<Vec<f64>> = points.collect();
        let value = |x: &Vec<f64>| (x[0] - 1.0).powi(2) + (x[1] + 0.1).powi(2);
        search.tell(&points, &points.iter().map(value).collect::<Vec<_>>());
        assert!(search.mean().iter().all(|x| (0.0..=1.0).contains(x)));
    }
    let found = search.mean();
    assert!(found[0] > 0.999 && found[1] < 1e-3, "{found:?}");
}

proptest! {
    #[test]
    fn reflection_keeps_the_inside_and_is_continuous(
        x in -9.0..9.0_f64,
        step in 0.0..1e-3_f64,
        inside in 0.0..1.0_f64,
    ) {
        let at = reflected(x);
        prop_assert!((0.0..=1.0).contains(&at));
        prop_assert!((reflected(x + step) - at).abs() <= step + 1e-12);
        prop_assert!((reflected(-x) - at).abs() < 1e-12);
        prop_assert!((at - inside).abs() <= (x - inside).abs() + 1e-12);
        if (0.0..=1.0).contains(&x) {
            prop_assert_eq!(at, x);
        }
    }
}

//! Spectra of known oscillations: their frequency, their power and their sense of rotation are found again.

use std::f64::consts::{E, TAU};

use sandbox::analysis::oscillation::{Oscillation, Spectrum, correlation_length};
use serde_json::json;

use crate::common::simulated::{measured, scenario};

/// Time between two values, seconds.
const EVERY: f64 = 0.4;
/// Number of values: 140 s.
const COUNT: usize = 350;

/// Numbers from −1 to 1 that depend on `state` alone.
fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1);
    (*state >> 40) as f64 / (1_u64 << 23) as f64 - 1.0
}

/// The velocities of a circle (`along` = 1, counterclockwise; −1, clockwise) or a line (0) at frequency `omega`, rad/s,
/// with an amplitude of 0.1 m/s, a phase and noise.
fn series(omega: f64, along: f64, phase: f64, noise: f64) -> Vec<[f64; 2]> {
    let mut state = (1e6 * phase) as u64 + 1;
    let at = |n: usize| {
        let turn = omega * EVERY * n as f64 + phase;
        let [a, b] = [random(&mut state), random(&mut state)];
        [
            0.3 + 0.1 * turn.cos() + noise * a,
            -0.2 + 0.1 * along * turn.sin() + noise * b,
        ]
    };
    (0..COUNT).map(at).collect()
}

#[test]
fn the_frequency_of_a_sine_in_noise_is_found() {
    for omega in [0.2, 0.35, 0.51, 1.3] {
        let boxes: Vec<_> = (0..60)
            .map(|k| series(omega, 0.0, f64::from(k), 0.15))
            .collect();
        let found = Oscillation::of(&boxes, EVERY).unwrap();
        let off = found.peak.unwrap() - omega;
        assert!(
            off.abs() < 0.1 * found.spectrum.resolution,
            "{omega}: {off}"
        );
        // The sine has the power 0.005 m²/s², the noise 2 · 0.0075 m²/s².
        let share = found.peak_share().unwrap();
        assert!((share - 0.005 / 0.02).abs() < 0.03, "{omega}: {share}");
        let mean = found.spins.iter().sum::<f64>() / found.spins.len() as f64;
        assert!(mean.abs() < 0.1, "a line has no spin: {mean}");
    }
}

#[test]
fn the_spin_of_circles_is_their_sense() {
    let senses = [1.0, -1.0, 1.0, 1.0, -1.0, -1.0];
    let boxes: Vec<_> = senses
        .iter()
        .map(|&sense| series(0.35, sense, 0.4, 0.0))
        .collect();
    let found = Oscillation::of(&boxes, EVERY).unwrap();
    for (sense, spin) in senses.iter().zip(&found.spins) {
        assert!((sense - spin).abs() < 1e-3, "{sense}: {spin}");
    }
    // The rest is the mean of an incomplete circle, which is removed.
    assert!(found.peak_share().unwrap() > 0.99);
}

#[test]
fn an_ellipse_has_the_spin_of_its_axes() {
    // Axes a and b: P₊ − P₋ = a b and P₊ + P₋ = (a² + b²)/2.
    for b in [-0.9, -0.3, 0.0, 0.5] {
        let found = Spectrum::of(&series(0.35, b, 1.0, 0.0), EVERY).unwrap();
        let spin = found.spin(found.around(0.35)).unwrap();
        let expected = 2.0 * b / (1.0 + b * b);
        assert!((spin - expected).abs() < 2e-3, "{b}: {spin}, {expected}");
    }
}

#[test]
fn the_power_is_the_mean_square_of_velocities() {
    let mut state = 5;
    let noise = (0..COUNT).map(|_| [random(&mut state), 2.0 * random(&mut state)]);
    let noise: Vec<[f64; 2]> = noise.collect();
    let found = Spectrum::of(&noise, EVERY).unwrap();
    // By Parseval's theorem, with the weights of the window.
    let mean = [0, 1].map(|k| noise.iter().map(|v| v[k]).sum::<f64>() / COUNT as f64);
    let (mut sum, mut weights) = (0.0, 0.0);
    for (n, v) in noise.iter().enumerate() {
        let weight = (TAU / 2.0 * (n as f64 + 0.5) / COUNT as f64).sin().powi(4);
        sum += weight * ((v[0] - mean[0]).powi(2) + (v[1] - mean[1]).powi(2));
        weights += weight;
    }
    let off = found.power() / (sum / weights) - 1.0;
    assert!(off.abs() < 5e-3, "without the highest frequency: {off}");
}

#[test]
fn short_and_constant_series_have_no_peak() {
    assert_eq!(Spectrum::of(&[[1.0, 2.0]; 15], EVERY), None);
    assert_eq!(Oscillation::of(&[], EVERY), None);
    let still = Spectrum::of(&[[1.0, 2.0]; 100], EVERY).unwrap();
    assert!(still.power() < 1e-25);
}

#[test]
fn people_who_walk_to_and_fro_oscillate_as_often_as_they_turn() {
    // Between two points 8 m apart, turning within 0.5 m of them.
    let stages: Vec<&str> = ["east", "west"].into_iter().cycle().take(60).collect();
    let summary = measured(json!({
        "duration_secs": 120, "profile": "sph", "journeys": [{"name": "to and fro", "stages": stages}],
        "waypoints": [{"name": "west", "at": [-4, 0], "within": 0.5}, {"name": "east", "at": [4, 0], "within": 0.5}],
        "agents": [{"position": [0, 0], "journey": "to and fro"}],
        "measurements": [{"oscillation": {"region": [[-8, -2], [8, 2]], "box_size": 16, "from_secs": 10}}],
    }));
    let found: Oscillation = summary.data("oscillation").unwrap();
    let metric = |name: &str| summary.metric(name).unwrap();
    let speed = metric("oscillation_speed_m_per_s");
    assert!((1.2..1.4).contains(&speed), "{speed}");
    assert!(metric("oscillation_peak_share") > 0.7);
    assert!(metric("oscillation_spin").abs() < 0.01);
    // From one turn to the next: 7 m at 1.4 m/s, and 2τ = 1 s, since the velocity returns as −v + 2v e^(−t/τ).
    let (peak, expected) = (found.peak.unwrap(), TAU / (2.0 * (7.0 / 1.4 + 1.0)));
    assert!((peak / expected - 1.0).abs() < 0.02, "{peak}: {expected}");
}

#[test]
fn wrong_keys_are_refused() {
    for (keys, said) in [
        (
            json!({"region": [[0, 0], [5, 5]], "band": [0.4, 0.3]}),
            "f.json: measurements[0].oscillation.band: its end, 0.3, must be above its start, 0.4",
        ),
        (
            json!({"region": [[0, 0], [500, 500]], "box_size": 1}),
            "f.json: measurements[0].oscillation.box_size: the region has 250000 boxes; at most 10000 are allowed",
        ),
        (
            json!({"region": [[0, 0], [5, 5]], "from_secs": 5, "until_secs": 1}),
            "f.json: measurements[0].oscillation.until_secs: must not be before `from_secs`, 5, but is 1",
        ),
    ] {
        let document = json!({"measurements": [{"oscillation": keys}]});
        assert_eq!(scenario(&document, &[]).unwrap_err(), said);
    }
}

#[test]
fn the_correlation_length_of_known_fields_is_found() {
    let turning = |phase: f64| -> Vec<[f64; 2]> {
        let angles = (0..200).map(|n| 0.3 * f64::from(n) + phase);
        angles.map(|angle| [angle.cos(), angle.sin()]).collect()
    };
    let field = |wave: f64| -> Vec<Option<Vec<[f64; 2]>>> {
        (0..60)
            .map(|k| Some(turning(wave * f64::from(k % 20))))
            .collect()
    };
    let length = |field: &[_]| correlation_length(field, 20, [2.0, 2.0]).unwrap();
    // All together: as long as the longest row; an empty box changes nothing.
    assert_eq!(length(&field(0.0)), 38.0);
    let mut holed = field(0.0);
    holed[7] = None;
    assert!((length(&holed) - 38.0).abs() < 1e-9);
    // A wave: the correlation at a distance d is cos(q d), with q per box. Columns all move alike.
    let single: Vec<_> = field(0.25).into_iter().take(20).collect();
    let expected = 2.0 * (1.0 / E).acos() / 0.25;
    let found = length(&single);
    assert!(
        (found - expected).abs() < 0.1,
        "{found} instead of {expected}"
    );
    assert_eq!(correlation_length(&[], 1, [2.0, 2.0]), None);
}

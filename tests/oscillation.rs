//! Spectra of known oscillations: their frequency, their power and their sense of rotation are found again.

use std::f64::consts::{E, TAU};

use sandbox::analysis::oscillation::{Oscillation, Spectrum, correlation_lengths};
use sandbox::runs::drive::Run;
use sandbox::runs::summary::Summary;
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
            .map(|k| Some(series(omega, 0.0, f64::from(k), 0.15)))
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
        let spins = found.spins.iter().map(|spin| spin.unwrap());
        let mean = spins.sum::<f64>() / found.spins.len() as f64;
        assert!(mean.abs() < 0.1, "a line has no spin: {mean}");
    }
}

#[test]
fn the_spin_of_circles_is_their_sense() {
    let senses = [1.0, -1.0, 1.0, 1.0, -1.0, -1.0].map(Some);
    // A box that was empty at some time keeps its place among the others.
    let senses: Vec<Option<f64>> = senses.into_iter().chain([None, Some(1.0)]).collect();
    let boxes = senses
        .iter()
        .map(|sense| Some(series(0.35, (*sense)?, 0.4, 0.0)));
    let boxes: Vec<_> = boxes.collect();
    let found = Oscillation::of(&boxes, EVERY).unwrap();
    assert_eq!(found.spins.len(), senses.len());
    for (sense, spin) in senses.iter().zip(&found.spins) {
        let off = sense.zip(*spin).map(|(sense, spin)| sense - spin);
        assert!(
            off.is_none_or(|off| off.abs() < 1e-3),
            "{sense:?}: {spin:?}"
        );
        assert_eq!(sense.is_some(), spin.is_some());
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
fn spectra_that_are_flat_or_fall_have_no_peak() {
    // A crowd that comes to rest, and a circle with one turn: the power falls from two resolutions on.
    let decay = |n: usize| (-0.1 * EVERY * n as f64).exp();
    let rest: Vec<[f64; 2]> = (0..COUNT).map(|n| [decay(n), 0.5 * decay(n)]).collect();
    assert_eq!(Spectrum::of(&rest, EVERY).unwrap().peak(), None);
    let noise = |seed: usize| {
        let mut state = seed as u64;
        let noise = (0..COUNT).map(|_| [random(&mut state), random(&mut state)]);
        Some(noise.collect())
    };
    let noise: Vec<_> = (1..500).map(noise).collect();
    assert_eq!(Oscillation::of(&noise, EVERY).unwrap().peak, None);
    let secs = COUNT as f64 * EVERY;
    let slow =
        |turns: f64| Spectrum::of(&series(turns * TAU / secs, 1.0, 0.3, 0.0), EVERY).unwrap();
    assert_eq!(slow(1.0).peak(), None);
    let found = slow(3.4).peak().unwrap() * secs / TAU;
    assert!((found - 3.4).abs() < 0.1, "{found} turns");
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
    let lengths = |field: &[_]| correlation_lengths(field, 20, [2.0, 3.0]);
    let close = |found: [Option<f64>; 2], expected: [f64; 2]| {
        let off = [0, 1].map(|k| found[k].unwrap() - expected[k]);
        assert!(
            off.iter().all(|off| off.abs() < 0.1),
            "{found:?} instead of {expected:?}"
        );
    };
    // All together: as long as rows and columns; an empty box changes nothing.
    close(lengths(&field(0.0)), [38.0, 6.0]);
    let mut holed = field(0.0);
    holed[7] = None;
    close(lengths(&holed), [38.0, 6.0]);
    // A wave along x: the correlation at a distance d is cos(q d), with q per box.
    let quarter = 2.0 * (1.0 / E).acos() / 0.25;
    close(lengths(&field(0.25)), [quarter, 6.0]);
    // One row has no distances along y, one box none at all.
    let row: Vec<_> = field(0.25).into_iter().take(20).collect();
    let [along, across] = lengths(&row);
    assert!((along.unwrap() - quarter).abs() < 0.1 && across.is_none());
    assert_eq!(correlation_lengths(&row[..1], 1, [2.0, 2.0]), [None, None]);
    assert_eq!(correlation_lengths(&[], 1, [2.0, 2.0]), [None, None]);
    // Where people move as one, boxes without people say nothing: neither between two others nor around them.
    let gap = [Some(turning(0.0)), None, Some(turning(0.0))];
    assert_eq!(correlation_lengths(&gap, 3, [2.0, 2.0]), [Some(4.0), None]);
    let corner = (0..100).map(|k| (k % 10 < 5 && k / 10 < 5).then(|| turning(0.0)));
    let corner: Vec<_> = corner.collect();
    assert_eq!(correlation_lengths(&corner, 10, [2.0, 2.0]), [Some(8.0); 2]);
}

#[test]
fn spectra_of_times_too_short_for_their_band_get_a_note() {
    let over = |from: f64, until: Option<f64>, low: f64| {
        let mut oscillation =
            json!({"region": [[0, 0], [12, 10]], "from_secs": from, "band": [low, 1.0]});
        if let Some(until) = until {
            oscillation["until_secs"] = json!(until);
        }
        let document = json!({
            "duration_secs": 120, "agents": [{"position": [5, 5], "goal": [5, 5]}],
            "measurements": [{"oscillation": oscillation}],
        });
        scenario(&document, &[]).unwrap().notes
    };
    // Two turns of 0.3 rad/s take 42 s.
    assert_eq!(over(78.0, None, 0.3), [""; 0]);
    assert_eq!(over(20.0, Some(62.0), 0.3), [""; 0]);
    for short in [
        over(79.0, None, 0.3),
        over(20.0, Some(61.0), 0.3),
        over(0.0, None, 0.1),
    ] {
        let said = &short[0];
        assert!(
            said.starts_with("measurements[0].oscillation: in "),
            "{said}"
        );
    }
    assert!(
        over(79.0, None, 0.3)[0]
            .contains("from 0.31 rad/s on, and `band` begins at 0.3: measure for at least 42 s")
    );
}

#[test]
fn the_speed_is_the_root_mean_square_without_a_window() {
    // A push at the start: a Hann window hides it, or shows nothing else.
    let document = json!({
        "duration_secs": 20, "profile": "sph", "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "waiting_areas": [{"name": "square", "area": [[0, 0], [8, 0], [8, 6], [0, 6]]}],
        "journeys": [{"name": "stay", "stages": ["square"]}],
        "crowds": [{"area": [[0.3, 0.3], [7.7, 0.3], [7.7, 5.7], [0.3, 5.7]], "number": 90, "journey": "stay"}],
        "events": [{"at_secs": 2, "for_secs": 1, "region": [[0, 0], [2, 6]],
                    "acceleration": [[0, 0], [0.2, 6], [0.8, 6], [1, 0]]}],
        "measurements": [{"oscillation": {"name": "all", "region": [[0, 0], [8, 6]]}},
                         {"oscillation": {"name": "start", "region": [[0, 0], [8, 6]], "until_secs": 6.4}}],
    });
    let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    // The mean velocities in 4 × 3 boxes every 0.4 s.
    let mut series: Vec<Vec<Option<[f64; 2]>>> = vec![Vec::new(); 12];
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        run.measure();
        let frame = run.simulation.frame();
        if frame.clock.frame().is_multiple_of(20) {
            let mut sums = [(0.0, [0.0; 2]); 12];
            for i in frame.agents.present() {
                let (r, v) = (frame.agents.position[i], frame.agents.velocity[i]);
                let place = |x: f64, most: usize| ((x / 2.0) as usize).min(most);
                let (count, sum) = &mut sums[4 * place(r.y, 2) + place(r.x, 3)];
                *count += 1.0;
                *sum = [sum[0] + v.x, sum[1] + v.y];
            }
            for (box_, (count, sum)) in series.iter_mut().zip(sums) {
                box_.push((count > 0.0).then(|| sum.map(|x| x / count)));
            }
        }
        run.simulation.integrate().unwrap();
    }
    let summary = Summary::of(&run);
    for (name, count) in [("all", 51), ("start", 17)] {
        let boxes = series
            .iter()
            .map(|of| of[..count].iter().copied().collect::<Option<Vec<_>>>());
        let (mut sum, mut times) = (0.0, 0.0);
        for velocities in boxes.flatten() {
            for k in 0..2 {
                let mean = velocities.iter().map(|v| v[k]).sum::<f64>() / count as f64;
                sum += velocities
                    .iter()
                    .map(|v| (v[k] - mean).powi(2))
                    .sum::<f64>();
            }
            times += count as f64;
        }
        let expected = (sum / times).sqrt();
        let found = summary.metric(&format!("{name}_speed_m_per_s")).unwrap();
        assert!(
            (found - expected).abs() < 1e-9,
            "{name}: {found}, not {expected}"
        );
    }
}

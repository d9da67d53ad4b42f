//! The speed of waves, found again in synthetic space-time diagrams.

use sandbox::analysis::wave::{Run, SpaceTime, Strip, measure};

const RUN: Run = Run {
    start: 150.0,
    source: 55.5,
    obstacle: 80.0,
};

/// A pulse that runs at `speed` and returns at `back`, scaled by `reflection`, in a slowly advancing crowd.
fn synthetic(speed: f64, back: f64, reflection: f64, noise: f64) -> SpaceTime {
    let strip = Strip {
        x: [45.0, 80.0],
        half_width: 8.0,
        bin: 0.5,
    };
    let mut diagram = SpaceTime::new(strip);
    let pulse = |t: f64| (-0.5 * (t / 0.15).powi(2)).exp();
    let hits = 150.3 + (80.0 - 55.5) / speed;
    let mut state = 1u64;
    for row in 0..300 {
        let t = 149.0 + 0.04 * f64::from(row);
        diagram.times.push(t);
        for bin in 0..strip.bins() {
            let x = strip.middle(bin);
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            let random = (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
            let there = pulse(t - 150.3 - (x - 55.5) / speed);
            let again = pulse(t - hits - (80.0 - x) / back);
            let v = 0.2 + 0.5 * (there - reflection * again) + noise * random;
            diagram.velocity.push(Some(v));
            diagram.speed.push(Some(v.abs()));
        }
    }
    diagram
}

#[test]
fn a_known_wave_is_found_again() {
    for (speed, back) in [(6.0, 6.0), (10.5, 10.0), (21.0, 18.0)] {
        let wave = measure(&synthetic(speed, back, 0.6, 0.0), &RUN).unwrap();
        let returning = wave.returning.unwrap();
        assert!((wave.arriving.speed.value / speed - 1.0).abs() < 0.01);
        assert!((returning.speed.value / back - 1.0).abs() < 0.02);
        assert!((wave.amplitude.value / 0.5 - 1.0).abs() < 0.03);
        assert!((wave.reflection.unwrap().value - 0.6).abs() < 0.03);
    }
}

#[test]
fn the_error_covers_what_noise_does() {
    let wave = measure(&synthetic(10.5, 10.0, 0.6, 0.1), &RUN).unwrap();
    let speed = wave.arriving.speed;
    assert!(speed.error > 0.0 && speed.error < 0.3, "{speed:?}");
    assert!((speed.value - 10.5).abs() < 4.0 * speed.error, "{speed:?}");
}

#[test]
fn nothing_is_found_where_nothing_runs() {
    let mut still = synthetic(10.0, 10.0, 0.6, 0.1);
    still.velocity.fill(Some(0.2));
    assert_eq!(measure(&still, &RUN), None);
    // Diagrams with hardly any times, as of a run that ends early.
    for times in 0..4 {
        let mut short = synthetic(10.0, 10.0, 0.6, 0.1);
        short.times.truncate(times);
        short.velocity.truncate(times * short.strip.bins());
        assert_eq!(measure(&short, &RUN), None, "{times}");
    }
}

#[test]
fn a_wave_that_is_swallowed_has_no_reflection() {
    let wave = measure(&synthetic(10.0, 10.0, 0.0, 0.02), &RUN).unwrap();
    assert_eq!(wave.reflection, None);
}

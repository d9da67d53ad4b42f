//! The colors of forces can be told apart, also by color-blind readers.

use sandbox::engine::profile::Term;
use sandbox::output::colors::{ColorMap, Rgb, TERMS};

type Matrix = [[f64; 3]; 3];

/// Machado, Oliveira and Fernandes 2009, severity 1.0, for linear RGB.
const VISIONS: [(&str, Matrix); 3] = [
    (
        "normal",
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ),
    (
        "protanopia",
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
    ),
    (
        "deuteranopia",
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
    ),
];

/// From linear sRGB to CIE XYZ with white D65.
const TO_XYZ: Matrix = [
    [0.4124564, 0.3575761, 0.1804375],
    [0.2126729, 0.7151522, 0.0721750],
    [0.0193339, 0.1191920, 0.9503041],
];

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// CIE L*a*b* of a color as it is seen.
fn lab(color: Rgb, vision: &Matrix) -> [f64; 3] {
    let linear = color.map(|value| {
        let value = f64::from(value) / 255.0;
        match value <= 0.04045 {
            true => value / 12.92,
            false => ((value + 0.055) / 1.055).powf(2.4),
        }
    });
    let seen = times(vision, linear).map(|value| value.clamp(0.0, 1.0));
    let (xyz, white) = (times(&TO_XYZ, seen), times(&TO_XYZ, [1.0; 3]));
    let f = |k: usize| {
        let part = xyz[k] / white[k];
        match part > 216.0 / 24389.0 {
            true => part.cbrt(),
            false => (24389.0 / 27.0 * part + 16.0) / 116.0,
        }
    };
    let [x, y, z] = [f(0), f(1), f(2)];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIE76.
fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

#[test]
fn color_differences_are_those_of_the_definition() {
    let normal = &VISIONS[0].1;
    let [white, black, red] = [[255; 3], [0; 3], [255, 0, 0]].map(|color| lab(color, normal));
    assert!((difference(white, black) - 100.0).abs() < 1e-3);
    // sRGB red: L* 53.24, a* 80.09, b* 67.20.
    assert!(difference(red, [53.24, 80.09, 67.20]) < 0.02, "{red:?}");
    // Red and green of equal lightness are hard to tell apart without red or green cones.
    let confused = [[200, 60, 40], [108, 108, 40]];
    let of = |k: usize| {
        let [a, b] = confused.map(|color| lab(color, &VISIONS[k].1));
        difference(a, b)
    };
    assert!(of(2) < 0.5 * of(0));
}

#[test]
fn every_two_colors_of_forces_differ_by_20_for_normal_and_for_color_blind_vision() {
    assert!(TERMS.len() >= Term::ALL.len() + 3);
    let colors = TERMS.iter().map(|&(name, color)| (name, color));
    let all: Vec<_> = colors.chain([("white", [255; 3])]).collect();
    for (vision, matrix) in &VISIONS {
        for (k, (name, color)) in all.iter().enumerate() {
            let own = lab(*color, matrix);
            assert!(own[0] > 40.0, "{name} is dark on dark ground: {own:?}");
            for (other, another) in &all[..k] {
                let apart = difference(own, lab(*another, matrix));
                assert!(
                    apart >= 20.0,
                    "{vision}: {name} and {other} differ by {apart:.1}"
                );
            }
        }
    }
}

#[test]
fn speeds_can_be_seen_on_dark_ground_and_grow_lighter() {
    let map = ColorMap::bright_inferno([0.0, 1.0]);
    let light = |k: u8| lab(map.color(f32::from(k) / 20.0), &VISIONS[0].1)[0];
    let all: Vec<f64> = (0..=20).map(light).collect();
    assert!(all[0] > 15.0 && all.is_sorted(), "{all:?}");
}

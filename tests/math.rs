//! Unit vectors, checks of many numbers at once, and powers of two in single precision.

use sandbox::engine::math::{Vector, are_finite, unit_vector};
use sandbox::engine::pairs::prelude::*;
use sandbox::engine::pairs::{Real, dispatch, f32x8, level};

#[test]
fn unit_vectors_are_the_cosines_and_sines_of_their_turns() {
    for k in 0..100_000_u32 {
        let turn = k.wrapping_mul(2_654_435_761);
        let v = unit_vector(turn);
        let angle = f64::from(turn) / 2_f64.powi(32) * std::f64::consts::TAU;
        assert!((v - Vector::new(angle.cos(), angle.sin())).norm() < 2e-15);
        assert!((v.norm() - 1.0).abs() < 1e-15);
    }
    let quarters = [0, 1, 2, 3].map(|quarter| unit_vector(quarter << 30));
    assert_eq!(
        quarters,
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Vector::from)
    );
}

#[test]
fn one_number_that_is_none_is_seen_among_many() {
    let mut numbers = vec![1e300; 99];
    assert!(are_finite(&numbers) && are_finite::<f64>(&[]));
    let mut vectors = vec![Vector::new(-1e300, 0.0); 99];
    assert!(are_finite(&vectors) && are_finite::<Vector>(&[]));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        numbers[57] = bad;
        vectors[57].y = bad;
        assert!(!are_finite(&numbers) && !are_finite(&vectors));
    }
}

#[test]
fn powers_of_two_are_right_to_the_last_bits() {
    for k in 0..100_000 {
        let x = -1e-3 * f64::from(k) as f32;
        let power = dispatch!(level(), simd => {
            <f32 as Real>::exp2(simd, f32x8::splat(simd, x))[3]
        });
        let exact = f64::from(x).exp2();
        assert!((f64::from(power) / exact - 1.0).abs() < 3e-7, "{x}");
    }
    let far = dispatch!(level(), simd => {
        <f32 as Real>::exp2(simd, f32x8::splat(simd, -1e9))[0]
    });
    assert!((0.0..=f32::MIN_POSITIVE).contains(&far));
}

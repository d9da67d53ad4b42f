//! Statistics against closed forms and integrals.

use sandbox::analysis::statistics::{Estimate, Line, MeanStd, Range, jackknife, student_95};

/// The probability of [−t, t] under Student's distribution with ν degrees of freedom, by Simpson's rule in
/// t = √ν tan φ, where the density is proportional to cos^(ν − 1) φ.
fn coverage(degrees: i32, t: f64) -> f64 {
    const STEPS: u32 = 2000;
    let integral = |end: f64| {
        let step = end / f64::from(STEPS);
        let weight = |k: u32| match k {
            0 | STEPS => 1.0,
            k if k.is_multiple_of(2) => 2.0,
            _ => 4.0,
        };
        let density = |k: u32| (f64::from(k) * step).cos().max(0.0).powi(degrees - 1);
        (0..=STEPS).map(|k| weight(k) * density(k)).sum::<f64>() * step / 3.0
    };
    integral((t / f64::from(degrees).sqrt()).atan()) / integral(std::f64::consts::FRAC_PI_2)
}

#[test]
fn ninety_five_per_cent_of_students_distribution_lie_within() {
    for count in (2..40).chain([100, 1000]) {
        let t = student_95(count).unwrap();
        let covered = coverage(count as i32 - 1, t);
        assert!((covered - 0.95).abs() < 1e-9, "{count}: {covered}");
    }
}

#[test]
fn the_deviation_of_a_sample_is_larger_than_that_of_the_population() {
    let of = MeanStd::of(&[1.0, 2.0, 3.0]).unwrap();
    assert_eq!((of.mean, of.std(), of.count), (2.0, Some(1.0), 3));
    assert_eq!(of.population_std(), (2.0_f64 / 3.0).sqrt());
    assert_eq!(MeanStd::of(&[]), None);
}

#[test]
fn a_single_value_tells_nothing_about_its_spread() {
    let single = MeanStd::of(&[4.0]).unwrap();
    assert_eq!((single.std(), single.interval_95()), (None, None));
    assert_eq!((single.error(), single.population_std()), (0.0, 0.0));
    assert_eq!([student_95(0), student_95(1)], [None, None]);
}

#[test]
fn values_may_come_one_by_one() {
    let values = [3.0, -1.0, 4.0, 1.5, 9.0];
    let mut running = MeanStd::default();
    values.iter().for_each(|&value| running.add(value));
    let of = MeanStd::of(&values).unwrap();
    assert!((running.mean - of.mean).abs() < 1e-14);
    assert!((running.error() - of.error()).abs() < 1e-14);
}

#[test]
fn the_median_of_an_even_number_lies_between_two() {
    let range = Range::of(&[4.0, 1.0, 10.0, 2.0]);
    assert_eq!(
        (range.minimum, range.median, range.maximum),
        (1.0, 3.0, 10.0)
    );
    assert_eq!(Range::of(&[7.0, 1.0, 2.0]).median, 2.0);
    let none = Range::of(&[]);
    assert!(none.minimum.is_nan() && none.median.is_nan() && none.maximum.is_nan());
}

#[test]
fn ratios_are_taken_run_by_run() {
    // A machine that is half as fast in the second run changes no ratio.
    let ratios = Range::of_ratios(&[3.0, 6.0], &[2.0, 4.0]);
    assert_eq!((ratios.minimum, ratios.maximum), (1.5, 1.5));
}

#[test]
fn a_line_is_found_again() {
    let points: Vec<(f64, f64)> = (0..9)
        .map(|k| (f64::from(k), 3.0 - 0.5 * f64::from(k)))
        .collect();
    let line = Line::through(&points).unwrap();
    assert!((line.slope + 0.5).abs() < 1e-12 && (line.at(4.0) - 1.0).abs() < 1e-12);
    assert_eq!(Line::through(&[(1.0, 2.0), (1.0, 3.0)]), None);
}

#[test]
fn the_jackknife_of_a_mean_is_its_standard_error() {
    let values = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
    let average = |v: &[f64]| Estimate::of_mean(v).map(|m| m.value);
    let estimate = jackknife(&values, average).unwrap();
    let expected = Estimate::of_mean(&values).unwrap();
    assert!((estimate.error - expected.error).abs() < 1e-12);
}

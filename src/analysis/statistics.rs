//! Confidence of a mean over seeds: Student's t.

/// Half-width of the 95 % confidence interval of a mean of `values` values, in standard errors of the mean: the 97.5 %
/// quantile of Student's t with `values` − 1 degrees of freedom, accurate to 1e-5. `None` for fewer than two values,
/// which have no sample standard deviation.
pub fn student_95(values: usize) -> Option<f64> {
    const TABLE: [f64; 10] = [
        12.706_205, 4.302_653, 3.182_446, 2.776_445, 2.570_582, 2.446_912, 2.364_624, 2.306_004,
        2.262_157, 2.228_139,
    ];
    let degrees = values.checked_sub(2)?;
    Some(match TABLE.get(degrees) {
        Some(&quantile) => quantile,
        None => expansion((degrees + 1) as f64),
    })
}

/// The same quantile as a series in 1/ν for ν degrees of freedom (Abramowitz & Stegun 26.7.5).
fn expansion(degrees: f64) -> f64 {
    /// 97.5 % quantile of the normal distribution.
    const Z: f64 = 1.959_963_984_540_054;
    let z = |power: i32| Z.powi(power);
    let terms = [
        (z(3) + Z) / 4.0,
        (5.0 * z(5) + 16.0 * z(3) + 3.0 * Z) / 96.0,
        (3.0 * z(7) + 19.0 * z(5) + 17.0 * z(3) - 15.0 * Z) / 384.0,
        (79.0 * z(9) + 776.0 * z(7) + 1482.0 * z(5) - 1920.0 * z(3) - 945.0 * Z) / 92_160.0,
    ];
    let nested = terms
        .iter()
        .rev()
        .fold(0.0, |sum, term| (sum + term) / degrees);
    Z + nested
}

/// Mean and population standard deviation; `None` if there are no values.
pub fn mean_and_deviation(values: &[f64]) -> Option<(f64, f64)> {
    if values.is_empty() {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / count;
    Some((mean, variance.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deviation_is_that_of_the_population() {
        assert_eq!(mean_and_deviation(&[1.0, 3.0]), Some((2.0, 1.0)));
        assert_eq!(mean_and_deviation(&[]), None);
    }

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
        for values in (2..40).chain([100, 1000]) {
            let t = student_95(values).unwrap();
            let covered = coverage(values as i32 - 1, t);
            assert!((covered - 0.95).abs() < 1e-6, "{values}: {covered}");
        }
    }

    #[test]
    fn a_single_value_tells_nothing_about_its_spread() {
        assert_eq!(student_95(0), None);
        assert_eq!(student_95(1), None);
    }
}

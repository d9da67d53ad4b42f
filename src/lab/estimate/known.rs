//! What the runs of a result say about those of others.

use super::limit::REFERENCE_STEP;
use super::prior::{Known, Quantity};
use super::series::Means;

impl Known {
    /// From the runs of a result; `None` if its value or its spread is 0, or if its name says no quantity.
    pub fn of([scene, profile]: &[String; 2], result: &str, means: &Means) -> Option<Self> {
        Quantity::of(result)?;
        let levels = &means.levels;
        let runs: f64 = levels.iter().map(|level| level.runs as f64).sum();
        let mean = |of: &dyn Fn(usize) -> f64| -> f64 {
            let parts = levels.iter().enumerate();
            parts
                .map(|(k, level)| level.runs as f64 * of(k))
                .sum::<f64>()
                / runs
        };
        let x = |k: usize| levels[k].step / REFERENCE_STEP;
        let (middle, value) = (mean(&x), mean(&|k| levels[k].mean));
        let square = mean(&|k| (x(k) - middle).powi(2));
        let product = mean(&|k| (x(k) - middle) * (levels[k].mean - value));
        let own = means.variance.sqrt();
        let limit = value - middle * if square > 0.0 { product / square } else { 0.0 };
        let known = Self {
            scene: scene.clone(),
            profile: profile.clone(),
            result: result.to_owned(),
            spread: own / limit.abs(),
            degrees: means.own_degrees,
            error: if square > 0.0 {
                product / square / own
            } else {
                0.0
            },
            error_std: (square > 0.0).then(|| 1.0 / (runs * square).sqrt()),
        };
        (known.spread > 0.0 && known.spread.is_finite()).then_some(known)
    }
}

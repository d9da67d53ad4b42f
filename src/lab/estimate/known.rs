//! What the runs of a result say about those of others.

use super::limit::{Level, REFERENCE_STEP};
use super::prior::Known;
use super::question::Question;
use super::series::Means;

impl Known {
    /// From the runs of a result; `None` if its value or its spread is 0, or if it is not about a known quantity.
    pub fn of(question: &Question, result: &str, means: &Means) -> Option<Self> {
        let quantity = question.quantity(result)?;
        let runs: f64 = means.levels.iter().map(|level| level.runs as f64).sum();
        let mean = |of: &dyn Fn(&Level) -> f64| -> f64 {
            let parts = means
                .levels
                .iter()
                .map(|level| level.runs as f64 * of(level));
            parts.sum::<f64>() / runs
        };
        let x = |level: &Level| level.step / REFERENCE_STEP;
        let (middle, value) = (mean(&x), mean(&|level| level.mean));
        let square = mean(&|level| (x(level) - middle).powi(2));
        let product = mean(&|level| (x(level) - middle) * (level.mean - value));
        let slope = if square > 0.0 { product / square } else { 0.0 };
        let own = means.variance.sqrt();
        let limit = value - middle * slope;
        let [scene, profile] = question.title.clone();
        let known = Self {
            scene,
            profile,
            result: result.to_owned(),
            quantity,
            spread: own / limit.abs(),
            degrees: means.own_degrees,
            error: slope / own,
            error_std: (square > 0.0).then(|| 1.0 / (runs * square).sqrt()),
        };
        (known.spread > 0.0 && known.spread.is_finite()).then_some(known)
    }
}

//! The errors of measurements, averaged over seeds: Table 1's numbers, speed by density, and the speed of a wave.

use super::results::{Judged, Measured, Quantity};
use analysis::statistics::MeanStd;
use runs::summary::Summary;

/// The metrics that are reported, with their names and units.
const METRICS: [(&str, &str, &str); 4] = [
    ("density_mean_15s", "density at 15 s", "P/m²"),
    ("density_std_15s", "its deviation", "P/m²"),
    ("flow_per_s", "flow", "P/s"),
    ("wave_speed_m_per_s", "wave speed", "m/s"),
];
/// The names of a fundamental diagram's metrics begin with this. Their root mean square is reported.
const DIAGRAM: &str = "speed_at_";

/// Compares the runs of each point, one per seed, with those of the reference.
pub(super) fn judge<'a>(
    points: impl Iterator<Item = &'a [Summary]>,
    reference: &[Summary],
    notes: String,
) -> Judged {
    let first = reference.first().map(|run| &run.metrics);
    let metrics = || first.into_iter().flat_map(|metrics| metrics.keys());
    let single = METRICS.into_iter().filter_map(|(metric, name, unit)| {
        let metric = metrics().find(|measured| *measured == metric)?;
        Some(((name, unit), vec![metric]))
    });
    let bins: Vec<&String> = metrics().filter(|name| name.starts_with(DIAGRAM)).collect();
    let diagram = (!bins.is_empty()).then_some((("speed by density", "m/s"), bins));
    let (names, metrics): (Vec<_>, Vec<_>) = single.chain(diagram).unzip();
    let quantities = names.into_iter().map(|(name, unit)| Quantity {
        name: name.to_owned(),
        unit,
    });
    let errors = |runs: &[Summary]| {
        let errors = metrics.iter().map(|of| deviation(of, runs, reference));
        errors.collect()
    };
    Judged {
        quantities: quantities.collect(),
        errors: points.map(errors).collect(),
        notes,
    }
}

/// The root mean square over some metrics of their means and deviations from the reference.
fn deviation(metrics: &[&String], runs: &[Summary], reference: &[Summary]) -> Option<Measured> {
    let of = |metric: &str, runs: &[Summary]| -> Vec<f64> {
        runs.iter().filter_map(|run| run.metric(metric)).collect()
    };
    let found = metrics
        .iter()
        .filter_map(|metric| Measured::between(&of(metric, runs), &of(metric, reference)));
    let found: Vec<Measured> = found.collect();
    let mean_square = |of: fn(&Measured) -> f64| {
        let squares = found.iter().map(|one| of(one).powi(2));
        (squares.sum::<f64>() / found.len() as f64).sqrt()
    };
    (!found.is_empty()).then(|| Measured {
        mean: Some((
            mean_square(|one| one.mean.map_or(0.0, |(mean, _)| mean)),
            mean_square(|one| one.mean.map_or(0.0, |(_, interval)| interval)),
        )),
        error: mean_square(|one| one.error),
        interval: mean_square(|one| one.interval),
    })
}

impl Measured {
    /// The mean of some values, and its distance from that of the reference.
    pub fn between(values: &[f64], reference: &[f64]) -> Option<Self> {
        let (own, other) = (MeanStd::of(values)?, MeanStd::of(reference)?);
        let [interval, beside] = [own, other].map(|of| of.interval_95().unwrap_or(0.0));
        Some(Self {
            mean: Some((own.mean, interval)),
            error: (own.mean - other.mean).abs(),
            interval: interval.hypot(beside),
        })
    }
}

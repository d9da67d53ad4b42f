//! The statistics of a run: Table 1's numbers, speed by density, and the speed of a wave, each over seeds.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::scenes::{CORRIDOR, Kind, PUSH, scenario};
use crate::analysis::statistics::MeanStd;
use crate::analysis::wave::{self, Run, SpaceTime, Strip};
use crate::engine::simulation::{Fault, Simulation};
use crate::lab::error::LabError;
use crate::runs::drive::{Then, drive, unless_over};
use crate::scenario::Scenario;
use crate::scenario::measurements::Metrics;

/// Speeds are averaged over agents of similar density. These are the lower ends of the bins, P/m²; each bin is 1 P/m²
/// wide.
const BINS: [f64; 6] = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5];
/// Start and end of the samples of speed and density, and the time between samples, seconds.
const FUNDAMENTAL: [f64; 2] = [2.0, 60.0];
const EVERY: f64 = 0.5;
/// How long a wave is followed, seconds.
const FOLLOWED: f64 = 5.0;
/// Time step of the space-time diagram, seconds.
const DIAGRAM_STEP: f64 = 0.04;

/// The values of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// For an evacuation: density at 15 s, its standard deviation, the flow, and the speeds by density. For a wave: its
    /// speed. `None` if the run gave no value.
    pub values: Vec<Option<f64>>,
}

/// The names and units of the quantities of a kind of scene, without the fundamental diagram's bins.
pub fn names(kind: Kind) -> &'static [(&'static str, &'static str)] {
    match kind {
        Kind::Motion => &[],
        Kind::Evacuation => &[
            ("density at 15 s", "P/m²"),
            ("its deviation", "P/m²"),
            ("flow", "P/s"),
        ],
        Kind::Wave => &[("wave speed", "m/s")],
    }
}

/// Runs a document under some settings with a seed.
///
/// # Errors
/// A setting is invalid, or the run fails.
pub fn sample(
    kind: Kind,
    document: &Value,
    settings: &[String],
    seed: u64,
) -> Result<Sample, LabError> {
    let settings = [settings, &[format!("seed={seed}")]].concat();
    let scenario = scenario(document, &settings)?;
    let run = match kind {
        Kind::Wave => wave_speed,
        Kind::Evacuation | Kind::Motion => evacuation,
    };
    run(&scenario).map_err(|fault| LabError::of(settings.join(" "), fault))
}

/// Table 1's three numbers, and the speeds by density.
fn evacuation(scenario: &Scenario) -> Result<Sample, Fault> {
    /// Table 1's flow is that of the first 350 arrivals.
    const ARRIVALS: usize = 350;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let mut metrics = Metrics::new(&scenario.measurements, &mut simulation);
    let [first, last] = FUNDAMENTAL.map(|time| simulation.frame().clock.frame_at(time));
    simulation.request_density_until(last + 1);
    let every = simulation.frame().clock.frame_at(EVERY).max(1);
    let mut speeds = [(0.0, 0.0); BINS.len()];
    drive(&mut simulation, scenario.duration_secs, |simulation, _| {
        metrics.observe(simulation);
        let frame = simulation.frame();
        let now = frame.clock.frame();
        if (first..=last).contains(&now) && now.is_multiple_of(every) {
            for (density, v) in frame.fields.density.iter().zip(&frame.agents.velocity) {
                let found = BINS.iter().rposition(|low| density >= low);
                if let Some(bin) = found.filter(|&bin| density - BINS[bin] < 1.0) {
                    speeds[bin].0 += v.norm();
                    speeds[bin].1 += 1.0;
                }
            }
        }
        let enough = simulation.outcome().arrivals.len() >= ARRIVALS && now > last;
        Ok::<Then, Fault>(if enough {
            Then::Stop
        } else {
            unless_over(simulation, scenario)
        })
    })?;
    let values = metrics.results(&simulation);
    let table = values.into_iter().take(3).map(|metric| metric.value);
    let speeds = speeds.map(|(sum, count)| (count > 0.0).then(|| sum / count));
    Ok(Sample {
        values: table.chain(speeds).collect(),
    })
}

/// The speed of the arriving crest.
fn wave_speed(scenario: &Scenario) -> Result<Sample, Fault> {
    let ([start, _], source) = PUSH;
    let [length, half] = CORRIDOR;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let strip = Strip {
        x: [1.0, length - 1.0],
        half_width: half - 0.5,
        bin: 1.0,
    };
    let mut diagram = SpaceTime::new(strip);
    let mut due = start - 0.5;
    drive(&mut simulation, start + FOLLOWED, |simulation, _| {
        if simulation.frame().clock.time() >= due - 1e-9 {
            diagram.observe(&simulation.frame());
            due += DIAGRAM_STEP.max(simulation.frame().clock.time_step());
        }
        Ok::<Then, Fault>(Then::GoOn)
    })?;
    let run = Run {
        start,
        source,
        obstacle: length,
    };
    let speed = wave::measure(&diagram, &run).map(|wave| wave.arriving.speed.value);
    Ok(Sample {
        values: vec![speed],
    })
}

/// A number over seeds, and its distance from the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Deviation {
    /// The mean.
    pub mean: f64,
    /// Half the width of its 95 % confidence interval.
    pub interval: f64,
    /// |mean − reference|.
    pub error: f64,
    /// Half the width of the 95 % confidence interval of that difference.
    pub error_interval: f64,
}

impl Deviation {
    /// Do the seeds distinguish this number from the reference?
    pub fn is_significant(&self) -> bool {
        self.error > self.error_interval
    }

    fn of(values: &[f64], reference: &[f64]) -> Option<Self> {
        let (ours, other) = (MeanStd::of(values)?, MeanStd::of(reference)?);
        let [interval, beside] = [ours, other].map(|of| of.interval_95().unwrap_or(0.0));
        Some(Self {
            mean: ours.mean,
            interval,
            error: (ours.mean - other.mean).abs(),
            error_interval: interval.hypot(beside),
        })
    }
}

/// The deviation of each number from the reference. For evacuations, the last one is the fundamental diagram: the root
/// mean square over its bins of the differences of mean speeds, m/s.
pub fn deviations(kind: Kind, samples: &[Sample], reference: &[Sample]) -> Vec<Option<Deviation>> {
    let column = |samples: &[Sample], k: usize| -> Vec<f64> {
        let values = samples.iter().filter_map(|sample| *sample.values.get(k)?);
        values.collect()
    };
    let count = names(kind).len();
    let against = |k: usize| Deviation::of(&column(samples, k), &column(reference, k));
    let mut found: Vec<Option<Deviation>> = (0..count).map(against).collect();
    if kind == Kind::Evacuation {
        let bins: Vec<Deviation> = (count..count + BINS.len()).filter_map(against).collect();
        let mean_square = |of: fn(&Deviation) -> f64| {
            let squares = bins.iter().map(|bin| of(bin).powi(2));
            (squares.sum::<f64>() / bins.len().max(1) as f64).sqrt()
        };
        found.push((!bins.is_empty()).then(|| Deviation {
            mean: mean_square(|bin| bin.mean),
            interval: mean_square(|bin| bin.interval),
            error: mean_square(|bin| bin.error),
            error_interval: mean_square(|bin| bin.error_interval),
        }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(values: &[f64]) -> Vec<Sample> {
        let sample = |&value: &f64| Sample {
            values: vec![Some(value)],
        };
        values.iter().map(sample).collect()
    }

    #[test]
    fn what_seeds_cannot_tell_apart_is_not_significant() {
        let reference = samples(&[10.0, 10.2, 9.8, 10.1, 9.9]);
        let same = deviations(
            Kind::Wave,
            &samples(&[10.1, 9.9, 10.2, 9.9, 10.0]),
            &reference,
        );
        let other = deviations(
            Kind::Wave,
            &samples(&[11.1, 10.9, 11.2, 10.9, 11.0]),
            &reference,
        );
        assert!(!same[0].unwrap().is_significant());
        assert!(other[0].unwrap().is_significant());
        assert!((other[0].unwrap().error - 1.02).abs() < 1e-12);
        // Five values of variance 0.025: t = 2.776, standard error 0.0707.
        let interval = Deviation::of(&[10.0, 10.2, 9.8, 10.1, 9.9], &[0.0])
            .unwrap()
            .interval;
        assert!((interval - 2.776_445_105_197_8 * (0.025_f64 / 5.0).sqrt()).abs() < 1e-12);
    }
}

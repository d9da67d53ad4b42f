//! The measurements of Tables 1 and 2: density at one time, flow, number of evacuated agents.

use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;

/// A measurement in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measurement {
    /// Mean and standard deviation of ρ_i at one time, over all agents or those in a region, P/m².
    Density {
        /// The time, seconds.
        at: f64,
        /// The region; `None` means everywhere.
        region: Option<Region>,
    },
    /// (n − 1) / (time of the n-th counted arrival − time of the first), P/s.
    FlowOfFirst {
        /// n, at least 2.
        arrivals: usize,
    },
    /// Counted arrivals until the frame nearest to a given time, divided by the time of that frame, P/s.
    FlowUntil {
        /// The time, seconds.
        until: f64,
    },
    /// The number of counted arrivals.
    Evacuated,
}

impl Measurement {
    /// The names of its values.
    pub fn names(&self) -> Vec<String> {
        match self {
            Self::Density { at, .. } => {
                vec![format!("density_mean_{at}s"), format!("density_std_{at}s")]
            }
            Self::FlowOfFirst { .. } => vec!["flow_per_s".to_owned()],
            Self::FlowUntil { until } => vec![format!("flow_first_{until}s_per_s")],
            Self::Evacuated => vec!["evacuated".to_owned()],
        }
    }

    /// The unit of its values.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Density { .. } => "P/m²",
            Self::FlowOfFirst { .. } | Self::FlowUntil { .. } => "P/s",
            Self::Evacuated => "agents",
        }
    }
}

/// A measured value.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Its name in reports.
    pub name: String,
    /// The value; `None` if there were no agents or too few arrivals, or if the run ended too early.
    pub value: Option<f64>,
    /// The unit of the value.
    pub unit: &'static str,
}

/// The measurements of one run.
#[derive(Debug, Clone)]
pub struct Metrics {
    measurements: Vec<Measurement>,
    /// Mean and standard deviation of every density taken so far, by measurement.
    densities: Vec<Option<(f64, f64)>>,
}

impl Metrics {
    /// Prepares the measurements, and requests from `simulation` the densities that they need.
    pub fn new(measurements: Vec<Measurement>, simulation: &mut Simulation) -> Self {
        for measurement in &measurements {
            if let Measurement::Density { at, .. } = measurement {
                let frame = simulation.frame().clock.frame_at(*at);
                simulation.request_density_until(frame + 1);
            }
        }
        Self {
            densities: vec![None; measurements.len()],
            measurements,
        }
    }

    /// The densities taken so far, by measurement.
    pub fn taken(&self) -> &[Option<(f64, f64)>] {
        &self.densities
    }

    /// Restores densities that were [`taken`](Self::taken) before. Ignores them if their number does not match.
    pub fn resume(&mut self, taken: &[Option<(f64, f64)>]) {
        if taken.len() == self.densities.len() {
            self.densities.copy_from_slice(taken);
        }
    }

    /// Takes the densities that are due in this evaluated frame.
    pub fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        for (measurement, taken) in self.measurements.iter().zip(&mut self.densities) {
            let Measurement::Density { at, region } = measurement else {
                continue;
            };
            let densities = &frame.fields.density;
            if frame.clock.frame() != frame.clock.frame_at(*at) || densities.is_empty() {
                continue;
            }
            let inside = |i: usize| region.is_none_or(|r| r.contains(frame.agents.position[i]));
            let densities: Vec<f64> = (0..frame.agents.len())
                .filter(|&i| inside(i))
                .map(|i| densities[i])
                .collect();
            *taken = mean_and_deviation(&densities);
        }
    }

    /// The values measured so far.
    pub fn results(&self, simulation: &Simulation) -> Vec<Metric> {
        let clock = simulation.frame().clock;
        let counted = simulation
            .outcome()
            .arrivals
            .iter()
            .filter(|arrival| arrival.counted);
        let times: Vec<f64> = counted.map(|arrival| arrival.time).collect();
        let values = |measurement: &Measurement, density: Option<(f64, f64)>| match measurement {
            Measurement::Density { .. } => {
                vec![
                    density.map(|(mean, _)| mean),
                    density.map(|(_, deviation)| deviation),
                ]
            }
            Measurement::FlowOfFirst { arrivals } => vec![flow_of_first(&times, *arrivals)],
            Measurement::FlowUntil { until } => {
                let due = clock.frame_at(*until).max(1);
                let end = clock.time_at(due);
                let count = times.iter().filter(|&&time| time <= end).count();
                vec![(clock.frame() >= due).then(|| count as f64 / end)]
            }
            Measurement::Evacuated => vec![Some(times.len() as f64)],
        };
        self.measurements
            .iter()
            .zip(&self.densities)
            .flat_map(|(measurement, &density)| {
                let named = measurement
                    .names()
                    .into_iter()
                    .zip(values(measurement, density));
                named.map(|(name, value)| Metric {
                    name,
                    value,
                    unit: measurement.unit(),
                })
            })
            .collect()
    }
}

/// (n − 1) / (t_n − t_1) for ascending arrival times.
fn flow_of_first(times: &[f64], arrivals: usize) -> Option<f64> {
    let last = times.get(arrivals.checked_sub(1)?)?;
    let span = last - times[0];
    (span > 0.0).then(|| (arrivals - 1) as f64 / span)
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
    fn flow_counts_the_gaps_between_arrivals() {
        let times: Vec<f64> = (0..10).map(|k| 5.0 + 0.5 * f64::from(k)).collect();
        assert_eq!(flow_of_first(&times, 10), Some(2.0));
        assert_eq!(flow_of_first(&times, 11), None);
        assert_eq!(flow_of_first(&[], 0), None);
    }

    #[test]
    fn the_deviation_is_that_of_the_population() {
        assert_eq!(mean_and_deviation(&[1.0, 3.0]), Some((2.0, 1.0)));
        assert_eq!(mean_and_deviation(&[]), None);
    }
}

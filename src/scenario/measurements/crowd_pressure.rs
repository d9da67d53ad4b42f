//! Crowd pressure: density times the variance of the velocities.

use schemars::JsonSchema;
use serde::Deserialize;

use super::window::Window;
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::crowd_pressure::{BEFORE_ACCIDENT, Pressures};
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "crowd_pressure";

/// The highest crowd pressure ρ Var(v) around any person, 1/s², with time, place and density; the mean; the most people
/// and the longest time above 0.02 1/s², which was measured before the accident at Mina in 2006 (Helbing, Johansson and
/// Al-Abideen 2007) and is not a safety limit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CrowdPressure {
    /// The beginning of the names of its values. Default: `crowd_pressure`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) window: Window,
}

impl Measure for CrowdPressure {
    /// With the time between two samples, seconds.
    type Seen = (Pressures, f64);

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("crowd_pressure.region", self.window.region)
    }

    fn about(&self) -> About {
        About {
            has_thresholds: true,
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.window.check("crowd_pressure")
    }

    fn quantities(&self) -> Vec<Quantity> {
        let most = format!("most people above {BEFORE_ACCIDENT} 1/s² at one time");
        let longest = format!(
            "longest time without a break with at least one person above {BEFORE_ACCIDENT} 1/s²"
        );
        let (agents, secs) = (
            format!("above_{BEFORE_ACCIDENT}_agents"),
            format!("above_{BEFORE_ACCIDENT}_secs"),
        );
        let values = [
            (
                "max_per_s2",
                "1/s²",
                "highest crowd pressure, ρ Var(v), at one person",
            ),
            ("max_at_secs", "s", "when it was highest"),
            ("max_x_m", "m", "where it was highest: x"),
            ("max_y_m", "m", "where it was highest: y"),
            (
                "max_density_per_m2",
                "P/m²",
                "density at the highest crowd pressure",
            ),
            (
                "mean_per_s2",
                "1/s²",
                "mean crowd pressure over people and samples",
            ),
            (&agents, "agents", &most),
            (&secs, "s", &longest),
        ];
        Quantity::all(self.name.as_deref().unwrap_or(NAME), &values)
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let window = self.window;
        if window.samples.is_due(simulation) {
            *secs = window.samples.secs(simulation);
            let time = simulation.frame().clock.time();
            seen.add(time, window.people(evaluated, true));
        }
    }

    fn values(&self, (seen, secs): &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let peak = seen.peak;
        let was_seen = peak.is_some();
        vec![
            peak.and_then(|(person, _)| person.pressure),
            peak.map(|(_, time)| time),
            peak.map(|(person, _)| person.position.x),
            peak.map(|(person, _)| person.position.y),
            peak.map(|(person, _)| person.density),
            seen.mean(),
            was_seen.then_some(f64::from(seen.people)),
            was_seen.then_some(seen.spell.longest() * secs),
        ]
    }
}

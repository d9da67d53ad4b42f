//! The results of one scene, and its cheapest settings.

use serde::Serialize;

use super::front::{Front, cheapest};
use super::knob::{Knob, are_default};
use super::scenes::{Kind, Scene};
use super::statistics::Deviation;
use crate::analysis::statistics::Range;
use crate::output::table::OldTable as Table;

/// A quantity whose error is measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
}

impl Quantity {
    pub(super) fn new(name: &str, unit: &'static str) -> Self {
        Self {
            name: name.to_owned(),
            unit,
        }
    }
}

/// A measured error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measured {
    /// If the quantity is a statistic over seeds: its mean and half its 95 % confidence interval.
    pub mean: Option<(f64, f64)>,
    /// Distance from the reference.
    pub error: f64,
    /// Half the 95 % confidence interval of the error; 0 if the error is not random.
    pub interval: f64,
}

impl Measured {
    /// An error that is not random.
    pub(super) fn exact(error: f64) -> Self {
        Self {
            mean: None,
            error,
            interval: 0.0,
        }
    }

    /// The error or half its confidence interval, whichever is larger: smaller errors cannot be told from 0.
    pub fn bound(&self) -> f64 {
        self.error.max(self.interval)
    }
}

impl From<Deviation> for Measured {
    fn from(found: Deviation) -> Self {
        Self {
            mean: Some((found.mean, found.interval)),
            error: found.error,
            interval: found.error_interval,
        }
    }
}

/// The result of one setting of one knob in one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The knob.
    pub knob: Knob,
    /// The label of its curve.
    pub curve: String,
    /// The settings, as `--set` takes them.
    pub settings: Vec<String>,
    /// Milliseconds per simulated second on one thread.
    pub cost: Range,
    /// The errors in the order of [`Found::quantities`]; `None` if a quantity has no value.
    pub errors: Vec<Option<Measured>>,
}

/// The results of one scene.
#[derive(Clone)]
pub struct Found {
    /// The scene.
    pub scene: Scene,
    /// The measured quantities.
    pub quantities: Vec<Quantity>,
    /// The points, curve by curve.
    pub points: Vec<Point>,
    /// Further findings, in words.
    pub notes: String,
}

/// Position errors for which the cheapest settings are listed, meters.
const POSITIONS: [f64; 4] = [0.03, 0.01, 0.003, 0.001];
/// The same for statistics, as relative errors.
const PARTS: [f64; 3] = [0.05, 0.02, 0.01];

impl Found {
    /// The one error by which settings are compared. For motion: of positions after about a second, in meters. For
    /// statistics: the largest relative error.
    pub fn overall(&self, point: &Point) -> Option<f64> {
        match self.scene.kind {
            Kind::Motion => point.errors[1].map(|error| error.error),
            Kind::Evacuation | Kind::Wave => {
                let relative = point.errors.iter().map(|error| {
                    let error = (*error)?;
                    Some(error.error / error.mean?.0.abs())
                });
                let all: Option<Vec<f64>> = relative.collect();
                all.map(|all| all.into_iter().fold(0.0, f64::max))
            }
        }
    }

    /// The points that have such an error: their indices, and their (cost, error).
    fn compared(&self) -> (Vec<usize>, Vec<(f64, f64)>) {
        let points = self.points.iter().enumerate();
        points
            .filter_map(|(k, point)| Some((k, (point.cost.median, self.overall(point)?))))
            .unzip()
    }

    fn targets(&self) -> (&'static [f64], fn(f64) -> String) {
        match self.scene.kind {
            Kind::Motion => (&POSITIONS, |error| format!("{} mm", 1e3 * error)),
            Kind::Evacuation | Kind::Wave => (&PARTS, |error| format!("{} %", 100.0 * error)),
        }
    }

    /// Table rows: the cheapest settings for each target error, and the settings that beat the default.
    pub fn choices(&self) -> Vec<Vec<String>> {
        let (indices, compared) = self.compared();
        let (targets, write) = self.targets();
        let named = |k: usize| self.points[indices[k]].settings.join(" ");
        let mut rows = Vec::new();
        for &most in targets {
            let found = cheapest(&compared, most);
            let found = found.map_or_else(
                || ["none".to_owned(), String::new(), String::new()],
                |k| {
                    let (cost, error) = compared[k];
                    [
                        named(k),
                        format!("{cost:.1}"),
                        precise(self.scene.kind, error),
                    ]
                },
            );
            rows.push(row(
                self.scene.name,
                &format!("at most {}", write(most)),
                found,
            ));
        }
        let default = indices
            .iter()
            .position(|&k| are_default(&self.points[k].settings));
        if let Some(k) = default {
            let (cost, error) = compared[k];
            let front = Front::of(&compared, k);
            let mut verdict = Vec::new();
            if let Some((other, error)) = front.best_at_cost {
                let error = precise(self.scene.kind, error);
                verdict.push(format!("at its cost: {} ({error})", named(other)));
            }
            if let Some((other, cost)) = front.cheapest_at_error {
                verdict.push(format!("at its error: {} ({cost:.1} ms)", named(other)));
            }
            let verdict = if verdict.is_empty() {
                "on the front".to_owned()
            } else {
                format!("beaten {}", verdict.join("; "))
            };
            let found = [
                verdict,
                format!("{cost:.1}"),
                precise(self.scene.kind, error),
            ];
            rows.push(row(self.scene.name, "the default", found));
        }
        rows
    }

    /// A table of all points.
    pub fn table(&self) -> Table {
        let mut head = vec![
            "knob".to_owned(),
            "settings".to_owned(),
            "ms per s".to_owned(),
        ];
        let quantities = self.quantities.iter();
        head.extend(quantities.map(|quantity| format!("{} [{}]", quantity.name, quantity.unit)));
        let rows = self.points.iter().map(|point| {
            let mut settings = point.settings.join(" ");
            if are_default(&point.settings) {
                settings += " (default)";
            }
            let cells = point
                .errors
                .iter()
                .map(|error| error.map_or(String::new(), written));
            let first = [
                point.knob.name().to_owned(),
                settings,
                format!("{:.2}", point.cost.median),
            ];
            first.into_iter().chain(cells).collect()
        });
        Table {
            words: 2,
            head,
            rows: rows.collect(),
        }
    }
}

fn row(scene: &str, wanted: &str, found: [String; 3]) -> Vec<String> {
    [scene.to_owned(), wanted.to_owned()]
        .into_iter()
        .chain(found)
        .collect()
}

/// Formats an error by which settings are compared, with its unit.
fn precise(kind: Kind, error: f64) -> String {
    match kind {
        Kind::Motion => format!("{:.2} mm", 1e3 * error),
        Kind::Evacuation | Kind::Wave => format!("{:.1} %", 100.0 * error),
    }
}

fn written(measured: Measured) -> String {
    match measured.mean {
        Some((mean, interval)) => {
            let sign = if measured.error > measured.interval {
                ""
            } else {
                "≤ "
            };
            format!(
                "{mean:.3} ± {interval:.3}, off {sign}{:.3}",
                measured.bound()
            )
        }
        None => format!("{:.2e}", measured.error),
    }
}

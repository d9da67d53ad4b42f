//! The results of one scene, and its cheapest settings.

use serde::Serialize;

use super::front::{Front, cheapest};
use super::scenes::{Kind, Scene, names};
use super::trials::Trial;
use crate::analysis::statistics::Range;
use crate::output::table::Table;

/// A quantity whose error is measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
}

impl Quantity {
    pub(super) fn new(name: impl Into<String>, unit: &'static str) -> Self {
        let name = name.into();
        Self { name, unit }
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

    /// Do the seeds distinguish the quantity from the reference?
    pub fn is_significant(&self) -> bool {
        self.error > self.interval
    }

    /// The error or half its confidence interval, whichever is larger: smaller errors cannot be told from 0.
    pub fn bound(&self) -> f64 {
        self.error.max(self.interval)
    }
}

/// The result of one trial in one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// The knob and the settings.
    #[serde(flatten)]
    pub trial: Trial,
    /// Milliseconds per simulated second on one thread.
    #[serde(rename = "ms_per_s")]
    pub cost: Range,
    /// The errors in the order of [`Found::quantities`]; `None` if a quantity has no value.
    pub errors: Vec<Option<Measured>>,
}

/// The errors of all trials in one scene.
#[derive(Default)]
pub(super) struct Judged {
    /// The measured quantities.
    pub quantities: Vec<Quantity>,
    /// The errors of each trial.
    pub errors: Vec<Vec<Option<Measured>>>,
    /// Further findings, in words.
    pub notes: String,
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

/// A row of the table of cheapest settings.
pub(super) struct Choice {
    scene: &'static str,
    /// The bound on the error, or "the default".
    wanted: String,
    settings: String,
    cost: Option<f64>,
    error: Option<String>,
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
            Kind::Statistics => {
                let relative = point.errors.iter().map(|error| {
                    let error = (*error)?;
                    Some(error.error / error.mean?.0.abs())
                });
                let all: Option<Vec<f64>> = relative.collect();
                all.map(|all| all.into_iter().fold(0.0, f64::max))
            }
        }
    }

    /// The bounds for which the cheapest settings are listed, with their names.
    fn bounds(&self) -> Vec<(f64, String)> {
        match self.scene.kind {
            Kind::Motion => POSITIONS.map(|m| (m, format!("{} mm", 1e3 * m))).to_vec(),
            Kind::Statistics => PARTS
                .map(|part| (part, format!("{} %", 100.0 * part)))
                .to_vec(),
        }
    }

    /// Formats an error by which settings are compared, with its unit.
    fn precise(&self, error: f64) -> String {
        match self.scene.kind {
            Kind::Motion => format!("{:.2} mm", 1e3 * error),
            Kind::Statistics => format!("{:.1} %", 100.0 * error),
        }
    }

    /// The cheapest settings for each bound, and the settings that beat the default.
    pub(super) fn choices(&self) -> Vec<Choice> {
        let points = self.points.iter();
        let (points, compared): (Vec<&Point>, Vec<(f64, f64)>) = points
            .filter_map(|point| Some((point, (point.cost.median, self.overall(point)?))))
            .unzip();
        let named = |k: usize| names(&points[k].trial.settings);
        let choice = |wanted: String, settings: String, found: Option<(f64, f64)>| Choice {
            scene: self.scene.name,
            wanted,
            settings,
            cost: found.map(|(cost, _)| cost),
            error: found.map(|(_, error)| self.precise(error)),
        };
        let bounds = self.bounds().into_iter();
        let mut choices: Vec<Choice> = bounds
            .map(|(most, name)| {
                let found = cheapest(&compared, most);
                let settings = found.map_or("none".to_owned(), named);
                let found = found.map(|k| compared[k]);
                choice(format!("at most {name}"), settings, found)
            })
            .collect();
        if let Some(k) = points.iter().position(|point| point.trial.is_default) {
            let front = Front::of(&compared, k);
            let at_cost = front.best_at_cost.map(|(other, error)| {
                format!("at its cost: {} ({})", named(other), self.precise(error))
            });
            let at_error = front
                .cheapest_at_error
                .map(|(other, cost)| format!("at its error: {} ({cost:.1} ms)", named(other)));
            let beaten: Vec<String> = at_cost.into_iter().chain(at_error).collect();
            let verdict = match beaten.is_empty() {
                true => "on the front".to_owned(),
                false => format!("beaten {}", beaten.join("; ")),
            };
            choices.push(choice("the default".to_owned(), verdict, Some(compared[k])));
        }
        choices
    }

    /// A table of all points.
    pub fn table(&self) -> Table {
        let mut table = Table::of(&self.points)
            .column("knob", |point| point.trial.knob.as_str())
            .column("settings", |point| {
                let default = ["", " (default)"][usize::from(point.trial.is_default)];
                names(&point.trial.settings) + default
            })
            .fixed("ms per s", 2, |point| point.cost.median);
        for (k, Quantity { name, unit }) in self.quantities.iter().enumerate() {
            let name = format!("{name} [{unit}]");
            let error = |point: &Point| point.errors[k];
            table = match self.scene.kind {
                Kind::Motion => table.exponent(&name, 2, |point| error(point).map(|e| e.error)),
                Kind::Statistics => table.column(&name, |point| error(point).and_then(written)),
            };
        }
        table.table()
    }
}

/// A table of choices.
pub(super) fn table(choices: &[Choice]) -> Table {
    Table::of(choices)
        .column("scene", |choice| choice.scene)
        .column("error", |choice| choice.wanted.as_str())
        .column("settings", |choice| choice.settings.as_str())
        .fixed("ms per s", 1, |choice| choice.cost)
        .column("error found", |choice| choice.error.clone())
        .table()
}

/// A mean over seeds with its deviation from the reference.
fn written(measured: Measured) -> Option<String> {
    let (mean, interval) = measured.mean?;
    let bound = measured.bound();
    let sign = ["≤ ", ""][usize::from(measured.is_significant())];
    Some(format!("{mean:.3} ± {interval:.3}, off {sign}{bound:.3}"))
}

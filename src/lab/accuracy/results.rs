//! The results of one scene, and its cheapest settings.

use serde::Serialize;

use super::front::{better, cheapest};
use super::scenes::{Kind, Scene, names};
use super::trials::Trial;
use analysis::statistics::Range;
use output::table::Table;

/// A quantity whose error is measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
}

/// A measured error.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Measured {
    /// If the quantity is a statistic over seeds: its mean and half its 95 % confidence interval.
    pub mean: Option<(f64, f64)>,
    /// Distance from the reference.
    pub error: f64,
    /// Half the 95 % confidence interval of the error; 0 if the error is not random.
    pub interval: f64,
}

impl Measured {
    /// Whether the seeds distinguish the quantity from the reference.
    pub fn is_significant(&self) -> bool {
        self.error > self.interval
    }

    /// The error or half its confidence interval, whichever is larger: smaller errors cannot be distinguished from 0.
    pub fn bound(&self) -> f64 {
        self.error.max(self.interval)
    }
}

/// The result of one trial in one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// The choice and the settings.
    #[serde(flatten)]
    pub trial: Trial,
    /// Milliseconds per simulated second on one thread.
    #[serde(rename = "ms_per_s")]
    pub cost: Range,
    /// The errors in the order of [`SceneResults::quantities`]; `None` if a quantity has no value.
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
pub struct SceneResults {
    /// The scene.
    pub scene: Scene,
    /// The measured quantities.
    pub quantities: Vec<Quantity>,
    /// The points, curve by curve.
    pub points: Vec<Point>,
    /// Further findings, in words.
    pub notes: String,
}

/// A row of the table of cheapest settings: the scene; the bound on the error, or "the default"; the settings, their
/// cost and their error.
pub(super) type Choice = (&'static str, String, String, Option<f64>, Option<String>);

/// Position errors for which the cheapest settings are listed, millimeters.
const POSITIONS: [f64; 4] = [30.0, 10.0, 3.0, 1.0];
/// The same for statistics, as relative errors in percent.
const PARTS: [f64; 3] = [5.0, 2.0, 1.0];

impl SceneResults {
    /// The error by which settings are compared. For motion: the error of positions after about a second, meters. For
    /// statistics: the largest relative error.
    pub fn overall(&self, point: &Point) -> Option<f64> {
        match self.scene.kind {
            Kind::Motion => point.errors[1].map(|error| error.error),
            Kind::Statistics => point.errors.iter().try_fold(0.0, |largest: f64, error| {
                let error = (*error)?;
                Some(largest.max(error.error / error.mean?.0.abs()))
            }),
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
        let choice = |wanted: String, settings: String, found: Option<usize>| {
            let cost = found.map(|k| compared[k].0);
            let error = found.map(|k| self.precise(compared[k].1));
            (self.scene.name, wanted, settings, cost, error)
        };
        let (bounds, unit, scale): (&[f64], _, _) = match self.scene.kind {
            Kind::Motion => (&POSITIONS, "mm", 1e3),
            Kind::Statistics => (&PARTS, "%", 1e2),
        };
        let at_most = bounds.iter().map(|most| {
            let found = cheapest(&compared, most / scale);
            let settings = found.map_or("none".to_owned(), named);
            choice(format!("at most {most} {unit}"), settings, found)
        });
        let mut choices: Vec<Choice> = at_most.collect();
        if let Some(k) = points.iter().position(|point| point.trial.is_default) {
            let [at_cost, at_error] = better(&compared, k);
            let at_cost = at_cost.map(|k| (k, "cost", self.precise(compared[k].1)));
            let at_error = at_error.map(|k| (k, "error", format!("{:.1} ms", compared[k].0)));
            let both = at_cost.into_iter().chain(at_error);
            let named_as = both.map(|(k, its, by)| format!("at its {its}: {} ({by})", named(k)));
            let beaten: Vec<String> = named_as.collect();
            let verdict = match beaten.is_empty() {
                true => "on the front".to_owned(),
                false => format!("beaten {}", beaten.join("; ")),
            };
            choices.push(choice("the default".to_owned(), verdict, Some(k)));
        }
        choices
    }

    /// A table of all points.
    pub fn table(&self) -> Table {
        let mut table = Table::of(&self.points)
            .column("choice", |point| point.trial.choice.as_str())
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
        .column("scene", |choice| choice.0)
        .column("error", |choice| choice.1.as_str())
        .column("settings", |choice| choice.2.as_str())
        .fixed("ms per s", 1, |choice| choice.3)
        .column("error found", |choice| choice.4.clone())
        .table()
}

/// A mean over seeds with its deviation from the reference.
fn written(measured: Measured) -> Option<String> {
    let (mean, interval) = measured.mean?;
    let bound = measured.bound();
    let sign = ["≤ ", ""][usize::from(measured.is_significant())];
    Some(format!("{mean:.3} ± {interval:.3}, off {sign}{bound:.3}"))
}

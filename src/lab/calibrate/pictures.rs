//! Convergence, errors and screening as pictures.

use super::report::{Report, ValueResult};
use super::scene::{Set, Target};
use super::search::{Generation, Screened};
use crate::gallery::{self, in_cell, positive};
use analysis::morris::Effect;
use output::colors::{ColorMap, Rgb};
use output::plot::{Axis, ColorBar, Corner, GRAY, LINES, Mark, Panel, Sheet, Style};

/// Height of a row with a value, points.
const ROW: f64 = 15.0;
/// Width for the names of values, and of a column of the map of effects, points.
const NAMES: f64 = 190.0;
const COLUMN: f64 = 78.0;
/// The smallest misfit on the logarithmic axis, tolerances.
const LEAST_SHOWN: f64 = 1e-2;
/// The tolerances shown to each side.
const MOST_SHOWN: f64 = 20.0;
/// Behind residuals of at most one tolerance.
const WITHIN: Rgb = [225, 240, 225];

/// `convergence`, `errors` and, if there was one, `screening`.
pub fn sheets(report: &Report) -> Vec<(&'static str, Sheet)> {
    let mut sheets = vec![
        ("convergence", convergence(report)),
        ("errors", errors(report)),
    ];
    let screened = report.found.screened.iter();
    sheets.extend(screened.map(|screened| ("screening", screening(report, screened))));
    sheets
}

/// Misfits and parameters by generation.
fn convergence(report: &Report) -> Sheet {
    let generations = &report.found.generations;
    let numbered = || (1..).map(f64::from).zip(generations);
    let last = generations.len().max(2) as f64;
    let start = report.found.trials[0].misfit;
    let misfits =
        |of: fn(&Generation) -> f64| numbered().map(move |(x, one)| [x, of(one).max(LEAST_SHOWN)]);
    let both = misfits(|of| of.misfits.minimum).chain(misfits(|of| of.misfits.maximum));
    let ends = both.map(|at| at[1]).chain([start.max(LEAST_SHOWN)]);
    let label = "misfit: root mean square residual [tolerances]";
    let y = Axis::log(label, positive(ends, [0.8, 1.25]));
    let unchanged = Style::broken(GRAY, 1.0, "start");
    let worst = Style::broken(LINES[5], 1.6, "worst of the generation");
    let median = Style::full(LINES[5], 1.6, "median");
    let best = Style::full(LINES[0], 1.8, "best");
    let so_far = Style::full(LINES[1], 1.2, "best so far");
    let marks = vec![
        Mark::line([[1.0, start], [last, start]], unchanged),
        Mark::dots(misfits(|of| of.misfits.maximum), worst),
        Mark::dots(misfits(|of| of.misfits.median), median),
        Mark::dots(misfits(|of| of.misfits.minimum), best),
        Mark::line(misfits(|of| of.best), so_far),
    ];
    let every = generations.len().div_ceil(12).max(1);
    let numbers = (1..=generations.len()).step_by(every);
    let ticks = numbers.map(|k| (k as f64, k.to_string()));
    let x = Axis::linear("generation", [1.0, last]).ticked(ticks);
    let searched = report.found.searched.iter().enumerate();
    let curves = searched.flat_map(|(j, &k)| {
        let curve = |side: f64, style| {
            let point = |(x, of): (f64, &Generation)| Some([x, of.mean[k]? + side * of.spread[k]?]);
            Mark::line(numbered().filter_map(point), style)
        };
        let mean = Style::nth(j, 1.4, &report.calibration.parameters[k].name);
        let pale = mean.color.map(|part| 255 - (255 - part) / 3);
        let rim = || Style::full(pale, 0.6, "");
        [curve(-1.0, rim()), curve(1.0, rim()), curve(0.0, mean)]
    });
    let title = "parameters: mean and standard deviation";
    let part = Axis::linear("part of the bounds", [0.0, 1.0]);
    let panels = vec![
        Panel::new("misfit", x.clone(), y, marks).with_legend(Corner::Beside),
        Panel::new(title, x, part, curves.collect()).with_legend(Corner::Beside),
    ];
    Sheet::new(&report.calibration.name, 1, [330.0, 180.0], panels)
}

/// The residuals of all values at the start and at the best point.
fn errors(report: &Report) -> Sheet {
    let values = report.values();
    let shown = |residual: f64| residual.clamp(-MOST_SHOWN, MOST_SHOWN);
    let of_values = values.iter();
    let known = of_values.flat_map(|value| [value.start.residual, value.best.residual]);
    let residuals = known.flatten().map(|residual| shown(residual).abs());
    let far = residuals.fold(2.0, f64::max) * 1.05;
    let width = 2.0 * far * NAMES / 300.0;
    let rows = values.len() as f64;
    let height = |k: usize| rows - 0.5 - k as f64;
    let mut marks = vec![
        Mark::rectangle([-1.0, 1.0], [0.0, rows], WITHIN),
        Mark::line([[0.0, 0.0], [0.0, rows]], Style::full(GRAY, 0.6, "")),
    ];
    marks.extend(names(&report.calibration.targets, -far - width, height));
    for (k, value) in values.iter().enumerate() {
        if let (Some(residual), Some(noise)) = (value.best.residual, value.best.noise) {
            let beside = [-1.96, 1.96].map(|side| shown(residual) + side * noise);
            let ends = beside.map(|end| [end.clamp(-far, far), height(k)]);
            marks.push(Mark::line(ends, Style::full(color(value.set), 0.8, "")));
        }
    }
    let dots = |residual: fn(&ValueResult) -> Option<f64>, of: Option<Set>, style| {
        let numbered = values.iter().enumerate();
        let own = numbered.filter(|(_, value)| of.is_none_or(|set| value.set == set));
        let points = own.filter_map(|(k, value)| Some([shown(residual(value)?), height(k)]));
        Mark::dots(points, style)
    };
    let start = Style::broken(GRAY, 2.2, "start");
    marks.push(dots(|value| value.start.residual, None, start));
    for set in Set::ALL {
        let style = Style::full(color(set), 2.4, &format!("best, {}", set.name()));
        if values.iter().any(|value| value.set == set) {
            marks.push(dots(|value| value.best.residual, Some(set), style));
        }
    }
    let label = "residual [tolerances], 95 % interval of the seeds";
    let x = Axis::linear(label, [-far - width, far]).ticked(ticks(far));
    let panel = Panel::new("", x, blank(rows), marks).with_legend(Corner::Beside);
    let name = &report.calibration.name;
    let title = format!("{name}: how far runs are off the measured values");
    let size = [NAMES + 300.0, ROW * rows.max(4.0)];
    Sheet::new(&title, 1, size, vec![panel])
}

fn color(set: Set) -> Rgb {
    match set {
        Set::Fit => LINES[0],
        Set::HoldOut => LINES[1],
        Set::Transfer => LINES[2],
    }
}

/// Round numbers from −`far` to `far`.
fn ticks(far: f64) -> impl Iterator<Item = (f64, String)> {
    let fitting = [1.0, 2.0, 5.0].into_iter().find(|step| far / step < 6.0);
    let step = fitting.unwrap_or(5.0);
    let most = (far / step) as i32;
    let values = (-most..=most).map(move |k| f64::from(k) * step);
    values.map(|value| (value, value.to_string().replace('-', "\u{2212}")))
}

/// An axis of rows without numbers.
fn blank(rows: f64) -> Axis {
    Axis::linear("", [0.0, rows]).ticked([(-1.0, String::new())])
}

/// The names of values in rows.
fn names<'a>(
    targets: impl IntoIterator<Item = &'a Target>,
    x: f64,
    height: impl Fn(usize) -> f64,
) -> impl Iterator<Item = Mark> {
    let targets = targets.into_iter().enumerate();
    targets.map(move |(k, target)| {
        let text = format!(" {}: {}", target.of, target.quantity);
        Mark::label([x, height(k)], [1, 0], text)
    })
}

/// The effects of the parameters on the misfit, and on each value.
fn screening(report: &Report, screened: &Screened) -> Sheet {
    let all = report.calibration.parameters.iter();
    let parameters: Vec<&str> = all.map(|of| of.name.as_str()).collect();
    let most = |of: fn(&Effect) -> f64| screened.misfit.iter().map(of).fold(1.0, f64::max);
    let label = "μ*: mean absolute effect on the misfit [tolerances]";
    let x = Axis::linear(label, [0.0, 1.35 * most(|of| of.mean_absolute)]);
    // Names lie above and below their points.
    let ends = [-0.1, 1.0].map(|end| end * 1.15 * most(|of| of.deviation));
    let y = Axis::linear("σ: its standard deviation", ends);
    let effects = screened.misfit.iter();
    let places = effects.map(|of| [of.mean_absolute, of.deviation]);
    let dots = Mark::dots(places.clone(), Style::full(LINES[0], 2.4, ""));
    let named = places.zip(&parameters).zip([1, -1].into_iter().cycle());
    let labels = named.map(|((at, name), above)| Mark::label(at, [1, above], format!(" {name}")));
    let marks = [dots].into_iter().chain(labels).collect();
    let misfit = Panel::new("on the misfit", x, y, marks);
    let name = &report.calibration.name;
    let title = format!("{name}: effects of the parameters over their bounds");
    let width = NAMES + COLUMN * parameters.len() as f64;
    let height = (ROW * screened.values.len() as f64).max(220.0);
    let panels = vec![map(report, screened, &parameters), misfit];
    Sheet::new(&title, 1, [width, height], panels)
}

/// A map of μ* over parameters and values.
fn map(report: &Report, screened: &Screened, parameters: &[&str]) -> Panel {
    let rows = screened.values.len();
    let value = |effect: &Effect| effect.mean_absolute;
    let effects = screened.values.iter().flatten().map(value);
    let largest = effects.fold(1.0, f64::max);
    let width = NAMES / COLUMN;
    let mut x = Axis::names("", parameters.iter().map(|name| (*name).to_owned()));
    x.range[0] = -width;
    let values = screened.values.iter().rev().flatten().map(value);
    let map = ColorMap::viridis([0.0, largest as f32]);
    let mut panel = gallery::map(
        "mean absolute effects on the values",
        [x, blank(rows as f64)],
        values.map(Some).collect(),
        ColorBar::new("μ* [tolerances]", &map),
    );
    for (k, effects) in screened.values.iter().enumerate() {
        let values = effects.iter().map(value).enumerate();
        panel.marks.extend(values.map(|(j, value)| {
            let text = format!("{value:.1}");
            in_cell([j, rows - 1 - k], text, value > 0.5 * largest)
        }));
    }
    let targets = report.calibration.targets.iter();
    let fitted = targets.filter(|target| target.set == Set::Fit);
    let height = |k: usize| rows as f64 - 0.5 - k as f64;
    panel.marks.extend(names(fitted, -width, height));
    panel
}

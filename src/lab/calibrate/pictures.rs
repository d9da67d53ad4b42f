//! Convergence, errors and screening as pictures.

use super::report::Report;
use super::scene::{Set, Target};
use super::search::Screened;
use crate::analysis::morris::Effect;
use crate::analysis::statistics::Range;
use crate::lab::error::LabError;
use crate::output::colors::{ColorMap, Rgb};
use crate::output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, GRAY, LINES, Label, Mark, Panel, Sheet, Style,
};
use crate::runs::store::Store;

/// Height of a row with a value, points.
const ROW: f64 = 15.0;
/// Width for the names of values, and of a column of the map of effects, points.
const NAMES: f64 = 190.0;
const COLUMN: f64 = 78.0;
/// The smallest misfit on the logarithmic axis, tolerances.
const LEAST_SHOWN: f64 = 1e-2;
/// The tolerances shown to each side.
const MOST_SHOWN: f64 = 20.0;

/// Draws `convergence`, `errors` and, if there was one, `screening`, each as SVG and PNG.
pub fn save(report: &Report, store: &Store) -> Result<(), LabError> {
    convergence(report).save(&store.path("convergence"))?;
    errors(report).save(&store.path("errors"))?;
    if let Some(screened) = &report.found.screened {
        screening(report, screened).save(&store.path("screening"))?;
    }
    Ok(())
}

/// Misfits and parameters by generation.
fn convergence(report: &Report) -> Sheet {
    let generations = &report.found.generations;
    let numbered = || (1..).map(f64::from).zip(generations);
    let last = generations.len().max(2) as f64;
    let start = report.found.trials[0].misfit;
    let all = generations
        .iter()
        .flat_map(|of| [of.misfits.minimum, of.misfits.maximum]);
    let all = all.chain([start]).map(|misfit| misfit.max(LEAST_SHOWN));
    let range = Range::of(&all.collect::<Vec<_>>());
    let y = Axis::log(
        "misfit: root mean square residual [tolerances]",
        [0.8 * range.minimum, 1.25 * range.maximum],
    );
    let line = |value: fn(&super::search::Generation) -> f64, style| {
        Mark::Line(
            numbered()
                .map(|(x, of)| [x, value(of).max(LEAST_SHOWN)])
                .collect(),
            style,
        )
    };
    let dots = |value: fn(&super::search::Generation) -> f64, style| {
        Mark::dots(
            numbered().map(|(x, of)| [x, value(of).max(LEAST_SHOWN)]),
            style,
        )
    };
    let marks = vec![
        Mark::Line(
            vec![[1.0, start], [last, start]],
            Style::broken(GRAY, 1.0, "start"),
        ),
        dots(
            |of| of.misfits.maximum,
            Style::broken(LINES[5], 1.6, "worst of the generation"),
        ),
        dots(|of| of.misfits.median, Style::full(LINES[5], 1.6, "median")),
        dots(|of| of.misfits.minimum, Style::full(LINES[0], 1.8, "best")),
        line(|of| of.best, Style::full(LINES[1], 1.2, "best so far")),
    ];
    let every = generations.len().div_ceil(12).max(1);
    let ticks = (1..=generations.len()).step_by(every);
    let generation = || Axis {
        ticks: ticks.clone().map(|k| (k as f64, k.to_string())).collect(),
        ..Axis::linear("generation", [1.0, last])
    };
    let misfits = Panel {
        legend: Some(Corner::Beside),
        ..Panel::new("misfit", generation(), y, marks)
    };
    let searched = report.found.searched.iter().enumerate();
    let curves = searched.flat_map(|(j, &k)| {
        let color = LINES[j % LINES.len()];
        let is_again = j >= LINES.len();
        let curve = |side: f64, style| {
            let points =
                numbered().filter_map(|(x, of)| Some([x, of.mean[k]? + side * of.spread[k]?]));
            Mark::Line(points.collect(), style)
        };
        let name = &report.calibration.parameters[k].name;
        let mean = match is_again {
            false => Style::full(color, 1.4, name),
            true => Style::broken(color, 1.4, name),
        };
        let rim = || Style::full(pale(color), 0.6, "");
        [curve(-1.0, rim()), curve(1.0, rim()), curve(0.0, mean)]
    });
    let y = Axis::linear("part of the bounds", [0.0, 1.0]);
    let parameters = Panel {
        legend: Some(Corner::Beside),
        ..Panel::new(
            "parameters: mean and standard deviation",
            generation(),
            y,
            curves.collect(),
        )
    };
    Sheet {
        title: report.calibration.name.clone(),
        columns: 1,
        panel_size: [330.0, 180.0],
        panels: vec![misfits, parameters],
        ..Sheet::default()
    }
}

fn pale(color: Rgb) -> Rgb {
    color.map(|part| 255 - (255 - part) / 3)
}

/// The residuals of all values at the start and at the best point.
fn errors(report: &Report) -> Sheet {
    let values = report.values();
    let targets = &report.calibration.targets;
    let shown = |residual: f64| residual.clamp(-MOST_SHOWN, MOST_SHOWN);
    let residuals = values
        .iter()
        .flat_map(|value| [value.start.residual, value.best.residual]);
    let far = residuals
        .flatten()
        .map(|residual| shown(residual).abs())
        .fold(2.0, f64::max)
        * 1.05;
    let width = 2.0 * far * NAMES / 300.0;
    let rows = values.len() as f64;
    let height = |k: usize| rows - 0.5 - k as f64;
    let mut marks: Vec<Mark> = Vec::new();
    let band = [[-1.0, 0.0], [1.0, 0.0], [1.0, rows], [-1.0, rows]];
    marks.push(Mark::Area(band.to_vec(), [225, 240, 225]));
    marks.push(Mark::Line(
        vec![[0.0, 0.0], [0.0, rows]],
        Style::full(GRAY, 0.6, ""),
    ));
    marks.extend(names(targets, -far - width, height));
    for (k, value) in values.iter().enumerate() {
        if let (Some(residual), Some(noise)) = (value.best.residual, value.best.noise) {
            let ends = [-1.96, 1.96].map(|side| shown(residual) + side * noise);
            let ends = ends.map(|end| [end.clamp(-far, far), height(k)]);
            marks.push(Mark::Line(
                ends.to_vec(),
                Style::full(color(value.set), 0.8, ""),
            ));
        }
    }
    let dots =
        |residual: fn(&super::report::ValueResult) -> Option<f64>, of: Option<Set>, style| {
            let own = values.iter().enumerate();
            let own = own.filter(|(_, value)| of.is_none_or(|set| value.set == set));
            let points = own.filter_map(|(k, value)| Some([shown(residual(value)?), height(k)]));
            Mark::dots(points.collect::<Vec<_>>(), style)
        };
    marks.push(dots(
        |value| value.start.residual,
        None,
        Style::broken(GRAY, 2.2, "start"),
    ));
    for set in Set::ALL {
        let style = Style::full(color(set), 2.4, &format!("best, {}", set.name()));
        if values.iter().any(|value| value.set == set) {
            marks.push(dots(|value| value.best.residual, Some(set), style));
        }
    }
    let title = format!(
        "{}: how far runs are off the measured values",
        report.calibration.name
    );
    let x = Axis {
        ticks: ticks(far),
        ..Axis::linear(
            "residual [tolerances], 95 % interval of the seeds",
            [-far - width, far],
        )
    };
    let y = blank(rows);
    Sheet {
        title,
        columns: 1,
        panel_size: [NAMES + 300.0, ROW * rows.max(4.0)],
        panels: vec![Panel {
            legend: Some(Corner::Beside),
            ..Panel::new("", x, y, marks)
        }],
        ..Sheet::default()
    }
}

fn color(set: Set) -> Rgb {
    match set {
        Set::Fit => LINES[0],
        Set::HoldOut => LINES[1],
        Set::Transfer => LINES[2],
    }
}

/// Round numbers from −`far` to `far`.
fn ticks(far: f64) -> Vec<(f64, String)> {
    let step = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|step| far / step < 6.0)
        .unwrap_or(5.0);
    let most = (far / step) as i32;
    let tick = |k: i32| {
        (
            f64::from(k) * step,
            (f64::from(k) * step).to_string().replace('-', "\u{2212}"),
        )
    };
    (-most..=most).map(tick).collect()
}

/// An axis of rows without numbers.
fn blank(rows: f64) -> Axis {
    Axis {
        ticks: vec![(-1.0, String::new())],
        ..Axis::linear("", [0.0, rows])
    }
}

/// The names of values in rows.
fn names<'a>(
    targets: impl IntoIterator<Item = &'a Target>,
    x: f64,
    height: impl Fn(usize) -> f64,
) -> Vec<Mark> {
    let name = |(k, target): (usize, &Target)| {
        Mark::Label(Label {
            at: [x, height(k)],
            side: [1, 0],
            text: format!(" {}: {}", target.of, target.quantity),
            color: BLACK,
        })
    };
    targets.into_iter().enumerate().map(name).collect()
}

/// The effects of the parameters on the misfit, and on each value.
fn screening(report: &Report, screened: &Screened) -> Sheet {
    let names_of: Vec<&str> = report
        .calibration
        .parameters
        .iter()
        .map(|of| of.name.as_str())
        .collect();
    let most = |of: fn(&Effect) -> f64| screened.misfit.iter().map(of).fold(1.0, f64::max);
    let [x, y] = [
        Axis::linear(
            "μ*: mean absolute effect on the misfit [tolerances]",
            [0.0, 1.35 * most(|of| of.mean_absolute)],
        ),
        Axis::linear(
            "σ: its standard deviation",
            // Names lie above and below their points.
            [-1, 1].map(|end| f64::from(end).max(-0.1) * 1.15 * most(|of| of.deviation)),
        ),
    ];
    let at = |of: &Effect| [of.mean_absolute, of.deviation];
    let dots = Mark::dots(
        screened.misfit.iter().map(at),
        Style::full(LINES[0], 2.4, ""),
    );
    let named = screened.misfit.iter().zip(&names_of);
    let labels = named.zip([1, -1].into_iter().cycle());
    let labels = labels.map(|((effect, name), above)| {
        Mark::Label(Label {
            at: at(effect),
            side: [1, above],
            text: format!(" {name}"),
            color: BLACK,
        })
    });
    let misfit = Panel::new(
        "on the misfit",
        x,
        y,
        std::iter::once(dots).chain(labels).collect(),
    );
    let panel_size = [
        NAMES + COLUMN * names_of.len() as f64,
        (ROW * screened.values.len() as f64).max(220.0),
    ];
    Sheet {
        title: format!(
            "{}: effects of the parameters over their bounds",
            report.calibration.name
        ),
        columns: 1,
        panel_size,
        panels: vec![map(report, screened, &names_of), misfit],
        ..Sheet::default()
    }
}

/// A map of μ* over parameters and values.
fn map(report: &Report, screened: &Screened, parameters: &[&str]) -> Panel {
    let (columns, rows) = (parameters.len(), screened.values.len());
    let all = screened
        .values
        .iter()
        .flatten()
        .map(|effect| effect.mean_absolute);
    let largest = all.fold(1.0, f64::max);
    let map = ColorMap::viridis([0.0, largest as f32]);
    let height = |k: usize| rows as f64 - 0.5 - k as f64;
    let mut marks = vec![Mark::Cells(Cells {
        extent: [[0.0, 0.0], [columns as f64, rows as f64]],
        columns,
        values: screened
            .values
            .iter()
            .rev()
            .flatten()
            .map(|effect| Some(effect.mean_absolute))
            .collect(),
        map: map.clone(),
    })];
    for (k, effects) in screened.values.iter().enumerate() {
        marks.extend(effects.iter().enumerate().map(|(j, effect)| {
            let color = if effect.mean_absolute > 0.5 * largest {
                [0; 3]
            } else {
                [255; 3]
            };
            let text = format!("{:.1}", effect.mean_absolute);
            Mark::Text([j as f64 + 0.5, height(k)], text, color)
        }));
    }
    let width = NAMES / COLUMN;
    let fitted = report
        .calibration
        .targets
        .iter()
        .filter(|target| target.set == Set::Fit);
    marks.extend(names(fitted, -width, height));
    let x = Axis::names("", parameters.iter().map(|name| (*name).to_owned()));
    let x = Axis {
        range: [-width, columns as f64],
        ..x
    };
    let label = "μ* [tolerances]".to_owned();
    Panel {
        bar: Some(ColorBar { label, map }),
        ..Panel::new(
            "mean absolute effects on the values",
            x,
            blank(rows as f64),
            marks,
        )
    }
}

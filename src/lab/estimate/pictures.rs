//! The picture of an estimate: the way to each result.

use super::answer::{Answer, AtStep, Row};
use super::bounds::Bounded;
use super::costs::name;
use super::run::Runs;
use crate::curves::{BAND, Curve, curves, panel};
use crate::gallery::{around, band, curve, spanned};
use analysis::round;
use output::colors::{Rgb, light};
use output::plot::{Axis, BLACK, Corner, GRAY, Mark, Panel, Point, Sheet, Style, line_color};
use runs::case::RunResult;
use scenario::Preset;

/// The color of a confidence band, as a part of its line's.
const LIGHT: f64 = 0.25;

/// The size of panels, points.
const PANEL: [f64; 2] = [190.0, 130.0];

/// Three panels for each result: its mean at each step, with the limit; its error after each round of runs; and the
/// error over the computing time, beside that of the default step.
pub fn sheet(runs: &Runs, answer: &Answer) -> Sheet {
    let wanted = runs.question.request.wanted.iter();
    let places = wanted.enumerate();
    let rows = places.filter_map(|(k, wanted)| Some((k, answer.row(&wanted.name)?)));
    let panels =
        rows.flat_map(|(k, row)| [by_step(row), by_round(runs, k, row), by_time(runs, k, row)]);
    let title = format!(
        "{}: {}; {} % intervals from chance and time step",
        answer.scenario,
        answer.profile,
        round::brief(100.0 * answer.confidence)
    );
    Sheet::new(&title, 3, PANEL, panels.collect())
}

/// The mean curves of the runs at the step with most runs; `None` if they measure none. Errors of the step are not part
/// of their bands.
pub fn curve_sheet(runs: &Runs, answer: &Answer) -> Option<(Sheet, Vec<(String, Curve)>)> {
    let level = runs.levels.iter().max_by_key(|level| level.results.len())?;
    let results: Vec<&RunResult> = level.results.iter().flatten().collect();
    let all = curves(&results);
    if all.is_empty() {
        return None;
    }
    let panels = all.iter().filter_map(|curve| {
        let label = format!("mean of {} runs", curve.runs);
        let panel = panel(&[(curve, line_color(0), label)])?;
        Some(panel.with_legend(Corner::LowerRight))
    });
    let step = format!("step {} s", round::brief(level.rung.step));
    let title = format!("{}: {}, {step}; {BAND}", answer.scenario, answer.profile);
    let sheet = Sheet::new(&title, all.len().min(3), PANEL, panels.collect());
    Some((
        sheet,
        all.into_iter().map(|curve| (step.clone(), curve)).collect(),
    ))
}

/// A panel for each bound; `None` without one.
pub fn bound_sheet(answer: &Answer) -> Option<Sheet> {
    let panels: Vec<Panel> = answer.bounds.iter().map(of_bound).collect();
    let title = format!("{}: {}", answer.scenario, answer.profile);
    (!panels.is_empty()).then(|| Sheet::new(&title, panels.len().min(3), PANEL, panels))
}

/// The share of runs up to each value, with the bound.
fn of_bound(bound: &Bounded) -> Panel {
    let mut values: Vec<f64> = bound.values.iter().flatten().copied().collect();
    values.sort_by(f64::total_cmp);
    let all = bound.values.len().max(1) as f64;
    let steps = values.iter().enumerate();
    let steps = steps.flat_map(|(k, &value)| [k, k + 1].map(|count| [value, count as f64 / all]));
    let ends = spanned(values.iter().copied().chain(bound.value));
    let mut marks = vec![
        Mark::line(
            ends.map(|x| [x, bound.share]),
            Style::broken(GRAY, 1.0, "share asked for"),
        ),
        Mark::line(steps, Style::full(line_color(0), 1.2, "share of runs")),
    ];
    marks.extend(bound.value.map(|value| {
        let line = [0.0, 1.0].map(|y| [value, y]);
        Mark::line(line, Style::full(BLACK, 1.2, "bound"))
    }));
    let x = Axis::linear(&bound.name, ends);
    let y = Axis::linear("share of runs", [0.0, 1.0]);
    Panel::new("", x, y, marks).with_legend(Corner::UpperLeft)
}

/// The color of a preset in pictures of costs.
pub(super) fn color(preset: Preset) -> Rgb {
    match preset {
        Preset::Paper => GRAY,
        Preset::Fast => line_color(1),
        Preset::Accurate => line_color(2),
    }
}

fn by_step(row: &Row) -> Panel {
    let coarsest = row.steps.iter().map(|at| at.step).fold(0.0, f64::max);
    let reached = row.reached;
    let error = |at: &AtStep| row.deviation / (at.runs as f64).sqrt();
    let points = row.steps.iter().map(|at| Point {
        x: at.step,
        y: at.mean,
        error: 2.0 * error(at),
    });
    let ends = row
        .steps
        .iter()
        .flat_map(|at| [at.mean - 2.0 * error(at), at.mean + 2.0 * error(at)]);
    let ends = ends.chain([reached.value - reached.error, reached.value + reached.error]);
    let color = line_color(0);
    let across = [-0.02 * coarsest, 1.05 * coarsest];
    let [upper, lower] =
        [1.0, -1.0].map(|side| across.map(|x| [x, reached.value + side * reached.error]));
    let steps = (0..=60).map(|k| f64::from(k) / 60.0 * 1.05 * coarsest);
    let fit = steps.map(|step| [step, row.limit.at(step)]);
    let marks = vec![
        band(&upper, &lower, light(color, LIGHT)),
        Mark::line(
            across.map(|x| [x, reached.value]),
            Style::full(color, 1.2, "estimate, interval"),
        ),
        Mark::line(fit, Style::broken(color, 1.0, "expected means")),
        Mark::Points(
            points.collect(),
            Style::full(BLACK, 2.4, "means ± 2 standard errors"),
        ),
    ];
    let x = Axis::linear("time step [s]", [-0.03 * coarsest, 1.06 * coarsest]);
    let y = Axis::linear(&row.name, spanned(ends));
    // Away from the means at fine steps.
    let corner = match row.limit.error_at(coarsest) < 0.0 {
        true => Corner::LowerLeft,
        false => Corner::UpperLeft,
    };
    Panel::new("", x, y, marks).with_legend(corner)
}

fn by_round(runs: &Runs, k: usize, row: &Row) -> Panel {
    let reached = runs
        .looks
        .iter()
        .filter_map(|look| Some((look.runs.iter().sum::<usize>() as f64, look.reached[k]?)));
    let reached: Vec<_> = reached.collect();
    let line = |of: fn(&super::Reached) -> f64, number: usize, label: &str| {
        let points = reached.iter().map(|(runs, reached)| [*runs, of(reached)]);
        let points = points.filter(|point| point[1] > 0.0);
        curve(points, Style::full(line_color(number), 1.2, label), 2.2)
    };
    let wanted = runs.question.request.wanted[k].error.of(row.reached.value);
    let most = reached.last().map_or(1.0, |(runs, _)| *runs);
    let mut marks = vec![Mark::line(
        [[0.0, wanted], [1.05 * most, wanted]],
        Style::broken(GRAY, 1.0, "wanted"),
    )];
    marks.extend(line(|reached| reached.error, 0, "both"));
    marks.extend(line(|reached| reached.seeds, 1, "seeds"));
    marks.extend(line(|reached| reached.step, 2, "step"));
    let errors = reached.iter().flat_map(|(_, r)| [r.error, r.seeds, r.step]);
    let y = Axis::log("half width", around(errors.chain([wanted]), 1.5));
    let x = Axis::linear("runs", [0.0, 1.05 * most]);
    Panel::new("", x, y, marks).with_legend(Corner::LowerLeft)
}

fn by_time(runs: &Runs, k: usize, row: &Row) -> Panel {
    let factor = runs.measured_factor();
    let secs = |counts: &[usize]| -> f64 {
        let levels = runs.levels.iter().zip(counts);
        levels
            .map(|(level, runs)| level.expected_secs * factor * *runs as f64)
            .sum()
    };
    let looks = runs.looks.iter();
    let made = looks.filter_map(|look| Some([secs(&look.runs), look.reached[k]?.error]));
    let made: Vec<[f64; 2]> = made.collect();
    // Chance falls with the number of runs, the error of the step stays.
    let last = made.last().map_or(1.0, |point| point[0]);
    let presets = match row.presets.as_slice() {
        [] => std::slice::from_ref(&row.default),
        presets => presets,
    };
    let lines = presets.iter().map(|of| -> Vec<[f64; 2]> {
        let runs = (0..24).map(|power| 1.5_f64.powi(power));
        let points = runs.map(|runs| [runs * of.timed.secs, of.error(runs)]);
        points.filter(|point| point[0] <= 3.0 * last).collect()
    });
    let lines: Vec<Vec<[f64; 2]>> = lines.collect();
    let points = || made.iter().chain(lines.iter().flatten());
    let x = Axis::log(
        "computing time [s]",
        around(points().map(|point| point[0]), 1.3),
    );
    let y = Axis::log("half width", around(points().map(|point| point[1]), 1.3));
    let mut marks: Vec<Mark> = presets
        .iter()
        .zip(&lines)
        .map(|(of, line)| {
            let label = format!("{}, its error known", name(of.timed.preset));
            let style = Style::broken(color(of.timed.preset), 1.2, &label);
            Mark::line(line.iter().copied(), style)
        })
        .collect();
    marks.extend(curve(
        made.iter().copied(),
        Style::full(line_color(0), 1.2, "estimate"),
        2.2,
    ));
    marks.extend(
        made.last()
            .map(|&at| Mark::dots([at], Style::broken(BLACK, 5.0, "result"))),
    );
    Panel::new("", x, y, marks).with_legend(Corner::LowerLeft)
}

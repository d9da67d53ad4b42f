//! The picture of an estimate: the way to each result.

use super::answer::{Answer, AtStep, Row};
use super::bounds::Bounded;
use super::run::Runs;
use super::series::Reached;
use crate::curves::{BAND, Curve, curves, panel};
use crate::gallery::{around, band, curve, spanned};
use analysis::round;
use output::colors::light;
use output::plot::{Axis, BLACK, Corner, GRAY, Mark, Panel, Point, Sheet, Style, line_color};
use runs::case::RunResult;

/// The color of a confidence band, as a part of its line's.
const LIGHT: f64 = 0.25;

/// The size of panels, points.
const PANEL: [f64; 2] = [190.0, 130.0];

/// Three panels for each result: its mean at each step, with the limit; its error after each round of runs; and the
/// error over the computing time, beside that of the default step.
pub fn sheet(runs: &Runs, answer: &Answer) -> Sheet {
    let wanted = runs.question.request.wanted.iter().enumerate();
    let rows = wanted.filter_map(|(k, wanted)| Some((k, answer.row(&wanted.name)?)));
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
fn of_bound(bounded: &Bounded) -> Panel {
    let Bounded {
        bound,
        value,
        values,
        ..
    } = bounded;
    let all = values.len().max(1) as f64;
    let mut known: Vec<f64> = values.iter().flatten().copied().collect();
    known.sort_by(f64::total_cmp);
    let ranked = known.iter().enumerate();
    let stairs = ranked.flat_map(|(k, &value)| [k, k + 1].map(|count| [value, count as f64 / all]));
    let ends = spanned(known.iter().copied().chain(*value));
    let asked = Style::broken(GRAY, 1.0, "share asked for");
    let mut marks = vec![
        Mark::line(ends.map(|x| [x, bound.share]), asked),
        Mark::line(stairs, Style::full(line_color(0), 1.2, "share of runs")),
    ];
    marks.extend(value.map(|value| {
        let line = [0.0, 1.0].map(|y| [value, y]);
        Mark::line(line, Style::full(BLACK, 1.2, "bound"))
    }));
    let x = Axis::linear(&bound.name, ends);
    let y = Axis::linear("share of runs", [0.0, 1.0]);
    Panel::new("", x, y, marks).with_legend(Corner::UpperLeft)
}

fn by_step(row: &Row) -> Panel {
    let coarsest = row.steps.iter().map(|at| at.step).fold(0.0, f64::max);
    let reached = row.reached;
    let error = |at: &AtStep| 2.0 * row.deviation / (at.runs as f64).sqrt();
    let points = row.steps.iter().map(|at| Point {
        x: at.step,
        y: at.mean,
        error: error(at),
    });
    let interval = [reached.value - reached.error, reached.value + reached.error];
    let levels = row.steps.iter();
    let ends = levels.flat_map(|at| [at.mean - error(at), at.mean + error(at)]);
    let y = Axis::linear(&row.name, spanned(ends.chain(interval)));
    let x = Axis::linear("time step [s]", [-0.03 * coarsest, 1.06 * coarsest]);
    let color = line_color(0);
    let across = |y: f64| [-0.02 * coarsest, 1.05 * coarsest].map(|x| [x, y]);
    let [lower, upper] = interval.map(across);
    let steps = (0..=60).map(|k| f64::from(k) / 60.0 * 1.05 * coarsest);
    let fit = steps.map(|step| [step, row.limit.at(step)]);
    let estimate = Style::full(color, 1.2, "estimate, interval");
    let expected = Style::broken(color, 1.0, "expected means");
    let means = Style::full(BLACK, 2.4, "means ± 2 standard errors");
    let marks = vec![
        band(&upper, &lower, light(color, LIGHT)),
        Mark::line(across(reached.value), estimate),
        Mark::line(fit, expected),
        Mark::Points(points.collect(), means),
    ];
    // Away from the means at fine steps.
    let corner = match row.limit.error_at(coarsest) < 0.0 {
        true => Corner::LowerLeft,
        false => Corner::UpperLeft,
    };
    Panel::new("", x, y, marks).with_legend(corner)
}

fn by_round(runs: &Runs, k: usize, row: &Row) -> Panel {
    let looks = runs.looks.iter();
    let reached = looks.filter_map(|look| Some((look.runs.iter().sum(), look.reached[k]?)));
    let reached: Vec<(usize, Reached)> = reached.collect();
    let line = |of: fn(&Reached) -> f64, number: usize, label: &str| {
        let points = reached
            .iter()
            .map(|(runs, reached)| [*runs as f64, of(reached)]);
        let visible = points.filter(|point| point[1] > 0.0);
        curve(visible, Style::full(line_color(number), 1.2, label), 2.2)
    };
    let wanted = runs.question.request.wanted[k].error.of(row.reached.value);
    let across = [
        0.0,
        1.05 * reached.last().map_or(1.0, |(runs, _)| *runs as f64),
    ];
    let asked = Style::broken(GRAY, 1.0, "wanted");
    let mut marks = vec![Mark::line(across.map(|x| [x, wanted]), asked)];
    marks.extend(line(|reached| reached.error, 0, "both"));
    marks.extend(line(|reached| reached.seeds, 1, "seeds"));
    marks.extend(line(|reached| reached.step, 2, "step"));
    let errors = reached.iter().flat_map(|(_, r)| [r.error, r.seeds, r.step]);
    let y = Axis::log("half width", around(errors.chain([wanted]), 1.5));
    Panel::new("", Axis::linear("runs", across), y, marks).with_legend(Corner::LowerLeft)
}

fn by_time(runs: &Runs, k: usize, row: &Row) -> Panel {
    let factor = runs.measured_factor();
    let secs = |counts: &[usize]| -> f64 {
        let levels = runs.levels.iter().zip(counts);
        let secs = levels.map(|(level, runs)| level.expected_secs * factor * *runs as f64);
        secs.sum()
    };
    let looks = runs.looks.iter();
    let made = looks.filter_map(|look| Some([secs(&look.runs), look.reached[k]?.error]));
    let made: Vec<[f64; 2]> = made.collect();
    let last = made.last().map_or(1.0, |point| point[0]);
    // Chance falls with the number of runs, the error of the step stays.
    let default = (0..24).map(|power| {
        let runs = 1.5_f64.powi(power);
        [runs * row.default.timed.secs, row.default.error(runs)]
    });
    let default: Vec<[f64; 2]> = default.filter(|point| point[0] <= 3.0 * last).collect();
    let along = |axis: usize| made.iter().chain(&default).map(move |point| point[axis]);
    let x = Axis::log("computing time [s]", around(along(0), 1.3));
    let y = Axis::log("half width", around(along(1), 1.3));
    let known = Style::broken(GRAY, 1.2, "paper, its error known");
    let mut marks = vec![Mark::line(default.iter().copied(), known)];
    let estimate = Style::full(line_color(0), 1.2, "estimate");
    marks.extend(curve(made.iter().copied(), estimate, 2.2));
    let result = Style::broken(BLACK, 5.0, "result");
    marks.extend(made.last().map(|&at| Mark::dots([at], result)));
    Panel::new("", x, y, marks).with_legend(Corner::LowerLeft)
}

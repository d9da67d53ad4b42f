//! Pictures of all results beside what was measured.

use super::check::Runs;
use super::keys::{Case, Check, Diagram, Expected};
use crate::curves::{self, Curve};
use crate::gallery::{BAND, band, curve, distinct, with_legend};
use output::colors::Rgb;
use output::plot::{Axis, BLACK, GRAY, Mark, Panel, Point, Sheet, Style, line_color};
use runs::summary::Summary;

/// The points of a curve.
const POINTS: u32 = 100;
/// The most panels in a row.
const IN_A_ROW: usize = 4;
/// The part of the passages from which the measured flow is drawn.
const BEGINNING: f64 = 0.1;
/// The end of axes of speed, m/s.
const FASTEST: f64 = 1.6;

/// The ends of the names of flow, density and speed at a line.
const AT_LINES: [&str; 3] = ["_flow_per_s", "_density_per_m2", "_speed_m_per_s"];

/// A line of a run at which flow, density and speed were measured.
struct Line<'a> {
    run: &'a str,
    name: &'a str,
    checks: [&'a Check; 3],
    /// P/s, P/m² and m/s.
    measured: [f64; 3],
}

/// `fundamental`, speeds by density, and `passages`, numbers of people over time at each line, of the scenes with runs.
pub fn sheets(cases: &[Case], runs: &[Runs]) -> Vec<(&'static str, Sheet)> {
    let lines: Vec<Line> = cases.iter().filter_map(|case| line(case, runs)).collect();
    let of = |diagram| cases.iter().find(|case| case.diagram == Some(diagram));
    let panels = [
        at_lines(&lines, runs),
        of(Diagram::SingleFile).and_then(|case| single_file(case, runs)),
        of(Diagram::EndlessCorridor).and_then(|case| corridor(case, runs)),
    ];
    let fundamental: Vec<Panel> = panels.into_iter().flatten().collect();
    let passages = lines
        .iter()
        .filter_map(|line| passages(line, runs))
        .collect();
    let past_the_line = format!("People past the line; {}", curves::BAND);
    let all = [
        ("fundamental", "Speed by density", fundamental),
        ("passages", &past_the_line, passages),
    ];
    let drawn = all.into_iter().filter(|(_, _, panels)| !panels.is_empty());
    let sheet = |(stem, title, panels): (_, &str, Vec<Panel>)| {
        let columns = panels.len().min(IN_A_ROW);
        let panels = with_legend(panels, columns);
        (stem, Sheet::new(title, columns, [200.0, 170.0], panels))
    };
    drawn.map(sheet).collect()
}

/// The line whose values a case compares with measured ones, also in data.
fn line<'a>(case: &'a Case, runs: &[Runs]) -> Option<Line<'a>> {
    let name = case.checks.first()?.metric()?.strip_suffix(AT_LINES[0])?;
    let checks = AT_LINES.map(|end| {
        let is_own = |check: &&Check| check.metric() == Some(&format!("{name}{end}"));
        case.checks.iter().find(is_own)
    });
    let [Some(flow), Some(density), Some(speed)] = checks else {
        return None;
    };
    let checks = [flow, density, speed];
    let measured = |check: &Check| match check.expected {
        Expected::Near { value, .. } => {
            value.or_else(|| check.value(|run| runs.first()?.data(run)))
        }
        _ => None,
    };
    Some(Line {
        run: flow.of.first()?,
        name,
        checks,
        measured: [measured(flow)?, measured(density)?, measured(speed)?],
    })
}

/// The profiles with their colors, in the order of the runs.
fn profiles<'a>(runs: &'a [Runs<'a>]) -> impl Iterator<Item = (&'a str, Rgb)> {
    let names = distinct(runs.iter().map(|run| run.profile()));
    names.into_iter().zip((0..).map(line_color))
}

/// The mean of a value over the seeds of a profile; `None` if a seed lacks it.
fn mean(runs: &[Runs], profile: &str, check: &Check) -> Option<f64> {
    let own = runs.iter().filter(|runs| runs.profile() == profile);
    let means = own.map(|runs| check.value(|label| runs.of(label)));
    let values: Vec<f64> = means.collect::<Option<_>>()?;
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// A panel with speeds by density.
fn speeds(title: &str, density: &str, most: f64, marks: Vec<Mark>) -> Panel {
    let x = Axis::linear(density, [0.0, most]);
    let y = Axis::linear("speed [m/s]", [0.0, FASTEST]);
    Panel::new(title, x, y, marks)
}

/// The checks of a case that have a place in its diagram, with their densities.
fn placed(case: &Case) -> impl Iterator<Item = (f64, &Check)> {
    let checks = case.checks.iter();
    checks.filter_map(|check| Some((check.at?, check)))
}

/// The values of these checks by density for each profile; `None` if the first profile has none.
fn rings(case: &Case, runs: &[Runs]) -> Option<Vec<Mark>> {
    let points = |profile: &str| -> Vec<[f64; 2]> {
        let point = |(density, check)| Some([density, mean(runs, profile, check)?]);
        placed(case).filter_map(point).collect()
    };
    let is_known = !points(runs.first()?.profile()).is_empty();
    let curves = profiles(runs).flat_map(|(profile, color)| {
        let style = Style::full(color, 1.2, profile);
        curve(points(profile), style, 2.4)
    });
    is_known.then(|| curves.collect())
}

/// Speeds in an endless corridor.
fn corridor(case: &Case, runs: &[Runs]) -> Option<Panel> {
    let found = rings(case, runs)?;
    let line = |speed: fn(f64) -> f64, style| {
        let densities = (1..=POINTS).map(|k| 5.0 * f64::from(k) / f64::from(POINTS));
        let points = densities.map(|density| [density, speed(density)]);
        let is_shown = |at: &[f64; 2]| (0.0..=FASTEST).contains(&at[1]);
        Mark::line(points.filter(is_shown), style)
    };
    let weidmann = |density: f64| 1.34 * (1.0 - (-1.913 * (1.0 / density - 1.0 / 5.4)).exp());
    let sfpe = |density: f64| match density < 0.54 {
        true => 1.2,
        false => 1.4 * (1.0 - 0.266 * density),
    };
    let measured = placed(case).filter_map(|(x, check)| match check.expected {
        Expected::Near { value, tolerance } => {
            let y = value?;
            let error = tolerance * y;
            Some(Point { x, y, error })
        }
        _ => None,
    });
    let mut marks = vec![
        line(weidmann, Style::full(GRAY, 1.0, "Weidmann 1993")),
        line(sfpe, Style::broken(GRAY, 1.0, "SFPE")),
    ];
    marks.extend(found);
    let style = Style::full(BLACK, 2.4, "measured, ± 10 %");
    marks.push(Mark::Points(measured.collect(), style));
    Some(speeds("endless corridor", "density [P/m²]", 5.0, marks))
}

/// Density and speed at each line, joined to what was measured there.
fn at_lines(lines: &[Line], runs: &[Runs]) -> Option<Panel> {
    let of_line = |line: &Line| [line.measured[1], line.measured[2]];
    let mut marks = Vec::new();
    for (profile, color) in profiles(runs) {
        let simulated = lines.iter().filter_map(|line| {
            let [_, density, speed] = line.checks.map(|check| mean(runs, profile, check));
            Some([of_line(line), [density?, speed?]])
        });
        let found: Vec<[[f64; 2]; 2]> = simulated.collect();
        let links = found.iter();
        marks.extend(links.map(|&ends| Mark::line(ends, Style::full(color, 0.5, ""))));
        let ends = found.iter().map(|way| way[1]);
        marks.push(Mark::dots(ends, Style::full(color, 2.4, "")));
    }
    if marks.is_empty() {
        return None;
    }
    let measured = lines.iter().map(of_line);
    marks.push(Mark::dots(measured, Style::full(BLACK, 2.4, "")));
    let title = "gaps, door and corridors; black: measured";
    Some(speeds(title, "density [P/m²]", 8.0, marks))
}

/// Speeds in single file, in the band of measured ones.
fn single_file(case: &Case, runs: &[Runs]) -> Option<Panel> {
    let found = rings(case, runs)?;
    let end = |end: usize| {
        let ends = placed(case).map(move |(at, check)| [at, check.expected.bounds()[end]]);
        ends.collect::<Vec<_>>()
    };
    let mut marks = vec![band(&end(0), &end(1), BAND)];
    marks.extend(found);
    let title = "single file; gray: measured, 10 to 90 %";
    Some(speeds(title, "density [P/m]", 2.0, marks))
}

/// The mean number of people past a line over time with its band, and the measured flow, or the number in the data.
fn passages(line: &Line, runs: &[Runs]) -> Option<Panel> {
    let (mut bands, mut lines) = (Vec::new(), Vec::new());
    let (mut latest, mut most) = (0.0_f64, 0.0_f64);
    let mut begins = f64::INFINITY;
    for (profile, color) in profiles(runs) {
        let own = runs.iter().filter(|run| run.profile() == profile);
        let times = own.filter_map(|run| run.of(line.run)?.data(line.name));
        let Some(curve) = Curve::of_passages(line.name, &times.collect::<Vec<_>>()) else {
            continue;
        };
        let (end, last) = *curve.points.last()?;
        (latest, most) = (latest.max(end), most.max(last.mean));
        let points = curve.points.iter();
        let begun = points.filter(|(_, point)| point.mean >= BEGINNING * last.mean);
        begins = begun.map(|(time, _)| *time).fold(begins, f64::min);
        let [band, mean] = curve.marks(color, profile);
        bands.push(band);
        lines.push(mean);
    }
    if !begins.is_finite() {
        return None;
    }
    let mut marks = [bands, lines].concat();
    let first = BEGINNING * most;
    let until = begins + (most - first) / line.measured[0];
    let (measured, style) = match runs.first().and_then(|run| run.data(line.run)) {
        None => (
            vec![[begins, first], [until, most]],
            Style::broken(BLACK, 1.2, "measured flow"),
        ),
        Some(data) => (steps(data, line.name)?, Style::full(BLACK, 1.2, "measured")),
    };
    let [end, count] = measured.last().copied().unwrap_or_default();
    marks.push(Mark::Line(measured, style));
    let x = Axis::linear("time [s]", [0.0, latest.max(end)]);
    let y = Axis::linear("people", [0.0, most.max(count)]);
    Some(Panel::new(line.run, x, y, marks))
}

/// The number of people past a line over time.
fn steps(of: &Summary, line: &str) -> Option<Vec<[f64; 2]>> {
    let times = of.data::<Vec<f64>>(line)?;
    let counts = (1..).map(f64::from);
    let steps = times.into_iter().zip(counts);
    Some(steps.map(|(time, count)| [time, count]).collect())
}

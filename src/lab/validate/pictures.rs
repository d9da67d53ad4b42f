//! Pictures of all results beside what was measured.

use super::bottlenecks::{MEASURED, Measured};
use super::corridors::SPEEDS;
use super::data;
use crate::lab::suite::Runs;
use crate::lab::verify::speeds::BANDS;
use crate::output::plot::{Axis, BLACK, Corner, GRAY, LINES, Mark, Panel, Point, Sheet, Style};
use crate::runs::summary::Summary;

/// The tolerance of measured speeds, as a part of them: half an error bar.
const TOLERANCE: f64 = 0.10;
/// The points of a curve.
const POINTS: u32 = 100;
/// The most panels in a row.
const IN_A_ROW: usize = 4;
/// The part of the passages from which the measured flow is drawn.
const BEGINNING: f64 = 0.1;

/// `fundamental`, speeds by density, and `passages`, numbers of people over time at each line, of the scenes with runs.
pub fn sheets(runs: &[Runs]) -> Vec<(&'static str, Sheet)> {
    let fundamental = [lines(runs), single_file(runs), corridor(runs)];
    let passages = all(runs).map(|measured| passages(&measured, runs));
    let all = [
        (
            "fundamental",
            "Speed by density",
            fundamental.into_iter().flatten().collect(),
        ),
        (
            "passages",
            "People past the line",
            passages.flatten().collect::<Vec<_>>(),
        ),
    ];
    let drawn = all.into_iter().filter(|(_, _, panels)| !panels.is_empty());
    let sheet = |(stem, title, panels): (_, &str, Vec<Panel>)| {
        let sheet = Sheet {
            title: title.to_owned(),
            columns: panels.len().min(IN_A_ROW),
            panel_size: [200.0, 170.0],
            panels: with_legend(panels),
            ..Sheet::default()
        };
        (stem, sheet)
    };
    drawn.map(sheet).collect()
}

/// The legend beside the last panel of the first row.
fn with_legend(mut panels: Vec<Panel>) -> Vec<Panel> {
    let place = panels.len().min(IN_A_ROW) - 1;
    panels[place].legend = Some(Corner::Beside);
    panels
}

/// The profiles with their colors, in the order of the runs.
fn profiles<'a>(runs: &'a [Runs<'a>]) -> Vec<(&'a str, [u8; 3])> {
    let mut names: Vec<&str> = Vec::new();
    for run in runs {
        if !names.contains(&run.profile()) {
            names.push(run.profile());
        }
    }
    let colors = LINES.into_iter().cycle();
    names.into_iter().zip(colors).collect()
}

/// The mean of a value of a run over the seeds of a profile; `None` if a seed lacks it.
fn mean(runs: &[Runs], profile: &str, label: &str, value: &str) -> Option<f64> {
    let own = runs.iter().filter(|run| run.profile() == profile);
    let values = own.map(|run| run.metric(label, value).ok().flatten());
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// A line with a dot at each value, for each profile.
fn curves<'a>(
    runs: &'a [Runs<'a>],
    values: impl Fn(&str) -> Vec<[f64; 2]> + 'a,
) -> impl Iterator<Item = Mark> + 'a {
    profiles(runs)
        .into_iter()
        .flat_map(move |(profile, color)| {
            let points = values(profile);
            [
                Mark::Line(points.clone(), Style::full(color, 1.2, "")),
                Mark::dots(points, Style::full(color, 2.4, profile)),
            ]
        })
}

/// Speeds in an endless corridor.
fn corridor(runs: &[Runs]) -> Option<Panel> {
    let speed = |profile: &str| {
        let speeds = SPEEDS.iter().filter_map(|(run, density, _)| {
            mean(runs, profile, run, "ring_speed_m_per_s").map(|speed| [*density, speed])
        });
        speeds.collect::<Vec<_>>()
    };
    runs.first()
        .filter(|run| !speed(run.profile()).is_empty())?;
    let curve = |speed: fn(f64) -> f64| {
        let densities = (1..=POINTS).map(|k| 5.0 * f64::from(k) / f64::from(POINTS));
        let points = densities.map(|density| [density, speed(density)]);
        points
            .filter(|[_, speed]| (0.0..=1.6).contains(speed))
            .collect()
    };
    let weidmann = |density: f64| 1.34 * (1.0 - (-1.913 * (1.0 / density - 1.0 / 5.4)).exp());
    let sfpe = |density: f64| {
        if density < 0.54 {
            1.2
        } else {
            1.4 * (1.0 - 0.266 * density)
        }
    };
    let measured = SPEEDS.map(|(_, x, y)| Point {
        x,
        y,
        error: TOLERANCE * y,
    });
    let mut marks = vec![
        Mark::Line(curve(weidmann), Style::full(GRAY, 1.0, "Weidmann 1993")),
        Mark::Line(curve(sfpe), Style::broken(GRAY, 1.0, "SFPE")),
    ];
    marks.extend(curves(runs, speed));
    let style = Style::full(BLACK, 2.4, "measured, ± 10 %");
    marks.push(Mark::Points(measured.to_vec(), style));
    let x = Axis::linear("density [P/m²]", [0.0, 5.0]);
    let y = Axis::linear("speed [m/s]", [0.0, 1.6]);
    Some(Panel::new("endless corridor", x, y, marks))
}

/// Density and speed at each line, joined to what was measured there.
fn lines(runs: &[Runs]) -> Option<Panel> {
    let value = |profile: &str, at: &Measured, what: &str| {
        mean(runs, profile, at.run, &format!("{}_{what}", at.line))
    };
    let mut marks = Vec::new();
    for (profile, color) in profiles(runs) {
        let found = all(runs).filter_map(|at| {
            let density = value(profile, &at, "density_per_m2")?;
            let speed = value(profile, &at, "speed_m_per_s")?;
            Some([[at.density, at.speed], [density, speed]])
        });
        let found: Vec<[[f64; 2]; 2]> = found.collect();
        let ways = found
            .iter()
            .map(|way| Mark::Line(way.to_vec(), Style::full(color, 0.5, "")));
        marks.extend(ways);
        marks.push(Mark::dots(
            found.iter().map(|way| way[1]),
            Style::full(color, 2.4, ""),
        ));
    }
    if marks.is_empty() {
        return None;
    }
    let measured = all(runs).map(|at| [at.density, at.speed]);
    marks.push(Mark::dots(measured, Style::full(BLACK, 2.4, "")));
    let x = Axis::linear("density [P/m²]", [0.0, 8.0]);
    let y = Axis::linear("speed [m/s]", [0.0, 1.6]);
    Some(Panel::new(
        "gaps, door and corridors; black: measured",
        x,
        y,
        marks,
    ))
}

/// Speeds in single file, in the band of measured ones.
fn single_file(runs: &[Runs]) -> Option<Panel> {
    let density = |written: &str| written.parse().unwrap_or(f64::NAN);
    let speed = |profile: &str| {
        let speeds = BANDS.iter().filter_map(|(run, at, _)| {
            mean(runs, profile, run, "ring_speed_m_per_s").map(|speed| [density(at), speed])
        });
        speeds.collect::<Vec<_>>()
    };
    runs.first()
        .filter(|run| !speed(run.profile()).is_empty())?;
    let low = BANDS.map(|(_, at, [low, _])| [density(at), low]);
    let high = BANDS.map(|(_, at, [_, high])| [density(at), high]);
    let band = low.into_iter().chain(high.into_iter().rev()).collect();
    let mut marks = vec![Mark::Area(band, [225, 225, 225])];
    marks.extend(curves(runs, speed));
    let x = Axis::linear("density [P/m]", [0.0, 2.0]);
    let y = Axis::linear("speed [m/s]", [0.0, 1.6]);
    Some(Panel::new(
        "single file; gray: measured, 10 to 90 %",
        x,
        y,
        marks,
    ))
}

/// What was measured at all lines, also in the data of the runs.
fn all<'a>(runs: &'a [Runs<'a>]) -> impl Iterator<Item = Measured> + 'a {
    let data = runs.first().into_iter().flat_map(data::measured);
    MEASURED.into_iter().chain(data)
}

/// The number of people past a line over time, and the measured flow, or the number in the data.
fn passages(at: &Measured, runs: &[Runs]) -> Option<Panel> {
    let mut marks = Vec::new();
    let (mut latest, mut most) = (0.0_f64, 0.0_f64);
    let mut begins = f64::INFINITY;
    for (profile, color) in profiles(runs) {
        for run in runs.iter().filter(|run| run.profile() == profile) {
            let Some(steps) = run.of(at.run).ok().and_then(|run| steps(run, at.line)) else {
                continue;
            };
            let [end, count] = steps.last().copied().unwrap_or_default();
            (latest, most) = (latest.max(end), most.max(count));
            let tenth = steps.get((BEGINNING * steps.len() as f64) as usize);
            begins = tenth.map_or(f64::INFINITY, |[time, _]| *time).min(begins);
            let label = if run.seed() == runs[0].seed() {
                profile
            } else {
                ""
            };
            marks.push(Mark::Line(steps, Style::full(color, 1.0, label)));
        }
    }
    if !begins.is_finite() {
        return None;
    }
    let first = BEGINNING * most;
    let until = begins + (most - first) / at.flow;
    let (measured, style) = match runs.first().and_then(|run| run.data(at.run)) {
        None => (
            vec![[begins, first], [until, most]],
            Style::broken(BLACK, 1.2, "measured flow"),
        ),
        Some(data) => (steps(data, at.line)?, Style::full(BLACK, 1.2, "measured")),
    };
    let [end, count] = measured.last().copied().unwrap_or_default();
    marks.push(Mark::Line(measured, style));
    let x = Axis::linear("time [s]", [0.0, latest.max(end)]);
    let y = Axis::linear("people", [0.0, most.max(count)]);
    Some(Panel::new(at.run, x, y, marks))
}

/// The number of people past a line over time.
fn steps(of: &Summary, line: &str) -> Option<Vec<[f64; 2]>> {
    let times = of.data::<Vec<f64>>(line)?;
    let steps = (1..).zip(times);
    Some(
        steps
            .map(|(count, time)| [time, f64::from(count)])
            .collect(),
    )
}

//! The picture of all values: how far each is from the measured one.

use super::finding::{Finding, is_fitted};
use super::report::Report;
use crate::gallery::BAND;
use output::plot::{Axis, Corner, GRAY, Mark, Panel, Sheet, Style, line_color};

/// Deviations farther out are drawn at this one, tolerances.
const FARTHEST: f64 = 8.0;
/// The height of a line, points.
const LINE: f64 = 9.5;
/// The width of the panel, points.
const WIDTH: f64 = 360.0;

/// `deviations`: for each value of each case a line with a dot for each profile, at the deviation of the mean over
/// the seeds from the measured value, in tolerances. Dots are hollow where a profile was not fitted to the value.
/// `None` without measured values.
pub fn sheet(report: &Report) -> Option<(&'static str, Sheet)> {
    let mut lines: Vec<(&Finding, usize)> = Vec::new();
    let cases = report.findings.chunk_by(|a, b| a.case.name == b.case.name);
    for findings in cases {
        let checks = findings[0].checks.iter().enumerate();
        let measured = checks.filter(|(_, check)| check.expected.is_measured());
        lines.extend(measured.map(|(k, _)| (&findings[0], k)));
    }
    // The first line is drawn at the top.
    let line = |finding: &Finding, check: usize| {
        let is_own = |&(of, k): &(&Finding, usize)| of.case.name == finding.case.name && k == check;
        let place = lines.iter().position(is_own)?;
        Some((lines.len() - place) as f64 - 0.5)
    };
    let mut marks = vec![
        Mark::Area(frame([-1.0, 1.0], lines.len()), BAND),
        Mark::line(
            [[0.0, 0.0], [0.0, lines.len() as f64]],
            Style::full(GRAY, 0.8, ""),
        ),
    ];
    for (k, profile) in report.profiles.iter().enumerate() {
        let own = report.findings.iter().filter(|one| one.profile == *profile);
        let mut dots = [Vec::new(), Vec::new()];
        for finding in own {
            for (check, judgment) in finding.checks.iter().enumerate() {
                let place = line(finding, check).zip(judgment.deviation());
                if let Some((y, deviation)) = place {
                    let x = deviation.clamp(-FARTHEST, FARTHEST);
                    dots[usize::from(is_fitted(finding, check))].push([x, y]);
                }
            }
        }
        let [seen, fitted] = dots;
        let color = line_color(k);
        let hollow = Style {
            broken: true,
            ..Style::full(color, 2.6, profile)
        };
        marks.push(Mark::dots(seen, hollow));
        if !fitted.is_empty() {
            let label = format!("{profile}, fitted");
            marks.push(Mark::dots(fitted, Style::full(color, 2.6, &label)));
        }
    }
    let title = "Deviation of every value";
    let x = Axis::linear("deviation [tolerances]", [-FARTHEST - 0.5, FARTHEST + 0.5]);
    let upward = lines.iter().rev();
    let names = upward.map(|(finding, k)| format!("{}: {}", finding.case.name, name(finding, *k)));
    let panel = Panel::new("", x, Axis::names("", names), marks).with_legend(Corner::Beside);
    let size = [WIDTH, LINE * lines.len() as f64];
    (!lines.is_empty()).then(|| ("deviations", Sheet::new(title, 1, size, vec![panel])))
}

/// The name of a quantity without its unit.
fn name<'a>(finding: &'a Finding, check: usize) -> &'a str {
    let name = &finding.checks[check].quantity;
    name.split(" [").next().unwrap_or(name)
}

/// The rectangle between two deviations over this many lines.
fn frame([low, high]: [f64; 2], lines: usize) -> Vec<[f64; 2]> {
    let top = lines as f64;
    vec![[low, 0.0], [high, 0.0], [high, top], [low, top]]
}

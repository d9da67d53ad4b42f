//! The picture of a study's answers.

use super::Answer;
use super::costs::name;
use super::pictures::color;
use super::rows::Answers;
use crate::gallery::{around, spanned, with_legend};
use crate::sweep::{Cell, plain};
use output::plot::{Axis, BLACK, Corner, Mark, Panel, Point, Sheet, Style, line_color};
use scenario::Preset;

/// The most panels in a row.
const COLUMNS: usize = 3;

impl Answers<'_> {
    /// A panel for each result, with an error bar for each row. If runs with presets were timed, another one for each
    /// result: the errors of all rows over the time that they took, and over the times of each preset.
    pub fn sheet(&self) -> Sheet {
        let axes = &self.study.axes;
        let label = |cell: &Cell| {
            let values = axes.iter().filter_map(|axis| cell.value(axis)).map(plain);
            values.collect::<Vec<_>>().join(", ")
        };
        let labels: Vec<String> = self.rows.iter().map(|(cell, _)| label(cell)).collect();
        let names = self.names();
        let panels = names.iter().map(|name| {
            let rows = self.rows.iter().enumerate();
            let points = rows.filter_map(|(place, (_, answer))| {
                let reached = answer.row(name)?.reached;
                Some(Point {
                    x: place as f64 + 0.5,
                    y: reached.value,
                    error: reached.error,
                })
            });
            let points: Vec<Point> = points.collect();
            let ends = points.iter().flat_map(|p| [p.y - p.error, p.y + p.error]);
            let x = Axis::names(&axes.join(", "), labels.clone());
            let y = Axis::linear(name, spanned(ends));
            let marks = vec![Mark::Points(points, Style::full(BLACK, 2.4, ""))];
            Panel::new("", x, y, marks)
        });
        let errors = with_legend(panels.collect(), COLUMNS);
        // Errors of a result are above its costs.
        let columns = match self.rows.iter().any(|(_, answer)| !answer.costs.is_empty()) {
            true => COLUMNS.min(names.len()),
            false => COLUMNS,
        };
        let costs = names.iter().filter_map(|name| self.costs_of(name));
        let panels: Vec<Panel> = errors.into_iter().chain(costs).collect();
        Sheet::new(
            &format!(
                "{}: estimates with intervals from chance and time step",
                self.study.name
            ),
            columns.min(panels.len().max(1)),
            [200.0, 130.0],
            panels,
        )
    }

    /// Total errors of a result, in percent, over the times that all results take with these errors: those of presets
    /// if the error of their step is known, and for the paper's also if it must be found.
    fn costs_of(&self, result: &str) -> Option<Panel> {
        let (_, first) = self.rows.first()?;
        if first.costs.is_empty() {
            return None;
        }
        let percent = |answer: &Answer| {
            let reached = answer.row(result)?.reached;
            Some(100.0 * reached.error / reached.value.abs())
        };
        let answers = || self.rows.iter().map(|(_, answer)| answer);
        let at = |secs: &dyn Fn(&Answer) -> Option<f64>| -> Vec<[f64; 2]> {
            let points = answers().filter_map(|answer| Some([secs(answer)?, percent(answer)?]));
            points.collect()
        };
        let mut all = at(&|answer| Some(answer.secs));
        let estimates = Style::broken(line_color(0), 3.0, "estimate");
        let mut marks = vec![Mark::dots(all.clone(), estimates)];
        let mut add = |secs: &dyn Fn(&Answer) -> Option<f64>, style: Style| {
            let points = at(secs);
            all.extend(&points);
            marks.push(Mark::dots(points, style));
        };
        for (number, cost) in first.costs.iter().enumerate() {
            let preset: Preset = cost.timed.preset;
            let known = |answer: &Answer| answer.costs.get(number)?.all_secs;
            add(&known, Style::full(color(preset), 2.2, &name(preset)));
            if preset == Preset::Paper {
                let found = |answer: &Answer| Some(answer.costs.get(number)?.two_steps_secs);
                let label = format!("{}, error of step found", name(preset));
                add(&found, Style::broken(color(preset), 2.2, &label));
            }
        }
        let x = Axis::log("computing time [s]", around(all.iter().map(|p| p[0]), 1.3));
        let y = Axis::log(
            &format!("error of {result} [%]"),
            around(all.iter().map(|p| p[1]), 1.3),
        );
        Some(Panel::new("", x, y, marks).with_legend(Corner::Beside))
    }
}

//! The picture of a study's answers.

use super::rows::Answers;
use crate::gallery::spanned;
use crate::sweep::{Cell, plain};
use output::plot::{Axis, BLACK, Mark, Panel, Point, Sheet, Style};

/// The most panels in a row.
const COLUMNS: usize = 3;

impl Answers<'_> {
    /// A panel for each result, with an error bar for each row.
    pub fn sheet(&self) -> Sheet {
        let what = "estimates with intervals from chance and time step";
        let title = format!("{}: {what}", self.study.name);
        let panels = self.panels();
        let columns = COLUMNS.min(panels.len().max(1));
        Sheet::new(&title, columns, [200.0, 130.0], panels)
    }

    /// Its panels.
    pub fn panels(&self) -> Vec<Panel> {
        let axes = &self.study.axes;
        let label = |cell: &Cell| {
            let values = axes.iter().filter_map(|axis| cell.value(axis)).map(plain);
            values.collect::<Vec<_>>().join(", ")
        };
        let labels: Vec<String> = self.rows.iter().map(|(cell, _)| label(cell)).collect();
        let panels = self.names().iter().map(|name| {
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
        panels.collect()
    }
}

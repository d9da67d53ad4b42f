//! Density and force along each path, and error against time.

use sandbox::engine::boundary::WallMethod;
use sandbox::output::colors::Rgb;
use sandbox::output::plot::{Axis, BLACK, Corner, LINES, Mark, Panel, Sheet, Style};

use super::{CaseReport, Error, METHODS, Method, MethodReport, Stored, Volumes, WallReport};

/// The color of the exact values, drawn below everything else.
const PALE: Rgb = [200, 200, 200];
/// An eighth color for lines.
const BROWN: Rgb = [130, 70, 20];
/// Smaller errors are drawn at this value: they are rounding errors. Percent.
const LEAST_ERROR: f64 = 1e-3;
/// Ranges of the axes of error against time: nanoseconds, percent.
const TIMES: [f64; 2] = [20.0, 10_000.0];
const ERRORS: [f64; 2] = [0.5 * LEAST_ERROR, 1000.0];
/// Panels per row.
const COLUMNS: usize = 3;

impl WallReport {
    /// Density and force along each path in rows of three paths, and work-precision diagrams.
    pub fn sheet(&self) -> Sheet {
        let mut panels = Vec::new();
        for (row, cases) in self.cases.chunks(COLUMNS).enumerate() {
            let quantity = |n, label: &'static str| {
                let panel = move |(k, case): (usize, &CaseReport)| {
                    let is_first = row == 0 && k == 0 && n == 0;
                    curves(case, n, label, is_first.then_some(Corner::UpperRight))
                };
                cases.iter().enumerate().map(panel)
            };
            panels.extend(quantity(0, "∫ W"));
            panels.extend(quantity(1, "|∫ ∇W| [1/m]"));
        }
        panels.push(self.work_precision("density", |method| Some(method.density)));
        panels.push(self.work_precision("force", |method| Some(method.force)));
        panels.push(self.work_precision("force along a straight wall", |method| method.roughness));
        let title = "Walls in SPH: each method beside the exact integrals (broken, hollow: particles 0.25 m apart)";
        Sheet::new(title, COLUMNS, [270.0, 180.0], panels)
    }

    /// A work-precision diagram with one dot for each path.
    fn work_precision(&self, title: &str, error: fn(&MethodReport) -> Option<Error>) -> Panel {
        let dots = |k: usize| {
            let methods = self.cases.iter().map(|case| &case.methods[k]);
            let dots = methods.filter_map(|method| {
                let percent = 100.0 * error(method)?.rms;
                Some([method.ns.median, percent.max(LEAST_ERROR)])
            });
            Mark::dots(dots, style(k, 2.6))
        };
        let numbers = |values: &[f64]| values.iter().map(|&v| (v, v.to_string())).collect();
        let mut x = Axis::log("time per agent [ns]", TIMES);
        x.ticks = numbers(&[30.0, 100.0, 300.0, 1000.0, 3000.0]);
        let mut y = Axis::log("error [%]", ERRORS);
        y.ticks = numbers(&[0.001, 0.01, 0.1, 1.0, 10.0, 100.0]);
        y.ticks[0].1 = "≤ 0.001".to_owned();
        let title = format!("work and precision: {title}, one dot a path");
        Panel::new(&title, x, y, (0..METHODS.len()).map(dots).collect())
    }
}

/// Quantity `n` along a path.
fn curves(case: &CaseReport, n: usize, label: &str, legend: Option<Corner>) -> Panel {
    let line = |values: &[[f64; 2]], style| {
        let points = case.along.iter().zip(values);
        Mark::line(points.map(|(&x, value)| [x, value[n]]), style)
    };
    let truth = case.hidden.iter().chain(&case.solid);
    let largest = truth.map(|value| value[n]).fold(0.0, f64::max);
    let mut marks = vec![
        line(&case.hidden, Style::full(PALE, 5.0, "hidden (truth)")),
        line(&case.solid, Style::broken(BLACK, 1.6, "solid (truth)")),
    ];
    let methods = case.methods.iter().enumerate();
    marks.extend(methods.map(|(k, method)| line(&method.curve, style(k, 1.0))));
    let ends = [case.along[0], case.along[case.along.len() - 1]];
    let (x, y) = (
        Axis::linear(case.axis, ends),
        Axis::linear(label, [0.0, 2.0 * largest]),
    );
    Panel {
        legend,
        ..Panel::new(case.name, x, y, marks)
    }
}

/// One color for each kind of method. Lines of coarser particles are broken; the title explains them.
fn style(k: usize, width: f64) -> Style {
    let method = METHODS[k];
    let color = match method {
        Method::Polygons(WallMethod::Representative) => LINES[1],
        Method::Polygons(WallMethod::Exact) => LINES[0],
        Method::Polygons(WallMethod::Union) => LINES[2],
        Method::Particles(Volumes::Whole, _) => BROWN,
        Method::Particles(Volumes::Cut, _) => LINES[3],
        Method::Particles(Volumes::Akinci, _) => LINES[4],
        Method::Map(Stored::Integrals, _) => LINES[5],
        Method::Map(Stored::Volume, _) => LINES[6],
    };
    match method {
        Method::Particles(_, spacing) if spacing > 0.1 => Style::broken(color, width, ""),
        _ => Style::full(color, width, &method.name()),
    }
}

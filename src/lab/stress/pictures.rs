//! The stability maps as pictures.

use super::cell::Cell;
use super::map::Detail;
use super::report::Report;
use super::rest::Rest;
use crate::analysis::stability::{FITTED, Scheme};
use crate::lab::error::LabError;
use crate::output::colors::ColorMap;
use crate::output::plot::{Axis, Cells, ColorBar, Corner, LINES, Mark, Panel, Point, Sheet, Style};
use crate::runs::store::Store;

/// Range of the step axis of all curves, milliseconds.
const STEPS: [f64; 2] = [2.0, 200.0];
/// The position of zero on a logarithmic axis.
const ZERO: f64 = 0.5;

/// Draws `maps.svg` and `maps.png`.
pub fn save(report: &Report, detail: Detail, store: &Store) -> Result<(), LabError> {
    let cells = &report.cells;
    let sheet = Sheet {
        title: "The largest time step at which a crowd comes to rest".to_owned(),
        columns: 3,
        panel_size: [210.0, 185.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![
            map("largest stable Δt", cells, detail, &LARGEST),
            map("auto in parts of it", cells, detail, &RATIO),
            map("speed kept at fine Δt", cells, detail, &UNREST),
            against_gas_constant(cells, detail),
            against_stiffness(cells, detail),
            against_viscosity(cells, detail),
        ],
    };
    sheet.save(&store.path("maps"))?;
    Ok(())
}

/// The quantity of a map.
struct Shown {
    value: fn(&Cell) -> f64,
    write: fn(f64) -> String,
    range: [f32; 2],
    label: &'static str,
}

const LARGEST: Shown = Shown {
    value: |cell| (1e3 * cell.limits[0].largest).log10(),
    write: |value| format!("{:.1}", 10_f64.powf(value)),
    range: [0.8, 2.1],
    label: "log₁₀ Δt [ms]",
};
const RATIO: Shown = Shown {
    value: |cell| cell.limits[0].ratio(),
    write: |value| format!("{value:.2}"),
    range: [0.5, 1.0],
    label: "auto / largest",
};
const UNREST: Shown = Shown {
    value: |cell| cell.limits[0].fine_speed,
    write: |value| format!("{value:.2}"),
    range: [0.0, 1.8],
    label: "root mean square speed [m/s]",
};

fn find(cells: &[Cell], crowd: Rest) -> Option<&Cell> {
    cells.iter().find(|cell| cell.crowd == crowd)
}

/// A map over k and ρ⁰max, with the numbers as text.
fn map(title: &str, cells: &[Cell], detail: Detail, shown: &Shown) -> Panel {
    let (columns, rows) = (detail.gas_constants(), detail.rest_densities());
    let colors = ColorMap::viridis(shown.range);
    let middle = 0.5 * f64::from(shown.range[0] + shown.range[1]);
    let (mut values, mut texts) = (Vec::new(), Vec::new());
    for (row, &rest_density_max) in rows.iter().enumerate() {
        for (column, &gas_constant) in columns.iter().enumerate() {
            let crowd = Rest {
                gas_constant,
                rest_density_max,
                ..Rest::default()
            };
            let value = find(cells, crowd).map(shown.value);
            values.push(value);
            texts.extend(value.map(|value| {
                let color = if value > middle { [0; 3] } else { [255; 3] };
                let place = [column as f64 + 0.5, row as f64 + 0.5];
                Mark::Text(place, (shown.write)(value), color)
            }));
        }
    }
    let names = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>();
    let mut marks = vec![Mark::Cells(Cells {
        extent: [[0.0, 0.0], [columns.len() as f64, rows.len() as f64]],
        columns: columns.len(),
        values,
        map: colors.clone(),
    })];
    marks.extend(texts);
    Panel {
        title: title.to_owned(),
        x: Axis::names("k", names(&columns)),
        y: Axis::names("ρ⁰max [P/m²]", names(&rows)),
        marks,
        bar: Some(ColorBar {
            label: shown.label.to_owned(),
            map: colors,
        }),
        legend: None,
    }
}

/// The results along one parameter, the formula and `auto`; steps in milliseconds.
fn curve(cells: &[Cell], crowds: &[(f64, Rest)], x: Axis, title: &str) -> Panel {
    let along = |step: fn(&Cell) -> f64| -> Vec<[f64; 2]> {
        let found = crowds
            .iter()
            .filter_map(|&(x, crowd)| Some((x, find(cells, crowd)?)));
        found
            .map(|(x, cell)| [x.max(ZERO), 1e3 * step(cell)])
            .collect()
    };
    let points = |steps: Vec<[f64; 2]>| {
        let points = steps.into_iter();
        points.map(|[x, y]| Point { x, y, error: 0.0 }).collect()
    };
    let paper = points(along(|cell| cell.limits[0].largest));
    let exact_walls = points(along(|cell| cell.limits[1].largest));
    let verlet = points(along(|cell| cell.limits[2].largest));
    Panel {
        title: title.to_owned(),
        x,
        y: Axis::log("Δt [ms]", STEPS),
        marks: vec![
            Mark::Line(
                along(|cell| cell.mode().largest_step(Scheme::SemiImplicit, &FITTED)),
                Style::broken(LINES[6], 1.0, "formula"),
            ),
            Mark::Line(
                along(|cell| cell.limits[0].auto),
                Style::full(LINES[1], 1.2, "auto"),
            ),
            Mark::Line(
                along(|cell| cell.limits[2].auto),
                Style::full(LINES[3], 1.2, "auto, Verlet"),
            ),
            Mark::Points(exact_walls, Style::full(LINES[2], 2.4, "with exact walls")),
            Mark::Points(verlet, Style::full(LINES[4], 2.4, "with Verlet")),
            Mark::Points(paper, Style::full(LINES[0], 2.4, "largest stable")),
        ],
        bar: None,
        legend: Some(Corner::LowerLeft),
    }
}

fn against_gas_constant(cells: &[Cell], detail: Detail) -> Panel {
    let crowd = |gas_constant| Rest {
        gas_constant,
        ..Rest::default()
    };
    let crowds: Vec<_> = detail
        .gas_constants()
        .into_iter()
        .map(|k| (k, crowd(k)))
        .collect();
    let axis = Axis::log("k", [40.0, 16_000.0]);
    curve(cells, &crowds, axis, "over k: ρ⁰max = 5, Kᵃᵍ = 50, μ = 0")
}

fn against_stiffness(cells: &[Cell], detail: Detail) -> Panel {
    let crowd = |agent_stiffness| Rest {
        agent_stiffness,
        ..Rest::default()
    };
    let crowds = detail.stiffnesses().into_iter();
    let crowds: Vec<_> = crowds.map(|k| (k.max(20.0), crowd(k))).collect();
    let axis = with_zero("Kᵃᵍ", 20.0, [15.0, 70_000.0], &[100.0, 1e3, 1e4]);
    curve(cells, &crowds, axis, "over Kᵃᵍ: k = 200, ρ⁰max = 5, μ = 0")
}

fn against_viscosity(cells: &[Cell], detail: Detail) -> Panel {
    let crowd = |viscosity| Rest {
        viscosity,
        ..Rest::default()
    };
    let crowds: Vec<_> = detail
        .viscosities()
        .into_iter()
        .map(|mu| (mu, crowd(mu)))
        .collect();
    let axis = with_zero("μ", ZERO, [0.4, 130.0], &[1.0, 5.0, 20.0, 100.0]);
    curve(cells, &crowds, axis, "over μ: k = 200, ρ⁰max = 5, Kᵃᵍ = 50")
}

/// A logarithmic axis on which `zero` stands for 0.
fn with_zero(label: &str, zero: f64, range: [f64; 2], ticks: &[f64]) -> Axis {
    let numbers = ticks.iter().map(|&value| (value, value.to_string()));
    let ticks = std::iter::once((zero, "0".to_owned())).chain(numbers);
    Axis {
        ticks: ticks.collect(),
        ..Axis::log(label, range)
    }
}

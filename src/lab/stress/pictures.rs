//! The stability maps as pictures.

use super::cell::Cell;
use super::map::Detail;
use super::rest::Rest;
use crate::gallery;
use engine::stability::{FITTED, Scheme};
use output::colors::ColorMap;
use output::plot::{Axis, ColorBar, Corner, LINES, Mark, Panel, Sheet, Style};

/// Range of the step axis of all curves, milliseconds.
const STEPS: [f64; 2] = [2.0, 200.0];
/// The positions of K^ag = 0 and of μ = 0 on logarithmic axes.
const SOFT: f64 = 20.0;
const THIN: f64 = 0.5;

/// Three maps over k and ρ⁰max, and curves over k, K^ag and μ.
pub fn sheet(cells: &[Cell], detail: &Detail) -> Sheet {
    let maps = MAPS.iter().map(|shown| map(cells, detail, shown));
    Sheet::new(
        "The largest time step at which a crowd comes to rest",
        3,
        [210.0, 185.0],
        maps.chain(curves(cells, detail)).collect(),
    )
}

/// The quantity of a map.
struct Shown {
    title: &'static str,
    value: fn(&Cell) -> f64,
    write: fn(f64) -> String,
    range: [f32; 2],
    label: &'static str,
}

const MAPS: [Shown; 3] = [
    Shown {
        title: "largest stable Δt",
        value: |cell| (1e3 * cell.limits[0].largest).log10(),
        write: |value| format!("{:.1}", 10_f64.powf(value)),
        range: [0.8, 2.1],
        label: "log₁₀ Δt [ms]",
    },
    Shown {
        title: "auto in parts of it",
        value: |cell| cell.limits[0].ratio(),
        write: |value| format!("{value:.2}"),
        range: [0.5, 1.0],
        label: "auto / largest",
    },
    Shown {
        title: "speed kept at fine Δt",
        value: |cell| cell.limits[0].fine_speed,
        write: |value| format!("{value:.2}"),
        range: [0.0, 1.8],
        label: "root mean square speed [m/s]",
    },
];

fn find(cells: &[Cell], crowd: Rest) -> Option<&Cell> {
    cells.iter().find(|cell| cell.crowd == crowd)
}

/// A map over k and ρ⁰max, with the numbers as text.
fn map(cells: &[Cell], detail: &Detail, shown: &Shown) -> Panel {
    let (columns, rows) = (&detail.gas_constants, &detail.rest_densities);
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
                gallery::in_cell([column, row], (shown.write)(value), value > middle)
            }));
        }
    }
    let x = Axis::names("k", columns.iter().map(f64::to_string));
    let y = Axis::names("ρ⁰max [P/m²]", rows.iter().map(f64::to_string));
    let bar = ColorBar::new(shown.label, &ColorMap::viridis(shown.range));
    let mut panel = gallery::map(shown.title, [x, y], values, bar);
    panel.marks.extend(texts);
    panel
}

/// The results along one parameter, the formula and `auto`; steps in milliseconds.
fn curve(title: &str, x: Axis, cells: &[(f64, &Cell)]) -> Panel {
    let along = |step: fn(&Cell) -> f64| cells.iter().map(move |(x, cell)| [*x, 1e3 * step(cell)]);
    let line = |style, step| Mark::line(along(step), style);
    let dots = |k: usize, label, step| Mark::dots(along(step), Style::full(LINES[k], 2.4, label));
    let marks = vec![
        line(Style::broken(LINES[6], 1.0, "formula"), |cell| {
            let mode = cell.crowd.mode();
            mode.largest_step(Scheme::SemiImplicit, &FITTED)
        }),
        line(Style::full(LINES[1], 1.2, "auto"), |cell| {
            cell.limits[0].auto
        }),
        line(Style::full(LINES[3], 1.2, "auto, Verlet"), |cell| {
            cell.limits[2].auto
        }),
        dots(2, "with exact walls", |cell| cell.limits[1].largest),
        dots(4, "with Verlet", |cell| cell.limits[2].largest),
        dots(0, "largest stable", |cell| cell.limits[0].largest),
    ];
    Panel::new(title, x, Axis::log("Δt [ms]", STEPS), marks).with_legend(Corner::LowerLeft)
}

/// Curves over k, K^ag and μ, each with the paper's other parameters.
fn curves(cells: &[Cell], detail: &Detail) -> [Panel; 3] {
    let over = |title, x: Axis, values: &[f64], zero: f64, set: fn(&mut Rest, f64)| {
        let place = |&value: &f64| {
            let mut crowd = Rest::default();
            set(&mut crowd, value);
            Some((value.max(zero), find(cells, crowd)?))
        };
        curve(
            title,
            x,
            &values.iter().filter_map(place).collect::<Vec<_>>(),
        )
    };
    [
        over(
            "over k: ρ⁰max = 5, Kᵃᵍ = 50, μ = 0",
            Axis::log("k", [40.0, 16_000.0]),
            &detail.gas_constants,
            0.0,
            |crowd, k| crowd.gas_constant = k,
        ),
        over(
            "over Kᵃᵍ: k = 200, ρ⁰max = 5, μ = 0",
            with_zero("Kᵃᵍ", SOFT, [15.0, 70_000.0], &[100.0, 1e3, 1e4]),
            &detail.stiffnesses,
            SOFT,
            |crowd, stiffness| crowd.agent_stiffness = stiffness,
        ),
        over(
            "over μ: k = 200, ρ⁰max = 5, Kᵃᵍ = 50",
            with_zero("μ", THIN, [0.4, 130.0], &[1.0, 5.0, 20.0, 100.0]),
            &detail.viscosities,
            THIN,
            |crowd, viscosity| crowd.viscosity = viscosity,
        ),
    ]
}

/// A logarithmic axis on which `zero` stands for 0.
fn with_zero(label: &str, zero: f64, range: [f64; 2], ticks: &[f64]) -> Axis {
    let numbers = ticks.iter().map(|&value| (value, value.to_string()));
    Axis::log(label, range).ticked([(zero, "0".to_owned())].into_iter().chain(numbers))
}

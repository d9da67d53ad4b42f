//! Heat maps of the study: a column for each quantity, a row for each pair of μ and K^ag.

use super::concert::Seen;
use super::grid::{self, Grid, Quantity, Result};
use super::save;
use crate::lab::reproduce::product::Product;
use crate::output::colors::{ColorMap, Rgb};
use crate::output::plot::{Axis, BLACK, Cells, ColorBar, Mark, Panel, Sheet};

const WHITE: Rgb = [255; 3];

/// The study; not part of `all`.
pub const PRODUCT: Product = Product {
    name: "study",
    about: "the shockwave against k, ρ⁰max, μ and K^ag, three seeds a cell",
    in_all: false,
    cases: |_| {
        let cells = Grid::default().cells();
        Ok(cells
            .iter()
            .flat_map(|cell| grid::SEEDS.map(|seed| cell.case(seed)))
            .collect())
    },
    write: |_, results, store| {
        let axes = Grid::default();
        let mut table = Vec::new();
        for cell in axes.cells() {
            let mut diagrams = Vec::new();
            for seed in grid::SEEDS {
                diagrams.push(Seen::of(results.of(&cell.case(seed))?)?.diagram);
            }
            table.push(Result::of(cell, &diagrams));
        }
        store.write("study.csv", grid::csv(&table).as_bytes())?;
        save(&sheet(&axes, &table), store, "study")
    },
};

/// The sheet from the results in the order of [`Grid::cells`].
fn sheet(grid: &Grid, results: &[Result]) -> Sheet {
    let per_panel = grid.gas_constant.len() * grid.rest_density_max.len();
    let mut panels = Vec::new();
    for block in results.chunks(per_panel.max(1)) {
        for quantity in Quantity::ALL {
            panels.push(panel(grid, block, quantity, range(results, quantity)));
        }
    }
    Sheet {
        title: "The shockwave against k, ρ⁰max, μ and Kᵃᵍ: mean ± standard error over seeds"
            .to_owned(),
        columns: Quantity::ALL.len(),
        panel_size: [170.0, 105.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels,
    }
}

/// Round limits for the color range of one quantity.
fn range(results: &[Result], quantity: Quantity) -> [f32; 2] {
    let values = || {
        results
            .iter()
            .filter_map(|r| r.get(quantity))
            .map(|e| e.value)
    };
    let (least, most) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    if least > most {
        return [0.0, 1.0];
    }
    let step = if quantity == Quantity::Speed {
        5.0
    } else {
        0.1
    };
    let lower = (least / step).floor();
    let upper = (most / step).ceil().max(lower + 1.0);
    [(step * lower) as f32, (step * upper) as f32]
}

fn panel(grid: &Grid, block: &[Result], quantity: Quantity, range: [f32; 2]) -> Panel {
    let map = ColorMap::viridis(range);
    let columns = grid.gas_constant.len();
    let values = block.iter().map(|r| r.get(quantity).map(|e| e.value));
    let rows = block.len().div_ceil(columns.max(1));
    let mut marks = vec![Mark::Cells(Cells {
        extent: [[0.0, 0.0], [columns as f64, rows as f64]],
        columns,
        values: values.collect(),
        map: map.clone(),
    })];
    let digits = if quantity == Quantity::Speed { 1 } else { 2 };
    for (k, result) in block.iter().enumerate() {
        let at = [(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5];
        let (text, color) = match result.get(quantity) {
            None if result.waves > 1 => ("not clear".to_owned(), BLACK),
            None => ("no wave".to_owned(), BLACK),
            Some(e) => {
                // White text on the dark half of the color range.
                let part = (e.value as f32 - range[0]) / (range[1] - range[0]);
                let light = part > 0.6;
                let text = format!("{:.digits$} ± {:.digits$}", e.value, e.error);
                (text, if light { BLACK } else { WHITE })
            }
        };
        marks.push(Mark::Text(at, text, color));
    }
    let cell = block.first().map(|result| result.cell);
    let title = cell.map_or(String::new(), |cell| {
        format!("μ = {}, Kᵃᵍ = {}", cell.viscosity, cell.agent_stiffness)
    });
    let names = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>();
    Panel {
        title,
        x: Axis::names("k", names(&grid.gas_constant)),
        y: Axis::names("ρ⁰max [P/m²]", names(&grid.rest_density_max)),
        marks,
        bar: Some(ColorBar {
            label: quantity.label().to_owned(),
            map,
        }),
        legend: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::wave::Estimate;

    /// Made-up results of a study; one cell has no wave.
    fn results(grid: &Grid) -> Vec<Result> {
        let estimate = |value: f64| {
            Some(Estimate {
                value,
                error: 0.02 * value,
            })
        };
        let result = |(k, cell): (usize, grid::Cell)| {
            let wave = k != 0;
            Result {
                cell,
                waves: if wave { 3 } else { 0 },
                runs: 3,
                speed: estimate((cell.gas_constant / 2.0).sqrt()).filter(|_| wave),
                amplitude: estimate(0.5 - 0.0005 * cell.gas_constant).filter(|_| wave),
                reflection: estimate(0.7 + 0.02 * cell.viscosity).filter(|_| wave),
            }
        };
        grid.cells().into_iter().enumerate().map(result).collect()
    }

    #[test]
    fn every_quantity_has_a_panel_for_every_pair_of_viscosity_and_contact() {
        let grid = Grid::default();
        let sheet = sheet(&grid, &results(&grid));
        assert_eq!(sheet.panels.len(), 3 * 4);
        assert!(sheet.panels.iter().all(|panel| panel.bar.is_some()));
        let folder = tempfile::tempdir().unwrap();
        sheet.save(&folder.path().join("study")).unwrap();
        let svg = std::fs::read_to_string(folder.path().join("study.svg")).unwrap();
        assert!(svg.contains("no wave") && svg.contains("ρ⁰max [P/m²]"));
    }
}

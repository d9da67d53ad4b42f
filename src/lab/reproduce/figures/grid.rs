//! Heat maps of the study of waves: a column for each quantity, a row for each pair of μ and K^ag.

use serde_json::Value;

use super::super::product::{Needs, Product};
use crate::gallery::{distinct, in_cell, map};
use crate::sweep::{Combination, Gathered};
use analysis::statistics::{Estimate, Range};
use output::colors::ColorMap;
use output::plot::{Axis, ColorBar, Panel, Sheet};

/// The study; not part of `all`.
pub const PRODUCT: Product = Product {
    name: "study",
    about: "the shockwave against k, ρ⁰max, μ and K^ag, three seeds a cell",
    in_all: false,
    studies: &["wave_grid"],
    needs: Needs::All,
    tables: &["study"],
    has_figure: true,
    find: |product, studies| {
        let study = &studies[0];
        let findings = product.figure(sheet(study));
        Ok(findings.with_table(product.name, &study.summary_table())?)
    },
};

/// A quantity of waves.
struct Quantity {
    metric: &'static str,
    label: &'static str,
    /// Limits of the color range are multiples of this.
    step: f64,
    digits: usize,
}

const QUANTITIES: [Quantity; 3] = [
    quantity("wave_speed_m_per_s", "wave speed [m/s]", 5.0, 1),
    quantity("wave_amplitude_m_per_s", "amplitude [m/s]", 0.1, 2),
    quantity("wave_reflection", "reflected / arriving", 0.1, 2),
];

const fn quantity(metric: &'static str, label: &'static str, step: f64, digits: usize) -> Quantity {
    Quantity {
        metric,
        label,
        step,
        digits,
    }
}

impl Quantity {
    /// The mean over seeds; `None` if fewer than two runs have a value.
    fn estimate(&self, row: &Combination) -> Option<Estimate> {
        let values: Vec<f64> = row.values(self.metric).into_iter().flatten().collect();
        (values.len() > 1).then(|| Estimate::of_mean(&values))?
    }

    /// Round limits for the color range.
    fn range(&self, rows: &[Combination]) -> [f32; 2] {
        let estimates = rows.iter().filter_map(|row| self.estimate(row));
        let values: Vec<f64> = estimates.map(|estimate| estimate.value).collect();
        if values.is_empty() {
            return [0.0, 1.0];
        }
        let of = Range::of(&values);
        let lower = (of.minimum / self.step).floor();
        let upper = (of.maximum / self.step).ceil().max(lower + 1.0);
        [(self.step * lower) as f32, (self.step * upper) as f32]
    }
}

/// The values of a key in these rows, without repetitions.
fn values(rows: &[Combination], key: &str) -> Vec<String> {
    let value = |row: &Combination| row.value(key).map(Value::to_string);
    distinct(rows.iter().map(|row| value(row).unwrap_or_default()))
}

fn sheet(study: &Gathered) -> Sheet {
    let rows = study.combinations();
    let columns = values(&rows, "gas_constant");
    let per_panel = columns.len() * values(&rows, "rest_density_max").len();
    let blocks = rows.chunks(per_panel.max(1));
    let panels = blocks.flat_map(|block| {
        let panel = |quantity| panel(block, &columns, quantity, quantity.range(&rows));
        QUANTITIES.iter().map(panel).collect::<Vec<_>>()
    });
    Sheet::new(
        "The shockwave against k, ρ⁰max, μ and Kᵃᵍ: mean ± standard error over seeds",
        QUANTITIES.len(),
        [170.0, 105.0],
        panels.collect(),
    )
}

/// One quantity for one pair of μ and K^ag.
fn panel(
    block: &[Combination],
    gas_constants: &[String],
    quantity: &Quantity,
    range: [f32; 2],
) -> Panel {
    let columns = gas_constants.len();
    let estimates: Vec<_> = block.iter().map(|row| quantity.estimate(row)).collect();
    let [mu, stiffness] = ["viscosity", "agent_stiffness"].map(|key| values(block, key).concat());
    let x = Axis::names("k", gas_constants.to_vec());
    let y = Axis::names("ρ⁰max [P/m²]", values(block, "rest_density_max"));
    let mut panel = map(
        &format!("μ = {mu}, Kᵃᵍ = {stiffness}"),
        [x, y],
        estimates.iter().map(|e| e.map(|e| e.value)).collect(),
        ColorBar::new(quantity.label, &ColorMap::viridis(range)),
    );
    let digits = quantity.digits;
    for (k, (row, estimate)) in block.iter().zip(&estimates).enumerate() {
        let seeds = row.values(QUANTITIES[0].metric);
        let waves = seeds.into_iter().flatten().count();
        let (text, is_light) = match estimate {
            None if waves > 1 => ("not clear".to_owned(), true),
            None => ("no wave".to_owned(), true),
            Some(e) => {
                let part = (e.value as f32 - range[0]) / (range[1] - range[0]);
                let text = format!("{:.digits$} ± {:.digits$}", e.value, e.error);
                (text, part > 0.6)
            }
        };
        let cell = [k % columns, k / columns];
        panel.marks.push(in_cell(cell, text, is_light));
    }
    panel
}

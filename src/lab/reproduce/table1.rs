//! Table 1: the room evacuation (§6.1).

use serde::Serialize;
use serde_json::json;

use super::comparison::{self, Band, Comparison, Quantity};
use super::product::{Needs, Product};
use super::published::{EvacuationRow, published, written};
use crate::lab::error::LabError;
use crate::lab::sweep::{Combination, Gathered};
use crate::output::table::Table;
use crate::runs::store::Store;

/// The table.
pub const PRODUCT: Product = Product {
    name: "table1",
    about: "30 rows: density, its deviation and flow of the evacuation",
    in_all: true,
    studies: &["table1"],
    needs: Needs::Seeds,
    write,
};

/// A row of the paper beside ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The profile's name (§5.5).
    pub profile: String,
    /// The key of the parameter that varies.
    pub setting: String,
    /// Its value.
    pub value: f64,
    /// Number of agents that left the room.
    pub evacuated: Comparison,
    /// Mean of ρ_i at 15 s, P/m².
    pub density: Comparison,
    /// Standard deviation of ρ_i at 15 s, P/m².
    pub deviation: Comparison,
    /// Evacuees per second until the 350th.
    pub flow: Comparison,
}

/// The rows of the paper beside the results of the study `table1`.
///
/// # Errors
/// The paper's values are not those of the study.
pub fn rows(results: &Gathered) -> Result<Vec<Row>, LabError> {
    let paper = published()?.table1.rows.into_iter();
    let ours = results.combinations();
    Ok(paper
        .zip(&ours)
        .map(|(row, ours)| Row::new(row, ours))
        .collect())
}

impl Row {
    /// Compares the results over seeds with a row of the paper.
    fn new(row: EvacuationRow, ours: &Combination) -> Self {
        let compare = |name: &str, paper, band| Comparison::new(paper, &ours.values(name), band);
        let plain = ["sf", "rvo"].contains(&row.profile.as_str());
        let (density, flow) = if plain { (0.04, 0.25) } else { (0.015, 0.10) };
        let (density, flow) = (Band::Relative(density), Band::Relative(flow));
        Self {
            evacuated: compare("evacuated", row.evacuated, None),
            density: compare("density_mean_15s", row.density, Some(density)),
            deviation: compare("density_std_15s", row.deviation, Some(Band::Absolute(0.12))),
            flow: compare("flow_per_s", row.flow, Some(flow)),
            profile: row.profile,
            setting: row.setting,
            value: row.value,
        }
    }

    /// The compared quantities.
    fn quantities(&self) -> [Quantity<'_>; 4] {
        let quantity = |(name, unit, compared)| Quantity {
            profile: &self.profile,
            setting: Some((&self.setting, self.value)),
            name,
            unit,
            compared,
        };
        [
            ("evacuated", "agents", &self.evacuated),
            ("density", "P/m²", &self.density),
            ("deviation", "P/m²", &self.deviation),
            ("flow", "P/s", &self.flow),
        ]
        .map(quantity)
    }

    /// The quantities outside of their bands.
    pub fn missed(&self) -> Vec<&'static str> {
        let missed = |q: &Quantity| q.compared.is_kept() == Some(false);
        let quantities = self.quantities().into_iter().filter(missed);
        quantities.map(|quantity| quantity.name).collect()
    }

    /// "kept", or the quantities outside of their bands.
    pub fn verdict(&self) -> String {
        match self.missed().as_slice() {
            [] => "kept".to_owned(),
            missed => format!("**missed**: {}", missed.join(", ")),
        }
    }
}

/// A parameter and its value in the paper's notation.
pub fn setting_written(key: &str, value: f64) -> String {
    let symbol = match key {
        "agent_stiffness" => "K^ag",
        "rest_density_max" => "ρ⁰max",
        other => other,
    };
    format!("{symbol} = {value}")
}

fn write(studies: &[Gathered], store: &Store) -> Result<String, LabError> {
    let [results] = studies else {
        return Err(LabError::Data("Table 1 has one study".to_owned()));
    };
    let published = published()?;
    let rows = rows(results)?;
    let seeds = results.study.seeds;
    let kept = rows.iter().filter(|row| row.missed().is_empty()).count();
    let markdown = format!(
        "{}\n{kept} of {} rows are inside their bands (means over {seeds} seed(s)): density 1.5 %, 4 % for SF and RVO; \
         its deviation 0.12 P/m²; flow 10 %, 25 % for SF and RVO.\n",
        markdown(&rows),
        rows.len(),
    );
    let json = json!({
        "source": published.source,
        "place": published.table1.place,
        "seeds": seeds,
        "rows": rows.iter().map(as_json).collect::<Vec<_>>(),
    });
    let quantities: Vec<Quantity> = rows.iter().flat_map(Row::quantities).collect();
    let csv = comparison::csv(&quantities)?;
    store.write("table1.md", markdown.as_bytes())?;
    store.write("table1.csv", &csv)?;
    store.write("table1.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}

fn as_json(row: &Row) -> serde_json::Value {
    let mut value = json!(row);
    value["missed"] = json!(row.missed());
    value
}

fn markdown(rows: &[Row]) -> String {
    Table::of(rows)
        .column("profile", |row| written(&row.profile))
        .column("setting", |row| setting_written(&row.setting, row.value))
        .column("evacuated: paper", |row| row.evacuated.paper)
        .fixed("ours", 0, |row| {
            row.evacuated.ours.map_or(0.0, |ours| ours.mean)
        })
        .fixed("density [P/m²]: paper", 2, |row| row.density.paper)
        .column("ours", |row| row.density.ours_written())
        .column("difference", |row| row.density.difference_written())
        .fixed("its deviation: paper", 2, |row| row.deviation.paper)
        .column("ours", |row| row.deviation.ours_written())
        .column("difference", |row| row.deviation.difference_written())
        .fixed("flow [P/s]: paper", 2, |row| row.flow.paper)
        .column("ours", |row| row.flow.ours_written())
        .column("difference", |row| row.flow.difference_written())
        .column("band", Row::verdict)
        .table()
        .markdown()
}

//! Table 1: the room evacuation (§6.1).

use serde::Serialize;
use serde_json::json;

use super::comparison::{self, Band, Comparison, Quantity};
use super::product::{Needs, Product};
use super::published::{EvacuationRow, published, written};
use crate::lab::error::LabError;
use crate::lab::sweep::{Combination, Gathered};
use crate::output::table;
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

    /// The compared quantities: name, unit and comparison.
    fn quantities(&self) -> [Quantity<'_>; 4] {
        [
            ("evacuated", "agents", &self.evacuated),
            ("density", "P/m²", &self.density),
            ("deviation", "P/m²", &self.deviation),
            ("flow", "P/s", &self.flow),
        ]
    }

    /// The quantities outside of their bands.
    pub fn missed(&self) -> Vec<&'static str> {
        [
            ("density", &self.density),
            ("deviation", &self.deviation),
            ("flow", &self.flow),
        ]
        .into_iter()
        .filter(|(_, comparison)| comparison.is_kept() == Some(false))
        .map(|(name, _)| name)
        .collect()
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
    let csv = comparison::csv(rows.iter().map(|row| {
        let setting = format!("{}={}", row.setting, row.value);
        (
            vec![row.profile.clone(), setting],
            row.quantities().to_vec(),
        )
    }))?;
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
    let mut table = table::Table::new(
        0,
        &[
            "profile",
            "setting",
            "evacuated: paper",
            "ours",
            "density [P/m²]: paper",
            "ours",
            "difference",
            "its deviation: paper",
            "ours",
            "difference",
            "flow [P/s]: paper",
            "ours",
            "difference",
            "band",
        ],
    );
    for row in rows {
        let evacuated = row.evacuated.ours.map_or(0.0, |ours| ours.mean);
        table.add([
            written(&row.profile),
            setting_written(&row.setting, row.value),
            row.evacuated.paper.to_string(),
            format!("{evacuated:.0}"),
            format!("{:.2}", row.density.paper),
            row.density.ours_written(),
            row.density.difference_written(),
            format!("{:.2}", row.deviation.paper),
            row.deviation.ours_written(),
            row.deviation.difference_written(),
            format!("{:.2}", row.flow.paper),
            row.flow.ours_written(),
            row.flow.difference_written(),
            row.verdict(),
        ]);
    }
    table.markdown()
}

//! Table 1: the room evacuation (§6.1).

use serde::Serialize;
use serde_json::json;

use super::case::Case;
use super::comparison::{Band, Comparison};
use super::error::ReproduceError;
use super::product::{Plan, Product};
use super::published::{EvacuationRow, published, written};
use super::runner::Results;
use super::store::Store;
use super::text::number;
use crate::output::table;

/// The table.
pub const PRODUCT: Product = Product {
    name: "table1",
    about: "30 rows: density, its deviation and flow of the evacuation",
    in_all: true,
    cases,
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

/// The run of a row with one seed.
pub fn case(row: &EvacuationRow, seed: u64) -> Case {
    Case::shipped("evacuation")
        .set("profile", &row.profile)
        .set(&row.setting, row.value)
        .seed(seed)
        .taking(expected_secs(&row.profile))
}

/// Estimated time on one core, seconds.
fn expected_secs(profile: &str) -> f64 {
    match profile {
        "sph" => 0.7,
        "sf->sph" => 2.0,
        "rvo->sph" => 4.0,
        "sf+sph" => 9.0,
        "sf" => 15.0,
        "rvo+sph" => 20.0,
        _ => 30.0,
    }
}

fn cases(plan: &Plan) -> Result<Vec<Case>, ReproduceError> {
    let rows = published()?.table1.rows;
    let all = rows
        .iter()
        .flat_map(|row| plan.seeds().map(|seed| case(row, seed)));
    Ok(all.collect())
}

impl Row {
    /// Compares a row with its runs over some seeds.
    ///
    /// # Errors
    /// A case was not run.
    pub fn new(
        row: &EvacuationRow,
        seeds: impl Iterator<Item = u64>,
        results: &Results,
    ) -> Result<Self, ReproduceError> {
        let seeds: Vec<Case> = seeds.map(|seed| case(row, seed)).collect();
        let compare = |name: &str, paper: f64, band: Option<Band>| {
            let values: Result<Vec<_>, ReproduceError> = seeds
                .iter()
                .map(|case| results.of(case)?.metric(name))
                .collect();
            Ok::<_, ReproduceError>(Comparison::new(paper, &values?, band))
        };
        let plain = ["sf", "rvo"].contains(&row.profile.as_str());
        let (density, flow) = if plain { (0.04, 0.25) } else { (0.015, 0.10) };
        Ok(Self {
            profile: row.profile.clone(),
            setting: row.setting.clone(),
            value: row.value,
            evacuated: compare("evacuated", row.evacuated, None)?,
            density: compare(
                "density_mean_15s",
                row.density,
                Some(Band::Relative(density)),
            )?,
            deviation: compare("density_std_15s", row.deviation, Some(Band::Absolute(0.12)))?,
            flow: compare("flow_per_s", row.flow, Some(Band::Relative(flow)))?,
        })
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

fn write(plan: &Plan, results: &Results, store: &Store) -> Result<String, ReproduceError> {
    let published = published()?;
    let rows: Result<Vec<Row>, _> = published
        .table1
        .rows
        .iter()
        .map(|row| Row::new(row, plan.seeds(), results))
        .collect();
    let rows = rows?;
    let kept = rows.iter().filter(|row| row.missed().is_empty()).count();
    let markdown = format!(
        "{}\n{kept} of {} rows are inside their bands (means over {} seed(s)): density 1.5 %, 4 % for SF and RVO; \
         its deviation 0.12 P/m²; flow 10 %, 25 % for SF and RVO.\n",
        markdown(&rows),
        rows.len(),
        plan.seeds
    );
    let json = json!({
        "source": published.source,
        "place": published.table1.place,
        "seeds": plan.seeds,
        "rows": rows.iter().map(as_json).collect::<Vec<_>>(),
    });
    store.write("table1.md", markdown.as_bytes())?;
    store.write("table1.csv", &csv(&rows)?)?;
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

fn csv(rows: &[Row]) -> Result<Vec<u8>, ReproduceError> {
    let mut table = table::Table::new(
        0,
        &[
            "profile",
            "setting",
            "value",
            "quantity",
            "unit",
            "paper",
            "ours_mean",
            "ours_std",
            "seeds_with_value",
            "seeds",
            "difference",
            "relative_difference",
            "kept",
        ],
    );
    for row in rows {
        for (name, unit, c) in [
            ("evacuated", "agents", &row.evacuated),
            ("density", "P/m²", &row.density),
            ("deviation", "P/m²", &row.deviation),
            ("flow", "P/s", &row.flow),
        ] {
            table.add([
                row.profile.clone(),
                row.setting.clone(),
                row.value.to_string(),
                name.to_owned(),
                unit.to_owned(),
                c.paper.to_string(),
                number(c.ours.map(|ours| ours.mean)),
                number(c.ours.and_then(|ours| ours.deviation)),
                c.ours.map_or(0, |ours| ours.count).to_string(),
                c.seeds.to_string(),
                number(c.difference()),
                number(c.relative()),
                c.is_kept()
                    .map_or_else(String::new, |kept| kept.to_string()),
            ]);
        }
    }
    Ok(table.csv()?)
}

//! Table 1: the room evacuation (§6.1).

use serde_json::json;

use super::comparison::Band;
use super::product::{Needs, Product};
use super::published::{PublishedRow, Varied, published};
use super::row::{self, BANDS, Row, compared, profiles};
use crate::error::LabError;
use crate::sweep::{Combination, Gathered};
use output::document::{Block, Findings};
use output::table::Table;
use scenario::{Scenario, Setting};

/// The table.
pub const PRODUCT: Product = Product {
    name: "table1",
    about: "30 rows: density, its deviation and flow of the evacuation",
    in_all: true,
    studies: &["table1"],
    needs: Needs::Seeds,
    tables: &["table1"],
    has_figure: false,
    find,
};

/// The scenario.
const EVACUATION: &str = "evacuation";

/// The metrics of density, deviation and flow.
const METRICS: [&str; 3] = ["density_mean_15s", "density_std_15s", "flow_per_s"];

/// The rows of the paper beside the results of the study `table1`.
///
/// # Errors
/// The paper's values cannot be read.
pub fn rows(results: &Gathered) -> Result<Vec<Row>, LabError> {
    let row = |(paper, ours): (PublishedRow, &Combination)| Row::new(paper, ours, METRICS);
    let ours = results.combinations();
    let paper = published().table1.rows.into_iter();
    Ok(paper.zip(&ours).map(row).collect())
}

/// The paper's value of one of our measurements, with its band.
pub(super) fn value_with_band(paper: &PublishedRow, metric: &str) -> Option<(f64, Band)> {
    let k = METRICS.iter().position(|own| *own == metric)?;
    let values = [paper.density, paper.deviation, paper.flow];
    Some((values[k], BANDS[k]))
}

/// The paper's values for a run of the evacuation with the settings of one of the table's rows, by the names of our
/// measurements; empty for other runs.
pub fn published_for(scenario: &Scenario) -> Vec<(&'static str, f64)> {
    let mut rows = published().table1.rows.into_iter();
    let Some(row) = rows.find(|row| has_settings_of(scenario, row)) else {
        return Vec::new();
    };
    let values = [row.density, row.deviation, row.flow];
    METRICS.into_iter().zip(values).collect()
}

/// Whether a scenario has the settings of a row; seeds and view may differ.
fn has_settings_of(scenario: &Scenario, row: &PublishedRow) -> bool {
    /// Keys that do not distinguish runs of a row. The parameters are compared as they act: some defaults depend on the
    /// profile.
    const FREE: [&str; 6] = [
        "seed",
        "population_seed",
        "behavior_seed",
        "parameters",
        "view",
        "debug_agents",
    ];
    if scenario.name != EVACUATION || scenario.profile_name != row.profile {
        return false;
    }
    let varied = row
        .varied
        .iter()
        .map(|of| format!("{}={}", of.setting, of.value));
    let typed = varied.chain([format!("profile={}", row.profile)]);
    let settings: Result<Vec<Setting>, _> = typed.map(|text| text.parse()).collect();
    let ours = settings
        .ok()
        .and_then(|settings| Scenario::shipped(EVACUATION, &settings).ok());
    let fixed = |scenario: &Scenario| {
        let mut settings = scenario.settings();
        for key in FREE {
            settings[key].take();
        }
        settings
    };
    ours.is_some_and(|ours| {
        ours.scene.groups == scenario.scene.groups && fixed(&ours) == fixed(scenario)
    })
}

/// A parameter and its value in the paper's notation.
pub(super) fn varied(Varied { setting, value }: &Varied) -> String {
    let symbol = match setting.as_str() {
        "agent_stiffness" => "K^ag",
        "rest_density_max" => "ρ⁰max",
        other => other,
    };
    format!("{symbol} = {value}")
}

fn find(product: &Product, studies: &[Gathered]) -> Result<Findings, LabError> {
    let results = &studies[0];
    let published = published();
    let rows = rows(results)?;
    let seeds = results.study.seeds;
    let as_json = |row: &Row| {
        let mut value = json!(row);
        value["missed"] = json!(row.missed());
        value
    };
    let json = json!({
        "source": published.source,
        "place": published.table1.place,
        "seeds": seeds,
        "rows": rows.iter().map(as_json).collect::<Vec<_>>(),
    });
    let blocks = vec![
        Block::table(table(&rows)),
        Block::text(row::kept(&rows, seeds)),
    ];
    let findings = product.findings(blocks, json);
    Ok(findings.with_table(product.name, &row::for_programs(&rows))?)
}

fn table(rows: &[Row]) -> Table {
    let evacuated = |row: &Row| row.evacuated.clone();
    let columns = profiles(rows)
        .column("setting", |row| row.varied.as_ref().map(varied))
        .column("evacuated: paper", |row| evacuated(row).map(|of| of.paper))
        .fixed("ours", 0, |row| {
            evacuated(row)
                .and_then(|of| of.ours)
                .map_or(0.0, |ours| ours.mean)
        });
    compared(columns).column("band", row::verdict).table()
}

//! Table 2: crossing and bottleneck (§6.2).

use serde::Serialize;
use serde_json::json;

use super::comparison::{self, Comparison, Quantity};
use super::product::{Needs, Product};
use super::published::{published, written};
use super::ranking::{LEAST_DIFFERENCE, Ranked, Ranking, rankings};
use crate::lab::error::LabError;
use crate::lab::sweep::{Combination, Gathered};
use crate::output::table;
use crate::runs::store::Store;

/// The table.
pub const PRODUCT: Product = Product {
    name: "table2",
    about: "7 rows: density and flow of the crossing, and their rankings",
    in_all: true,
    studies: &["table2"],
    needs: Needs::Seeds,
    write,
};

/// The metric of the table's density.
const DENSITY: &str = "density_mean_45s";
/// The metric of its standard deviation.
const DEVIATION: &str = "density_std_45s";
/// The metric of the table's flow.
const FLOW: &str = "flow_first_60s_per_s";

/// A row of the paper beside ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The profile's name (§5.5).
    pub profile: String,
    /// Mean of ρ_i at 45 s in front of the door, P/m².
    pub density: Comparison,
    /// Standard deviation of ρ_i there, P/m².
    pub deviation: Comparison,
    /// Evacuees per second in the first 60 s.
    pub flow: Comparison,
}

/// The whole table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// Its rows.
    pub rows: Vec<Row>,
    /// All rankings of flow and of density with a clear difference in the paper.
    pub rankings: Vec<Ranking>,
}

impl Table {
    /// Compares seven combinations, in the order of the paper's rows, with the paper.
    ///
    /// # Errors
    /// The paper's values cannot be read.
    pub fn new(ours: &[Combination]) -> Result<Self, LabError> {
        let published = published()?.table2.rows;
        let (mut rows, mut densities, mut flows) = (Vec::new(), Vec::new(), Vec::new());
        for (row, ours) in published.iter().zip(ours) {
            let (density, flow) = (ours.values(DENSITY), ours.values(FLOW));
            rows.push(Row {
                profile: row.profile.clone(),
                density: Comparison::new(row.density, &density, None),
                deviation: Comparison::new(row.deviation, &ours.values(DEVIATION), None),
                flow: Comparison::new(row.flow, &flow, None),
            });
            let ranked = |paper, ours| Ranked {
                name: written(&row.profile),
                paper,
                ours,
            };
            densities.push(ranked(row.density, density));
            flows.push(ranked(row.flow, flow));
        }
        let mut found = rankings("flow", &flows);
        found.append(&mut rankings("density", &densities));
        Ok(Self {
            rows,
            rankings: found,
        })
    }

    /// The number of rankings that are kept, and of all rankings.
    pub fn kept(&self, quantity: &str) -> [usize; 2] {
        let all = self.rankings.iter().filter(|r| r.quantity == quantity);
        [all.clone().filter(|r| r.is_kept()).count(), all.count()]
    }

    /// The broken rankings as text.
    pub fn broken(&self) -> Vec<String> {
        let broken = self.rankings.iter().filter(|r| !r.is_kept());
        broken
            .map(|r| format!("{} {} > {}", r.quantity, r.higher, r.lower))
            .collect()
    }

    fn rows_markdown(&self) -> String {
        let mut table = table::Table::new(
            0,
            &[
                "profile",
                "density [P/m²]: paper",
                "ours",
                "difference",
                "its deviation: paper",
                "ours",
                "difference",
                "flow [P/s]: paper",
                "ours",
                "difference",
            ],
        );
        for row in &self.rows {
            let mut cells = vec![written(&row.profile)];
            for quantity in [&row.density, &row.deviation, &row.flow] {
                cells.push(format!("{:.2}", quantity.paper));
                cells.push(quantity.ours_written());
                cells.push(quantity.difference_written());
            }
            table.rows.push(cells);
        }
        table.markdown()
    }

    fn rankings_markdown(&self) -> String {
        let mut table = table::Table::new(
            0,
            &[
                "quantity", "higher", "lower", "paper", "ours", "seeds", "ranking",
            ],
        );
        for ranking in &self.rankings {
            let [a, b] = ranking.paper;
            let ours = ranking
                .ours
                .map_or("–".to_owned(), |[a, b]| format!("{a:.2} > {b:.2}"));
            let verdict = if ranking.is_kept() {
                "kept"
            } else {
                "**broken**"
            };
            table.add([
                ranking.quantity.to_owned(),
                ranking.higher.clone(),
                ranking.lower.clone(),
                format!("{a:.2} > {b:.2}"),
                ours.replace('>', if ranking.is_kept() { ">" } else { "≤" }),
                format!("{} of {}", ranking.seeds[0], ranking.seeds[1]),
                verdict.to_owned(),
            ]);
        }
        table.markdown()
    }

    /// The rows, the rankings, and the number of rankings that are kept.
    pub fn markdown(&self) -> String {
        let [flows, all_flows] = self.kept("flow");
        let [densities, all_densities] = self.kept("density");
        let percent = 100.0 * LEAST_DIFFERENCE;
        format!(
            "{}\nOf the rows that differ by more than {percent} % in the paper, {flows} of {all_flows} rankings \
             of flow and {densities} of {all_densities} of density are kept.\n\n{}",
            self.rows_markdown(),
            self.rankings_markdown()
        )
    }
}

impl Row {
    /// The compared quantities: name, unit and comparison.
    fn quantities(&self) -> Vec<Quantity<'_>> {
        vec![
            ("density", "P/m²", &self.density),
            ("deviation", "P/m²", &self.deviation),
            ("flow", "P/s", &self.flow),
        ]
    }
}

fn write(studies: &[Gathered], store: &Store) -> Result<String, LabError> {
    let [results] = studies else {
        return Err(LabError::Data("Table 2 has one study".to_owned()));
    };
    let published = published()?;
    let table = Table::new(&results.combinations())?;
    let markdown = table.markdown();
    let rankings: Vec<_> = table
        .rankings
        .iter()
        .map(|ranking| {
            let mut value = json!(ranking);
            value["kept"] = json!(ranking.is_kept());
            value
        })
        .collect();
    let json = json!({
        "source": published.source,
        "place": published.table2.place,
        "seeds": results.study.seeds,
        "rows": table.rows,
        "rankings": rankings,
    });
    store.write("table2.md", markdown.as_bytes())?;
    let rows = table.rows.iter();
    let csv = comparison::csv(
        rows.map(|row| (vec![row.profile.clone(), String::new()], row.quantities())),
    )?;
    store.write("table2.csv", &csv)?;
    store.write("table2.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}

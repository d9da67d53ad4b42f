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
        table::Table::of(&self.rows)
            .column("profile", |row| written(&row.profile))
            .fixed("density [P/m²]: paper", 2, |row| row.density.paper)
            .column("ours", |row| row.density.ours_written())
            .column("difference", |row| row.density.difference_written())
            .fixed("its deviation: paper", 2, |row| row.deviation.paper)
            .column("ours", |row| row.deviation.ours_written())
            .column("difference", |row| row.deviation.difference_written())
            .fixed("flow [P/s]: paper", 2, |row| row.flow.paper)
            .column("ours", |row| row.flow.ours_written())
            .column("difference", |row| row.flow.difference_written())
            .table()
            .markdown()
    }

    fn rankings_markdown(&self) -> String {
        let pair = |[a, b]: [f64; 2], sign| format!("{a:.2} {sign} {b:.2}");
        let sign = |ranking: &Ranking| if ranking.is_kept() { ">" } else { "≤" };
        let verdict = |ranking: &Ranking| match ranking.is_kept() {
            true => "kept",
            false => "**broken**",
        };
        table::Table::of(&self.rankings)
            .column("quantity", |ranking| ranking.quantity)
            .column("higher", |ranking| ranking.higher.as_str())
            .column("lower", |ranking| ranking.lower.as_str())
            .column("paper", |ranking| pair(ranking.paper, ">"))
            .column("ours", |ranking| {
                ranking.ours.map(|ours| pair(ours, sign(ranking)))
            })
            .column("seeds", |ranking| {
                format!("{} of {}", ranking.seeds[0], ranking.seeds[1])
            })
            .column("ranking", verdict)
            .table()
            .markdown()
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
    /// The compared quantities.
    fn quantities(&self) -> [Quantity<'_>; 3] {
        let quantity = |(name, unit, compared)| Quantity {
            profile: &self.profile,
            setting: None,
            name,
            unit,
            compared,
        };
        [
            ("density", "P/m²", &self.density),
            ("deviation", "P/m²", &self.deviation),
            ("flow", "P/s", &self.flow),
        ]
        .map(quantity)
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
    let quantities: Vec<Quantity> = table.rows.iter().flat_map(Row::quantities).collect();
    let csv = comparison::csv(&quantities)?;
    store.write("table2.csv", &csv)?;
    store.write("table2.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}

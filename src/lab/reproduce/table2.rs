//! Table 2: crossing and bottleneck (§6.2).

use serde_json::json;

use super::product::{Needs, Product};
use super::published::{PublishedRow, published, written};
use super::ranking::{LEAST_DIFFERENCE, Ranked, Ranking, rankings};
use super::row::{self, Row, compared, profiles};
use crate::error::LabError;
use crate::sweep::{Combination, Gathered};
use output::document::{Block, Findings};
use output::table::Table;

/// The table.
pub const PRODUCT: Product = Product {
    name: "table2",
    about: "7 rows: density and flow of the crossing, and their rankings",
    in_all: true,
    studies: &["table2"],
    needs: Needs::Seeds,
    tables: &["table2"],
    has_figure: false,
    find,
};

/// The metrics of density, deviation and flow.
const METRICS: [&str; 3] = [
    "density_mean_45s",
    "density_std_45s",
    "flow_first_60s_per_s",
];

/// The whole table.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingTable {
    /// Its rows.
    pub rows: Vec<Row>,
    /// All rankings of flow and of density with a clear difference in the paper.
    pub rankings: Vec<Ranking>,
}

impl CrossingTable {
    /// Compares seven combinations, in the order of the paper's rows, with the paper.
    ///
    /// # Errors
    /// The paper's values cannot be read.
    pub fn new(ours: &[Combination]) -> Result<Self, LabError> {
        let paper = published().table2.rows;
        let ranked = |metric: &str, value: fn(&PublishedRow) -> f64| -> Vec<Ranked> {
            let ranked = |(row, ours): (&PublishedRow, &Combination)| Ranked {
                name: written(&row.profile),
                paper: value(row),
                ours: ours.values(metric),
            };
            paper.iter().zip(ours).map(ranked).collect()
        };
        let [density, _, flow] = METRICS;
        let mut found = rankings("flow", &ranked(flow, |row| row.flow));
        found.extend(rankings("density", &ranked(density, |row| row.density)));
        let pairs = paper.into_iter().zip(ours);
        let rows = pairs.map(|(row, ours)| Row::new(row, ours, METRICS));
        Ok(Self {
            rows: rows.collect(),
            rankings: found,
        })
    }

    /// The number of rankings that are kept, and of all rankings.
    pub fn kept(&self, quantity: &str) -> [usize; 2] {
        let all = self.rankings.iter().filter(|r| r.quantity == quantity);
        [all.clone().filter(|r| r.is_kept()).count(), all.count()]
    }

    fn rankings_table(&self) -> Table {
        let pair = |[a, b]: [f64; 2], sign| format!("{a:.2} {sign} {b:.2}");
        let either =
            |ranking: &Ranking, kept, broken| if ranking.is_kept() { kept } else { broken };
        Table::of(&self.rankings)
            .column("quantity", |ranking| ranking.quantity)
            .column("higher", |ranking| ranking.higher.as_str())
            .column("lower", |ranking| ranking.lower.as_str())
            .column("paper", |ranking| pair(ranking.paper, ">"))
            .column("ours", |ranking| {
                let sign = either(ranking, ">", "≤");
                ranking.ours.map(|ours| pair(ours, sign))
            })
            .column("seeds", |ranking| {
                format!("{} of {}", ranking.seeds[0], ranking.seeds[1])
            })
            .column("ranking", |ranking| either(ranking, "kept", "**broken**"))
            .table()
    }

    /// The rows, the rankings, and how many of both are kept.
    fn blocks(&self, seeds: usize) -> Vec<Block> {
        let [flows, all_flows] = self.kept("flow");
        let [densities, all_densities] = self.kept("density");
        let percent = 100.0 * LEAST_DIFFERENCE;
        let rows = compared(profiles(&self.rows)).column("band", row::verdict);
        vec![
            Block::table(rows.table()),
            Block::text(row::kept(&self.rows, seeds)),
            Block::text(format!(
                "Of the rows that differ by more than {percent} % in the paper, {flows} of {all_flows} rankings of \
                 flow and {densities} of {all_densities} of density are kept."
            )),
            Block::table(self.rankings_table()),
        ]
    }
}

fn find(product: &Product, studies: &[Gathered]) -> Result<Findings, LabError> {
    let results = &studies[0];
    let published = published();
    let table = CrossingTable::new(&results.combinations())?;
    let as_json = |ranking: &Ranking| {
        let mut value = json!(ranking);
        value["kept"] = json!(ranking.is_kept());
        value
    };
    let json = json!({
        "source": published.source,
        "place": published.table2.place,
        "seeds": results.study.seeds,
        "rows": table.rows,
        "rankings": table.rankings.iter().map(as_json).collect::<Vec<_>>(),
    });
    let findings = product.findings(table.blocks(results.study.seeds), json);
    Ok(findings.with_table(product.name, &row::for_programs(&table.rows))?)
}

//! Table 2: crossing and bottleneck (§6.2).

use serde::Serialize;
use serde_json::json;

use super::case::Case;
use super::comparison::Comparison;
use super::error::ReproduceError;
use super::product::{Plan, Product};
use super::published::{CrossingRow, published, written};
use super::ranking::{LEAST_DIFFERENCE, Ranked, Ranking, rankings};
use super::runner::Results;
use super::store::Store;
use super::text::number;
use crate::output::table;

/// The table.
pub const PRODUCT: Product = Product {
    name: "table2",
    about: "7 rows: density and flow of the crossing, and their rankings",
    in_all: true,
    cases,
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

/// The run of a row with one seed.
pub fn case(profile: &str, seed: u64) -> Case {
    Case::shipped("crossing")
        .set("profile", profile)
        .seed(seed)
        .taking(expected_secs(profile))
}

/// Estimated time on one core, seconds.
pub fn expected_secs(profile: &str) -> f64 {
    match profile {
        "sph" => 0.5,
        "sf->sph" => 3.0,
        "rvo->sph" => 5.0,
        "sf" => 6.0,
        "sf+sph" => 7.5,
        "rvo" => 8.5,
        _ => 11.0,
    }
}

fn cases(plan: &Plan) -> Result<Vec<Case>, ReproduceError> {
    let rows = published()?.table2.rows;
    let all = rows
        .iter()
        .flat_map(|row| plan.seeds().map(|seed| case(&row.profile, seed)));
    Ok(all.collect())
}

impl Table {
    /// Compares the table with the runs that `case` returns for a profile and a seed.
    ///
    /// # Errors
    /// A case was not run.
    pub fn new(
        plan: &Plan,
        results: &Results,
        case: impl Fn(&str, u64) -> Case,
    ) -> Result<Self, ReproduceError> {
        let published = published()?.table2.rows;
        let values = |row: &CrossingRow, name: &str| -> Result<Vec<_>, ReproduceError> {
            plan.seeds()
                .map(|seed| results.of(&case(&row.profile, seed))?.metric(name))
                .collect()
        };
        let (mut rows, mut densities, mut flows) = (Vec::new(), Vec::new(), Vec::new());
        for row in &published {
            let (density, flow) = (values(row, DENSITY)?, values(row, FLOW)?);
            rows.push(Row {
                profile: row.profile.clone(),
                density: Comparison::new(row.density, &density, None),
                deviation: Comparison::new(row.deviation, &values(row, DEVIATION)?, None),
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

    fn csv(&self) -> Result<Vec<u8>, ReproduceError> {
        let mut table = table::Table::new(
            0,
            &[
                "profile",
                "quantity",
                "unit",
                "paper",
                "ours_mean",
                "ours_std",
                "seeds",
                "difference",
                "relative_difference",
            ],
        );
        for row in &self.rows {
            for (name, unit, c) in [
                ("density", "P/m²", &row.density),
                ("deviation", "P/m²", &row.deviation),
                ("flow", "P/s", &row.flow),
            ] {
                table.add([
                    row.profile.clone(),
                    name.to_owned(),
                    unit.to_owned(),
                    c.paper.to_string(),
                    number(c.ours.map(|ours| ours.mean)),
                    number(c.ours.and_then(|ours| ours.deviation)),
                    c.seeds.to_string(),
                    number(c.difference()),
                    number(c.relative()),
                ]);
            }
        }
        Ok(table.csv()?)
    }
}

fn write(plan: &Plan, results: &Results, store: &Store) -> Result<String, ReproduceError> {
    let published = published()?;
    let table = Table::new(plan, results, case)?;
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
        "seeds": plan.seeds,
        "rows": table.rows,
        "rankings": rankings,
    });
    store.write("table2.md", markdown.as_bytes())?;
    store.write("table2.csv", &table.csv()?)?;
    store.write("table2.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}

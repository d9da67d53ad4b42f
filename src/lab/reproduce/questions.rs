//! Questions about the tables: how walls, doorways, start positions and guesses change Tables 1 and 2. Each is a study.

use serde_json::json;

use super::product::{Needs, Product};
use super::published::published;
use super::table2::CrossingTable;
use crate::error::LabError;
use crate::sweep::{Combination, Gathered};
use analysis::statistics::{MeanStd, Range};
use output::document::{Block, Findings};
use output::table::{Cell, Table};

/// Answers to all questions.
pub const PRODUCT: Product = Product {
    name: "questions",
    about: "what walls, doorways, starts and guesses change in Tables 1 and 2",
    in_all: false,
    studies: &[
        "questions_sf_flow",
        "questions_geometry",
        "questions_last_agents",
        "questions_rvo_density",
        "questions_blend_spread",
        CROSSING,
    ],
    needs: Needs::Seeds,
    tables: &[],
    has_figure: false,
    find,
};

/// The study about Table 2; its list has that table's profiles once for each geometry.
const CROSSING: &str = "questions_crossing";

/// The columns of the tables: metric and head. Metrics that a study does not measure are left out.
const COLUMNS: [(&str, &str); 10] = [
    ("evacuated", "evacuated"),
    ("locked", "locked"),
    ("density_mean_15s", "density [P/m²]"),
    ("density_std_15s", "its deviation"),
    ("density_mean_45s", "density [P/m²]"),
    ("density_std_45s", "its deviation"),
    ("flow_per_s", "flow [P/s]"),
    ("flow_first_60s_per_s", "flow [P/s]"),
    ("pauses_secs", "pauses [s]"),
    ("flow_between_pauses_per_s", "flow between pauses"),
];

fn find(product: &Product, studies: &[Gathered]) -> Result<Findings, LabError> {
    let seeds = studies.first().map_or(0, |study| study.study.seeds);
    let mut blocks = vec![Block::text(format!(
        "Over {seeds} seed(s): mean ± half the 95 % confidence interval of the mean (Student's t)."
    ))];
    let mut data = Vec::new();
    for study in studies {
        let about = study.study.document["description"]
            .as_str()
            .unwrap_or_default();
        let (title, text) = about.split_once("? ").unwrap_or((about, ""));
        let combinations = study.combinations();
        blocks.push(Block::Heading(format!("{title}?")));
        blocks.push(Block::text(text));
        if study.study.name == CROSSING {
            blocks.push(Block::table(rankings(&combinations)?));
        }
        blocks.push(Block::table(table(&combinations)));
        data.push(json!({ "question": title, "study": study.json() }));
    }
    Ok(product.findings(blocks, json!({ "seeds": seeds, "questions": data })))
}

/// One line per entry of the list.
fn table(combinations: &[Combination]) -> Table {
    let measured = |metric: &str| {
        let mut values = combinations.iter().flat_map(|row| row.values(metric));
        values.any(|value| value.is_some())
    };
    let mut table = Table::of(combinations).column("run", |row| row.label().to_owned());
    for (metric, head) in COLUMNS.into_iter().filter(|(metric, _)| measured(metric)) {
        table = table.fixed(head, 2, |row| {
            let values: Vec<f64> = row.values(metric).into_iter().flatten().collect();
            match metric {
                "locked" => format!("{} of {}", values.iter().sum::<f64>(), values.len()).into(),
                "evacuated" => evacuated(&values).into(),
                _ => Cell::from(
                    MeanStd::of(&values).map(|of| Cell::Spread(of.mean, of.interval_95())),
                ),
            }
        });
    }
    table.table()
}

/// The number of all seeds, or the least, the median and the largest one.
fn evacuated(values: &[f64]) -> String {
    let Range {
        minimum,
        median,
        maximum,
    } = Range::of(values);
    match minimum == maximum {
        true => minimum.to_string(),
        false => format!("{minimum} to {maximum}, median {median}"),
    }
}

/// Which rankings of Table 2 hold in each geometry, and how many agents of the crossing stream get through.
fn rankings(combinations: &[Combination]) -> Result<Table, LabError> {
    let profiles = published().table2.rows.len();
    let mut geometries = Vec::new();
    for rows in combinations.chunks(profiles) {
        let label = rows.first().map_or("", Combination::label);
        let counts = rows.iter().flat_map(|row| row.values("uncounted"));
        let through = counts.flatten();
        geometries.push(Geometry {
            name: label.rsplit_once(": ").map_or(label, |(name, _)| name),
            table: CrossingTable::new(rows)?,
            through: Range::of(&through.collect::<Vec<f64>>()),
        });
    }
    let kept = |geometry: &Geometry, quantity| {
        let [kept, all] = geometry.table.kept(quantity);
        format!("{kept} of {all}")
    };
    let broken = |geometry: &Geometry| {
        let missed = geometry.table.rankings.iter().filter(|r| !r.is_kept());
        let broken = missed.map(|r| format!("{} {} > {}", r.quantity, r.higher, r.lower));
        broken.collect::<Vec<_>>().join("; ")
    };
    Ok(Table::of(&geometries)
        .column("geometry", |geometry| geometry.name)
        .column("flow", |geometry| kept(geometry, "flow"))
        .column("density", |geometry| kept(geometry, "density"))
        .column("broken", broken)
        .range("of the stream through in 60 s:", 0, |geometry| {
            geometry.through
        })
        .table())
}

/// Table 2 in one geometry.
struct Geometry<'a> {
    name: &'a str,
    table: CrossingTable,
    /// Number of agents of the crossing stream that get through, over profiles and seeds.
    through: Range,
}

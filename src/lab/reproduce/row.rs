//! The rows of Tables 1 and 2: the paper's values beside ours.

use serde::Serialize;

use super::comparison::{Band, Comparison};
use super::published::{PublishedRow, Varied, written};
use crate::sweep::Combination;
use output::table::{Columns, Table};

/// The bands of density, its deviation and flow around the paper's values, the same for all rows: where one more run
/// lies with 95 % beside the mean of ten, t √(1 + 1/10) s. s is the standard deviation over seeds of Table 1, pooled
/// over its rows: 0.74 % of the density, 0.019 P/m², 4.3 % of the flow. The paper gives one value per row.
pub(super) const BANDS: [Band; 3] = [
    Band::Relative(0.015),
    Band::Absolute(0.04),
    Band::Relative(0.09),
];

/// The band of the evacuated agents. Their number differs between seeds in one row of those that do not lock.
const EVACUATED: Band = Band::Absolute(1.0);

/// The bands in words.
pub(super) const BANDS_IN_WORDS: &str = "density 1.5 %, its deviation 0.04 P/m², flow 9 %";

/// A row of the paper beside ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The profile's name (§5.5).
    pub profile: String,
    /// The property that distinguishes rows of the same profile in Table 1.
    #[serde(flatten)]
    pub varied: Option<Varied>,
    /// Number of agents that left the room, in Table 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evacuated: Option<Comparison>,
    /// Mean of ρ_i, P/m².
    pub density: Comparison,
    /// Standard deviation of ρ_i, P/m².
    pub deviation: Comparison,
    /// Evacuees per second.
    pub flow: Comparison,
}

/// A quantity of a row: its name, its unit, and our value beside the paper's.
type Quantity<'a> = (&'static str, &'static str, &'a Comparison);

impl Row {
    /// Compares the results over seeds with a row of the paper. `metrics` are those of density, its deviation and
    /// flow.
    pub(super) fn new(paper: PublishedRow, ours: &Combination, metrics: [&str; 3]) -> Self {
        let [density, deviation, flow] = BANDS.map(Some);
        let values = |k: usize| ours.values(metrics[k]);
        let evacuated = paper.evacuated;
        Self {
            profile: paper.profile,
            varied: paper.varied,
            evacuated: evacuated
                .map(|paper| Comparison::new(paper, &ours.values("evacuated"), Some(EVACUATED))),
            density: Comparison::new(paper.density, &values(0), density),
            deviation: Comparison::new(paper.deviation, &values(1), deviation),
            flow: Comparison::new(paper.flow, &values(2), flow),
        }
    }

    /// The compared quantities.
    fn quantities(&self) -> Vec<Quantity<'_>> {
        let evacuated = self.evacuated.iter().map(|of| ("evacuated", "agents", of));
        let others = [
            ("density", "P/m²", &self.density),
            ("deviation", "P/m²", &self.deviation),
            ("flow", "P/s", &self.flow),
        ];
        evacuated.chain(others).collect()
    }

    /// The quantities outside of their bands.
    pub fn missed(&self) -> Vec<&'static str> {
        let quantities = self.quantities().into_iter();
        let missed = quantities.filter(|(_, _, compared)| compared.is_kept() == Some(false));
        missed.map(|(name, ..)| name).collect()
    }
}

/// The rows and the values of each quantity that are inside of their bands, in words.
pub(super) fn kept(rows: &[Row], seeds: usize) -> String {
    let whole = rows.iter().filter(|row| row.missed().is_empty()).count();
    let names = rows.first().map_or(Vec::new(), Row::quantities);
    let quantity = |(name, ..): Quantity| {
        let missed = rows
            .iter()
            .filter(|row| row.missed().contains(&name))
            .count();
        format!("{name} {}", rows.len() - missed)
    };
    let quantities: Vec<String> = names.into_iter().map(quantity).collect();
    let is_counted = rows.iter().any(|row| row.evacuated.is_some());
    let evacuated = if is_counted {
        ", evacuated agents 1"
    } else {
        ""
    };
    format!(
        "Of {} rows, {whole} are inside of all bands (means over {seeds} seed(s)); by quantity: {}. Bands, the same \
         for all rows: {BANDS_IN_WORDS}{evacuated}.",
        rows.len(),
        quantities.join(", ")
    )
}

/// "kept", or the quantities outside of their bands.
pub(super) fn verdict(row: &Row) -> String {
    match row.missed().as_slice() {
        [] => "kept".to_owned(),
        missed => format!("**missed**: {}", missed.join(", ")),
    }
}

/// Adds the paper's densities, deviations and flows, ours, and the differences.
pub(super) fn compared<'r>(mut columns: Columns<'r, Row>) -> Columns<'r, Row> {
    type Of = fn(&Row) -> &Comparison;
    let quantities: [(&str, Of); 3] = [
        ("density [P/m²]", |row| &row.density),
        ("its deviation", |row| &row.deviation),
        ("flow [P/s]", |row| &row.flow),
    ];
    for (head, of) in quantities {
        columns = columns
            .fixed(&format!("{head}: paper"), 2, |row| of(row).paper)
            .column("ours", |row| of(row).ours_written())
            .column("difference", |row| of(row).difference_written());
    }
    columns
}

/// A table with the column of the profile.
pub(super) fn profiles(rows: &[Row]) -> Columns<'_, Row> {
    Table::of(rows).column("profile", |row| written(&row.profile))
}

/// A table for programs, with a line per quantity.
pub(super) fn for_programs(rows: &[Row]) -> Table {
    let with_row = |row| Row::quantities(row).into_iter().map(move |q| (row, q));
    let quantities: Vec<(&Row, Quantity)> = rows.iter().flat_map(with_row).collect();
    let varied = |row: &'_ Row| row.varied.clone();
    Table::of(&quantities)
        .column("profile", |(row, _)| row.profile.as_str())
        .column("setting", |(row, _)| {
            varied(row).map_or(String::new(), |of| of.setting)
        })
        .column("value", |(row, _)| varied(row).map(|of| of.value))
        .column("quantity", |(_, (name, ..))| *name)
        .column("unit", |(_, (_, unit, _))| *unit)
        .column("paper", |(.., (.., of))| of.paper)
        .spread("ours", 2, ["_mean", "_std"], |(.., (.., of))| of.ours)
        .column("seeds_with_value", |(.., (.., of))| {
            of.ours.map_or(0, |ours| ours.count)
        })
        .column("seeds", |(.., (.., of))| of.seeds)
        .column("difference", |(.., (.., of))| of.difference())
        .column("relative_difference", |(.., (.., of))| of.relative())
        .column("kept", |(.., (.., of))| of.is_kept())
        .table()
}

//! The order of two rows, in the paper and here.

use serde::Serialize;

use analysis::statistics::MeanStd;

/// Rows with a smaller difference in the paper, relative to the lower one, are not ranked.
pub const LEAST_DIFFERENCE: f64 = 0.1;

/// Two rows that differ clearly in the paper.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ranking {
    /// The compared quantity.
    pub quantity: &'static str,
    /// The higher in the paper.
    pub higher: String,
    /// The lower in the paper.
    pub lower: String,
    /// The paper's two values.
    pub paper: [f64; 2],
    /// Our two means; `None` if a run gave no value.
    pub ours: Option<[f64; 2]>,
    /// Number of seeds with the paper's order, and of all seeds.
    pub seeds: [usize; 2],
}

/// The data for ranking a row.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// The row.
    pub name: String,
    /// The paper's value.
    pub paper: f64,
    /// Our values by seed, in the same order for all rows.
    pub ours: Vec<Option<f64>>,
}

impl Ranking {
    /// Whether our means have the paper's order.
    pub fn is_kept(&self) -> bool {
        self.ours.is_some_and(|[higher, lower]| higher > lower)
    }
}

/// All rankings of rows that differ enough in the paper.
pub fn rankings(quantity: &'static str, rows: &[Ranked]) -> Vec<Ranking> {
    let pairs = rows
        .iter()
        .enumerate()
        .flat_map(|(k, a)| rows[k + 1..].iter().map(move |b| (a, b)));
    pairs
        .map(|(a, b)| if a.paper >= b.paper { (a, b) } else { (b, a) })
        .filter(|(a, b)| a.paper > b.paper * (1.0 + LEAST_DIFFERENCE))
        .map(|(a, b)| ranking(quantity, a, b))
        .collect()
}

fn ranking(quantity: &'static str, higher: &Ranked, lower: &Ranked) -> Ranking {
    let by_seed = higher.ours.iter().zip(&lower.ours);
    let kept = by_seed.clone().filter(|(a, b)| a.is_some() && a > b);
    Ranking {
        quantity,
        higher: higher.name.clone(),
        lower: lower.name.clone(),
        paper: [higher.paper, lower.paper],
        ours: mean(&higher.ours)
            .zip(mean(&lower.ours))
            .map(|(a, b)| [a, b]),
        seeds: [kept.count(), by_seed.count()],
    }
}

fn mean(values: &[Option<f64>]) -> Option<f64> {
    let all: Option<Vec<f64>> = values.iter().copied().collect();
    Some(MeanStd::of(&all?)?.mean)
}

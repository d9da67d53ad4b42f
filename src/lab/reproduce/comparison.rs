//! Our values beside the paper's: spread over seeds, difference, band.

use serde::Serialize;

use analysis::statistics::MeanStd;
use output::table::Cell;

/// The largest allowed distance of a mean from the paper's value, inclusive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// Relative to the paper's value.
    Relative(f64),
    /// In the unit of the value.
    Absolute(f64),
}

/// A quantity of one row.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The paper's value.
    pub paper: f64,
    /// Our values, over the seeds that gave one.
    pub ours: Option<MeanStd>,
    /// Number of seeds.
    pub seeds: usize,
    /// The band, if there is one.
    pub band: Option<Band>,
}

impl Comparison {
    /// Compares values over seeds with the paper's; `None` for a run without a value.
    pub fn new(paper: f64, values: &[Option<f64>], band: Option<Band>) -> Self {
        let given: Vec<f64> = values.iter().copied().flatten().collect();
        Self {
            paper,
            ours: MeanStd::of(&given),
            seeds: values.len(),
            band,
        }
    }

    /// Our mean minus the paper's value.
    pub fn difference(&self) -> Option<f64> {
        self.ours.map(|ours| ours.mean - self.paper)
    }

    /// The difference relative to the paper's value.
    pub fn relative(&self) -> Option<f64> {
        self.difference().map(|difference| difference / self.paper)
    }

    /// Whether our mean is inside the band; false if a run gave no value, `None` without a band.
    pub fn is_kept(&self) -> Option<bool> {
        /// Limits such as 0.015 are not exact in binary.
        const ROUNDING: f64 = 1e-12;
        let band = self.band?;
        let complete = self.ours.is_some_and(|ours| ours.count == self.seeds);
        let (off, most) = match band {
            Band::Relative(most) => (self.relative(), most),
            Band::Absolute(most) => (self.difference(), most),
        };
        Some(complete && off.is_some_and(|off| off.abs() <= most + ROUNDING))
    }

    /// Our values, and the number of seeds with a value if it is not all of them.
    pub fn ours_written(&self) -> String {
        let ours = Cell::from(self.ours).fixed(2);
        match self.ours {
            Some(some) if some.count < self.seeds => {
                format!("{ours} ({} of {})", some.count, self.seeds)
            }
            _ => ours,
        }
    }

    /// The difference in percent, or in the unit of the value if the band is given in it.
    pub fn difference_written(&self) -> String {
        let text = match self.band {
            Some(Band::Absolute(_)) => self.difference().map(|off| format!("{off:+.2}")),
            _ => self.relative().map(|off| format!("{:+.1} %", 100.0 * off)),
        };
        text.unwrap_or_else(|| "–".to_owned())
    }
}

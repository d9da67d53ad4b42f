//! Our values beside the paper's: spread over seeds, difference, band.

use serde::Serialize;

use crate::analysis::statistics::MeanStd;
use crate::lab::error::LabError;
use crate::output::table::{Cell, Table};

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

    /// Is our mean inside the band? No if a run gave no value; `None` without a band.
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

/// A quantity of a table's row.
pub(super) struct Quantity<'a> {
    /// The row's profile.
    pub profile: &'a str,
    /// The setting that distinguishes the row, if there is one: key and value.
    pub setting: Option<(&'a str, f64)>,
    /// The quantity's name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Our value beside the paper's.
    pub compared: &'a Comparison,
}

/// One line per quantity.
pub(super) fn csv(quantities: &[Quantity]) -> Result<Vec<u8>, LabError> {
    let table = Table::of(quantities)
        .column("profile", |q| q.profile)
        .column("setting", |q| q.setting.map_or("", |(key, _)| key))
        .column("value", |q| q.setting.map(|(_, value)| value))
        .column("quantity", |q| q.name)
        .column("unit", |q| q.unit)
        .column("paper", |q| q.compared.paper)
        .spread("ours", 2, ["_mean", "_std"], |q| q.compared.ours)
        .column("seeds_with_value", |q| {
            q.compared.ours.map_or(0, |ours| ours.count)
        })
        .column("seeds", |q| q.compared.seeds)
        .column("difference", |q| q.compared.difference())
        .column("relative_difference", |q| q.compared.relative())
        .column("kept", |q| q.compared.is_kept());
    Ok(table.table().csv()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_kept_up_to_the_border_of_its_band() {
        let kept = |paper, ours, band| Comparison::new(paper, &[Some(ours)], Some(band)).is_kept();
        assert_eq!(kept(4.0, 4.06, Band::Relative(0.015)), Some(true));
        assert_eq!(kept(4.0, 3.94, Band::Relative(0.015)), Some(true));
        assert_eq!(kept(4.0, 4.061, Band::Relative(0.015)), Some(false));
        assert_eq!(kept(0.27, 0.39, Band::Absolute(0.12)), Some(true));
        assert_eq!(kept(0.27, 0.14, Band::Absolute(0.12)), Some(false));
        assert_eq!(Comparison::new(4.0, &[Some(4.0)], None).is_kept(), None);
    }

    #[test]
    fn a_seed_without_a_value_misses_the_band_and_is_told() {
        let values = [Some(1.0), None, Some(3.0)];
        let flow = Comparison::new(2.0, &values, Some(Band::Relative(0.25)));
        assert_eq!(flow.relative(), Some(0.0));
        assert_eq!(flow.is_kept(), Some(false));
        assert_eq!(flow.ours_written(), "2.00 ± 1.41 (2 of 3)");
        let nothing = Comparison::new(2.0, &[None], Some(Band::Relative(0.25)));
        assert_eq!(nothing.is_kept(), Some(false));
        assert_eq!(nothing.ours_written(), "–");
        assert_eq!(nothing.difference_written(), "–");
    }
}

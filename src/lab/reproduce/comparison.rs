//! Our values beside the paper's: spread over seeds, difference, band.

use serde::Serialize;

use crate::lab::error::LabError;
use crate::output::table::Table;

/// The spread of values over seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The sample standard deviation; `None` for a single value.
    pub deviation: Option<f64>,
    /// Number of values.
    pub count: usize,
}

impl Spread {
    /// The spread of `values`; `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            mean,
            deviation: (count > 1).then(|| (squares / (count - 1) as f64).sqrt()),
            count,
        })
    }

    /// `3.27 ± 0.01`, or the value alone.
    pub fn written(&self) -> String {
        match self.deviation {
            Some(deviation) => format!("{:.2} ± {deviation:.2}", self.mean),
            None => format!("{:.2}", self.mean),
        }
    }
}

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
    pub ours: Option<Spread>,
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
            ours: Spread::of(&given),
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
        match self.ours {
            None => "–".to_owned(),
            Some(ours) if ours.count < self.seeds => {
                format!("{} ({} of {})", ours.written(), ours.count, self.seeds)
            }
            Some(ours) => ours.written(),
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

/// A compared quantity: its name, unit and comparison.
pub(super) type Quantity<'a> = (&'a str, &'a str, &'a Comparison);

/// One line per quantity of rows that are identified by profile and setting.
pub(super) fn csv<'a>(
    rows: impl Iterator<Item = (Vec<String>, Vec<Quantity<'a>>)>,
) -> Result<Vec<u8>, LabError> {
    let head = [
        "profile",
        "setting",
        "quantity",
        "unit",
        "paper",
        "ours_mean",
        "ours_std",
        "seeds_with_value",
        "seeds",
        "difference",
        "relative_difference",
        "kept",
    ];
    let mut table = Table::new(0, &head);
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for (names, quantities) in rows {
        for (quantity, unit, c) in quantities {
            let mut row = names.clone();
            row.extend([
                quantity.to_owned(),
                unit.to_owned(),
                c.paper.to_string(),
                number(c.ours.map(|ours| ours.mean)),
                number(c.ours.and_then(|ours| ours.deviation)),
                c.ours.map_or(0, |ours| ours.count).to_string(),
                c.seeds.to_string(),
                number(c.difference()),
                number(c.relative()),
                c.is_kept().map_or(String::new(), |kept| kept.to_string()),
            ]);
            table.rows.push(row);
        }
    }
    Ok(table.csv()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_over_seeds_is_that_of_a_sample() {
        let spread = Spread::of(&[1.0, 2.0, 3.0]).unwrap();
        assert_eq!(
            (spread.mean, spread.deviation, spread.count),
            (2.0, Some(1.0), 3)
        );
        assert_eq!(spread.written(), "2.00 ± 1.00");
        let single = Spread::of(&[4.0]).unwrap();
        assert_eq!((single.mean, single.deviation), (4.0, None));
        assert_eq!(single.written(), "4.00");
        assert_eq!(Spread::of(&[]), None);
    }

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

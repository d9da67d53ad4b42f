//! A measured quantity with its expectation.

use serde::Serialize;

/// Limits such as 1.6 are not exact in binary.
const ROUNDING: f64 = 1e-9;

/// The expectation for a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// A value between two, inclusive; infinite if there is no bound.
    Between([f64; 2]),
    /// A measured value, with a tolerance as a fraction of it.
    Near {
        /// The measured value.
        value: f64,
        /// The tolerance.
        tolerance: f64,
    },
    /// Any value: it is reported.
    Any,
}

/// A measured quantity of one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Its name and unit.
    pub quantity: String,
    /// The value; `None` if the run gave none.
    pub value: Option<f64>,
    /// The expectation.
    pub expected: Expected,
    /// The label of the run that gives the value; `None` if several do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<&'static str>,
}

impl Check {
    /// A value that must lie between two.
    pub fn between(quantity: impl Into<String>, value: Option<f64>, low: f64, high: f64) -> Self {
        Self {
            quantity: quantity.into(),
            value,
            expected: Expected::Between([low, high]),
            run: None,
        }
    }

    /// A value that must be within a tolerance, a fraction, of a measured one.
    pub fn near(
        quantity: impl Into<String>,
        value: Option<f64>,
        (measured, tolerance): (f64, f64),
    ) -> Self {
        Self {
            quantity: quantity.into(),
            value,
            expected: Expected::Near {
                value: measured,
                tolerance,
            },
            run: None,
        }
    }

    /// The same check of a value that this run gives.
    #[must_use]
    pub fn of_run(self, label: &'static str) -> Self {
        Self {
            run: Some(label),
            ..self
        }
    }

    /// A value that must not exceed `high`.
    pub fn at_most(quantity: impl Into<String>, value: Option<f64>, high: f64) -> Self {
        Self::between(quantity, value, f64::NEG_INFINITY, high)
    }

    /// A value that must not be below `low`.
    pub fn at_least(quantity: impl Into<String>, value: Option<f64>, low: f64) -> Self {
        Self::between(quantity, value, low, f64::INFINITY)
    }

    /// A value that must be this number.
    pub fn exactly(quantity: impl Into<String>, value: Option<f64>, number: f64) -> Self {
        Self::between(quantity, value, number, number)
    }

    /// A value that is reported.
    pub fn reported(quantity: impl Into<String>, value: Option<f64>) -> Self {
        Self {
            quantity: quantity.into(),
            value,
            expected: Expected::Any,
            run: None,
        }
    }

    /// The bounds of the value, inclusive; infinite if there are none.
    pub fn bounds(&self) -> [f64; 2] {
        match self.expected {
            Expected::Any => [f64::NEG_INFINITY, f64::INFINITY],
            Expected::Near { value, tolerance } => {
                [1.0 - tolerance, 1.0 + tolerance].map(|part| value * part)
            }
            Expected::Between(bounds) => bounds,
        }
    }

    /// Whether the value is as expected. A missing value passes only if any value would.
    pub fn is_passed(&self) -> bool {
        let [low, high] = self.bounds();
        let range = low - ROUNDING..=high + ROUNDING;
        self.expected == Expected::Any || self.value.is_some_and(|value| range.contains(&value))
    }

    /// Whether the value is compared with a measured one.
    pub fn is_compared(&self) -> bool {
        matches!(self.expected, Expected::Near { .. })
    }

    /// The difference of the value from a measured one, as a fraction of the measured value.
    pub fn error(&self) -> Option<f64> {
        match self.expected {
            Expected::Near { value, .. } => Some(self.value? / value - 1.0),
            _ => None,
        }
    }

    /// The expectation, in words.
    pub fn expected_written(&self) -> String {
        match self.expected {
            Expected::Any => "reported".to_owned(),
            Expected::Near { value, tolerance } => {
                let value = (1e3 * value).round() / 1e3; // measured in data: with all digits
                format!("{value} ± {} %", (100.0 * tolerance).round())
            }
            Expected::Between([low, high]) if low == high => format!("{low}"),
            Expected::Between([f64::NEG_INFINITY, high]) => format!("at most {high}"),
            Expected::Between([low, f64::INFINITY]) => format!("at least {low}"),
            Expected::Between([low, high]) => format!("{low} to {high}"),
        }
    }
}

//! A measured quantity beside what is expected of it.

use serde::Serialize;

/// Limits such as 1.6 are not exact in binary.
const ROUNDING: f64 = 1e-9;

/// What is expected of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// A value between two, inclusive; infinite if there is no bound.
    Between([f64; 2]),
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
    /// What is expected.
    pub expected: Expected,
}

impl Check {
    /// A value that must lie between two.
    pub fn between(quantity: impl Into<String>, value: Option<f64>, low: f64, high: f64) -> Self {
        Self {
            quantity: quantity.into(),
            value,
            expected: Expected::Between([low, high]),
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
        }
    }

    /// Is the value as expected? A missing value is only if any is.
    pub fn is_passed(&self) -> bool {
        match self.expected {
            Expected::Any => true,
            Expected::Between([low, high]) => {
                let range = low - ROUNDING..=high + ROUNDING;
                self.value.is_some_and(|value| range.contains(&value))
            }
        }
    }

    /// What is expected, in words.
    pub fn expected_written(&self) -> String {
        match self.expected {
            Expected::Any => "reported".to_owned(),
            Expected::Between([low, high]) if low == high => format!("{low}"),
            Expected::Between([f64::NEG_INFINITY, high]) => format!("at most {high}"),
            Expected::Between([low, f64::INFINITY]) => format!("at least {low}"),
            Expected::Between([low, high]) => format!("{low} to {high}"),
        }
    }
}

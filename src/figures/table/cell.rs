//! The cells of tables.

use common::statistics::{Estimate, MeanStd};

/// The content of a row in a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words; left-aligned.
    Text(String),
    /// A number.
    Number(f64),
    /// A number and its uncertainty or deviation, if known: `3.27 ± 0.01`.
    Spread(f64, Option<f64>),
    /// No value; also from `None` and NaN.
    Missing,
}

/// The format of numbers in text and Markdown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Format {
    AllDigits,
    Fixed(usize),
    Exponent(usize),
}

impl Cell {
    /// As text and Markdown show it in a column with `digits` decimals.
    pub fn fixed(&self, digits: usize) -> String {
        self.shown(Format::Fixed(digits))
    }

    /// As text and Markdown show it.
    pub(super) fn shown(&self, format: Format) -> String {
        let number = |value: f64| match format {
            Format::AllDigits => value.to_string(),
            Format::Fixed(digits) => format!("{value:.digits$}"),
            Format::Exponent(digits) => format!("{value:.digits$e}"),
        };
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) | Self::Spread(value, None) => number(*value),
            Self::Spread(value, Some(off)) => format!("{} ± {}", number(*value), number(*off)),
            Self::Missing => "–".to_owned(),
        }
    }
}

/// A number with as many decimals as its error has in two digits; all digits without an error.
pub fn as_precise(number: f64, error: f64) -> String {
    let places = error.log10().floor();
    if !places.is_finite() {
        return number.to_string();
    }
    let decimals = (1.0 - places).clamp(0.0, 12.0) as usize;
    let text = format!("{number:.decimals$}");
    match text.trim_matches(['-', '0', '.']).is_empty() {
        true => text.trim_start_matches('-').to_owned(),
        false => text,
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<bool> for Cell {
    fn from(value: bool) -> Self {
        Self::Text(value.to_string())
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        if value.is_nan() {
            return Self::Missing;
        }
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Self::Number(value as f64)
    }
}

impl From<u32> for Cell {
    fn from(value: u32) -> Self {
        Self::Number(f64::from(value))
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        Self::Number(value as f64)
    }
}

/// Mean ± sample standard deviation.
impl From<MeanStd> for Cell {
    fn from(of: MeanStd) -> Self {
        Self::Spread(of.mean, of.std())
    }
}

/// Value ± standard error.
impl From<Estimate> for Cell {
    fn from(estimate: Estimate) -> Self {
        Self::Spread(estimate.value, Some(estimate.error))
    }
}

impl<C: Into<Cell>> From<Option<C>> for Cell {
    fn from(value: Option<C>) -> Self {
        value.map_or(Self::Missing, C::into)
    }
}

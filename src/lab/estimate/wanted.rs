//! What a user asks for: results with their errors, and limits.

use std::fmt;
use std::str::FromStr;

use crate::scenario::quote::shown;

/// A result, and the error that it may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The name of the measurement.
    pub name: String,
    /// The half width of its confidence interval.
    pub error: Tolerance,
}

/// The half width of a confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// A fraction of the value.
    Relative(f64),
    /// In the unit of the value.
    Absolute(f64),
}

impl Tolerance {
    /// In the unit of the value.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Relative(part) => part * value.abs(),
            Self::Absolute(error) => error,
        }
    }
}

/// As typed: `2%` or `0.05`.
impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Relative(part) => write!(f, "{} %", 100.0 * part),
            Self::Absolute(error) => write!(f, "{error}"),
        }
    }
}

impl FromStr for Wanted {
    type Err = String;

    /// Reads `NAME=2%` or `NAME=0.05`.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = || "not a result with its error, such as flow_per_s=1% or flow_per_s=0.05";
        let (name, error) = text.split_once('=').ok_or_else(form)?;
        let (number, is_part) = match error.trim().strip_suffix('%') {
            Some(number) => (number, true),
            None => (error, false),
        };
        let number: f64 = number.trim().parse().map_err(|_| form())?;
        if !(number > 0.0 && number.is_finite()) {
            let error = shown(error.trim());
            return Err(format!("the error {error} must be above 0"));
        }
        Ok(Self {
            name: name.trim().to_owned(),
            error: match is_part {
                true => Tolerance::Relative(number / 100.0),
                false => Tolerance::Absolute(number),
            },
        })
    }
}

/// How far an estimate may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The most runs, at all time steps together.
    pub runs: usize,
    /// The time after which no more runs begin, seconds; `None` without a limit.
    pub secs: Option<f64>,
}

/// Everything that an estimate is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The results; at least one.
    pub wanted: Vec<Wanted>,
    /// The probability with which an interval shall hold the true value, such as 0.95.
    pub confidence: f64,
    /// Its limits.
    pub limits: Limits,
}

//! What a user asks for: results with their errors, and limits.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use analysis::round;
use analysis::statistics::draws_above;
use scenario::quote::shown;

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
            Self::Relative(part) => write!(f, "{} %", round::text(100.0 * part)),
            Self::Absolute(error) => write!(f, "{error}"),
        }
    }
}

impl FromStr for Wanted {
    type Err = String;

    /// Reads `NAME=2%` or `NAME=0.05`.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = "not a result with its error, such as flow_per_s=1% or flow_per_s=0.05";
        let ([name, typed], number, is_part) = named_number(text).ok_or(form)?;
        if !(number > 0.0 && number.is_finite()) {
            return Err(format!("the error {} must be above 0", shown(typed)));
        }
        let error = match is_part {
            true => Tolerance::Relative(number / 100.0),
            false => Tolerance::Absolute(number),
        };
        let name = name.to_owned();
        Ok(Self { name, error })
    }
}

/// A name with a value as typed, the number of this value, and whether it is in percent.
fn named_number(text: &str) -> Option<([&str; 2], f64, bool)> {
    let (name, value) = text.split_once('=')?;
    let (name, value) = (name.trim(), value.trim());
    let percent = value.strip_suffix('%');
    let number = percent.unwrap_or(value).trim().parse().ok()?;
    Some(([name, value], number, percent.is_some()))
}

/// A result, and the share of runs that shall be on one side of a bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bound {
    /// The name of the measurement.
    pub name: String,
    /// The share of runs: from 0.5 on they are at most the bound; below, this share is at most and the others are at
    /// least the bound.
    pub share: f64,
}

impl Bound {
    /// Whether the bound is above most runs.
    pub fn is_upper(&self) -> bool {
        self.share >= 0.5
    }

    /// The share of runs on the inner side of the bound.
    pub fn inner(&self) -> f64 {
        self.share.max(1.0 - self.share)
    }

    /// The number of runs that such a bound needs at least, with this probability that it holds.
    pub fn runs(&self, confidence: f64) -> usize {
        draws_above(self.inner(), confidence)
    }
}

impl FromStr for Bound {
    type Err = String;

    /// Reads `NAME=95%`.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = "not a result with a share of runs, such as time_secs=95%";
        let read = named_number(text).filter(|(.., is_part)| *is_part);
        let ([name, typed], percent, _) = read.ok_or(form)?;
        if !(0.01..=99.99).contains(&percent) {
            return Err(format!(
                "the share {} must be between 0.01 and 99.99 %",
                shown(typed)
            ));
        }
        let (name, share) = (name.to_owned(), percent / 100.0);
        Ok(Self { name, share })
    }
}

/// The runs that a bound is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// As many seeds as the bound needs.
    #[default]
    Seeds,
    /// 50 runs as in IMO's guidelines on evacuation analysis (MSC.1/Circ.1238, annex 2; MSC.1/Circ.1533, annex 3,
    /// appendix 3): 10 populations with 5 runs each; or 50 populations with one run each where runs of a population
    /// would be the same.
    Imo,
}

/// The number of runs in [`Sampling::Imo`].
pub(super) const IMO_RUNS: usize = 50;

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
    /// The results whose means are asked for.
    pub wanted: Vec<Wanted>,
    /// The results whose bounds are asked for.
    pub bounds: Vec<Bound>,
    /// The runs that these are made of.
    pub sampling: Sampling,
    /// The probability with which an interval shall hold the true value, such as 0.95.
    pub confidence: f64,
    /// Its limits.
    pub limits: Limits,
}

impl Request {
    /// The number of runs that a bound is made of.
    pub fn runs_for(&self, bound: &Bound) -> usize {
        match self.sampling {
            Sampling::Seeds => bound.runs(self.confidence),
            Sampling::Imo => IMO_RUNS,
        }
    }
}

//! Judgments: values of checks beside what is expected.

use serde::Serialize;

use super::keys::{Case, Check, Expected};
use super::quantity::Quantity;
use crate::error::LabError;
use runs::summary::Summary;

/// Limits such as 1.6 are not exact in binary.
const ROUNDING: f64 = 1e-9;

/// The results of one profile and one seed, by label.
pub struct Runs<'a> {
    /// The results of all cases.
    pub own: Vec<(&'a str, &'a Summary)>,
    /// The measurements in the data from which runs begin, by the labels of the runs.
    pub measured: &'a [(String, Summary)],
}

/// A value beside what is expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judgment {
    /// The name of the quantity, and its unit.
    pub quantity: String,
    /// The value; `None` if the run gave none.
    pub value: Option<f64>,
    /// The expectation.
    pub expected: Expected,
    /// The label of the run that is compared with a measured value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
}

/// The ratio of a value to a measured one in tolerances: ln(value/measured)/ln(1 + tolerance). It is 1 at the upper end
/// of the tolerance. Twice and half the measured value have deviations of equal size.
pub fn in_tolerances(value: f64, [measured, tolerance]: [f64; 2]) -> f64 {
    (value / measured).ln() / tolerance.ln_1p()
}

impl Runs<'_> {
    /// The profile; empty without runs.
    pub fn profile(&self) -> &str {
        self.own.first().map_or("", |(_, run)| &run.profile)
    }

    /// The seed; 0 without runs.
    pub fn seed(&self) -> u64 {
        self.own.first().map_or(0, |(_, run)| run.seed)
    }

    /// The results of a run.
    pub fn of(&self, label: &str) -> Option<&Summary> {
        let mut own = self.own.iter();
        own.find(|(own, _)| *own == label).map(|(_, run)| *run)
    }

    /// The measurements in the data from which a run begins; `None` if it begins without data.
    pub fn data(&self, label: &str) -> Option<&Summary> {
        let mut measured = self.measured.iter();
        measured.find(|(own, _)| own == label).map(|(_, data)| data)
    }
}

impl Case {
    /// The description with the source.
    pub fn title(&self) -> String {
        match &self.source {
            Some(source) => format!("{} ({source})", self.about),
            None => self.about.clone(),
        }
    }

    /// The labels of its runs.
    pub fn runs(&self) -> impl Iterator<Item = &str> {
        let checked = self.checks.iter().flat_map(|check| &check.of);
        let drawn = self.picture.iter().map(|picture| &picture.run);
        checked.chain(drawn).map(String::as_str)
    }

    /// Whether `name` refers to it: its name, or its number without the letter.
    pub fn is_named(&self, name: &str) -> bool {
        let letter = |rest: &str| rest.len() == 1 && rest.chars().all(|c| c.is_ascii_lowercase());
        let rest = self.name.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || letter(rest))
    }
}

impl Check {
    /// A check of a measured quantity that only reports it: every value passes.
    pub fn of_metric(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            quantity: vec![Quantity::Named(name.to_owned())],
            of: vec![String::new()],
            function: None,
            at: None,
            expected: Expected::Any,
            fitted: Vec::new(),
        }
    }

    /// The name of its quantity, if it is a measured one.
    pub fn metric(&self) -> Option<&str> {
        match &self.quantity[..] {
            [Quantity::Named(name)] => Some(name),
            _ => None,
        }
    }

    /// The value from these runs; `None` if one of them gives none.
    pub fn value<'a>(&self, run: impl Fn(&str) -> Option<&'a Summary>) -> Option<f64> {
        let runs = self.of.iter().map(|label| run(label));
        let found = runs.flat_map(|run| self.quantity.iter().map(move |of| of.value(run?)));
        let values: Vec<f64> = found.collect::<Option<_>>()?;
        match self.function {
            Some(function) => Some(function.of(&values)),
            None => values.first().copied(),
        }
    }

    /// The value and the expectation of these runs.
    ///
    /// # Errors
    /// The data from which a run begins do not give the expected value.
    pub fn judged(&self, runs: &Runs) -> Result<Judgment, LabError> {
        let mut expected = self.expected;
        if let Expected::Near {
            value: value @ None,
            ..
        } = &mut expected
        {
            let in_data = self.value(|label| runs.data(label));
            let missing =
                || LabError::missing(self.of.join(", "), format!("{} in the data", self.name));
            *value = Some(in_data.ok_or_else(missing)?);
        }
        let run = self.of.first().filter(|_| expected.is_measured());
        Ok(Judgment {
            quantity: self.name.clone(),
            value: self.value(|label| runs.of(label)),
            expected,
            run: run.cloned(),
        })
    }
}

impl Expected {
    /// Whether it is a measured value.
    pub fn is_measured(&self) -> bool {
        matches!(self, Self::Near { .. })
    }

    /// The bounds of the value, inclusive; infinite if there are none.
    pub fn bounds(&self) -> [f64; 2] {
        match *self {
            Self::Any => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Near { value, tolerance } => {
                [1.0 - tolerance, 1.0 + tolerance].map(|part| value.unwrap_or(f64::NAN) * part)
            }
            Self::Between(bounds) => bounds,
        }
    }
}

/// The expectation, in words.
impl std::fmt::Display for Expected {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match *self {
            Self::Any => f.write_str("reported"),
            Self::Near { value, tolerance } => {
                let value = (1e3 * value.unwrap_or(f64::NAN)).round() / 1e3; // measured in data: with all digits
                write!(f, "{value} ± {} %", (100.0 * tolerance).round())
            }
            Self::Between([low, high]) if low == high => write!(f, "{low}"),
            Self::Between([f64::NEG_INFINITY, high]) => write!(f, "at most {high}"),
            Self::Between([low, f64::INFINITY]) => write!(f, "at least {low}"),
            Self::Between([low, high]) => write!(f, "{low} to {high}"),
        }
    }
}

impl Judgment {
    /// Whether the value is as expected. A missing value passes only if any value would.
    pub fn is_passed(&self) -> bool {
        let [low, high] = self.expected.bounds();
        let range = low - ROUNDING..=high + ROUNDING;
        self.expected == Expected::Any || self.value.is_some_and(|value| range.contains(&value))
    }

    /// The deviation of the value from a measured one, in tolerances.
    pub fn deviation(&self) -> Option<f64> {
        match self.expected {
            Expected::Near { value, tolerance } => {
                Some(in_tolerances(self.value?, [value?, tolerance]))
            }
            _ => None,
        }
    }

    /// The difference of the value from a measured one, as a fraction of the measured value.
    pub fn error(&self) -> Option<f64> {
        match self.expected {
            Expected::Near { value, .. } => Some(self.value? / value? - 1.0),
            _ => None,
        }
    }
}

//! Cases, and the runs that they judge.

use super::check::Check;
use crate::lab::error::LabError;
use crate::runs::summary::{PlaceResult, Summary};
use crate::scenario::measurements::Walk;

/// A case.
pub struct Case {
    /// Its name in tables, on the command line and of its picture.
    pub id: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// The labels of its runs in the study.
    pub runs: &'static [&'static str],
    /// Turns the results of one profile and seed into checks, always the same in the same order.
    pub judge: fn(&Runs) -> Result<Vec<Check>, LabError>,
    /// Profiles that are known to miss an expectation, each with the reason.
    pub misses: &'static [(&'static str, &'static str)],
    /// The picture: the label of a run, and the time, seconds.
    pub picture: (&'static str, f64),
}

impl Case {
    /// Whether `name` refers to it: its id, or its number without the letter.
    pub fn is_named(&self, name: &str) -> bool {
        let letter = |rest: &str| rest.len() == 1 && rest.chars().all(|c| c.is_ascii_lowercase());
        let rest = self.id.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || letter(rest))
    }

    /// The reason why this profile misses an expectation, if it is known to.
    pub fn known_miss(&self, profile: &str) -> Option<&'static str> {
        let mut misses = self.misses.iter();
        misses.find(|(of, _)| *of == profile).map(|(_, why)| *why)
    }
}

/// The results of one profile and one seed, by label.
pub struct Runs<'a> {
    /// The name of the suite.
    pub suite: &'a str,
    /// The results of all cases.
    pub own: Vec<(&'a str, &'a Summary)>,
    /// The measurements in the data from which runs begin, by the labels of the runs.
    pub measured: &'a [(&'static str, Summary)],
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

    fn missing(&self, label: &str, what: &str) -> LabError {
        LabError::missing(format!("{}, {label}", self.suite), what)
    }

    /// The results of a run.
    ///
    /// # Errors
    /// There is no such run.
    pub fn of(&self, label: &str) -> Result<&Summary, LabError> {
        let found = self.own.iter().find(|(own, _)| *own == label);
        found
            .map(|(_, summary)| *summary)
            .ok_or_else(|| self.missing(label, "run"))
    }

    /// The measurements in the data from which a run begins; `None` if it begins without data.
    pub fn data(&self, label: &str) -> Option<&Summary> {
        let found = self.measured.iter().find(|(own, _)| *own == label);
        found.map(|(_, summary)| summary)
    }

    /// A measured value of a run.
    ///
    /// # Errors
    /// There is no such run.
    pub fn metric(&self, label: &str, name: &str) -> Result<Option<f64>, LabError> {
        Ok(self.of(label)?.metric(name))
    }

    /// The time at which the last agent of a run left, seconds; `None` if agents remain.
    ///
    /// # Errors
    /// There is no such run.
    pub fn last(&self, label: &str) -> Result<Option<f64>, LabError> {
        self.metric(label, "t100_secs")
    }

    /// The value of one run divided by that of another.
    ///
    /// # Errors
    /// One of the runs is missing.
    pub fn ratio(&self, name: &str, of: &str, to: &str) -> Result<Option<f64>, LabError> {
        let [of, to] = [self.metric(of, name)?, self.metric(to, name)?];
        Ok(of.zip(to).map(|(of, to)| of / to))
    }

    /// A place of a run.
    ///
    /// # Errors
    /// There is no such run or place.
    pub fn place(&self, label: &str, name: &str) -> Result<&PlaceResult, LabError> {
        let found = self
            .of(label)?
            .places
            .iter()
            .find(|place| place.name == name);
        found.ok_or_else(|| self.missing(label, name))
    }

    /// The number of agents that have passed a place.
    ///
    /// # Errors
    /// There is no such run or place.
    pub fn passed(&self, label: &str, name: &str) -> Result<Option<f64>, LabError> {
        Ok(Some(f64::from(self.place(label, name)?.passed)))
    }

    /// The flow of all agents at an exit, P/s.
    ///
    /// # Errors
    /// There is no such run or place.
    pub fn flow(&self, label: &str, exit: &str) -> Result<Option<f64>, LabError> {
        let exit = self.place(label, exit)?;
        let flow = |[from, to]: [f64; 2]| f64::from(exit.passed.saturating_sub(1)) / (to - from);
        Ok(exit.from_to_secs.map(flow))
    }

    /// The walks of the agents of a run.
    ///
    /// # Errors
    /// There is no such run, or it measures no `walks`.
    pub fn walks(&self, label: &str) -> Result<Vec<Walk>, LabError> {
        let walks = self.of(label)?.data("walks");
        walks.ok_or_else(|| self.missing(label, "walks"))
    }
}

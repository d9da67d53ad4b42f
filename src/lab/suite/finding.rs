//! What was found about a case.

use super::check::Judgment;
use super::keys::Case;

/// The name of the check of walls.
pub const THROUGH_WALLS: &str = "people through walls";

/// The checks of one case with one profile and seed.
#[derive(Clone)]
pub struct Finding<'a> {
    /// The case.
    pub case: &'a Case,
    /// The profile.
    pub profile: String,
    /// The seed; `None` for means over seeds.
    pub seed: Option<u64>,
    /// The judgments of its checks.
    pub checks: Vec<Judgment>,
}

impl Finding<'_> {
    /// Whether all values are as expected.
    pub fn is_passed(&self) -> bool {
        self.checks.iter().all(Judgment::is_passed)
    }
}

/// Whether the profile was fitted to the value of this check.
pub fn is_fitted(finding: &Finding, check: usize) -> bool {
    let check = finding.case.checks.get(check);
    check.is_some_and(|check| check.fitted.contains(&finding.profile))
}

/// A case that is not computed.
pub struct Skipped<'a> {
    /// The case.
    pub case: &'a Case,
    /// What it lacks.
    pub lacks: Lacks,
    /// The reason in words; of data their source, too.
    pub why: String,
}

/// What a case lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lacks {
    /// The data with which people start.
    Data,
    /// A scene and checks that another simulator can be given.
    Scene,
}

impl Lacks {
    /// Why cases are skipped.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Data => "data are missing",
            Self::Scene => "another simulator cannot be judged by them",
        }
    }
}

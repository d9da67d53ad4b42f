//! Calibrated profiles: profiles of the paper with a walking law, and parameters that were fitted to experiments.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use crate::input::embedded;
use crate::keys::parameters::Parameters;

/// A calibrated profile.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibrated {
    /// Its name.
    pub name: &'static str,
    /// The people whom it describes, and what it was fitted to.
    pub about: &'static str,
    /// The calibration that searches its parameters.
    pub study: &'static str,
    /// The profile of the paper that it changes.
    pub base: &'static str,
    /// Its parameters where they are not the paper's.
    pub parameters: Parameters,
}

/// All calibrated profiles.
static ALL: LazyLock<Vec<Calibrated>> =
    LazyLock::new(|| embedded("calibrated.json", include_str!("calibrated.json")));

/// All calibrated profiles.
pub fn all() -> &'static [Calibrated] {
    &ALL
}

/// Parameter sets of calibrated profiles that meet the experiments as well as those of the profile.
static ENSEMBLES: LazyLock<BTreeMap<String, Vec<BTreeMap<String, f64>>>> =
    LazyLock::new(|| embedded("ensemble.json", include_str!("ensemble.json")));

/// The parameter sets of a calibrated profile, each with the values that differ from those of the profile; empty if it
/// has none.
pub fn ensemble(profile: &str) -> &'static [BTreeMap<String, f64>] {
    ENSEMBLES.get(profile).map_or(&[], Vec::as_slice)
}

/// The calibrated profile of this name.
pub fn named(name: &str) -> Option<&'static Calibrated> {
    ALL.iter().find(|profile| profile.name == name)
}

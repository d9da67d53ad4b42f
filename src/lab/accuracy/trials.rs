//! The trials in a scene: values of the numerical choices ("choices") that act in it.
//!
//! Every entry of the scene's study is a trial, except the first one, which has no settings, and `reference`, with
//! which statistics are compared. A trial's label is `CHOICE` or `CHOICE: CURVE`; pictures join the points of a curve
//! by a line. ` (best)` marks the value at which the choice adds no error.

use serde::{Serialize, Serializer};
use serde_json::Value;

use super::scenes::{SCENES, scenario, setting};
use crate::error::LabError;
use crate::gallery::distinct;
use crate::sweep::{Cell, Study};
use scenario::Setting;

/// The label of the first entry.
const DEFAULT: &str = "default";
/// The label of the entry with which statistics are compared.
const REFERENCE: &str = "reference";
/// The end of the label of a choice's best value.
const BEST: &str = " (best)";

/// Settings that are tried in a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// The choice.
    pub choice: String,
    /// The label of its curve.
    pub curve: String,
    /// The settings.
    #[serde(serialize_with = "texts")]
    pub settings: Vec<Setting>,
    /// Whether these are the defaults.
    #[serde(rename = "default")]
    pub is_default: bool,
    /// The choice's best settings, with all others at their defaults; `None` for a choice without a best value.
    #[serde(skip)]
    pub best: Option<Vec<Setting>>,
    /// The index of the study's entry with its runs; defaults share those of the first entry.
    #[serde(skip)]
    pub(super) entry: usize,
}

impl Trial {
    /// Whether both are on one curve.
    pub fn shares_curve(&self, other: &Self) -> bool {
        (&self.choice, &self.curve) == (&other.choice, &other.curve)
    }
}

fn texts<S: Serializer>(settings: &[Setting], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(settings.iter().map(Setting::to_string))
}

/// The names of all choices.
pub fn choices() -> Vec<&'static str> {
    let labels = SCENES.iter().flat_map(|scene| scene.labels());
    let choices = labels.map(|label| choice_and_curve(label).0);
    distinct(choices.filter(|choice| ![DEFAULT, REFERENCE].contains(choice)))
}

fn choice_and_curve(label: &str) -> (&str, &str) {
    let label = label.strip_suffix(BEST).unwrap_or(label);
    label.split_once(": ").unwrap_or((label, label))
}

/// The trials of a study. `document` is the scene's document, which their settings change.
///
/// # Errors
/// A setting is invalid.
pub fn trials(study: &Study, document: &Value) -> Result<Vec<Trial>, LabError> {
    let default = numerics(document, &[])?;
    let (mut trials, mut best) = (Vec::new(), Vec::new());
    for (entry, cells) in study.cells.chunks(study.seeds).enumerate() {
        let label = cells[0].label().unwrap_or_default();
        if [DEFAULT, REFERENCE].contains(&label) {
            continue;
        }
        let settings = settings(&cells[0])?;
        let (choice, curve) = choice_and_curve(label);
        if label.ends_with(BEST) {
            best.push((choice, settings.clone()));
        }
        let is_default = numerics(document, &settings)? == default;
        trials.push(Trial {
            choice: choice.to_owned(),
            curve: curve.to_owned(),
            settings,
            is_default,
            best: None,
            entry: if is_default { 0 } else { entry },
        });
    }
    for trial in &mut trials {
        let own = best.iter().find(|(choice, _)| *choice == trial.choice);
        trial.best = own.map(|(_, settings)| settings.clone());
    }
    Ok(trials)
}

/// The settings of a cell, without its seed.
pub fn settings(cell: &Cell) -> Result<Vec<Setting>, LabError> {
    let settings = cell.settings();
    settings.map(|(key, value)| setting(key, value)).collect()
}

/// The index of the study's entry with which statistics are compared.
pub fn reference(study: &Study) -> Option<usize> {
    let mut entries = study.cells.chunks(study.seeds);
    entries.position(|cells| cells[0].label() == Some(REFERENCE))
}

/// A few trials of each curve: its last three, or the three before the last one if these are time steps.
pub fn few(trials: &[Trial]) -> Vec<Trial> {
    let curves = trials.chunk_by(Trial::shares_curve);
    let few = curves.flat_map(|curve| {
        let first = curve[0].settings.first();
        let varies_step = first.is_some_and(|setting| setting.path() == ["time_step_secs"]);
        let end = curve.len() - usize::from(varies_step);
        &curve[end.saturating_sub(3)..end]
    });
    few.cloned().collect()
}

/// The numerical choices of a document under some settings, with all defaults filled in.
fn numerics(document: &Value, settings: &[Setting]) -> Result<impl PartialEq + use<>, LabError> {
    let scene = scenario(document, settings)?.scene;
    let (clock, integrator, walls) = (scene.clock, scene.integrator, scene.wall_method);
    let (precision, lists) = (scene.precision, scene.neighbor_lists);
    Ok((clock, integrator, walls, precision, lists, scene.groups))
}

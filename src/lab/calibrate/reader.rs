//! Reads the scenes of a file with their measured values.

use super::file::{SceneKeys, ValueKeys};
use super::parameter::places;
use super::scene::{Reading, Scene, Set, Target, checks};
use super::study::check_text;
use crate::lab::suite::Expected;
use crate::lab::sweep::{Entries, Root, Study, source};
use crate::lab::validate::VALIDATION;
use crate::runs::case::Case;
use crate::runs::memory::Memory;
use crate::runs::summary::Summary;
use crate::scenario::measurements::Measurement;
use crate::scenario::quote::shown;
use crate::scenario::{Problem, Setting, suggestion};

/// The profile of the validation's cases unless the file's settings have another.
const PROFILE: &str = "sph";
/// Largest tolerance, as a fraction of the measured value.
const LARGEST_TOLERANCE: f64 = 10.0;

/// Reads the scenes of a file.
pub(super) struct Reader<'a> {
    pub root: Root<'a>,
    /// Settings of all scenes.
    pub settings: &'a Entries,
    /// The runs of the validation, when the first of its cases was read.
    pub validation: Option<Study>,
    pub memory: &'a Memory,
    pub scenes: Vec<Scene>,
    pub targets: Vec<Target>,
}

impl Reader<'_> {
    /// Adds the scene at `place` with its values.
    pub fn add(&mut self, set: Set, keys: &SceneKeys, place: &str) -> Result<(), Problem> {
        match (&keys.case, &keys.scenario) {
            (Some(case), None) => self.case(set, case, keys, place),
            (None, Some(scenario)) => self.scenario(set, scenario, keys, place),
            _ => {
                let reason = "must have one of `case` (of the validation) and `scenario` (own)";
                Err(Problem::new(place, reason))
            }
        }
    }

    fn case(&mut self, set: Set, id: &str, keys: &SceneKeys, place: &str) -> Result<(), Problem> {
        let at = |key: &str| format!("{place}.{key}");
        if keys.name.is_some() {
            return Err(Problem::new(at("name"), "belongs to an own `scenario`"));
        }
        let Some(case) = VALIDATION.without_data().find(|case| case.id == id) else {
            let ids: Vec<&str> = VALIDATION.without_data().map(|case| case.id).collect();
            let near = suggestion(id, ids.iter().copied());
            let reason = format!(
                "no case is called `{}`{near} (there are {})",
                shown(id),
                ids.join(", ")
            );
            return Err(Problem::new(at("case"), reason));
        };
        let checks = checks(case, "", &Summary::default());
        let checks = checks.map_err(|error| Problem::new(place, error.to_string()))?;
        let known = checks
            .iter()
            .enumerate()
            .filter_map(|(k, check)| match check.expected {
                Expected::Near { value, tolerance } => {
                    Some((k, check, check.run?, value, tolerance))
                }
                _ => None,
            });
        let known: Vec<_> = known.collect();
        let all: Vec<ValueKeys> = known
            .iter()
            .map(|(_, check, ..)| ValueKeys::of(&check.quantity))
            .collect();
        for (k, wanted) in keys.values.as_ref().unwrap_or(&all).iter().enumerate() {
            let place = format!("{place}.values[{k}]");
            let is_meant = |quantity: &str| {
                let rest = quantity.strip_prefix(wanted.quantity.as_str());
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
            };
            let meant = known
                .iter()
                .filter(|(_, check, ..)| is_meant(&check.quantity));
            let meant: Vec<_> = meant.collect();
            if meant.is_empty() {
                let names: Vec<&str> = known
                    .iter()
                    .map(|(_, check, ..)| check.quantity.as_str())
                    .collect();
                let reason = format!(
                    "case {id} has no quantity `{}`; it has {}",
                    shown(&wanted.quantity),
                    names.join(", ")
                );
                return Err(Problem::new(place, reason));
            }
            if meant.len() > 1 && wanted.value.is_some() {
                let reason = format!("means {} quantities, and gives one value", meant.len());
                return Err(Problem::new(place, reason));
            }
            for &&(number, check, run, value, tolerance) in &meant {
                let base = self
                    .validated(run)
                    .map_err(|error| Problem::new(&place, error))?;
                let scene = self.scene(run.to_owned(), base, &keys.settings, &place)?;
                self.target(
                    Target {
                        set,
                        scene,
                        of: case.id.to_owned(),
                        quantity: check.quantity.clone(),
                        measured: wanted.value.unwrap_or(value),
                        tolerance: wanted.tolerance.unwrap_or(tolerance),
                        reading: Reading::Check(case, run, number),
                    },
                    &place,
                )?;
            }
        }
        Ok(())
    }

    fn scenario(
        &mut self,
        set: Set,
        file: &str,
        keys: &SceneKeys,
        place: &str,
    ) -> Result<(), Problem> {
        let at = |key: &str| format!("{place}.{key}");
        let found = source(file, &at("scenario"), self.root)?;
        let refused = |error| Problem::new(at("scenario"), format!("{error}"));
        let base = Case::new(found, Vec::new(), self.memory).map_err(refused)?;
        let given = keys.values.as_deref().unwrap_or_default();
        if given.is_empty() {
            let reason = "is missing: a list of objects with `quantity`, `value` and `tolerance`";
            return Err(Problem::new(at("values"), reason));
        }
        let name = keys.name.clone().unwrap_or_else(|| shown(file));
        check_text(&name, &at("name"))?;
        let scene = self.scene(name.clone(), base, &keys.settings, place)?;
        let scenario = self.scenes[scene].case.scenario();
        let scenario = scenario.map_err(|error| Problem::new(place, error.to_string()))?;
        let metrics = scenario.measurements.iter().flat_map(Measurement::names);
        let metrics: Vec<String> = metrics.collect();
        for (k, wanted) in given.iter().enumerate() {
            let place = format!("{place}.values[{k}]");
            let quantity = &wanted.quantity;
            if !metrics.contains(quantity) {
                let near = suggestion(quantity, metrics.iter().map(String::as_str));
                let reason = format!(
                    "{} does not measure `{}`{near} (it measures {})",
                    shown(&name),
                    shown(quantity),
                    shown(&metrics.join(", "))
                );
                return Err(Problem::new(place, reason));
            }
            let (Some(measured), Some(tolerance)) = (wanted.value, wanted.tolerance) else {
                let reason = "needs a `value` and a `tolerance`, a part of the value such as 0.1";
                return Err(Problem::new(place, reason));
            };
            let target = Target {
                set,
                scene,
                of: name.clone(),
                quantity: quantity.clone(),
                measured,
                tolerance,
                reading: Reading::Metric(quantity.clone()),
            };
            self.target(target, &place)?;
        }
        Ok(())
    }

    /// The run of the validation with this label.
    fn validated(&mut self, label: &str) -> Result<Case, String> {
        let study = match self.validation.take() {
            Some(study) => study,
            None => Study::built_in_for(VALIDATION.name, &[PROFILE.to_owned()], Some(1))
                .map_err(|error| error.to_string())?,
        };
        let cell = study.cells.iter().find(|cell| cell.label() == Some(label));
        let case = cell.map(|cell| cell.case.clone());
        self.validation = Some(study);
        case.ok_or_else(|| format!("the validation has no run {label}"))
    }

    /// The number of the scene with the common settings and its own; it is added if it is new.
    fn scene(
        &mut self,
        name: String,
        base: Case,
        own: &Entries,
        place: &str,
    ) -> Result<usize, Problem> {
        let refused = |place: &str, error: String| Problem::new(place, error);
        let document = base.scenario().map(|scenario| scenario.document);
        let document = document.map_err(|error| refused(place, error.to_string()))?;
        let mut settings = Vec::new();
        for (inside, entries) in [
            ("settings".to_owned(), self.settings),
            (format!("{place}.settings"), own),
        ] {
            for (key, value) in &entries.0 {
                let text = format!("{inside}.{}={}", shown(key), shown(&value.to_string()));
                for path in places(key, &document) {
                    let setting = Setting::new(&path, value.clone(), text.clone());
                    settings.push(setting.map_err(|error| refused(&inside, error.to_string()))?);
                }
            }
        }
        let case = base.with(settings, self.memory);
        let case = case.map_err(|error| refused(place, error.to_string()))?;
        if let Some(known) = self
            .scenes
            .iter()
            .position(|scene| scene.case.key == case.key)
        {
            return Ok(known);
        }
        let scenario = case.scenario();
        let scenario = scenario.map_err(|error| refused(place, error.to_string()))?;
        self.scenes.push(Scene {
            name,
            case,
            ends_empty: scenario.stop.when_empty,
            document: scenario.document,
        });
        Ok(self.scenes.len() - 1)
    }

    fn target(&mut self, target: Target, place: &str) -> Result<(), Problem> {
        let Target {
            measured,
            tolerance,
            ..
        } = target;
        if !(measured > 0.0 && measured.is_finite()) {
            let reason = format!("must be above 0, not {measured}: differences are ratios");
            return Err(Problem::new(format!("{place}.value"), reason));
        }
        if !(tolerance > 0.0 && tolerance <= LARGEST_TOLERANCE) {
            let reason = format!(
                "must be above 0 and at most {LARGEST_TOLERANCE}, a part of the value, not {tolerance}"
            );
            return Err(Problem::new(format!("{place}.tolerance"), reason));
        }
        let is_same =
            |other: &&Target| other.scene == target.scene && other.quantity == target.quantity;
        if let Some(other) = self.targets.iter().find(is_same) {
            let reason = format!(
                "{} of {} is already in {}",
                target.quantity,
                shown(&target.of),
                other.set.name()
            );
            return Err(Problem::new(place, reason));
        }
        self.targets.push(target);
        Ok(())
    }
}

impl ValueKeys {
    fn of(quantity: &str) -> Self {
        Self {
            quantity: quantity.to_owned(),
            value: None,
            tolerance: None,
        }
    }
}

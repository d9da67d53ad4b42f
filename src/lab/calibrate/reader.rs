//! Reads the scenes of a file with their measured values.

use std::cell::OnceCell;

use super::file::{SceneKeys, ValueKeys};
use super::parameter::check_text;
use super::parameter::places;
use super::scene::{Scene, Set, Target};
use crate::suite::{Case as SuiteCase, Check, Expected, Suite};
use crate::sweep::{Changes, Entries, Study, Written, source};
use runs::case::Case;
use runs::memory::Memory;
use scenario::measurements::Measurement;
use scenario::quote::shown;
use scenario::{Problem, Setting, suggestion};

/// The suite whose cases can be scenes.
const VALIDATION: &str = "validation";
/// The profile of its runs unless the file's settings have another.
const PROFILE: &str = "sph";
/// Largest tolerance, as a fraction of the measured value.
const LARGEST_TOLERANCE: f64 = 10.0;

/// The validation and its runs, when the first of its cases was read.
pub(super) type Validation = OnceCell<(Suite, Study)>;

/// Reads the scenes of a file.
pub(super) struct Reader<'a> {
    /// The file.
    pub from: &'a Written,
    /// Settings of all scenes.
    pub settings: &'a Entries,
    pub validation: &'a Validation,
    pub memory: &'a Memory,
    pub scenes: Vec<Scene>,
    pub targets: Vec<Target>,
}

impl<'a> Reader<'a> {
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
        let (suite, study) = self
            .validation()
            .map_err(|error| Problem::new(place, error))?;
        let case = named(suite, id).map_err(|reason| Problem::new(at("case"), reason))?;
        let checks = case.checks.iter();
        let measured: Vec<&Check> = checks.filter(|one| one.expected.is_measured()).collect();
        let all = measured.iter().map(|check| ValueKeys::of(&check.name));
        let by_default: Vec<ValueKeys> = all.collect();
        let values = keys.values.as_ref().unwrap_or(&by_default);
        for (k, wanted) in values.iter().enumerate() {
            let place = format!("{place}.values[{k}]");
            let meant = meant(wanted, id, &measured);
            for check in meant.map_err(|reason| Problem::new(&place, reason))? {
                let (
                    [run],
                    Expected::Near {
                        value: Some(value),
                        tolerance,
                    },
                ) = (&check.of[..], check.expected)
                else {
                    continue;
                };
                let cell = study.cells.iter().find(|cell| cell.label() == Some(run));
                let missing = || Problem::new(&place, format!("the validation has no run {run}"));
                let base = cell.ok_or_else(missing)?.case.clone();
                let scene = self.scene(run.clone(), base, &keys.settings, &place)?;
                let target = Target {
                    set,
                    scene,
                    of: case.name.clone(),
                    quantity: check.name.clone(),
                    measured: wanted.value.unwrap_or(value),
                    tolerance: wanted.tolerance.unwrap_or(tolerance),
                    check: check.clone(),
                };
                self.target(target, &place)?;
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
        let found = source(file, &at("scenario"), self.from)?;
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
        let read = self.scenes[scene].case.scenario();
        let scenario = read.map_err(|error| Problem::new(place, error.to_string()))?;
        let names = scenario.measurements.iter().flat_map(Measurement::names);
        let metrics: Vec<String> = names.collect();
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
                check: Check::of_metric(quantity),
            };
            self.target(target, &place)?;
        }
        Ok(())
    }

    /// The validation with its runs.
    fn validation(&self) -> Result<&'a (Suite, Study), String> {
        if let Some(known) = self.validation.get() {
            return Ok(known);
        }
        let suite = Suite::built_in(VALIDATION).map_err(|error| error.to_string())?;
        let changes = Changes {
            profiles: &[PROFILE.to_owned()],
            seeds: Some(1),
            ..Changes::default()
        };
        let study = suite.study(&changes).map_err(|error| error.to_string())?;
        Ok(self.validation.get_or_init(|| (suite, study)))
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
        let read = base.scenario().map(|scenario| scenario.document);
        let document = read.map_err(|error| refused(place, error.to_string()))?;
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
        let changed = base.with(settings, self.memory);
        let case = changed.map_err(|error| refused(place, error.to_string()))?;
        if let Some(known) = self.scenes.iter().position(|one| one.case.key == case.key) {
            return Ok(known);
        }
        let read = case.scenario();
        let scenario = read.map_err(|error| refused(place, error.to_string()))?;
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

/// The case of a suite with this name; else why there is none.
fn named<'s>(suite: &'s Suite, name: &str) -> Result<&'s SuiteCase, String> {
    let mut cases = suite.without_data();
    cases.find(|case| case.name == name).ok_or_else(|| {
        let names = suite.without_data().map(|case| case.name.as_str());
        let known: Vec<&str> = names.collect();
        let near = suggestion(name, known.iter().copied());
        let (name, known) = (shown(name), known.join(", "));
        format!("no case is called `{name}`{near} (there are {known})")
    })
}

/// The checks of a case that a value means: those whose name begins with its quantity; else why there are none.
fn meant<'c>(
    wanted: &ValueKeys,
    case: &str,
    measured: &[&'c Check],
) -> Result<Vec<&'c Check>, String> {
    let is_meant = |check: &&&Check| {
        let rest = check.name.strip_prefix(wanted.quantity.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let meant: Vec<&Check> = measured.iter().filter(is_meant).copied().collect();
    match meant.len() {
        0 => {
            let known: Vec<&str> = measured.iter().map(|check| check.name.as_str()).collect();
            let (quantity, known) = (shown(&wanted.quantity), known.join(", "));
            Err(format!(
                "case {case} has no quantity `{quantity}`; it has {known}"
            ))
        }
        count if count > 1 && wanted.value.is_some() => {
            Err(format!("means {count} quantities, and gives one value"))
        }
        _ => Ok(meant),
    }
}

//! Checks of a suite's file: what it expects, and whether its runs and quantities exist.

use super::keys::{Case, Check, Expected};
use crate::sweep::{Cell, check_name};
use scenario::quote::shown;
use scenario::{Problem, suggestion};

/// The label of a run; empty without one.
pub fn label(cell: &Cell) -> &str {
    cell.label().unwrap_or_default()
}

/// Checks what can be checked without the study's runs.
pub fn check_cases(cases: &[Case], profiles: &[String]) -> Result<(), Problem> {
    if cases.is_empty() {
        return Err(Problem::new("cases", "must not be empty"));
    }
    each(cases, "cases", |case| {
        check_name(&case.name)?;
        if cases.iter().filter(|other| other.name == case.name).count() > 1 {
            return Err(Problem::new(
                "name",
                "must not be the name of several cases",
            ));
        }
        if case.checks.is_empty() {
            return Err(Problem::new("checks", "must not be empty"));
        }
        let mut missed = case.known_misses.keys().filter(|_| !profiles.is_empty());
        if let Some(profile) = missed.find(|profile| !profiles.contains(profile)) {
            let reason = unknown("the study's grid", "profile", profile, profiles);
            return Err(Problem::new("known_misses", reason));
        }
        each(&case.checks, "checks", Check::check_keys)
    })
}

/// Checks each item of the list `key`.
pub fn each<T>(
    items: &[T],
    key: &str,
    check: impl Fn(&T) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let mut items = items.iter().enumerate();
    items.try_for_each(|(k, item)| {
        check(item).map_err(|problem| problem.under(&format!("{key}[{k}]")))
    })
}

impl Check {
    fn check_keys(&self) -> Result<(), Problem> {
        let count = self.quantity.len() * self.of.len();
        let refused = self.function.and_then(|function| function.refuses(count));
        let (key, reason) = match (self.function, self.expected) {
            (_, _) if self.of.is_empty() => ("of", "must not be empty"),
            (_, _) if self.quantity.is_empty() => ("quantity", "must not be empty"),
            (None, _) if count > 1 => (
                "function",
                "missing: several values need a `mean`, `sum`, `difference`, `ratio` or `place`",
            ),
            (_, Expected::Between([low, high])) if low > high => (
                "expected.between",
                "must be two numbers, the smaller one first",
            ),
            (
                _,
                Expected::Near {
                    value: Some(0.0), ..
                },
            ) => (
                "expected.near.value",
                "must not be 0, for the tolerance is a part of it",
            ),
            (_, Expected::Near { tolerance, .. }) if tolerance <= 0.0 => (
                "expected.near.tolerance",
                "must be above 0, a part of the value such as 0.1",
            ),
            _ => match refused {
                Some(reason) => ("function", reason),
                None => return Ok(()),
            },
        };
        Err(Problem::new(key, reason))
    }
}

/// Says that something has no `what` of this name, and which ones it has.
pub fn unknown<T: AsRef<str>>(of: &str, what: &str, name: &str, all: &[T]) -> String {
    let near = suggestion(name, all.iter().map(AsRef::as_ref));
    let names: Vec<String> = all.iter().map(|name| shown(name.as_ref())).collect();
    let all = if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    };
    format!(
        "{} has no {what} `{}`{near} (it has {all})",
        shown(of),
        shown(name)
    )
}

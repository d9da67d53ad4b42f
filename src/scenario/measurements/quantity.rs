//! What a measurement measures: names, units and meanings of its values.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Measurement;
use crate::input::embedded;

/// A measurement of each kind that has values, with usual keys.
const EXAMPLES: &str = include_str!("examples.json");

/// A value of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its name in reports, unique in a scenario.
    pub name: String,
    /// Its unit; empty for shares.
    pub unit: &'static str,
    /// What it means, in a phrase.
    pub meaning: String,
}

impl Measurement {
    /// The names of all measurements that have values, each with what it measures, for usual keys.
    pub fn all_quantities() -> Vec<(String, Vec<Quantity>)> {
        let names = embedded::<Vec<BTreeMap<String, Value>>>("examples.json", EXAMPLES)
            .into_iter()
            .filter_map(|example| example.into_keys().next());
        let examples: Vec<Self> = embedded("examples.json", EXAMPLES);
        let quantities = examples.iter().map(Self::quantities);
        names.zip(quantities).collect()
    }
}

impl Quantity {
    pub(super) fn new(name: impl Into<String>, unit: &'static str, meaning: &str) -> Self {
        Self {
            name: name.into(),
            unit,
            meaning: meaning.to_owned(),
        }
    }

    /// Quantities, each with its value.
    ///
    /// # Panics
    /// There are not as many values as quantities: those at the end would get lost, or stand beside a wrong name.
    pub(super) fn paired(
        quantities: Vec<Self>,
        values: Vec<Option<f64>>,
    ) -> impl Iterator<Item = (Self, Option<f64>)> {
        let names = || -> Vec<&str> { quantities.iter().map(|one| one.name.as_str()).collect() };
        assert_eq!(
            quantities.len(),
            values.len(),
            "`values` must have one value for each of `quantities`, {:?}",
            names()
        );
        quantities.into_iter().zip(values)
    }

    /// Quantities whose names begin with that of the measurement.
    pub(super) fn all(of: &str, quantities: &[(&str, &'static str, &str)]) -> Vec<Self> {
        let quantity = |&(what, unit, meaning): &(&str, _, &str)| {
            Self::new(format!("{of}_{what}"), unit, meaning)
        };
        quantities.iter().map(quantity).collect()
    }
}

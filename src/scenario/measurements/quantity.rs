//! What a measurement measures: names, units and meanings of its values.

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

impl Quantity {
    pub(super) fn new(name: impl Into<String>, unit: &'static str, meaning: &str) -> Self {
        Self {
            name: name.into(),
            unit,
            meaning: meaning.to_owned(),
        }
    }

    /// Quantities whose names begin with that of the measurement.
    pub(super) fn all(of: &str, quantities: &[(&str, &'static str, &str)]) -> Vec<Self> {
        let quantity = |&(what, unit, meaning): &(&str, _, &str)| {
            Self::new(format!("{of}_{what}"), unit, meaning)
        };
        quantities.iter().map(quantity).collect()
    }
}

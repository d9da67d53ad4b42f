//! What a study's file expects of its runs: cases and their checks.

use std::collections::BTreeMap;

use serde::de::IntoDeserializer;
use serde::de::value::StrDeserializer;
use serde::{Deserialize, Deserializer, Serialize};
use serde_untagged::UntaggedEnumVisitor;

use super::quantity::{Function, Quantity};
use crate::sweep::{DataFile, Entries};

/// The keys of a study's file that make it a suite, and those that the suite reads, too.
#[derive(Debug, Deserialize)]
pub(super) struct File {
    pub name: Option<String>,
    #[serde(default)]
    pub grid: Entries,
    #[serde(default)]
    pub data: Vec<DataFile>,
    /// Reasons that several cases share, by name.
    #[serde(default)]
    pub reasons: BTreeMap<String, String>,
    pub cases: Vec<Case>,
}

/// A case: what is expected of some runs of the study.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Its name in tables, on the command line and of its picture.
    pub name: String,
    /// A description, in one line.
    pub(super) about: String,
    /// The kind of scene, under which its values are counted.
    pub(crate) kind: Option<String>,
    /// The source of what is expected.
    pub(super) source: Option<String>,
    /// The picture, if there is one.
    pub picture: Option<Moment>,
    /// The diagram that shows its checks, if there is one.
    pub(super) diagram: Option<Diagram>,
    /// What is expected.
    pub checks: Vec<Check>,
    /// Profiles that are known to miss an expectation, each with the reason.
    #[serde(default)]
    pub known_misses: BTreeMap<String, String>,
}

/// A moment of a run.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// The label of the run.
    #[serde(default)]
    pub run: String,
    /// The time, seconds.
    pub at_secs: f64,
}

/// A diagram of speeds by density.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Diagram {
    /// People in a periodic corridor, with the curves of Weidmann and the SFPE.
    EndlessCorridor,
    /// People one behind the other.
    SingleFile,
}

/// A quantity with its expectation.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// Its name and unit in tables.
    pub name: String,
    /// What is measured in each run.
    #[serde(deserialize_with = "quantities")]
    pub(super) quantity: Vec<Quantity>,
    /// The labels of the runs. Runs of a study without a list have an empty label.
    #[serde(default = "unlabeled", deserialize_with = "labels")]
    pub of: Vec<String>,
    /// The function of these values; `None` for a single value.
    pub(super) function: Option<Function>,
    /// Where it is in the diagram: a density, P/m² or P/m.
    pub(super) at: Option<f64>,
    /// The expectation.
    #[serde(default)]
    pub expected: Expected,
    /// The calibrated profiles that were fitted to it.
    #[serde(default)]
    pub fitted: Vec<String>,
}

/// The expectation for a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Expected {
    /// A value between two, inclusive; infinite if there is no bound.
    Between(#[serde(deserialize_with = "bounds")] [f64; 2]),
    /// A measured value, with a tolerance as a fraction of it.
    Near {
        /// The measured value; `None`: as in the data from which the run begins.
        value: Option<f64>,
        /// The tolerance.
        tolerance: f64,
    },
    /// Any value: it is reported.
    #[default]
    Any,
}

fn unlabeled() -> Vec<String> {
    vec![String::new()]
}

/// Two numbers; `null` for no bound.
fn bounds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let [low, high] = <[Option<f64>; 2]>::deserialize(deserializer)?;
    Ok([
        low.unwrap_or(f64::NEG_INFINITY),
        high.unwrap_or(f64::INFINITY),
    ])
}

fn quantities<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Quantity>, D::Error> {
    let words =
        "the name of a quantity, an object such as {\"passed\": \"door\"}, or a list of these";
    one_or_several(deserializer, words)
}

fn labels<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<String>, D::Error> {
    one_or_several(deserializer, "the label of a run, or a list of labels")
}

/// One item, or a list of them.
fn one_or_several<'de, D, T>(deserializer: D, words: &str) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: for<'t> Deserialize<'t>,
{
    UntaggedEnumVisitor::new()
        .expecting(words)
        .string(|text| {
            let text: StrDeserializer<serde_untagged::de::Error> = text.into_deserializer();
            Ok(vec![T::deserialize(text)?])
        })
        .map(|keys| Ok(vec![keys.deserialize()?]))
        .seq(|items| items.deserialize())
        .deserialize(deserializer)
}

//! What is known about a result before its first run, from results that were measured before.
//!
//! Two things are known: the spread of runs, and the error of the paper's step in units of this spread. The sources
//! are the results that ship with the program (`knowledge.json`, which the experiment `knowledge` writes), and the
//! rows of the same study that are finished. Across scenes, the spreads of flows of one profile differ by a factor
//! of up to ten, so a spread from another scene counts as one degree of freedom only; the spreads of a study's rows
//! differ less. Knowledge about the error of the step is the shares of its sizes among similar results, beside general
//! shares that count as two results.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use super::limit::SIZES;
use crate::model::Quantity;
use analysis::statistics::MeanStd;
use scenario::input::embedded;

/// General shares of the sizes of errors.
const GENERAL: [f64; SIZES.len()] = [0.25, 0.35, 0.2, 0.13, 0.07];
/// The number of results that they count as.
const GENERAL_COUNT: f64 = 2.0;
/// The part that a result of another profile counts.
const OTHER_PROFILE: f64 = 0.3;
/// The degrees of freedom of a spread from other scenes.
const OTHER_SCENES: f64 = 1.0;
/// The standard deviation of the logarithm of the spread over the rows of a study: of a single row, and at least.
const ROWS: [f64; 2] = [0.3, 0.15];
/// The most degrees of freedom of a spread from the rows of a study.
const MOST_DEGREES: f64 = 10.0;
/// From these degrees of freedom on, two runs are enough to begin with.
const WELL_KNOWN: f64 = 4.0;
/// Steps of the iteration for the shares of sizes.
const ITERATIONS: usize = 30;

/// A measured result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// The scenario.
    pub scene: String,
    /// The profile.
    pub profile: String,
    /// The result.
    pub result: String,
    /// What it is about.
    pub quantity: Quantity,
    /// The standard deviation of runs, as a part of the value.
    pub spread: f64,
    /// Its degrees of freedom.
    pub degrees: f64,
    /// The error of the paper's step in standard deviations of a run, if it is of first order.
    pub error: f64,
    /// The standard error of this error; `None` if only one step was run.
    pub error_std: Option<f64>,
}

/// The results that ship with the program.
static SHIPPED: LazyLock<Vec<Known>> =
    LazyLock::new(|| embedded("knowledge.json", include_str!("knowledge.json")));

/// What is known about a result before its first run.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    /// The shares of the sizes of errors.
    pub shares: [f64; SIZES.len()],
    /// The standard deviation of runs as a part of the value, and its degrees of freedom.
    spread: Option<(f64, f64)>,
    /// The number of similar results.
    pub similar: usize,
}

impl Prior {
    /// Nothing is known but the general shares.
    pub const NONE: Self = Self {
        shares: GENERAL,
        spread: None,
        similar: 0,
    };

    /// What is known about a result of a profile: from `rows`, finished rows of the same study, and from what ships
    /// with the program about its quantity, without the scene `but`.
    pub fn of(
        [profile, result]: [&str; 2],
        quantity: Option<Quantity>,
        rows: &[Known],
        but: Option<&str>,
    ) -> Self {
        let Some(quantity) = quantity else {
            return Self::NONE;
        };
        let is_same =
            |known: &&Known| known.quantity == quantity && but != Some(known.scene.as_str());
        let is_own = |known: &&Known| known.profile == profile;
        let is_near = |known: &&Known| is_own(known) && known.result == result;
        let same = SHIPPED.iter().filter(is_same);
        let (own, others): (Vec<&Known>, Vec<&Known>) = same.partition(is_own);
        let near: Vec<&Known> = rows.iter().filter(is_near).collect();
        let full = own.iter().chain(&near).map(|known| (*known, 1.0));
        let all = full.chain(others.into_iter().map(|known| (known, OTHER_PROFILE)));
        Self {
            shares: shares(&all.collect::<Vec<_>>()),
            spread: of_rows(&near).or_else(|| of_scenes(&own)),
            similar: own.len() + near.len(),
        }
    }

    /// The number of runs to begin with at the first step.
    pub fn first_runs(&self) -> usize {
        /// Without rows of the same study.
        const FEW: usize = 4;
        match self.spread {
            Some((_, degrees)) if degrees >= WELL_KNOWN => 2,
            _ => FEW,
        }
    }

    /// The standard deviation of runs as a part of the value, and its degrees of freedom, if known.
    pub(super) fn spread(&self) -> Option<(f64, f64)> {
        self.spread
    }

    /// The variance of single runs and its degrees of freedom, from a sum of squared deviations with these degrees and
    /// from what was known. Knowledge that lies z standard deviations from the data loses a factor of z².
    pub(super) fn variance(&self, squares: f64, degrees: f64, mean: f64) -> [f64; 2] {
        let own = squares / degrees;
        let Some((spread, known)) = self.spread.filter(|_| own > 0.0) else {
            return [own, degrees];
        };
        let expected = (spread * mean).powi(2);
        let off = (own / expected).ln().powi(2) / (2.0 / degrees + 2.0 / known);
        let known = known / off.max(1.0);
        let all = degrees + known;
        [(squares + known * expected) / all, all]
    }

    /// The degrees of freedom of the spread that is known.
    pub(super) fn degrees(&self) -> f64 {
        self.spread.map_or(0.0, |(_, degrees)| degrees)
    }
}

/// The spread from the rows of a study, and its degrees of freedom.
fn of_rows(near: &[&Known]) -> Option<(f64, f64)> {
    let logs: Vec<f64> = near.iter().map(|known| known.spread.ln()).collect();
    let of = mean(&logs)?;
    let [single, least] = ROWS;
    let measured = MeanStd::of(&logs).and_then(|of| of.std());
    let between = measured.map_or(single, |std| std.max(least));
    let chances = near.iter().map(|known| 0.5 / known.degrees.max(1.0));
    let chance = chances.sum::<f64>() / near.len() as f64;
    let degrees = 0.5 / (between.powi(2) + chance);
    Some((of.exp(), degrees.min(MOST_DEGREES)))
}

/// The spread from other scenes, each of which counts once.
fn of_scenes(own: &[&Known]) -> Option<(f64, f64)> {
    let scenes = own.chunk_by(|a, b| a.scene == b.scene).filter_map(|of| {
        let logs: Vec<f64> = of.iter().map(|known| known.spread.ln()).collect();
        mean(&logs)
    });
    let of = mean(&scenes.collect::<Vec<_>>())?;
    Some((of.exp(), OTHER_SCENES))
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The most likely shares of the sizes among results with errors, each with its weight, beside the general ones.
fn shares(known: &[(&Known, f64)]) -> [f64; SIZES.len()] {
    let mut shares = GENERAL;
    for _ in 0..ITERATIONS {
        let mut counts = GENERAL.map(|share| GENERAL_COUNT * share);
        for (known, weight) in known {
            let Some(std) = known.error_std else {
                continue;
            };
            let mut likely = shares;
            for (likely, size) in likely.iter_mut().zip(SIZES) {
                let variance = size * size + std * std;
                *likely *= (-0.5 * known.error.powi(2) / variance).exp() / variance.sqrt();
            }
            let sum: f64 = likely.iter().sum();
            for (count, likely) in counts.iter_mut().zip(likely) {
                *count += weight * likely / sum.max(f64::MIN_POSITIVE);
            }
        }
        let sum: f64 = counts.iter().sum();
        shares = counts.map(|count| count / sum);
    }
    shares
}

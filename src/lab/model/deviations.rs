//! The deviations of a profile from experiments, and the interval that they give for a value of the same kind.
//!
//! Conformal prediction (V. Vovk, A. Gammerman, G. Shafer, Algorithmic Learning in a Random World, 2005): if a new
//! deviation is one more draw from where n known ones come from, it is at most the ⌈(n + 1) P⌉-th smallest of them with
//! the probability P at least, whatever their distribution. People who hurry deviate to another side than calm ones, so
//! deviations count from the mean of those with people alike; each from a mean without its own experiment, as a new
//! experiment has no part in that mean either.

use std::collections::BTreeSet;

use serde::Serialize;

use super::Quantity;
use crate::error::LabError;
use crate::suite::{Status, Suite};

/// The probability with which intervals hold a value.
pub const SHARE: f64 = 0.9;
/// The mean of the people alike counts as if there were this many more values without any deviation: a mean of few
/// values is near to none.
const UNKNOWN: f64 = 4.0;
/// The kinds of cases with hurried people begin with this word.
const HURRIED: &str = "hurried";

/// People by what they were told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum People {
    /// They walk as they like.
    Calm,
    /// They hurry.
    Hurried,
}

impl People {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Calm => "calm",
            Self::Hurried => "hurried",
        }
    }
}

/// A value of a profile beside a measured one.
#[derive(Debug, Clone)]
struct Deviation {
    experiment: String,
    people: People,
    quantity: Quantity,
    /// The logarithm of the simulated value over the measured one.
    ratio: f64,
}

/// The deviations of a profile.
#[derive(Debug, Clone)]
pub struct Deviations(Vec<Deviation>);

/// By what a simulated value is multiplied to give the bounds of the measured one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    pub low: f64,
    pub high: f64,
    /// The number of experiments that measure the quantity.
    pub experiments: usize,
    /// Those of them with people alike.
    pub alike: usize,
}

impl Deviations {
    /// Those of a profile in `sandbox validate` without data; `None` if it is not among them.
    ///
    /// # Errors
    /// Data that ship with the program are invalid.
    pub fn of(profile: &str) -> Result<Option<Self>, LabError> {
        let status = Status::validated()?;
        let Some(passed) = status.profiles.get(profile) else {
            return Ok(None);
        };
        let invalid = |error: scenario::ScenarioError| LabError::Data(error.to_string());
        let suite = Suite::built_in("validation").map_err(invalid)?;
        let mut all = Vec::new();
        for case in &suite.cases {
            let kind = case.kind.as_deref().unwrap_or_default();
            let values = passed.ratios.get(&case.name).into_iter().flatten();
            all.extend(values.filter_map(|(name, ratio)| {
                Some(Deviation {
                    experiment: case.name.clone(),
                    people: match kind.starts_with(HURRIED) {
                        true => People::Hurried,
                        false => People::Calm,
                    },
                    quantity: quantity_of(name)?,
                    ratio: ratio.ln(),
                })
            }));
        }
        Ok(Some(Self(all)).filter(|all| !all.0.is_empty()))
    }

    /// What the measured value of a quantity may be over the simulated one; `None` with too few values.
    pub fn factors(&self, quantity: Quantity, people: People) -> Option<Factors> {
        let own: Vec<&Deviation> = self
            .0
            .iter()
            .filter(|one| one.quantity == quantity)
            .collect();
        let mut scores: Vec<f64> = own
            .iter()
            .map(|one| {
                let others = own.iter().filter(|of| of.experiment != one.experiment);
                (one.ratio - shift(others.copied(), one.people)).abs()
            })
            .collect();
        scores.sort_by(f64::total_cmp);
        let rank = (SHARE * (scores.len() + 1) as f64).ceil() as usize;
        let width = scores.get(rank.checked_sub(1)?)?;
        let shift = shift(own.iter().copied(), people);
        let experiments = |of: &dyn Fn(&Deviation) -> bool| {
            let named = own.iter().filter(|one| of(one)).map(|one| &one.experiment);
            named.collect::<BTreeSet<_>>().len()
        };
        Some(Factors {
            low: (-shift - width).exp(),
            high: (-shift + width).exp(),
            experiments: experiments(&|_| true),
            alike: experiments(&|one| one.people == people),
        })
    }
}

/// The mean deviation of people alike, nearer to 0 the fewer they are.
fn shift<'d>(values: impl Iterator<Item = &'d Deviation>, people: People) -> f64 {
    let alike = values.filter(|one| one.people == people);
    let (count, sum) = alike.fold((0.0, 0.0), |(count, sum), one| {
        (count + 1.0, sum + one.ratio)
    });
    sum / (count + UNKNOWN)
}

/// What a value of a case is about, by its name: `before: flow [P/s]`.
fn quantity_of(name: &str) -> Option<Quantity> {
    let (_, unit) = name.rsplit_once('[')?;
    Quantity::of_unit(unit.trim_end_matches(']'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviations(ratios: &[(u32, f64)], people: People) -> impl Iterator<Item = Deviation> {
        let of = move |&(experiment, ratio): &(u32, f64)| Deviation {
            experiment: experiment.to_string(),
            people,
            quantity: Quantity::Flow,
            ratio,
        };
        ratios.iter().map(of)
    }

    #[test]
    fn nine_values_without_a_mean_give_the_largest_deviation() {
        let ratios = [0.1, -0.1, 0.2, -0.2, 0.05, -0.05, 0.15, -0.15, 0.0].map(f64::from);
        let mut numbered = Vec::new();
        for (k, ratio) in ratios.into_iter().enumerate() {
            numbered.push((k as u32, ratio));
        }
        let all = Deviations(deviations(&numbered, People::Calm).collect());
        let Factors {
            low,
            high,
            experiments,
            alike,
        } = all.factors(Quantity::Flow, People::Calm).unwrap();
        // Each deviation counts from the mean of the others: 0.2 from −0.2/12.
        let width = 0.2 + 0.2 / 12.0;
        assert!((low - f64::exp(-width)).abs() < 1e-12 && (high - f64::exp(width)).abs() < 1e-12);
        assert_eq!((experiments, alike), (9, 9));
        assert_eq!(all.factors(Quantity::Speed, People::Calm), None);
        let eight = Deviations(all.0[..8].to_vec());
        assert_eq!(
            eight.factors(Quantity::Flow, People::Calm),
            None,
            "90 % need nine values"
        );
    }

    #[test]
    fn people_who_deviate_to_one_side_have_an_interval_on_the_other_side() {
        let calm: Vec<(u32, f64)> = (0..12).map(|k| (k, 0.0)).collect();
        let hurried: Vec<(u32, f64)> = (12..24).map(|k| (k, 0.3)).collect();
        let all = deviations(&calm, People::Calm).chain(deviations(&hurried, People::Hurried));
        let all = Deviations(all.collect());
        let [calm, hurried] = [People::Calm, People::Hurried]
            .map(|people| all.factors(Quantity::Flow, people).unwrap());
        assert!(calm.low < 1.0 && calm.high > 1.0);
        assert!(hurried.high < 1.0, "{hurried:?}"); // simulated flows are too high
        assert!(hurried.low < f64::exp(-0.3) && hurried.high > f64::exp(-0.3));
    }
}

//! Bounds on most runs, by order statistics: valid for any distribution of a result over runs.

use serde::Serialize;

use super::run::{Runs, StepRuns};
use super::sample::Sample;
use super::wanted::{Bound, IMO_RUNS, Sampling};
use crate::error::LabError;
use crate::sweep::number;
use analysis::round;
use analysis::statistics::probability_above;
use runs::case::RunResult;
use runs::job::Listener;
use runs::store::Store;

/// IMO's number of runs of each population, where these differ.
const REPETITIONS: usize = 5;

/// A bound on most runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bounded {
    /// The name of the result.
    pub name: String,
    /// The share of runs that are at most the value.
    pub share: f64,
    /// The bound; `None` if there are no runs with this rank, or if that run has no value.
    pub value: Option<f64>,
    /// The rank of the value: 1 is the smallest of all runs.
    pub rank: Option<usize>,
    /// The number of runs.
    pub runs: usize,
    /// Those without a value: they count as runs beyond all others.
    pub missing: usize,
    /// The number of runs that the bound needs at least.
    pub needed: usize,
    /// The probability that the bound holds; `None` if runs share their populations, and so are not independent.
    pub confidence: Option<f64>,
    /// The number of populations and of runs of each.
    pub populations: [usize; 2],
    /// The time step of the runs, seconds. Its error is not part of the bound.
    pub step: f64,
    /// The values of all runs, in the order of their seeds.
    pub values: Vec<Option<f64>>,
}

impl Bounded {
    /// Whether the bound is above most runs.
    pub fn is_upper(&self) -> bool {
        self.share >= 0.5
    }

    /// The share of runs on the inner side of the bound.
    pub fn inner(&self) -> f64 {
        self.share.max(1.0 - self.share)
    }

    /// Whether there were enough runs, but the run with the bound's rank has no value.
    pub fn is_lost(&self) -> bool {
        self.value.is_none() && self.rank.is_some()
    }

    /// Why it is.
    pub fn lost(&self) -> String {
        let (side, share) = match self.is_upper() {
            true => ("above", self.inner()),
            false => ("below", 1.0 - self.inner()),
        };
        format!(
            "{} of {} runs have no value and count as {side} all others, so no bound holds for {} % of runs; \
             let the runs last longer, or ask for a result that they have",
            self.missing,
            self.runs,
            round::brief(100.0 * share)
        )
    }
}

impl Runs<'_> {
    /// Makes the runs of the bounds.
    ///
    /// # Errors
    /// As [`run`](fn@super::run).
    pub(super) fn make_for_bounds(
        &mut self,
        elapsed: f64,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<(), LabError> {
        let question = self.question;
        let (request, start) = (&question.request, question.start);
        if request.sampling == Sampling::Imo {
            if request.limits.runs < IMO_RUNS {
                self.stopped = Some(format!("at most {} runs were allowed", request.limits.runs));
                return Ok(());
            }
            let repetitions = if question.is_behavior_random {
                REPETITIONS
            } else {
                1
            };
            let rung = question.rungs[start];
            let results = self.results_of(
                IMO_RUNS,
                &|k| {
                    let [population, repetition] = [k / repetitions, k % repetitions];
                    let case = question.of_population(rung, population, repetition)?;
                    let name = format!("population {}, run {}", population + 1, repetition + 1);
                    Ok((case, name))
                },
                store,
                listener,
            )?;
            self.sample = Some(Sample {
                results,
                repetitions,
            });
            return Ok(());
        }
        let needed = request.bounds.iter().map(|bound| request.runs_for(bound));
        let mut wanted = vec![0; self.levels.len()];
        wanted[start] = needed.max().unwrap_or(0);
        self.stopped = self.cut(&mut wanted, elapsed);
        self.make(&wanted, store, listener)
    }

    /// What they say.
    pub(super) fn bounded(&self, bound: &Bound) -> Bounded {
        let question = self.question;
        let level: &StepRuns = &self.levels[question.start];
        let confidence = question.request.confidence;
        // Further runs were made for errors of means, and their number depends on the values: a bound from all runs
        // would hold with another probability.
        let own = level.results.len().min(bound.runs(confidence));
        let (results, repetitions) = match &self.sample {
            Some(sample) => (&sample.results[..], sample.repetitions),
            None => (&level.results[..own], 1),
        };
        let value = |result: &Result<RunResult, String>| number(result.as_ref().ok()?, &bound.name);
        let values: Vec<Option<f64>> = results.iter().map(value).collect();
        let all = values.len();
        let rank = match self.sample {
            // The value is selected for which this share of the ranked values are lower.
            Some(_) => (bound.inner() * all as f64).ceil() as usize + 1,
            None => all,
        };
        let rank = Some(rank).filter(|rank| (1..=all).contains(rank));
        let holds = rank.filter(|_| repetitions == 1);
        let holds = holds.map(|rank| probability_above(rank, all, bound.inner()));
        let (value, rank) = ranked(&values, rank, bound.is_upper());
        Bounded {
            name: bound.name.clone(),
            share: bound.share,
            value,
            rank,
            runs: all,
            missing: values.iter().filter(|value| value.is_none()).count(),
            needed: question.request.runs_for(bound),
            confidence: holds,
            populations: [all / repetitions, repetitions],
            step: level.rung.step,
            values,
        }
    }
}

/// The value that is beyond all but the outermost ones, with its rank from the smallest. `rank` counts from the inner
/// side. Missing values count as beyond all others.
fn ranked(
    values: &[Option<f64>],
    rank: Option<usize>,
    is_upper: bool,
) -> (Option<f64>, Option<usize>) {
    let Some(rank) = rank else {
        return (None, None);
    };
    let mut known: Vec<f64> = values.iter().flatten().copied().collect();
    known.sort_by(f64::total_cmp);
    if !is_upper {
        known.reverse();
    }
    let value = known.get(rank - 1).copied();
    let from_smallest = if is_upper {
        rank
    } else {
        values.len() + 1 - rank
    };
    (value, Some(from_smallest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_values_are_beyond_all_others_on_both_sides() {
        let values = [Some(3.0), None, Some(1.0), Some(2.0)];
        for (rank, is_upper, value, from_smallest) in [
            (3, true, Some(3.0), 3),
            (4, true, None, 4),
            (3, false, Some(1.0), 2),
            (4, false, None, 1),
        ] {
            let found = ranked(&values, Some(rank), is_upper);
            assert_eq!(found, (value, Some(from_smallest)), "{rank}");
        }
        assert_eq!(ranked(&values, None, true), (None, None));
    }
}

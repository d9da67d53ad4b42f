//! Bounds on most runs, by order statistics: valid for any distribution of a result over runs.

use serde::Serialize;

use super::run::{Runs, Sample};
use super::wanted::{Bound, IMO_RUNS, Sampling};
use crate::error::LabError;
use crate::jobs::each;
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
    /// The result and the share of runs.
    #[serde(flatten)]
    pub bound: Bound,
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
    /// Whether there were enough runs, but the run with the bound's rank has no value.
    pub fn is_lost(&self) -> bool {
        self.value.is_none() && self.rank.is_some()
    }

    /// Why it is.
    pub fn lost(&self) -> String {
        let (side, share) = match self.bound.is_upper() {
            true => ("above", self.bound.inner()),
            false => ("below", 1.0 - self.bound.inner()),
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
        let request = &question.request;
        if request.sampling == Sampling::Imo {
            return self.make_sample(store, listener);
        }
        let needed = request.bounds.iter().map(|bound| request.runs_for(bound));
        let mut wanted = vec![0; self.levels.len()];
        wanted[question.start] = needed.max().unwrap_or(0);
        self.stopped = self.cut(&mut wanted, elapsed);
        self.make(&wanted, store, listener)
    }

    /// Makes the runs of IMO's guidelines.
    fn make_sample(&mut self, store: &Store, listener: &dyn Listener) -> Result<(), LabError> {
        let question = self.question;
        let most = question.request.limits.runs;
        if most < IMO_RUNS {
            self.stopped = Some(format!("at most {most} runs were allowed"));
            return Ok(());
        }
        let repetitions = match question.is_behavior_random {
            true => REPETITIONS,
            false => 1,
        };
        let rung = question.rungs[question.start];
        let case = |k: usize| {
            let [population, repetition] = [k / repetitions, k % repetitions];
            let case = question.of_population(rung, population, repetition)?;
            let name = format!("population {}, run {}", population + 1, repetition + 1);
            Ok((case, name))
        };
        let results = self.results_of(each(IMO_RUNS, case)?, store, listener)?;
        self.sample = Some(Sample {
            results,
            repetitions,
        });
        Ok(())
    }

    /// What they say.
    pub(super) fn bounded(&self, bound: &Bound) -> Bounded {
        let question = self.question;
        let level = &self.levels[question.start];
        let (results, repetitions) = match &self.sample {
            Some(sample) => (&sample.results[..], sample.repetitions),
            None => {
                // Further runs were made for errors of means, and their number depends on the values: a bound from all
                // runs would hold with another probability.
                let needed = bound.runs(question.request.confidence);
                (&level.results[..level.results.len().min(needed)], 1)
            }
        };
        let value = |result: &Result<RunResult, String>| number(result.as_ref().ok()?, &bound.name);
        let values: Vec<Option<f64>> = results.iter().map(value).collect();
        let all = values.len();
        let inner = match self.sample {
            // The value is selected for which this share of the ranked values are lower.
            Some(_) => (bound.inner() * all as f64).ceil() as usize + 1,
            None => all,
        };
        let place = Some(inner).filter(|place| (1..=all).contains(place));
        let independent = place.filter(|_| repetitions == 1);
        let (value, rank) = ranked(&values, place, bound.is_upper());
        Bounded {
            bound: bound.clone(),
            value,
            rank,
            runs: all,
            missing: values.iter().filter(|value| value.is_none()).count(),
            needed: question.request.runs_for(bound),
            confidence: independent.map(|place| probability_above(place, all, bound.inner())),
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

//! Which runs come next.
//!
//! Further runs are added one by one where they shrink the excess of errors over those asked for by most per second of
//! computing, until none is left or the number of runs has doubled; their means count as expected. Half of the runs of
//! this plan are made, and the next plan is made with their results. All of it is a function of the values: it does not
//! depend on clocks and threads.

use super::limit::Limit;
use super::prior::Prior;
use super::series::{FEWEST, Means, Reached};
use super::wanted::Tolerance;

/// The runs of the first round at each of its two steps, if nothing is known before.
const PILOT: usize = 5;
/// The runs at a finer step than those of the first round, without which nothing is reached: at long steps a crowd may
/// behave otherwise, as at a door that jams only at short ones.
const FINER: usize = 6;
/// A plan with at most this number of runs is carried out at once.
const FEW: usize = 6;
/// The most runs that are tried to find the first step.
const MOST_TRIED: usize = 1000;
/// The standard deviations on either side of the mean that hold nine of ten normal values.
const NINE_OF_TEN: f64 = 1.645;
/// A scene that nobody has run may need this many times the runs: the error of its step is not known. With it, ranges
/// hold the mean number of runs of nine in ten of 276 questions (`experiments coverage`).
const UNSEEN: usize = 5;
/// Predictions without a limit end at this number of runs.
pub const MOST_PREDICTED: usize = 100_000;

/// A step on offer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// The time step, seconds.
    pub step: f64,
    /// The expected time of a run, seconds on one core.
    pub secs: f64,
    /// The number of runs so far.
    pub runs: usize,
}

/// A wanted result with what is known of it.
#[derive(Debug, Clone)]
pub struct Goal {
    /// The error asked for.
    pub tolerance: Tolerance,
    /// Its runs so far.
    pub means: Means,
    /// Their limit of fine steps, by which the means of further runs are expected.
    pub limit: Limit,
    /// Whether runs differ by chance: if not, two of them say all.
    has_chance: bool,
}

impl Goal {
    /// From runs.
    pub fn new(tolerance: Tolerance, means: Means) -> Self {
        let limit = means.limit();
        Self {
            tolerance,
            has_chance: true,
            means,
            limit,
        }
    }

    /// The goal of a result that nothing in the runs leaves to chance: any number of runs says it.
    pub(super) fn without_chance(self) -> Self {
        Self {
            has_chance: false,
            ..self
        }
    }

    /// Before the first run: the value is 1. `None` if no spread is known, or if the error is asked for in the result's
    /// unit.
    pub fn expected(tolerance: Tolerance, prior: &Prior) -> Option<Self> {
        let means = Means::expected(prior)?;
        let limit = Limit::exact(1.0);
        matches!(tolerance, Tolerance::Relative(_)).then_some(Self {
            tolerance,
            has_chance: true,
            means,
            limit,
        })
    }

    /// The value with its errors.
    pub fn reached(&self, confidence: f64) -> Reached {
        self.means.errors(&self.limit, confidence)
    }
}

/// The number of further runs at each of `offers`, which are in order from the finest to the coarsest step; `None` if
/// all goals are reached, with enough runs to say so. `first` are the runs of the first round.
pub fn further(
    goals: &[Goal],
    offers: &[Offer],
    first: &[usize],
    confidence: f64,
) -> Option<Vec<usize>> {
    let steps: Vec<f64> = offers.iter().map(|offer| offer.step).collect();
    let excess = |plan: &[usize]| -> f64 {
        let after = goals.iter().map(|goal| {
            let after = goal.means.with(&goal.limit, &steps, plan);
            after.excess(goal.tolerance, confidence)
        });
        after.sum()
    };
    let mut plan = vec![0; offers.len()];
    let mut left = excess(&plan);
    let runs: usize = offers.iter().map(|offer| offer.runs).sum();
    if left <= 0.0 {
        if !goals.iter().any(|goal| goal.has_chance) {
            return None;
        }
        let begun = first.iter().position(|&runs| runs > 0);
        if let Some(finer) = begun.and_then(|k| k.checked_sub(1)) {
            let looked: usize = offers[..=finer].iter().map(|offer| offer.runs).sum();
            plan[finer] = FINER.saturating_sub(looked);
        }
        let most = (0..offers.len()).max_by_key(|&k| offers[k].runs)?;
        plan[most] += FEWEST.saturating_sub(runs + plan.iter().sum::<usize>());
        return plan.iter().any(|&runs| runs > 0).then_some(plan);
    }
    // A step that is finer than half of the finest one so far is left to the next plan.
    let tried = offers.iter().position(|offer| offer.runs > 0);
    let first = tried.unwrap_or(0).saturating_sub(1);
    let most = runs.max(FEW);
    while plan.iter().sum::<usize>() < most {
        let choices = (first..offers.len()).map(|k| {
            let runs = offers[k].runs + plan[k];
            let added = if runs > 0 { (runs / 4).max(1) } else { 2 };
            let mut longer = plan.clone();
            longer[k] += added;
            let after = excess(&longer);
            let gain = (left - after) / (added as f64 * offers[k].secs);
            (gain, longer, after)
        });
        let best = choices.max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, longer, after)) = best.filter(|(gain, ..)| *gain > 0.0) else {
            break;
        };
        (plan, left) = (longer, after);
        if left <= 0.0 {
            break;
        }
    }
    let count: usize = plan.iter().sum();
    if count == 0 {
        plan[first] = 2; // no single addition helps: a finer step may
    } else if count > FEW {
        plan.iter_mut().for_each(|runs| *runs = runs.div_ceil(2));
    }
    Some(plan)
}

/// The numbers of runs of the first round, if nothing is known: some at the step with number `start`, and at the next
/// coarser one, or else at the next finer one.
pub fn pilot(offers: &[Offer], start: usize) -> Vec<usize> {
    let other = match start + 1 < offers.len() {
        true => start + 1,
        false => start.saturating_sub(1),
    };
    let runs = |k| if k == start || k == other { PILOT } else { 0 };
    (0..offers.len()).map(runs).collect()
}

/// The numbers of runs of the first round of goals that are expected: a few runs at the step from which on the whole
/// estimate is expected to be cheapest; `None` without goals.
pub fn first_round(goals: &[Goal], offers: &[Offer], confidence: f64) -> Option<Vec<usize>> {
    let few = goals
        .iter()
        .map(|goal| goal.means.prior.first_runs())
        .max()?;
    let only = |at: usize| -> Vec<usize> {
        let runs = (0..offers.len()).map(|k| if k == at { few } else { 0 });
        runs.collect()
    };
    let cost = |at: usize| -> f64 {
        let (counts, errors) = predicted(goals, offers, only(at), (confidence, MOST_TRIED));
        let counted = offers.iter().zip(counts);
        let secs: f64 = counted.map(|(offer, runs)| offer.secs * runs as f64).sum();
        // Errors that are not reached cost as many times more.
        let pairs = goals.iter().zip(errors);
        let missing = pairs.map(|(goal, error)| (error / goal.tolerance.of(1.0)).max(1.0));
        secs * missing.product::<f64>().powi(2)
    };
    let costs: Vec<f64> = (0..offers.len()).map(cost).collect();
    let cheapest = (0..offers.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b]));
    cheapest.map(only)
}

/// The number of runs at each of `offers` that an estimate is expected to need that begins with `first`, from what is
/// known of its goals: at most `most`, or those of the first round. Also the errors that they are expected to give,
/// half widths in the order of the goals.
pub fn predicted(
    known: &[Goal],
    offers: &[Offer],
    first: Vec<usize>,
    (confidence, most): (f64, usize),
) -> (Vec<usize>, Vec<f64>) {
    let steps: Vec<f64> = offers.iter().map(|offer| offer.step).collect();
    let begun = offers.iter().zip(&first);
    let mut offers: Vec<Offer> = begun
        .map(|(offer, &runs)| Offer { runs, ..*offer })
        .collect();
    loop {
        let counts: Vec<usize> = offers.iter().map(|offer| offer.runs).collect();
        let after = |goal: &Goal| {
            let means = goal.means.afresh(&goal.limit, &steps, &counts);
            Goal::new(goal.tolerance, means)
        };
        let goals: Vec<Goal> = known.iter().map(after).collect();
        let room = most.saturating_sub(counts.iter().sum());
        let Some(more) = further(&goals, &offers, &first, confidence).filter(|_| room > 0) else {
            let errors = goals.iter().map(|goal| goal.reached(confidence).error);
            return (counts, errors.collect());
        };
        let asked = more.iter().sum::<usize>().max(room);
        let mut left = room;
        for (offer, more) in offers.iter_mut().zip(more) {
            // At least one more run in all, and no more than there is room for.
            let added = (more * room).div_ceil(asked).min(left);
            offer.runs += added;
            left -= added;
        }
    }
}

/// The numbers of runs between which the number of an estimate is expected in nine of ten cases: with the smallest and
/// the largest spread that what is known of its goals allows; without runs of the scene, with those that an unknown
/// error of the step may take.
pub fn range(
    known: &[Goal],
    offers: &[Offer],
    first: &[usize],
    (confidence, most): (f64, usize),
) -> [usize; 2] {
    let [low, high] = [-1.0, 1.0].map(|sign| {
        let scaled = known.iter().map(|goal| {
            let logarithm = sign * NINE_OF_TEN * goal.means.spread_uncertainty();
            let means = Means {
                variance: goal.means.variance * (2.0 * logarithm).exp(),
                ..goal.means.clone()
            };
            Goal {
                means,
                ..goal.clone()
            }
        });
        let scaled: Vec<Goal> = scaled.collect();
        let (runs, _) = predicted(&scaled, offers, first.to_vec(), (confidence, most));
        runs.iter().sum::<usize>()
    });
    let is_unseen = known.iter().any(|goal| goal.means.levels.is_empty());
    let factor = if is_unseen { UNSEEN } else { 1 };
    [low, most.min(factor * high)]
}

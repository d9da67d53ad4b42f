//! How often intervals hold the value: estimates repeated with the runs of a pool.
//!
//! The pool has runs of a question at its coarsest steps, with many seeds. An estimate is repeated with seeds drawn
//! from it with replacement, as from an endless crowd of runs in which the pool's means are the true ones. Its interval
//! is compared with the mean at the finest step, and with the limit that all runs of the pool together give. What the
//! program knows of the scene itself does not count.

use serde::Serialize;

use super::scenes::{MADE_ON, Scene, WRITTEN_AFTER};
use sandbox::analysis::statistics::{MeanStd, shuffled};
use sandbox::lab::error::LabError;
use sandbox::lab::estimate::{
    Goal, Limits, MOST_PREDICTED, Means, Offer, Prior, Question, QuestionError, Request, Runs,
    Sampling, Series, Tolerance, Wanted, first_round, further, pilot, predicted, range,
};
use sandbox::lab::jobs::each;
use sandbox::runs::case::Source;
use sandbox::runs::job::Listener;
use sandbox::runs::store::Store;
use sandbox::scenario::Setting;

/// The probability that intervals are made for.
pub(super) const CONFIDENCE: f64 = 0.95;
/// The number of standard errors on either side of such an interval, if the spread is known.
const NORMAL: f64 = 1.959_963_984_540_054;
/// How often the first step is halved.
const HALVINGS: usize = 2;
/// The most runs of an estimate at one step.
const MOST_DRAWN: usize = 1000;
/// Predicted numbers of runs within this factor of the true one count as right.
const FACTOR: f64 = 1.5;
/// The errors that are asked for, in standard deviations of a run at the finest step.
const ERRORS: [f64; 2] = [1.0, 0.5];
/// The largest part of the value that one standard deviation counts as: nobody asks for an error of several hundred
/// percent of a rare result.
const MOST_ASKED: f64 = 0.5;
/// Estimates with fewer runs than this are counted apart: twice the fewest.
const FEW: usize = 40;

/// The size of a study of intervals.
#[derive(Debug, Clone, Copy)]
pub struct Pool {
    /// The number of runs at each step.
    pub seeds: usize,
    /// The number of estimates of each result.
    pub repeats: usize,
}

impl Pool {
    /// The whole study.
    pub const WHOLE: Self = Self {
        seeds: 300,
        repeats: 200,
    };
    /// A check that everything works.
    pub const QUICK: Self = Self {
        seeds: 20,
        repeats: 20,
    };
}

/// How often the intervals of one result hold its value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Covered {
    /// Whether the method was made on the scene.
    pub is_made_on: bool,
    /// The scenario.
    pub scene: String,
    /// The profile.
    pub profile: String,
    /// The result.
    pub result: String,
    /// The error asked for.
    pub wanted: String,
    /// The limit that all runs of the pool give, and half its 95 % confidence interval.
    pub limit: [f64; 2],
    /// The mean of all runs at the finest step, and half its 95 % confidence interval.
    pub finest: [f64; 2],
    /// The number of estimates.
    pub estimates: usize,
    /// The number of estimates whose interval holds the mean at the finest step.
    pub held: usize,
    /// The number of estimates whose interval holds the limit.
    pub held_limit: usize,
    /// The mean number of runs of an estimate.
    pub runs: f64,
    /// Their mean time, seconds on one core as expected.
    pub secs: f64,
    /// The number and time of the runs at the step that is cheapest if its error and the spread are known.
    pub known: Option<[f64; 2]>,
    /// The shares of estimates for which the number of runs that another estimate lets expect, or the whole pool, is
    /// within a factor of 1.5.
    pub predicted: [f64; 2],
    /// The number of estimates that ended before the error asked for because draws ran out.
    pub unfinished: usize,
    /// The numbers of runs between which that of an estimate is expected before the first run, from other scenes.
    pub planned: Option<[usize; 2]>,
    /// The number of estimates whose number of runs is between these.
    pub in_plan: usize,
    /// Of the estimates with fewer than 40 runs, those whose interval holds the mean at the finest step, and all.
    pub few: [usize; 2],
    /// The same of those with 40 runs and more.
    pub many: [usize; 2],
}

/// The results of a study of intervals.
pub struct Coverage {
    /// The rows.
    pub rows: Vec<Covered>,
    /// The computing time of the pool, seconds on one core.
    pub secs: f64,
    pub(super) pool: Pool,
}

/// The names of all scenes.
#[must_use]
pub fn scenes() -> Vec<&'static str> {
    let all = MADE_ON.iter().chain(&WRITTEN_AFTER);
    all.map(Scene::name).collect()
}

/// Makes the runs of the pools of these scenes that are not in the store, and repeats the estimates; no names: of all
/// scenes.
///
/// # Errors
/// A run fails, or results cannot be stored.
pub fn coverage(
    names: &[String],
    pool: Pool,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Coverage, LabError> {
    let (mut rows, mut secs) = (Vec::new(), 0.0);
    let halves = MADE_ON.iter().map(|scene| (scene, true));
    let halves = halves.chain(WRITTEN_AFTER.iter().map(|scene| (scene, false)));
    let is_asked = |scene: &Scene| names.is_empty() || names.iter().any(|one| one == scene.name());
    for (scene, is_made_on) in halves.filter(|(scene, _)| is_asked(scene)) {
        for profile in scene.profiles {
            let question = question(scene.file, profile, scene.results)?;
            let (runs, finest) = pooled(&question, pool, store, listener)?;
            secs += runs.measured_secs();
            for k in 0..scene.results.len() {
                for error in ERRORS {
                    let row = covered(&runs, k, finest, (pool, error))?;
                    rows.extend(row.map(|row| Covered { is_made_on, ..row }));
                }
            }
        }
    }
    Ok(Coverage { rows, secs, pool })
}

/// The runs of a pool, and the number of its finest step. What is known of the scene itself does not count.
pub(super) fn pooled<'a>(
    question: &'a Question,
    pool: Pool,
    store: &Store,
    listener: &dyn Listener,
) -> Result<(Runs<'a>, usize), LabError> {
    let mut runs = Runs::none(question, &[], Some(&question.title[0]))?;
    let finest = question.start.saturating_sub(HALVINGS);
    let mut wanted = vec![0; runs.levels.len()];
    wanted[finest..].fill(pool.seeds);
    runs.make(&wanted, store, listener)?;
    Ok((runs, finest))
}

pub(super) fn question(file: &str, profile: &str, results: &[&str]) -> Result<Question, LabError> {
    let invalid = |error: QuestionError| LabError::Data(error.to_string());
    let wanted = results.iter().map(|name| Wanted {
        name: (*name).to_owned(),
        error: Tolerance::Relative(0.01), // each estimate has its own
    });
    let request = Request {
        wanted: wanted.collect(),
        bounds: Vec::new(),
        sampling: Sampling::default(),
        confidence: CONFIDENCE,
        limits: Limits {
            runs: usize::MAX,
            secs: None,
        },
    };
    let profile = Setting::of("profile", profile.into(), &format!("profile={profile}"));
    Question::new(Source::BuiltIn(file.into()), vec![profile], request, None).map_err(invalid)
}

/// One estimate with the runs of a pool.
struct Estimate {
    /// Whether its interval holds the mean at the finest step, and the limit.
    held: [bool; 2],
    runs: usize,
    secs: f64,
    is_finished: bool,
    /// What its runs say in the end.
    means: Option<Means>,
}

/// The estimates of a result with this error, in standard deviations of a run; `None` if all runs have the same value.
fn covered(
    runs: &Runs,
    k: usize,
    finest: usize,
    (pool, error): (Pool, f64),
) -> Result<Option<Covered>, LabError> {
    let question = runs.question;
    let name = &question.request.wanted[k].name;
    let all = runs.series(name);
    let all = Series {
        steps: all.steps[finest..].to_vec(),
        values: all.values[finest..].to_vec(),
    };
    let offers = &runs.offers()[finest..];
    let at_steps: Vec<MeanStd> = all
        .values
        .iter()
        .filter_map(|values| MeanStd::of(&values.iter().flatten().copied().collect::<Vec<_>>()))
        .collect();
    let Some((finest_mean, whole)) = at_steps.first().zip(all.means(&Prior::NONE)) else {
        return Err(LabError::missing(&question.title[0], name));
    };
    let spread = finest_mean.std().unwrap_or_default();
    if spread == 0.0 || finest_mean.mean == 0.0 {
        return Ok(None);
    }
    let wanted = &Wanted {
        name: name.clone(),
        error: Tolerance::Relative(error * (spread / finest_mean.mean.abs()).min(MOST_ASKED)),
    };
    let reference = whole.reached(CONFIDENCE);
    let prior = &runs.priors[k];
    let expected = Goal::expected(wanted.error, prior);
    let known = expected.and_then(|goal| first_round(&[goal], offers, CONFIDENCE));
    let first = known.unwrap_or_else(|| pilot(offers, question.start - finest));
    let of_pool = Pooled {
        all: &all,
        offers,
        first: &first,
        prior,
        wanted,
    };
    let references = [finest_mean.mean, reference.value];
    let expected = Goal::expected(wanted.error, prior);
    let asked = (CONFIDENCE, MOST_PREDICTED);
    let planned = expected.map(|goal| range(&[goal], offers, &first, asked));
    let estimate = |seed: usize| {
        let draw = |k: usize| shuffled(pool.seeds, (seed * MOST_DRAWN + k) as u64)[0];
        let order: Vec<usize> = (0..MOST_DRAWN).map(draw).collect();
        of_pool.estimate(&order, references)
    };
    let estimates = each(pool.repeats, estimate)?;
    let count = estimates.len() as f64;
    let mean = |of: &dyn Fn(&Estimate) -> f64| estimates.iter().map(of).sum::<f64>() / count;
    // The number of runs that is expected from these means, which a finished estimate or the whole pool has.
    let expected = |means: &Means| -> usize {
        let goal = Goal::new(wanted.error, means.clone());
        let asked = (CONFIDENCE, MOST_PREDICTED);
        let (runs, _) = predicted(&[goal], offers, first.clone(), asked);
        runs.iter().sum()
    };
    let is_right = |expected: usize, one: &Estimate| {
        let ratio = expected as f64 / one.runs as f64;
        (1.0 / FACTOR..=FACTOR).contains(&ratio)
    };
    let pairs = estimates.iter().zip(estimates.iter().cycle().skip(1));
    let by_estimate = pairs.filter(|(before, after)| {
        let means = before.means.as_ref();
        means.is_some_and(|means| is_right(expected(means), after))
    });
    let by_estimate = by_estimate.count() as f64 / count;
    let of_all = expected(&whole);
    let by_pool = estimates.iter().filter(|one| is_right(of_all, one)).count() as f64 / count;
    let allowed = wanted.error.of(reference.value);
    let known = at_steps.iter().zip(offers).filter_map(|(mean, offer)| {
        let room = allowed.powi(2) - (mean.mean - reference.value).powi(2);
        let runs = ((NORMAL * mean.std()?).powi(2) / room).ceil().max(2.0);
        (room > 0.0).then_some([runs, runs * offer.secs])
    });
    let few = |of: bool| {
        let all = estimates.iter().filter(move |one| (one.runs < FEW) == of);
        [all.clone().filter(|one| one.held[0]).count(), all.count()]
    };
    Ok(Some(Covered {
        is_made_on: false,
        scene: question.title[0].clone(),
        profile: question.title[1].clone(),
        result: wanted.name.clone(),
        wanted: wanted.error.to_string(),
        limit: [reference.value, reference.error],
        finest: [
            finest_mean.mean,
            finest_mean.interval_95().unwrap_or_default(),
        ],
        estimates: estimates.len(),
        held: estimates.iter().filter(|one| one.held[0]).count(),
        held_limit: estimates.iter().filter(|one| one.held[1]).count(),
        runs: mean(&|one| one.runs as f64),
        secs: mean(&|one| one.secs),
        known: known.min_by(|a, b| a[1].total_cmp(&b[1])),
        predicted: [by_estimate, by_pool],
        unfinished: estimates.iter().filter(|one| !one.is_finished).count(),
        planned,
        in_plan: (planned.map_or(0, |[low, high]| {
            let is_in = |one: &&Estimate| (low..=high).contains(&one.runs);
            estimates.iter().filter(is_in).count()
        })),
        few: few(true),
        many: few(false),
    }))
}

/// Where the runs of an estimate come from, and what is known before.
struct Pooled<'a> {
    all: &'a Series,
    offers: &'a [Offer],
    first: &'a [usize],
    prior: &'a Prior,
    wanted: &'a Wanted,
}

impl Pooled<'_> {
    /// An estimate with the runs in this order.
    fn estimate(&self, order: &[usize], references: [f64; 2]) -> Estimate {
        let mut counts = self.first.to_vec();
        loop {
            let values = self.all.values.iter().zip(&counts);
            let drawn = Series {
                steps: self.all.steps.clone(),
                values: values
                    .map(|(values, &count)| order[..count].iter().map(|&k| values[k]).collect())
                    .collect(),
            };
            let Some(means) = drawn.means(self.prior) else {
                return Estimate {
                    held: [false; 2],
                    runs: 0,
                    secs: 0.0,
                    is_finished: false,
                    means: None,
                };
            };
            let next = self.next(&means, &counts);
            let more = next.clone().unwrap_or_default();
            let asked = counts.iter().zip(&more);
            let asked: Vec<usize> = asked.map(|(all, more)| all + more).collect();
            let is_finished = next.is_none();
            if is_finished || asked.iter().any(|&count| count > order.len()) {
                let reached = means.reached(CONFIDENCE);
                let secs = counts.iter().zip(self.offers);
                let secs = secs.map(|(count, offer)| *count as f64 * offer.secs);
                return Estimate {
                    held: references.map(|value| (reached.value - value).abs() <= reached.error),
                    runs: counts.iter().sum(),
                    secs: secs.sum(),
                    is_finished,
                    means: Some(means),
                };
            }
            counts = asked;
        }
    }

    /// The further runs of an estimate.
    fn next(&self, means: &Means, counts: &[usize]) -> Option<Vec<usize>> {
        let goal = Goal::new(self.wanted.error, means.clone());
        let offers = self.offers.iter().zip(counts);
        let offers: Vec<Offer> = offers
            .map(|(offer, &runs)| Offer { runs, ..*offer })
            .collect();
        further(&[goal], &offers, self.first, CONFIDENCE)
    }
}

//! The runs of an estimate, round by round, until the errors are as small as asked for.

use std::time::Instant;

use rayon::current_num_threads;

use super::costs::Timed;
use super::plan::{Goal, Offer, further};
use super::prior::{Known, Prior};
use super::question::{Question, Rung};
use super::sample::Sample;
use super::series::{Means, Reached, Series};
use crate::error::LabError;
use crate::jobs::each;
use crate::sweep::number;
use output::table::as_precise;
use runs::case::{Case, RunResult};
use runs::drive::End;
use runs::error::RunError;
use runs::job::{self, Job, Listener};
use runs::store::Store;

/// The runs at one time step, in the order of their seeds.
#[derive(Debug, Clone)]
pub struct StepRuns {
    /// The step.
    pub rung: Rung,
    /// The results; the error message of runs that failed.
    pub results: Vec<Result<RunResult, String>>,
    /// The expected time of a run, seconds on one core.
    pub expected_secs: f64,
}

/// The results after a round.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// The number of runs at each step.
    pub runs: Vec<usize>,
    /// What is reached for each wanted result; `None` without values.
    pub reached: Vec<Option<Reached>>,
}

/// All runs of an estimate.
pub struct Runs<'a> {
    /// The question.
    pub question: &'a Question,
    /// The runs at each step on offer, from the finest to the coarsest.
    pub levels: Vec<StepRuns>,
    /// The state after each round.
    pub looks: Vec<Look>,
    /// The runs of bounds, if these are not those at a step on offer.
    pub sample: Option<Sample>,
    /// Runs with each preset, if they were asked for.
    pub timed: Vec<Timed>,
    /// What was known about the wanted results before.
    pub priors: Vec<Prior>,
    /// Why no more runs were made, if an error is larger than asked for.
    pub stopped: Option<String>,
}

/// Runs the question's scenario until all errors are as small as asked for, or a limit is reached. Finished runs are
/// taken from the store. `rows` are the results of finished rows of the same study.
///
/// # Errors
/// Results cannot be stored, or a run is invalid.
pub fn run<'a>(
    question: &'a Question,
    rows: &[Known],
    store: &Store,
    listener: &dyn Listener,
) -> Result<Runs<'a>, LabError> {
    let begin = Instant::now();
    let mut runs = Runs::none(question, rows, None)?;
    let elapsed = || begin.elapsed().as_secs_f64();
    // First the bounds: their number of runs is fixed, and these runs count for the errors, too.
    if !question.request.bounds.is_empty() {
        runs.make_for_bounds(elapsed(), store, listener)?;
    }
    if !question.request.wanted.is_empty() {
        runs.make_for_errors(&elapsed, store, listener)?;
    }
    if question.request.costs {
        runs.timed = Timed::of_presets(question, store, listener)?;
    }
    Ok(runs)
}

impl<'a> Runs<'a> {
    /// No runs yet; what ships with the program counts without the scene `but`.
    pub fn none(
        question: &'a Question,
        rows: &[Known],
        but: Option<&str>,
    ) -> Result<Self, LabError> {
        let level = |&rung: &Rung| {
            let case = question.case(rung, 0);
            Ok(StepRuns {
                rung,
                results: Vec::new(),
                expected_secs: case.map_err(|error| failed(question, error))?.expected_secs,
            })
        };
        let wanted = question.request.wanted.iter();
        let profile = &question.title[1];
        let priors = wanted.map(|wanted| Prior::of(profile, &wanted.name, rows, but));
        let priors = priors.collect();
        let levels: Result<_, LabError> = question.rungs.iter().map(level).collect();
        Ok(Self {
            question,
            levels: levels?,
            looks: Vec::new(),
            sample: None,
            timed: Vec::new(),
            priors,
            stopped: None,
        })
    }

    /// Makes runs round by round, until all errors are as small as asked for.
    fn make_for_errors(
        &mut self,
        elapsed: &dyn Fn() -> f64,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<(), LabError> {
        let first = self.first_round(Some(listener));
        let made = self.levels.iter().map(|level| level.results.len());
        let mut wanted: Vec<usize> = first.into_iter().zip(made).map(|(a, b)| a.max(b)).collect();
        loop {
            let limit = self.cut(&mut wanted, elapsed());
            self.make(&wanted, store, listener)?;
            self.look();
            listener.notes(&self.progress());
            let confidence = self.question.request.confidence;
            let Some(more) = further(&self.goals(), &self.offers(), confidence) else {
                return Ok(());
            };
            if limit.is_some() {
                self.stopped = limit;
                return Ok(());
            }
            wanted
                .iter_mut()
                .zip(more)
                .for_each(|(all, more)| *all += more);
        }
    }

    /// Reduces the numbers of runs to what the limits allow. Returns the limit that is then reached, if one is.
    pub(super) fn cut(&self, wanted: &mut [usize], elapsed: f64) -> Option<String> {
        let limits = self.question.request.limits;
        let done: Vec<usize> = self
            .levels
            .iter()
            .map(|level| level.results.len())
            .collect();
        let more = |wanted: &[usize]| -> usize {
            wanted.iter().zip(&done).map(|(all, done)| all - done).sum()
        };
        // The largest numbers that are allowed in these proportions, then one more each while there is room.
        let scale = |wanted: &mut [usize], room: usize| {
            let asked = more(wanted).max(1);
            let full = wanted.to_vec();
            for (all, done) in wanted.iter_mut().zip(&done) {
                *all = done + (*all - done) * room / asked;
            }
            let mut left = room - more(wanted);
            for (all, full) in wanted.iter_mut().zip(full) {
                let added = usize::from(*all < full && left > 0);
                *all += added;
                left -= added;
            }
        };
        let sampled = self.sample.as_ref().map_or(0, |of| of.results.len());
        let free = limits
            .runs
            .saturating_sub(done.iter().sum::<usize>() + sampled);
        let asked = more(wanted);
        let mut reached = None;
        if asked > free {
            scale(wanted, free);
            reached = Some(format!("at most {} runs were allowed", limits.runs));
        }
        let Some(secs) = limits.secs else {
            return reached;
        };
        let measured = self.measured_factor();
        let levels = self.levels.iter().zip(wanted.iter()).zip(&done);
        let due: f64 = levels
            .map(|((level, all), done)| (all - done) as f64 * level.expected_secs * measured)
            .sum::<f64>()
            / current_num_threads() as f64;
        if done.iter().any(|&runs| runs > 0) && elapsed + due > secs {
            let part = ((secs - elapsed) / due).clamp(0.0, 1.0);
            scale(wanted, (more(wanted) as f64 * part) as usize);
            reached = Some(format!("at most {} minutes were allowed", secs / 60.0));
        }
        reached
    }

    /// The measured time of the runs so far, over the expected time; 1 without runs.
    pub fn measured_factor(&self) -> f64 {
        let finished = self.levels.iter().flat_map(|level| {
            let finished = level.results.iter().flatten();
            finished.map(|result| [result.wall_secs, level.expected_secs])
        });
        let [wall, expected] = finished.fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
        if expected > 0.0 { wall / expected } else { 1.0 }
    }

    /// The results of all runs, without those that time presets.
    pub fn all_results(&self) -> impl Iterator<Item = &Result<RunResult, String>> + Clone {
        let levels = self.levels.iter().flat_map(|level| &level.results);
        levels.chain(self.sample.iter().flat_map(|sample| &sample.results))
    }

    /// The time of all runs, seconds on one core.
    pub fn measured_secs(&self) -> f64 {
        let results = self.all_results();
        results.flatten().map(|result| result.wall_secs).sum()
    }

    /// Makes runs until there are these many at each step.
    pub fn make(
        &mut self,
        wanted: &[usize],
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<(), LabError> {
        let question = self.question;
        let places = self.levels.iter().zip(wanted).enumerate();
        let places = places
            .flat_map(|(k, (level, &all))| (level.results.len()..all).map(move |seed| (k, seed)));
        let places: Vec<(usize, usize)> = places.collect();
        let run = |index: usize| {
            let (k, seed) = places[index];
            let case = question.case(question.rungs[k], seed)?;
            let step = question.rungs[k].step;
            let name = format!("step {step:.4} s, seed {}", case.seed);
            Ok((case, name))
        };
        let results = self.results_of(places.len(), &run, store, listener)?;
        for (result, (k, _)) in results.into_iter().zip(places) {
            self.levels[k].results.push(result);
        }
        Ok(())
    }

    /// The results of runs, each with its name, in order; the error message of runs that failed.
    pub(super) fn results_of(
        &self,
        count: usize,
        run: &(dyn Fn(usize) -> Result<(Case, String), RunError> + Sync),
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<Vec<Result<RunResult, String>>, LabError> {
        let question = self.question;
        let cases: Result<Vec<(Case, String)>, RunError> = each(count, run)?.into_iter().collect();
        let cases = cases.map_err(|error| failed(question, error))?;
        let jobs = cases.iter().map(|(case, name)| case.job(name.clone()));
        let jobs: Vec<Job> = jobs.collect();
        job::run(&jobs, store, question.memory(), listener)?;
        let result = |(case, _): &(Case, String)| {
            let failure = || {
                let failure = store.failure(&case.key);
                failure.map_or("no result".to_owned(), |failure| failure.message)
            };
            store.result(&case.key)?.ok_or_else(failure)
        };
        Ok(cases.iter().map(result).collect())
    }

    /// The values of the wanted result with this number.
    pub fn series(&self, wanted: usize) -> Series {
        self.series_of(&self.question.request.wanted[wanted].name)
    }

    /// The values of the result with this name.
    pub fn series_of(&self, name: &str) -> Series {
        let value = |result: &Result<RunResult, String>| {
            let result = result.as_ref().ok()?;
            number(result, name)
        };
        let values = self.levels.iter();
        Series {
            steps: self.levels.iter().map(|level| level.rung.step).collect(),
            values: values
                .map(|level| level.results.iter().map(value).collect())
                .collect(),
        }
    }

    /// The steps with the number of their runs.
    pub fn offers(&self) -> Vec<Offer> {
        let offer = |level: &StepRuns| Offer {
            step: level.rung.step,
            secs: level.expected_secs,
            runs: level.results.len(),
        };
        self.levels.iter().map(offer).collect()
    }

    /// The wanted results that have values.
    pub fn goals(&self) -> Vec<Goal> {
        self.named_goals().map(|(_, goal)| goal).collect()
    }

    /// These with their names.
    pub(super) fn named_goals(&self) -> impl Iterator<Item = (&str, Goal)> {
        let wanted = self.question.request.wanted.iter().zip(self.means());
        wanted.filter_map(|(wanted, means)| {
            let (means, tolerance) = (means?, wanted.error);
            Some((wanted.name.as_str(), Goal { means, tolerance }))
        })
    }

    /// Notes what is reached.
    fn look(&mut self) {
        let confidence = self.question.request.confidence;
        let reached = self.means().map(|means| Some(means?.reached(confidence).0));
        let reached = reached.collect();
        let runs = self.levels.iter().map(|level| level.results.len());
        let runs = runs.collect();
        self.looks.push(Look { runs, reached });
    }

    /// The means of each wanted result; `None` without values.
    fn means(&self) -> impl Iterator<Item = Option<Means>> {
        let priors = self.priors.iter().enumerate();
        priors.map(|(k, prior)| self.series(k).means(prior))
    }

    /// Why a result has no values.
    pub(super) fn without_values(&self, name: &str) -> String {
        let results = self.all_results();
        let failure = results.clone().find_map(|result| result.as_ref().err());
        let all = results.clone().count();
        let ended = |end| {
            results
                .clone()
                .flatten()
                .filter(|r| r.summary.end == Some(end))
                .count()
        };
        let why = failure.map_or_else(
            || {
                format!(
                    "{} ended because no agent arrived for some time, {} at the scenario's duration",
                    ended(End::Idle),
                    ended(End::Duration)
                )
            },
            |message| format!("the first error is: {message}"),
        );
        format!("{name}: too few of {all} runs have a value; {why}")
    }

    /// The state after the last round, in one line.
    fn progress(&self) -> String {
        let Some(look) = self.looks.last() else {
            return String::new();
        };
        let wanted = self.question.request.wanted.iter().zip(&look.reached);
        let results = wanted.map(|(wanted, reached)| {
            let Some(reached) = reached else {
                return format!("{} has no value", wanted.name);
            };
            let [value, error] =
                [reached.value, reached.error].map(|number| as_precise(number, reached.error));
            format!(
                "{} {value} ± {error}{}, wanted {}",
                wanted.name,
                reached
                    .percent()
                    .map_or(String::new(), |part| format!(" ({part})")),
                wanted.error
            )
        });
        let runs: usize = look.runs.iter().sum();
        format!(
            "after {runs} runs: {}",
            results.collect::<Vec<_>>().join("; ")
        )
    }
}

fn failed(question: &Question, error: RunError) -> LabError {
    LabError::of(question.title[0].clone(), error)
}

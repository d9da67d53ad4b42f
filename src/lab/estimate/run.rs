//! The runs of an estimate, round by round, until the errors are as small as asked for.

use std::time::Instant;

use super::plan::{Goal, Offer, first_round, further, pilot};
use super::prior::{Known, Prior};
use super::question::{Question, Rung};
use super::series::{Reached, Series};
use super::wanted::Wanted;
use crate::error::LabError;
use crate::jobs::{Results, each};
use crate::sweep::number;
use analysis::round;
use output::table::as_precise;
use runs::case::{Case, RunResult};
use runs::drive::End;
use runs::error::RunError;
use runs::job::{self, Job, Listener};
use runs::store::Store;

/// The results of runs; the error message of those that failed.
pub(super) type Outcomes = Vec<Result<RunResult, String>>;

/// The runs at one time step, in the order of their seeds.
#[derive(Debug, Clone)]
pub struct StepRuns {
    /// The step.
    pub rung: Rung,
    /// The results; the error message of runs that failed.
    pub results: Outcomes,
    /// The expected time of a run, seconds on one core.
    pub expected_secs: f64,
}

/// The runs of IMO's guidelines on evacuation analysis.
#[derive(Debug, Clone)]
pub struct Sample {
    /// The results; the error message of runs that failed.
    pub results: Outcomes,
    /// The number of runs of each population.
    pub repetitions: usize,
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
    /// What was known about the wanted results before.
    pub priors: Vec<Prior>,
    /// The values of each wanted result after the last round, with its goal; `None` without values.
    pub(super) wanted: Vec<(Series, Option<Goal>)>,
    /// The state after each round.
    pub looks: Vec<Look>,
    /// The runs of bounds, if these are not those at a step on offer.
    pub sample: Option<Sample>,
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
    Ok(runs)
}

impl<'a> Runs<'a> {
    /// No runs yet; what ships with the program counts without the scene `but`.
    ///
    /// # Errors
    /// A run is invalid.
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
        let levels: Result<_, LabError> = question.rungs.iter().map(level).collect();
        let [_, profile] = &question.title;
        let priors = question.request.wanted.iter().map(|wanted| {
            let quantity = question.quantity(&wanted.name);
            Prior::of([profile, &wanted.name], quantity, rows, but)
        });
        Ok(Self {
            question,
            levels: levels?,
            priors: priors.collect(),
            wanted: Vec::new(),
            looks: Vec::new(),
            sample: None,
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
        let confidence = self.question.request.confidence;
        let (first, steps) = (self.first_round(), self.levels.iter());
        if let Some(first) = &first {
            let similar: usize = self.priors.iter().map(|prior| prior.similar).sum();
            for (count, level) in first.iter().zip(steps).filter(|(count, _)| **count > 0) {
                let step = round::brief(level.rung.step);
                listener.notes(&format!(
                    "begins with {count} runs with a step of {step} s, as {similar} similar results suggest"
                ));
            }
        }
        let first = first.unwrap_or_else(|| pilot(&self.offers(), self.question.start));
        let made = self.counts().into_iter();
        let mut wanted: Vec<usize> = made
            .zip(&first)
            .map(|(made, &first)| made.max(first))
            .collect();
        loop {
            let limit = self.cut(&mut wanted, elapsed());
            self.make(&wanted, store, listener)?;
            self.look();
            listener.notes(&self.progress());
            let goals: Vec<Goal> = self.goals().flatten().cloned().collect();
            let Some(more) = further(&goals, &self.offers(), &first, confidence) else {
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

    /// The wanted results before their first runs; `None` if too little is known of one.
    pub(super) fn expected(&self) -> Option<Vec<Goal>> {
        let wanted = self.question.request.wanted.iter().zip(&self.priors);
        wanted
            .map(|(wanted, prior)| Goal::expected(wanted.error, prior))
            .collect()
    }

    /// The numbers of runs of the first round; `None` if too little is known.
    pub(super) fn first_round(&self) -> Option<Vec<usize>> {
        let confidence = self.question.request.confidence;
        first_round(&self.expected()?, &self.offers(), confidence)
    }

    /// What the wanted results say to rows of the same study.
    pub(super) fn known(&self) -> impl Iterator<Item = Known> {
        let wanted = self.question.request.wanted.iter().zip(self.goals());
        wanted.filter_map(|(wanted, goal)| Known::of(self.question, &wanted.name, &goal?.means))
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

    /// The results of the runs at the steps on offer.
    pub(super) fn all_at_steps(&self) -> impl Iterator<Item = &Result<RunResult, String>> + Clone {
        self.levels.iter().flat_map(|level| &level.results)
    }

    /// The results of all runs.
    pub fn all_results(&self) -> impl Iterator<Item = &Result<RunResult, String>> + Clone {
        self.all_at_steps()
            .chain(self.sample.iter().flat_map(|sample| &sample.results))
    }

    /// The time of all runs, seconds on one core.
    pub fn measured_secs(&self) -> f64 {
        let results = self.all_results();
        results.flatten().map(|result| result.wall_secs).sum()
    }

    /// Makes runs until there are these many at each step.
    ///
    /// # Errors
    /// As [`run`](fn@run).
    pub fn make(
        &mut self,
        wanted: &[usize],
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<(), LabError> {
        let question = self.question;
        let levels = self.levels.iter().zip(wanted).enumerate();
        let missing: Vec<(usize, usize)> = levels
            .flat_map(|(k, (level, &all))| (level.results.len()..all).map(move |seed| (k, seed)))
            .collect();
        let case = |index: usize| {
            let (k, seed) = missing[index];
            let rung = question.rungs[k];
            let case = question.case(rung, seed)?;
            let name = format!("step {:.4} s, seed {}", rung.step, case.seed);
            Ok((case, name))
        };
        let cases = each(missing.len(), case)?;
        let results = self.results_of(cases, store, listener)?;
        for (result, (k, _)) in results.into_iter().zip(missing) {
            self.levels[k].results.push(result);
        }
        Ok(())
    }

    /// The results of runs, each with its name, in order.
    pub(super) fn results_of(
        &self,
        cases: Vec<Result<(Case, String), RunError>>,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<Outcomes, LabError> {
        let invalid = |error| failed(self.question, error);
        let named: Result<Vec<(Case, String)>, RunError> = cases.into_iter().collect();
        let valid = named.map_err(invalid)?;
        let jobs: Vec<Job> = valid
            .iter()
            .map(|(case, name)| case.job(name.clone()))
            .collect();
        job::run(&jobs, store, self.question.memory(), listener)?;
        let outcome = |job: &Job| Results(store).outcome(&job.key);
        let missing = || Err("no result".to_owned());
        let results = jobs.iter().map(|job| outcome(job).unwrap_or_else(missing));
        Ok(results.collect())
    }

    /// The values of the result with this name.
    pub fn series(&self, name: &str) -> Series {
        let value = |result: &Result<RunResult, String>| number(result.as_ref().ok()?, name);
        let values = |level: &StepRuns| level.results.iter().map(value).collect();
        Series {
            steps: self.levels.iter().map(|level| level.rung.step).collect(),
            values: self.levels.iter().map(values).collect(),
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

    /// The number of runs at each step.
    pub(super) fn counts(&self) -> Vec<usize> {
        let levels = self.levels.iter();
        levels.map(|level| level.results.len()).collect()
    }

    /// The goals of the wanted results; `None` without values.
    pub(super) fn goals(&self) -> impl Iterator<Item = Option<&Goal>> {
        self.wanted.iter().map(|(_, goal)| goal.as_ref())
    }

    /// Notes what is reached.
    pub(super) fn look(&mut self) {
        let request = &self.question.request;
        let is_certain = self.are_runs_alike();
        let with_goal = |(wanted, prior): (&Wanted, &Prior)| {
            let series = self.series(&wanted.name);
            let goal = series
                .means(prior)
                .map(|means| Goal::new(wanted.error, means));
            match is_certain {
                true => (series, goal.map(Goal::without_chance)),
                false => (series, goal),
            }
        };
        let wanted = request.wanted.iter().zip(&self.priors);
        self.wanted = wanted.map(with_goal).collect();
        let reached = |goal: Option<&Goal>| Some(goal?.reached(request.confidence));
        self.looks.push(Look {
            runs: self.counts(),
            reached: self.goals().map(reached).collect(),
        });
    }

    /// Whether all runs at the same step, two at least, ended in the same state: nothing in them is left to chance.
    fn are_runs_alike(&self) -> bool {
        let state = |result: &Result<RunResult, String>| {
            let run = result.as_ref().ok()?;
            Some(run.summary.state_sha256.clone())
        };
        let mut repeated = self
            .levels
            .iter()
            .filter(|level| level.results.len() > 1)
            .peekable();
        repeated.peek().is_some()
            && repeated.all(|level| {
                let mut states = level.results.iter().map(state);
                let first = states.next().flatten();
                first.is_some() && states.all(|state| state == first)
            })
    }

    /// Why a result has no values.
    pub(super) fn without_values(&self, name: &str) -> String {
        let results = self.all_results();
        let all = results.clone().count();
        let failure = results.clone().find_map(|result| result.as_ref().err());
        let ended = |end| {
            let finished = results.clone().flatten();
            finished.filter(|r| r.summary.end == Some(end)).count()
        };
        let why = match failure {
            Some(message) => format!("the first error is: {message}"),
            None => format!(
                "{} ended because no agent arrived for some time, {} at the scenario's duration",
                ended(End::Idle),
                ended(End::Duration)
            ),
        };
        format!("{name}: too few of {all} runs have a value; {why}")
    }

    /// The state after the last round, in one line.
    fn progress(&self) -> String {
        let Some(look) = self.looks.last() else {
            return String::new();
        };
        let result = |(wanted, reached): (&Wanted, &Option<Reached>)| {
            let name = &wanted.name;
            let Some(reached) = reached else {
                return format!("{name} has no value");
            };
            let written = |number| as_precise(number, reached.error);
            let (value, error) = (written(reached.value), written(reached.error));
            let percent = reached.percent().map(|part| format!(" ({part})"));
            let part = percent.unwrap_or_default();
            format!("{name} {value} ± {error}{part}, wanted {}", wanted.error)
        };
        let wanted = self.question.request.wanted.iter().zip(&look.reached);
        let runs: usize = look.runs.iter().sum();
        let results: Vec<String> = wanted.map(result).collect();
        format!("after {runs} runs: {}", results.join("; "))
    }
}

fn failed(question: &Question, error: RunError) -> LabError {
    LabError::of(question.title[0].clone(), error)
}

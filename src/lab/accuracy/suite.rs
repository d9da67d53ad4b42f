//! The whole measurement: every scene under every choice. Errors are stored; costs are measured anew.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::report::Report;
use super::results::{Judged, Point, SceneResults};
use super::scenes::{Kind, Scene, names};
use super::trajectory::Trajectories;
use super::trials::{Trial, few, reference, settings, trials};
use super::{cost, statistics};
use crate::error::LabError;
use crate::jobs::{Results, results};
use crate::sweep::{Cell, Study};
use analysis::statistics::Range;
use runs::case::RunResult;
use runs::identity::Identity;
use runs::job::{Job, Listener, Progress};
use runs::store::Store;
use runs::summary::Summary;
use scenario::Setting;

/// The plan of a measurement.
#[derive(Clone)]
pub struct Plan {
    /// The scenes.
    pub scenes: Vec<Scene>,
    /// The choices whose values are tried; empty for all.
    pub choices: Vec<String>,
    /// A check that everything works: few values, two seeds, and costs from a single turn.
    pub quick: bool,
}

/// The number of measurements of each cost.
const TURNS: usize = 5;
/// The time from which the crowds of scenes judged by statistics are dense, seconds: their costs are measured from then
/// on.
const DENSE_AT: f64 = 15.0;
/// The number of seeds of a quick plan.
const FEW_SEEDS: u64 = 2;

/// A scene and its trials.
struct Task {
    scene: Scene,
    study: Study,
    document: Value,
    trials: Vec<Trial>,
    /// The entry of the study with which statistics are compared.
    reference: Option<usize>,
    quick: bool,
}

/// Runs the jobs of the plan that have no results in `store`, and writes tables and pictures.
///
/// # Errors
/// A run or a file fails.
pub fn accuracy(plan: &Plan, store: &Store, listener: &dyn Listener) -> Result<Report, LabError> {
    let prepared = plan.scenes.iter().map(|&scene| Task::new(scene, plan));
    let tasks = prepared.collect::<Result<Vec<Task>, _>>()?;
    let of_tasks: Vec<Vec<Job>> = tasks.iter().map(Task::jobs).collect();
    let jobs: Vec<Job> = of_tasks.into_iter().flatten().collect();
    let results = results(&jobs, store, listener)?;
    let finished = tasks.iter().map(|task| task.finish(results, listener));
    let found = finished.collect::<Result<Vec<SceneResults>, _>>()?;
    Ok(Report {
        scenes: found,
        quick: plan.quick,
    })
}

impl Task {
    fn new(scene: Scene, plan: &Plan) -> Result<Self, LabError> {
        let few_seeds = plan.quick && scene.kind == Kind::Statistics;
        let study = scene.study(few_seeds.then_some(FEW_SEEDS))?;
        let document = scene.document(&study)?;
        let mut trials = trials(&study, &document)?;
        trials.retain(|trial| plan.choices.is_empty() || plan.choices.contains(&trial.choice));
        if plan.quick {
            trials = few(&trials);
        }
        // A quick plan has no reference runs: it compares with the first trial.
        let reference = match plan.quick {
            true => trials.first().map(|trial| trial.entry),
            false => reference(&study),
        };
        Ok(Self {
            scene,
            study,
            document,
            trials,
            reference,
            quick: plan.quick,
        })
    }

    fn jobs<'a>(&'a self) -> Vec<Job<'a>> {
        let (scene, document, trials, quick) =
            (self.scene.name, &self.document, &self.trials, self.quick);
        if self.scene.kind == Kind::Statistics {
            let entries = self.entries().into_iter();
            let cells = entries.flat_map(|entry| self.cells(entry));
            let job = |cell: &'a Cell| cell.case.job(format!("{scene} {cell}"));
            return cells.map(job).collect();
        }
        let (name, key) = self.motion();
        let work = move |_: Progress| Trajectories::of(document, trials, quick);
        vec![Job::new(name, key, 100.0, work)]
    }

    /// The name and the identity of the job of a scene of motion.
    fn motion(&self) -> (String, Identity) {
        let (document, trials, quick) = (&self.document, &self.trials, self.quick);
        let name = format!("motion {}, {} points", self.scene.name, trials.len());
        let key = Identity::of(&name, format!("{document} {trials:?} {quick}"));
        (name, key)
    }

    /// The entries of the study whose runs statistics need.
    fn entries(&self) -> BTreeSet<usize> {
        let entries = self.trials.iter().map(|trial| trial.entry);
        entries.chain(self.reference).collect()
    }

    /// The cells of an entry, one per seed.
    fn cells(&self, entry: usize) -> &[Cell] {
        let seeds = self.study.seeds;
        &self.study.cells[entry * seeds..(entry + 1) * seeds]
    }

    /// Combines the results of the jobs, and measures the costs.
    fn finish(&self, results: Results, listener: &dyn Listener) -> Result<SceneResults, LabError> {
        let judged = match self.scene.kind {
            Kind::Motion => {
                let (name, key) = self.motion();
                results.of::<Trajectories>(&name, &key)?.judge()
            }
            Kind::Statistics => self.statistics(results)?,
        };
        let trials = self.trials.iter();
        let settings = trials
            .clone()
            .map(|trial| (trial.entry, &trial.settings[..]));
        let settings: BTreeMap<usize, &[Setting]> = settings.collect();
        let (count, name) = (settings.len(), self.scene.name);
        listener.notes(&format!("{name}: measuring the cost of {count} settings"));
        let turns = if self.quick { 1 } else { TURNS };
        let from = match self.scene.kind {
            Kind::Motion => 0.0,
            Kind::Statistics => DENSE_AT,
        };
        let measured = cost::measure(&self.document, from, settings.values().copied(), turns)?;
        let costs: BTreeMap<&usize, Range> = settings.keys().zip(measured).collect();
        let points = trials.zip(judged.errors).map(|(trial, errors)| Point {
            trial: trial.clone(),
            cost: costs[&trial.entry],
            errors,
        });
        Ok(SceneResults {
            scene: self.scene,
            quantities: judged.quantities,
            points: points.collect(),
            notes: judged.notes,
        })
    }

    /// Compares the runs of all entries with those of the reference.
    fn statistics(&self, results: Results) -> Result<Judged, LabError> {
        let seeds = self.study.seeds;
        let mut runs: BTreeMap<usize, Vec<Summary>> = BTreeMap::new();
        for entry in self.entries() {
            let cells = self.cells(entry).iter();
            let own = cells.map(|cell| {
                Ok(results
                    .of::<RunResult>(&cell.to_string(), &cell.case.key)?
                    .summary)
            });
            runs.insert(entry, own.collect::<Result<_, LabError>>()?);
        }
        let Some(reference) = self.reference else {
            return Ok(Judged::default());
        };
        let fine = names(&settings(&self.cells(reference)[0])?);
        let against = match self.quick {
            true => format!("the first point, {fine},"),
            false => fine,
        };
        let points = self.trials.iter().map(|trial| &runs[&trial.entry][..]);
        let notes =
            format!("Over {seeds} seeds, against {against} with as many; intervals are 95 %.");
        Ok(statistics::judge(points, &runs[&reference], notes))
    }
}

//! Points → runs → values of all targets. The runs of several points are the cells of a sweep.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::scene::{Set, Target};
use super::study::Calibration;
use crate::error::LabError;
use crate::jobs::each;
use crate::sweep::{Cell, Gathered, Shard, State, Study};
use analysis::statistics::MeanStd;
use runs::case::Case;
use runs::job::{self, Listener};
use runs::memory::Memory;
use runs::store::Store;
use scenario::Setting;

/// Computes points.
pub struct Evaluator<'a> {
    /// The calibration.
    pub calibration: &'a Calibration,
    /// The shard of the cells that this process computes first.
    pub shard: Shard,
    /// The finished cells.
    pub store: &'a Store,
    /// Receives progress reports.
    pub listener: &'a dyn Listener,
}

/// The values of one target at one point: for each seed a value, or the reason why there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// By seed.
    pub runs: Vec<Result<f64, String>>,
}

/// A point with the samples of all requested targets, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// Coordinates between 0 and 1.
    pub point: Vec<f64>,
    /// The samples.
    pub samples: Vec<Sample>,
}

/// The place of a run: point, scene and seed.
type Place = (usize, usize, u64);
/// Cells with their places.
type Cells = Vec<(Place, Cell)>;

impl Sample {
    /// Mean and standard deviation of the values; `None` without values.
    pub fn values(&self) -> Option<MeanStd> {
        let values = self.runs.iter().flatten().copied();
        MeanStd::of(&values.collect::<Vec<f64>>())
    }

    /// The fraction of the runs that failed.
    pub fn failed(&self) -> f64 {
        let failed = self.runs.iter().filter(|run| run.is_err()).count();
        failed as f64 / self.runs.len().max(1) as f64
    }
}

impl Evaluator<'_> {
    /// The targets of these sets, in order.
    pub fn targets(&self, sets: &[Set]) -> Vec<&Target> {
        let targets = self.calibration.targets.iter();
        targets.filter(|one| sets.contains(&one.set)).collect()
    }

    /// Computes the runs of all points for these targets and seeds that are not in the store: first those of the shard,
    /// then those that no other process has claimed. Waits for those that another process computes.
    ///
    /// # Errors
    /// Results cannot be stored. Failed runs are in the samples.
    pub fn evaluate(
        &self,
        name: &str,
        points: &[Vec<f64>],
        (targets, seeds): (&[&Target], &[u64]),
    ) -> Result<Vec<Evaluated>, LabError> {
        let scenes: BTreeSet<usize> = targets.iter().map(|target| target.scene).collect();
        let point = |k: usize| {
            scenes
                .iter()
                .flat_map(move |&scene| seeds.iter().map(move |&seed| (k, scene, seed)))
        };
        let places: Vec<Place> = (0..points.len()).flat_map(point).collect();
        let (cells, mut states) = self.cells(points, places)?;
        let (places, cells): (Vec<Place>, Vec<Cell>) = cells.into_iter().unzip();
        let study = Study::of_cells(name, cells, self.calibration.memory);
        states.extend(places.into_iter().zip(self.computed(&study)?));
        let sample = |k: usize, target: &Target| {
            let scene = &self.calibration.scenes[target.scene];
            let run = |seed: &u64| match &states[&(k, target.scene, *seed)] {
                State::Finished(run) => target.read(scene, run, &self.calibration.rule),
                State::Failed(why) => Err(why.clone()),
                State::Missing => Err("no result".to_owned()),
            };
            Sample {
                runs: seeds.iter().map(run).collect(),
            }
        };
        let evaluated = |(k, point): (usize, &Vec<f64>)| Evaluated {
            point: point.clone(),
            samples: targets.iter().map(|target| sample(k, target)).collect(),
        };
        Ok(points.iter().enumerate().map(evaluated).collect())
    }

    /// The cells of these runs, and the runs with invalid scenarios as failures, such as crowds of people too large to
    /// fit.
    fn cells(
        &self,
        points: &[Vec<f64>],
        places: Vec<Place>,
    ) -> Result<(Cells, BTreeMap<Place, State>), LabError> {
        let of = self.calibration;
        let memory = Memory::new(of.memory);
        let checked = each(places.len(), |k| {
            let (point, scene, seed) = places[k];
            self.case(&points[point], scene, seed, &memory)
        })?;
        let (mut cells, mut failures) = (Vec::new(), BTreeMap::new());
        for (place, case) in places.into_iter().zip(checked) {
            let case = match case {
                Ok(case) => case,
                Err(why) => {
                    failures.insert(place, State::Failed(why));
                    continue;
                }
            };
            let (point, scene, _) = place;
            let parameters = of.parameters.iter().zip(of.values(&points[point]));
            let values = parameters.map(|(of, value)| (of.name.clone(), json!(value)));
            let label = ("label".to_owned(), json!(of.scenes[scene].name));
            let cell = Cell {
                number: cells.len() + 1,
                values: std::iter::once(label).chain(values).collect(),
                case,
            };
            cells.push((place, cell));
        }
        Ok((cells, failures))
    }

    fn case(
        &self,
        point: &[f64],
        scene: usize,
        seed: u64,
        memory: &Memory,
    ) -> Result<Case, String> {
        let scene = &self.calibration.scenes[scene];
        let mut settings = self
            .calibration
            .settings(scene, &self.calibration.values(point))?;
        let seed = Setting::new("seed", Value::from(seed), format!("seed={seed}"));
        settings.push(seed.map_err(|error| error.to_string())?);
        let case = scene.case.with(settings, memory);
        case.map_err(|error| error.to_string())
    }

    /// The states of all cells, after cells without a state were computed. Failed cells are not tried again: they would
    /// fail again.
    fn computed(&self, study: &Study) -> Result<Vec<State>, LabError> {
        for shard in [self.shard, Shard::WHOLE] {
            let states = Gathered::of(study, self.store).states;
            let is_missing = |cell: &Cell| states[cell.number - 1] == State::Missing;
            if !study.cells.iter().any(is_missing) {
                return Ok(states);
            }
            let jobs = study.jobs(|cell| shard.has(cell.number) && is_missing(cell));
            if !jobs.is_empty() {
                self.listener.notes(&study.name);
                job::run(&jobs, self.store, study.memory, self.listener)?;
            }
        }
        Ok(Gathered::of(study, self.store).states)
    }
}

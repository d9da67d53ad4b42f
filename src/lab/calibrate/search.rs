//! The stages of a calibration: the start, the screening, the search, the slopes at the best point, the errors there.

use super::evaluate::{Evaluated, Evaluator};
use super::residual::{noise, ratio, residual};
use super::scene::{Set, Target};
use crate::error::LabError;
use analysis::cma_es::{CmaEs, reflected};
use analysis::identifiability::{Knowledge, Slopes};
use analysis::morris::{Effect, Trajectories};
use analysis::statistics::{MeanStd, Range};

/// The distance from the best point at which slopes are measured, as a fraction of the bounds.
pub const SLOPE_STEP: f64 = 0.1;
/// The search ends when no parameter varies by more than this, as a fraction of the bounds.
pub const CONVERGED: f64 = 1e-3;

/// The stage that a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The starting point.
    Start,
    /// The screening.
    Screening,
    /// A generation of the search, counted from 1.
    Generation(usize),
    /// A neighbor of the best point.
    Slopes,
}

impl Stage {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Screening => "screening",
            Self::Generation(_) => "search",
            Self::Slopes => "slopes",
        }
    }
}

/// A point of the search.
pub struct Trial {
    /// Its stage.
    pub stage: Stage,
    /// Its samples of the targets of the fit.
    pub evaluated: Evaluated,
    /// The root mean square of the residuals, tolerances.
    pub misfit: f64,
}

/// One generation.
pub struct Generation {
    /// The center of the distribution before it, coordinates; parameters that are not searched have none.
    pub mean: Vec<Option<f64>>,
    /// The standard deviations of the distribution.
    pub spread: Vec<Option<f64>>,
    /// The smallest, median and largest misfit.
    pub misfits: Range,
    /// The smallest misfit of all trials so far.
    pub best: f64,
}

/// The effects of the parameters.
pub struct Screened {
    /// On the misfit, by parameter.
    pub misfit: Vec<Effect>,
    /// On each value of the fit, by parameter.
    pub values: Vec<Vec<Effect>>,
}

/// Everything that was found.
pub struct Calibrated {
    /// All points with the targets of the fit and the seeds of the search, in order.
    pub trials: Vec<Trial>,
    /// The screening, if there was one.
    pub screened: Option<Screened>,
    /// The numbers of the parameters that were searched.
    pub searched: Vec<usize>,
    /// The generations.
    pub generations: Vec<Generation>,
    /// The number of the best trial.
    pub best: usize,
    /// The identifiability of the searched parameters.
    pub knowledge: Knowledge,
    /// The starting and the best point with all targets and the final seeds.
    pub compared: [Evaluated; 2],
}

/// Runs all stages.
pub fn search(evaluator: &Evaluator) -> Result<Calibrated, LabError> {
    let mut stages = Stages {
        evaluator,
        targets: evaluator.targets(&[Set::Fit]),
        trials: Vec::new(),
    };
    let of = evaluator.calibration;
    let start = of.start();
    stages.add(
        "the starting point",
        Stage::Start,
        std::slice::from_ref(&start),
    )?;
    let screened = stages.screened()?;
    let searched = stages.searched(screened.as_ref())?;
    let generations = stages.generations(&searched)?;
    let best = stages.best();
    let knowledge = stages.knowledge(best, &searched)?;
    let points = [start, stages.trials[best].evaluated.point.clone()];
    let all = evaluator.targets(&Set::ALL);
    let compared = evaluator.evaluate("the errors", &points, (&all, &of.final_seeds))?;
    let [start, end]: [Evaluated; 2] = compared
        .try_into()
        .map_err(|_| LabError::missing("the errors", "result"))?;
    Ok(Calibrated {
        trials: stages.trials,
        screened,
        searched,
        generations,
        best,
        knowledge,
        compared: [start, end],
    })
}

struct Stages<'a> {
    evaluator: &'a Evaluator<'a>,
    /// The targets of the fit.
    targets: Vec<&'a Target>,
    trials: Vec<Trial>,
}

impl Stages<'_> {
    /// Adds trials at these points; returns their misfits.
    fn add(&mut self, name: &str, stage: Stage, points: &[Vec<f64>]) -> Result<Vec<f64>, LabError> {
        let of = self.evaluator.calibration;
        let evaluated = self
            .evaluator
            .evaluate(name, points, (&self.targets, &of.seeds))?;
        let trials = evaluated.into_iter().map(|evaluated| Trial {
            stage,
            misfit: evaluated.misfit(&self.targets, &of.rule),
            evaluated,
        });
        let first = self.trials.len();
        self.trials.extend(trials);
        Ok(self.trials[first..].iter().map(|one| one.misfit).collect())
    }

    /// The number of the best trial: the first of the smallest misfit.
    fn best(&self) -> usize {
        let trials = self.trials.iter().enumerate();
        let best = trials.min_by(|(_, a), (_, b)| a.misfit.total_cmp(&b.misfit));
        best.map_or(0, |(k, _)| k)
    }

    fn screened(&mut self) -> Result<Option<Screened>, LabError> {
        let of = self.evaluator.calibration;
        let Some(screening) = of.screening else {
            return Ok(None);
        };
        let design = Trajectories::new(of.parameters.len(), screening.trajectories, screening.seed);
        let first = self.trials.len();
        let measured = self.add("screening", Stage::Screening, &design.points)?;
        let trials = &self.trials[first..];
        let effects = self.targets.iter().enumerate().map(|(k, target)| {
            let value = |trial: &Trial| residual(&trial.evaluated.samples[k], target, &of.rule);
            design.effects(&trials.iter().map(value).collect::<Vec<_>>())
        });
        let values = effects.collect();
        let misfits: Vec<Option<f64>> = measured.into_iter().map(Some).collect();
        Ok(Some(Screened {
            misfit: design.effects(&misfits),
            values,
        }))
    }

    /// The parameters that are searched: not frozen, and changing a value by `drop_below`. A parameter whose
    /// effects could not be computed is searched, too.
    fn searched(&self, screened: Option<&Screened>) -> Result<Vec<usize>, LabError> {
        let of = self.evaluator.calibration;
        let free = of.free();
        let (Some(screened), Some(screening)) = (screened, of.screening) else {
            return Ok(free);
        };
        let is_searched = |parameter: &usize| {
            let effects = || screened.values.iter().map(|value| value[*parameter]);
            effects().any(|effect| effect.mean_absolute >= screening.drop_below)
                || effects().all(|effect| effect.count == 0)
        };
        let searched: Vec<usize> = free.into_iter().filter(is_searched).collect();
        if searched.is_empty() {
            let reason = "the screening drops all parameters; lower screening.drop_below";
            return Err(LabError::Data(reason.to_owned()));
        }
        Ok(searched)
    }

    fn generations(&mut self, searched: &[usize]) -> Result<Vec<Generation>, LabError> {
        let of = self.evaluator.calibration;
        let start = of.start();
        let from: Vec<f64> = searched.iter().map(|&k| start[k]).collect();
        let population = of.population(searched.len());
        let mut search = CmaEs::new(&from, of.search.spread, population, of.search.seed);
        let count = start.len();
        let spread_out = |own: &[f64]| {
            let mut all = vec![None; count];
            searched
                .iter()
                .zip(own)
                .for_each(|(&k, &value)| all[k] = Some(value));
            all
        };
        let mut generations: Vec<Generation> = Vec::new();
        for number in 1..=of.search.generations {
            let (mean, spread) = (search.mean().to_vec(), search.spread());
            if spread.iter().all(|&spread| spread < CONVERGED) {
                break;
            }
            let drawn = search.ask().into_iter();
            let inside = drawn.map(|own| own.into_iter().map(reflected).collect());
            let asked: Vec<Vec<f64>> = inside.collect();
            let placed = asked.iter().map(|own| {
                let mut point = start.clone();
                searched
                    .iter()
                    .zip(own)
                    .for_each(|(&k, &value)| point[k] = value);
                point
            });
            let points: Vec<Vec<f64>> = placed.collect();
            let name = format!("generation {number} of {}", of.search.generations);
            let found = self.add(&name, Stage::Generation(number), &points)?;
            search.tell(&asked, &found);
            let best = self.trials[self.best()].misfit;
            let misfits = Range::of(&found);
            self.evaluator.listener.notes(&format!(
                "{name}: {:.2} to {:.2} tolerances, the best of all {best:.2}",
                misfits.minimum, misfits.maximum
            ));
            generations.push(Generation {
                mean: spread_out(&mean),
                spread: spread_out(&spread),
                misfits,
                best,
            });
        }
        Ok(generations)
    }

    /// The identifiability of the parameters, from the slopes of the residuals around the best trial.
    fn knowledge(&mut self, best: usize, searched: &[usize]) -> Result<Knowledge, LabError> {
        let center = self.trials[best].evaluated.point.clone();
        let shifted = searched.iter().flat_map(|&k| {
            [-SLOPE_STEP, SLOPE_STEP].map(|step| {
                let mut point = center.clone();
                point[k] = (point[k] + step).clamp(0.0, 1.0);
                point
            })
        });
        let ends: Vec<Vec<f64>> = shifted.collect();
        let first = self.trials.len();
        self.add("slopes at the best point", Stage::Slopes, &ends)?;
        let (before, pairs) = self.trials.split_at(first);
        let best = &before[best];
        // Residuals that no parameter explains count as noise of all values.
        let free = self.targets.len() as f64 - searched.len() as f64;
        let squares = best.misfit.powi(2) * self.targets.len() as f64;
        let unexplained = (squares / free.max(1.0)).max(1.0);
        let slopes = self.targets.iter().enumerate().map(|(target, of)| {
            let changes = searched.iter().enumerate().map(|(j, &parameter)| {
                let [low, high] = [&pairs[2 * j], &pairs[2 * j + 1]].map(|trial| &trial.evaluated);
                let width = high.point[parameter] - low.point[parameter];
                let runs = high.samples[target]
                    .runs
                    .iter()
                    .zip(&low.samples[target].runs);
                let differences = runs
                    .filter_map(|(high, low)| Some((high.as_ref().ok()?, low.as_ref().ok()?)))
                    .map(|(&high, &low)| (ratio(high, of) - ratio(low, of)) / width);
                MeanStd::of(&differences.collect::<Vec<f64>>())
            });
            let differences: Vec<Option<MeanStd>> = changes.collect();
            let noise = noise(&best.evaluated.samples[target], of).unwrap_or_default();
            let scale = (unexplained * (1.0 + noise * noise)).sqrt();
            slopes(&differences, scale)
        });
        Ok(Knowledge::of(searched.len(), &slopes.collect::<Vec<_>>()))
    }
}

/// The slopes of a residual from the differences of all seeds, over `scale`. The errors of all slopes are taken to be
/// equal, because those of few seeds are uncertain themselves. A parameter has no slope if no run gave a value there.
fn slopes(differences: &[Option<MeanStd>], scale: f64) -> Slopes {
    let errors = differences.iter().flatten().filter(|of| of.count > 1);
    let squares: Vec<f64> = errors.map(|of| of.error().powi(2)).collect();
    let variance = MeanStd::of(&squares).map_or(0.0, |of| of.mean) / (scale * scale);
    let slope = |of: &Option<MeanStd>| of.map_or(0.0, |of| of.mean / scale);
    let known = |of: &Option<MeanStd>| of.map_or(0.0, |_| variance);
    Slopes {
        slopes: differences.iter().map(slope).collect(),
        variances: differences.iter().map(known).collect(),
    }
}

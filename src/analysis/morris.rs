//! Screening: which parameters have an effect at all, from a few runs for each (Morris 1991; μ* of Campolongo, Cariboni
//! and Saltelli 2007).
//!
//! A trajectory starts at a random point of a grid of four levels in the unit cube and changes every parameter once, in
//! random order, by 2/3 of its range. The change of a value, divided by 2/3, is an elementary effect.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::statistics::MeanStd;

/// The levels of the grid: 0, 1/3, 2/3 and 1.
const LEVELS: u8 = 4;

/// Trajectories through the unit cube.
#[derive(Debug, Clone)]
pub struct Trajectories {
    /// All points, trajectory by trajectory.
    pub points: Vec<Vec<f64>>,
    /// The parameter that changes before each point; `None` at the start of a trajectory.
    changed: Vec<Option<usize>>,
}

/// The elementary effects of one parameter on a value, in units of the value over the whole range of the parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Effect {
    /// μ*: the mean of the absolute effects; 0 without effects.
    pub mean_absolute: f64,
    /// σ: the standard deviation of the effects, large if they depend on other parameters or on chance.
    pub deviation: f64,
    /// The number of effects.
    pub count: usize,
}

impl Trajectories {
    /// `count` trajectories over `dimension` parameters: `count` · (`dimension` + 1) points.
    pub fn new(dimension: usize, count: usize, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (mut points, mut changed) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let drawn = (0..dimension).map(|_| rng.random_range(0..LEVELS));
            let mut levels: Vec<u8> = drawn.collect();
            let mut order: Vec<usize> = (0..dimension).collect();
            for k in (1..dimension).rev() {
                order.swap(k, rng.random_range(0..=k));
            }
            points.push(point(&levels));
            changed.push(None);
            for parameter in order {
                levels[parameter] = (levels[parameter] + LEVELS / 2) % LEVELS;
                points.push(point(&levels));
                changed.push(Some(parameter));
            }
        }
        Self { points, changed }
    }

    /// The effects of each parameter on a value with these outputs at the points. Steps from or to a point without an
    /// output are left out.
    pub fn effects(&self, outputs: &[Option<f64>]) -> Vec<Effect> {
        let dimension = self.points.first().map_or(0, Vec::len);
        let mut effects = vec![Vec::new(); dimension];
        for (k, parameter) in self.changed.iter().enumerate() {
            if let Some(parameter) = *parameter
                && let (Some(from), Some(to)) = (outputs[k - 1], outputs[k])
            {
                let step = self.points[k][parameter] - self.points[k - 1][parameter];
                effects[parameter].push((to - from) / step);
            }
        }
        effects.iter().map(|effects| Effect::of(effects)).collect()
    }
}

impl Effect {
    fn of(effects: &[f64]) -> Self {
        let absolute: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
        let deviation = MeanStd::of(effects).and_then(|of| of.std());
        Self {
            mean_absolute: MeanStd::of(&absolute).map_or(0.0, |of| of.mean),
            deviation: deviation.unwrap_or_default(),
            count: effects.len(),
        }
    }
}

fn point(levels: &[u8]) -> Vec<f64> {
    let last = f64::from(LEVELS - 1);
    let parts = levels.iter().map(|&level| f64::from(level) / last);
    parts.collect()
}

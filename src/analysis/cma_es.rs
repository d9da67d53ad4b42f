//! CMA-ES: minimizes a function by samples of a normal distribution whose covariance adapts to it.
//!
//! This is the (μ/μ_w, λ) strategy with a full covariance matrix, cumulative step-size adaptation and positive weights
//! (Hansen, *The CMA evolution strategy: a tutorial*, arXiv:1604.00772, 2016, with its default constants). It uses only
//! the order of the values, so a monotone transformation of the function changes nothing.
//!
//! ```
//! # use sandbox_analysis::cma_es::CmaEs;
//! let mut search = CmaEs::new(&[0.9, 0.1], 0.3, 8, 1);
//! for _ in 0..100 {
//!     let points = search.ask();
//!     let values: Vec<f64> = points.iter().map(|x| (x[0] - 0.5).powi(2) + x[1].powi(2)).collect();
//!     search.tell(&points, &values);
//! }
//! assert!((search.mean()[0] - 0.5).abs() < 1e-6);
//! ```

use libm::{cos, exp, log};
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The fewest points of a generation: two are its parents.
pub const LEAST_POPULATION: usize = 4;

/// The state of a search. [`ask`](Self::ask) and [`tell`](Self::tell) alternate. Equal seeds and values give equal
/// points.
#[derive(Debug, Clone)]
pub struct CmaEs {
    constants: Constants,
    mean: DVector<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    root: Root,
    step_path: DVector<f64>,
    covariance_path: DVector<f64>,
    /// The number of generations that were told.
    generation: i32,
    rng: ChaCha8Rng,
}

/// The constants of the strategy, by the tutorial's Table 1.
#[derive(Debug, Clone)]
struct Constants {
    population: usize,
    /// w_i of the parents, the best first; their sum is 1.
    weights: Vec<f64>,
    /// μ_eff.
    mass: f64,
    /// c_σ and d_σ.
    step_rate: f64,
    damping: f64,
    /// c_c, c_1 and c_μ.
    path_rate: f64,
    rank_one: f64,
    rank_mu: f64,
    /// The mean length of a standard normal vector.
    expected_length: f64,
}

impl Constants {
    fn new(dimension: usize, population: usize) -> Self {
        let (n, lambda) = (dimension as f64, population as f64);
        let weight = |rank: usize| log(0.5 * (lambda + 1.0)) - log(rank as f64);
        let weights: Vec<f64> = (1..=population / 2).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let mass = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let step_rate = (mass + 2.0) / (n + mass + 5.0);
        let rank_one = 2.0 / ((n + 1.3).powi(2) + mass);
        let rank_mu = 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0).powi(2) + mass);
        Self {
            population,
            weights,
            mass,
            step_rate,
            damping: 1.0 + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + step_rate,
            path_rate: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
            rank_one,
            rank_mu: rank_mu.min(1.0 - rank_one),
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

/// The square root of the covariance: B diag(d) Bᵀ.
#[derive(Debug, Clone)]
struct Root {
    basis: DMatrix<f64>,
    lengths: DVector<f64>,
}

impl Root {
    fn of(covariance: &DMatrix<f64>) -> Self {
        /// Rounding errors must not make a length zero or imaginary.
        const LEAST: f64 = 1e-20;
        let eigen = SymmetricEigen::new(covariance.clone());
        let least = LEAST * eigen.eigenvalues.max();
        Self {
            basis: eigen.eigenvectors,
            lengths: eigen.eigenvalues.map(|value| value.max(least).sqrt()),
        }
    }

    fn times(&self, vector: &DVector<f64>) -> DVector<f64> {
        &self.basis * self.lengths.component_mul(vector)
    }

    /// The inverse square root times a vector.
    fn whitened(&self, vector: &DVector<f64>) -> DVector<f64> {
        &self.basis * (self.basis.transpose() * vector).component_div(&self.lengths)
    }
}

impl CmaEs {
    /// A search from `start` with the standard deviation `step` in every coordinate and at least
    /// [`LEAST_POPULATION`] points per generation. The start must have a coordinate.
    pub fn new(start: &[f64], step: f64, population: usize, seed: u64) -> Self {
        let n = start.len();
        let covariance = DMatrix::identity(n, n);
        Self {
            constants: Constants::new(n, population.max(LEAST_POPULATION)),
            mean: DVector::from_column_slice(start),
            step,
            root: Root::of(&covariance),
            covariance,
            step_path: DVector::zeros(n),
            covariance_path: DVector::zeros(n),
            generation: 0,
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// A usual number of points per generation: 4 + ⌊3 ln n⌋.
    pub fn usual_population(dimension: usize) -> usize {
        4 + (3.0 * log(dimension.max(1) as f64)) as usize
    }

    /// The center of the distribution.
    pub fn mean(&self) -> &[f64] {
        self.mean.as_slice()
    }

    /// The standard deviation of the distribution in each coordinate.
    pub fn spread(&self) -> Vec<f64> {
        let variances = self.covariance.diagonal();
        let deviations = variances.iter().map(|variance| self.step * variance.sqrt());
        deviations.collect()
    }

    /// Draws the points of the next generation.
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        let mut point = || {
            let draws = (0..self.mean.len()).map(|_| normal(&mut self.rng));
            let normal = DVector::from_iterator(self.mean.len(), draws);
            let point = &self.mean + self.step * self.root.times(&normal);
            point.as_slice().to_vec()
        };
        (0..self.constants.population).map(|_| point()).collect()
    }

    /// Takes the points of a generation with their values; NaN is worse than any number. The points are those that were
    /// asked last, or these moved into bounds by [`reflected`]: then the distribution does not widen beyond the bounds.
    pub fn tell(&mut self, points: &[Vec<f64>], values: &[f64]) {
        let of = &self.constants;
        let value = |k: usize| match values[k].is_nan() {
            true => f64::INFINITY,
            false => values[k],
        };
        let mut order: Vec<usize> = (0..points.len().min(values.len())).collect();
        order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
        let way = |k: usize| (DVector::from_column_slice(&points[k]) - &self.mean) / self.step;
        let best = order.iter().zip(&of.weights);
        let parents: Vec<(DVector<f64>, f64)> =
            best.map(|(&k, &weight)| (way(k), weight)).collect();
        let n = self.mean.len();
        let zero = || DVector::zeros(n);
        let way = parents
            .iter()
            .fold(zero(), |sum, (way, weight)| sum + way * *weight);
        self.mean += &way * self.step;
        self.generation += 1;

        let kept = 1.0 - of.step_rate;
        let added = (of.step_rate * (2.0 - of.step_rate) * of.mass).sqrt();
        self.step_path = &self.step_path * kept + self.root.whitened(&way) * added;
        let length = self.step_path.norm();

        // A long step path stalls the covariance path, so that the covariance does not grow too fast.
        let early = (1.0 - kept.powi(2 * self.generation)).sqrt();
        let bound = (1.4 + 2.0 / (n as f64 + 1.0)) * of.expected_length;
        let stalled = length / early >= bound;
        let added = (of.path_rate * (2.0 - of.path_rate) * of.mass).sqrt();
        self.covariance_path *= 1.0 - of.path_rate;
        if !stalled {
            self.covariance_path += &way * added;
        }

        let lost = match stalled {
            true => of.path_rate * (2.0 - of.path_rate),
            false => 0.0,
        };
        self.covariance *= 1.0 - of.rank_one * (1.0 - lost) - of.rank_mu;
        let path = &self.covariance_path;
        self.covariance += path * path.transpose() * of.rank_one;
        for (way, weight) in &parents {
            self.covariance += way * way.transpose() * (of.rank_mu * weight);
        }
        self.step *= exp(of.step_rate / of.damping * (length / of.expected_length - 1.0));
        self.root = Root::of(&self.covariance);
    }
}

/// A coordinate reflected at 0 and 1 until it lies between them. Reflection brings it no farther from any point between
/// them, so reflecting the points of a distribution with its center inside narrows the distribution.
pub fn reflected(coordinate: f64) -> f64 {
    let turned = coordinate.rem_euclid(2.0);
    if turned > 1.0 { 2.0 - turned } else { turned }
}

/// A standard normal number (Box and Muller 1958).
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let [length, angle]: [f64; 2] = [rng.random(), rng.random()];
    (-2.0 * log(1.0 - length)).sqrt() * cos(TAU * angle)
}

//! How well values determine parameters: intervals and correlations from the slopes of residuals (the Gauss–Newton
//! approximation of the sum of their squares).
//!
//! Residuals have the standard deviation 1. Parameters are coordinates of the unit cube; before any residual, each is
//! uniform in it (variance 1/12). So every parameter has an interval; a parameter without slopes has the whole range.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The 97.5 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;
/// The variance of a uniform number between 0 and 1.
const UNIFORM_VARIANCE: f64 = 1.0 / 12.0;

/// The slopes of one residual.
#[derive(Debug, Clone, PartialEq)]
pub struct Slopes {
    /// By parameter, per range of the parameter.
    pub slopes: Vec<f64>,
    /// The variances of their errors. They are subtracted from the squares of the slopes, to remove the bias by noise.
    pub variances: Vec<f64>,
}

/// The knowledge about the parameters.
#[derive(Debug, Clone)]
pub struct Knowledge {
    covariance: DMatrix<f64>,
}

impl Knowledge {
    /// The knowledge about `dimension` parameters from the slopes of all residuals.
    pub fn of(dimension: usize, residuals: &[Slopes]) -> Self {
        let mut information = DMatrix::zeros(dimension, dimension);
        for Slopes { slopes, variances } in residuals {
            let slopes = DVector::from_column_slice(slopes);
            let variances = DVector::from_column_slice(variances);
            information += &slopes * slopes.transpose() - DMatrix::from_diagonal(&variances);
        }
        // Negative eigenvalues are noise: they carry no information.
        let mut eigen = SymmetricEigen::new(information);
        eigen.eigenvalues.apply(|value| *value = value.max(0.0));
        let variance = |value: f64| 1.0 / (value + 1.0 / UNIFORM_VARIANCE);
        eigen.eigenvalues.apply(|value| *value = variance(*value));
        Self {
            covariance: eigen.recompose(),
        }
    }

    /// Half the width of the 95 % interval of a parameter, as a fraction of its range.
    pub fn half_width(&self, parameter: usize) -> f64 {
        NORMAL_95 * self.covariance[(parameter, parameter)].sqrt()
    }

    /// The correlation of two parameters, from −1 to 1: near ±1 if only a combination of both is determined.
    pub fn correlation(&self, a: usize, b: usize) -> f64 {
        let of = &self.covariance;
        of[(a, b)] / (of[(a, a)] * of[(b, b)]).sqrt()
    }
}

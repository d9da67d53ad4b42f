//! The stability maps: for every k and ρ⁰max, for every K^ag, for every μ, the largest time step at which
//! a crowd comes to rest, found by bisection.

use serde::{Deserialize, Serialize};

use super::rest::Rest;
use crate::clock::PAPER_COARSE_STEP;
use crate::job::Job;
use crate::reproduce::ReproduceError;
use crate::simulation::Fault;
use crate::stability::{self, FITTED, Mode};

/// No step is longer, seconds: Δt_fine never is longer than Δt_coarse.
const LONGEST: f64 = PAPER_COARSE_STEP;
/// A step so much shorter than the formula's shows what the model does by itself.
const FINE: f64 = 0.2;
/// The search begins so far below and above the formula's step, as factors.
const WIDTH: f64 = 4.0;

/// How finely the maps are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Detail {
    /// Few points and few bisections.
    pub quick: bool,
}

impl Detail {
    /// k, rising.
    pub fn gas_constants(self) -> Vec<f64> {
        let every = if self.quick { 4 } else { 1 };
        (0..9)
            .step_by(every)
            .map(|k| 50.0 * f64::from(1 << k))
            .collect()
    }

    /// ρ⁰max, P/m², rising.
    pub fn rest_densities(self) -> Vec<f64> {
        if self.quick {
            vec![3.0, 5.0, 8.0]
        } else {
            vec![3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
        }
    }

    /// K^ag, rising.
    pub fn stiffnesses(self) -> Vec<f64> {
        if self.quick {
            vec![0.0, 1e3, 5e4]
        } else {
            vec![0.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4]
        }
    }

    /// μ, rising.
    pub fn viscosities(self) -> Vec<f64> {
        if self.quick {
            vec![0.0, 5.0, 100.0]
        } else {
            vec![0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 35.0, 50.0, 70.0, 100.0]
        }
    }

    /// Every crowd of the maps, each once.
    pub fn crowds(self) -> Vec<Rest> {
        let paper = Rest::default();
        let mut crowds = Vec::new();
        for gas_constant in self.gas_constants() {
            crowds.extend(
                self.rest_densities()
                    .into_iter()
                    .map(|rest_density_max| Rest {
                        gas_constant,
                        rest_density_max,
                        ..paper
                    }),
            );
        }
        let stiff = self.stiffnesses().into_iter();
        crowds.extend(stiff.map(|agent_stiffness| Rest {
            agent_stiffness,
            ..paper
        }));
        let thick = self.viscosities().into_iter();
        crowds.extend(thick.map(|viscosity| Rest { viscosity, ..paper }));
        let mut once: Vec<Rest> = Vec::new();
        for crowd in crowds {
            if !once.contains(&crowd) {
                once.push(crowd);
            }
        }
        once
    }

    fn bisections(self) -> u32 {
        if self.quick { 4 } else { 7 }
    }
}

/// One place on the maps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The crowd.
    pub crowd: Rest,
    /// The speeds that the model keeps in the full and in the loose room at fine steps, m/s.
    pub unrest: [f64; 2],
    /// The largest stable step that was found, seconds.
    pub largest: f64,
    /// What `auto` takes, seconds.
    pub auto: f64,
    /// Is that stable?
    pub auto_is_stable: bool,
}

impl Cell {
    /// Finds the largest stable step of a crowd.
    ///
    /// # Errors
    /// Somebody has no place at the start.
    pub fn find(crowd: Rest, detail: Detail) -> Result<Self, Fault> {
        let guess = crowd.mode().largest_step(&FITTED);
        let auto = stability::time_step(&crowd.scene(crowd.densities()[0], 1.0));
        let unrest = crowd.unrest(FINE * guess)?;
        let (mut low, mut high) = (guess / WIDTH, (guess * WIDTH).min(LONGEST));
        while !crowd.is_stable(low, unrest)? && low > 1e-3 * guess {
            (low, high) = (low / WIDTH, low);
        }
        if crowd.is_stable(high, unrest)? {
            low = high;
        }
        for _ in 0..detail.bisections() {
            let middle = (low * high).sqrt();
            if crowd.is_stable(middle, unrest)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Self {
            crowd,
            unrest,
            largest: low,
            auto,
            auto_is_stable: crowd.is_stable(auto, unrest)?,
        })
    }

    /// The job of finding it.
    pub fn job(crowd: Rest, detail: Detail) -> Job {
        let steps = detail.bisections();
        let name = format!(
            "map k={} ρ⁰max={} K^ag={} μ={}, {steps} bisections",
            crowd.gas_constant, crowd.rest_density_max, crowd.agent_stiffness, crowd.viscosity
        );
        // Frames of 8 s, in two rooms, with three crowds, the fine steps foremost.
        let frames = 48.0 * (1.0 / FINE + f64::from(steps) + 4.0);
        let expected = 5e-5 * frames / crowd.mode().largest_step(&FITTED);
        Job::new(name, expected, move || {
            Self::find(crowd, detail).map_err(|fault| ReproduceError::Fault {
                case: format!("{crowd:?}"),
                fault,
            })
        })
    }

    /// `auto` in parts of the largest stable step.
    pub fn ratio(&self) -> f64 {
        self.auto / self.largest
    }

    /// The fastest mode.
    pub fn mode(&self) -> Mode {
        self.crowd.mode()
    }
}

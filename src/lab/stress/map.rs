//! The points of the stability maps (`maps.json`): every pair of k and ρ⁰max, every K^ag and every μ. Held-out points
//! test the formula that is fitted to the maps.

use serde::Deserialize;

use super::rest::Rest;
use crate::error::LabError;
use crate::gallery::distinct;

/// The points of the maps, and how closely their limits are searched for. Values are in increasing order.
#[derive(Debug, Clone, Deserialize)]
pub struct Detail {
    /// k, m²/s².
    pub gas_constants: Vec<f64>,
    /// ρ⁰max, P/m².
    pub rest_densities: Vec<f64>,
    /// K^ag, 1/s².
    pub stiffnesses: Vec<f64>,
    /// μ, 1/s.
    pub viscosities: Vec<f64>,
    /// Crowds that the fit does not use: points between those of the maps, three points of the maps with other agents,
    /// and stiff gas with stiff contact and with viscosity.
    pub held_out: Vec<Rest>,
    /// The label of the hard case that is left out: the soak, or its shorter form.
    pub omitted_case: String,
    /// Number of bisections in the search for a step.
    pub bisections: u32,
}

impl Detail {
    /// All points or, if `quick`, few points and few bisections.
    ///
    /// # Errors
    /// `maps.json` is invalid.
    pub fn read(quick: bool) -> Result<Self, LabError> {
        let read = serde_json::from_str::<[Self; 2]>(include_str!("maps.json"));
        let [all, few] = read.map_err(|error| LabError::Data(format!("maps.json: {error}")))?;
        Ok(if quick { few } else { all })
    }

    /// All distinct crowds of the maps.
    pub fn crowds(&self) -> Vec<Rest> {
        let paper = Rest::default();
        let mut crowds: Vec<Rest> = Vec::new();
        for &gas_constant in &self.gas_constants {
            crowds.extend(self.rest_densities.iter().map(|&rest_density_max| Rest {
                gas_constant,
                rest_density_max,
                ..paper
            }));
        }
        crowds.extend(self.stiffnesses.iter().map(|&agent_stiffness| Rest {
            agent_stiffness,
            ..paper
        }));
        let thick = self.viscosities.iter();
        crowds.extend(thick.map(|&viscosity| Rest { viscosity, ..paper }));
        distinct(crowds)
    }
}

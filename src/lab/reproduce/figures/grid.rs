//! The parameter study of the concert that the paper leaves to future work: speed, amplitude and reflection of the wave
//! against k, ρ⁰max, μ and K^ag.

use serde::{Deserialize, Serialize};

use super::concert::{self, RUN};
use crate::analysis::wave::{self, Estimate, SpaceTime};
use crate::lab::reproduce::case::Case;

/// The seeds of every cell.
pub const SEEDS: [u64; 3] = [1, 2, 3];

/// k, ρ⁰max in P/m², μ and K^ag of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// k.
    pub gas_constant: f64,
    /// ρ⁰max, P/m².
    pub rest_density_max: f64,
    /// μ.
    pub viscosity: f64,
    /// K^ag.
    pub agent_stiffness: f64,
}

/// The values on each axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// k.
    pub gas_constant: Vec<f64>,
    /// ρ⁰max, P/m².
    pub rest_density_max: Vec<f64>,
    /// μ.
    pub viscosity: Vec<f64>,
    /// K^ag.
    pub agent_stiffness: Vec<f64>,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            gas_constant: vec![100.0, 200.0, 400.0],
            rest_density_max: vec![4.0, 5.0, 6.0],
            viscosity: vec![0.0, 5.0],
            agent_stiffness: vec![50.0, 250.0],
        }
    }
}

impl Grid {
    /// All cells; k changes fastest, then ρ⁰max, μ and K^ag.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for &agent_stiffness in &self.agent_stiffness {
            for &viscosity in &self.viscosity {
                for &rest_density_max in &self.rest_density_max {
                    cells.extend(self.gas_constant.iter().map(|&gas_constant| Cell {
                        gas_constant,
                        rest_density_max,
                        viscosity,
                        agent_stiffness,
                    }));
                }
            }
        }
        cells
    }
}

impl Cell {
    /// The run with one seed.
    pub fn case(&self, seed: u64) -> Case {
        concert::case()
            .set("gas_constant", self.gas_constant)
            .set("rest_density_max", self.rest_density_max)
            .set("viscosity", self.viscosity)
            .set("agent_stiffness", self.agent_stiffness)
            .seed(seed)
    }
}

/// A quantity that is measured in every cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Speed of the arriving wave, m/s.
    Speed,
    /// Amplitude of the arriving wave in front of the stage, m/s.
    Amplitude,
    /// Amplitude of the returning wave over that of the arriving one, in front of the stage.
    Reflection,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 3] = [Self::Speed, Self::Amplitude, Self::Reflection];

    /// Its name and unit.
    pub fn label(self) -> &'static str {
        match self {
            Self::Speed => "wave speed [m/s]",
            Self::Amplitude => "amplitude [m/s]",
            Self::Reflection => "reflected / arriving",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed_m_per_s",
            Self::Amplitude => "amplitude_m_per_s",
            Self::Reflection => "reflection",
        }
    }
}

/// The result of one cell over its seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Result {
    /// The cell.
    pub cell: Cell,
    /// Number of runs with a wave.
    pub waves: usize,
    /// Number of runs.
    pub runs: usize,
    /// Mean and standard error over seeds; `None` with fewer than two waves.
    pub speed: Option<Estimate>,
    /// The same for the amplitude.
    pub amplitude: Option<Estimate>,
    /// The same for the reflection; `None` with fewer than two reflections.
    pub reflection: Option<Estimate>,
}

impl Result {
    /// The result of a cell from the diagrams of its runs.
    pub fn of<'a>(cell: Cell, diagrams: impl IntoIterator<Item = &'a SpaceTime>) -> Self {
        let waves: Vec<_> = diagrams
            .into_iter()
            .map(|diagram| wave::measure(diagram, &RUN))
            .collect();
        let over_seeds = |value: &dyn Fn(&wave::Wave) -> Option<f64>| {
            let values: Vec<f64> = waves.iter().flatten().filter_map(value).collect();
            // A single value has no standard error.
            (values.len() > 1).then(|| Estimate::of_mean(&values))?
        };
        Self {
            cell,
            waves: waves.iter().flatten().count(),
            runs: waves.len(),
            speed: over_seeds(&|wave| Some(wave.arriving.speed.value)),
            amplitude: over_seeds(&|wave| Some(wave.amplitude.value)),
            reflection: over_seeds(&|wave| wave.reflection.map(|r| r.value)),
        }
    }

    /// The estimate of one quantity.
    pub fn get(&self, quantity: Quantity) -> Option<Estimate> {
        match quantity {
            Quantity::Speed => self.speed,
            Quantity::Amplitude => self.amplitude,
            Quantity::Reflection => self.reflection,
        }
    }
}

/// All cells as CSV; values that do not exist are empty.
pub fn csv(results: &[Result]) -> String {
    let mut text = "gas_constant,rest_density_max,viscosity,agent_stiffness,runs,waves".to_owned();
    for quantity in Quantity::ALL {
        text += &format!(",{0},{0}_error", quantity.name());
    }
    text.push('\n');
    for result in results {
        let cell = result.cell;
        text += &format!(
            "{},{},{},{},{},{}",
            cell.gas_constant,
            cell.rest_density_max,
            cell.viscosity,
            cell.agent_stiffness,
            result.runs,
            result.waves
        );
        for quantity in Quantity::ALL {
            text += &result.get(quantity).map_or(",,".to_owned(), |estimate| {
                format!(",{:.4},{:.4}", estimate.value, estimate.error)
            });
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_is_one_cell() {
        let cells = Grid::default().cells();
        assert_eq!(cells.len(), 36);
        for (k, cell) in cells.iter().enumerate() {
            assert!(cells[..k].iter().all(|other| other != cell));
        }
    }

    #[test]
    fn a_cell_without_waves_is_empty_in_the_table() {
        let cell = Grid::default().cells()[0];
        let text = csv(&[Result::of(cell, [])]);
        assert!(text.ends_with("100,4,0,50,0,0,,,,,,\n"), "{text}");
    }
}

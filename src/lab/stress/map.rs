//! The points of the stability maps: every k and ρ⁰max, every K^ag, every μ; and other points that test the maps'
//! formula.

use super::rest::Rest;

/// k, ρ⁰max, K^ag and μ of points that the fit does not use: points between those of the maps, three points of the maps
/// with other agents, and stiff gas with stiff contact and with viscosity.
const HELD_OUT: [[f64; 4]; 27] = [
    [70.0, 3.5, 50.0, 0.0],
    [150.0, 6.5, 50.0, 0.0],
    [300.0, 4.5, 50.0, 0.0],
    [450.0, 7.5, 50.0, 0.0],
    [600.0, 5.5, 50.0, 0.0],
    [1100.0, 8.0, 50.0, 0.0],
    [200.0, 7.0, 50.0, 0.0],
    [400.0, 8.0, 50.0, 0.0],
    [1600.0, 7.0, 50.0, 0.0],
    [2300.0, 3.5, 50.0, 0.0],
    [4500.0, 7.5, 50.0, 0.0],
    [9000.0, 6.5, 50.0, 0.0],
    [200.0, 5.0, 25.0, 0.0],
    [200.0, 5.0, 300.0, 0.0],
    [200.0, 5.0, 3000.0, 0.0],
    [200.0, 5.0, 30_000.0, 0.0],
    [200.0, 5.0, 50.0, 15.0],
    [200.0, 5.0, 50.0, 27.0],
    [200.0, 5.0, 50.0, 85.0],
    [1600.0, 6.0, 1000.0, 0.0],
    [6400.0, 4.0, 10_000.0, 0.0],
    [800.0, 7.0, 200.0, 10.0],
    [3200.0, 5.0, 2000.0, 20.0],
    [100.0, 3.0, 5000.0, 5.0],
    [50.0, 8.0, 500.0, 50.0],
    [400.0, 6.0, 0.0, 35.0],
    [12_800.0, 8.0, 50_000.0, 100.0],
];

/// The resolution of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Detail {
    /// Few points and few bisections.
    pub quick: bool,
}

impl Detail {
    /// k, in increasing order.
    pub fn gas_constants(self) -> Vec<f64> {
        let every = if self.quick { 4 } else { 1 };
        (0..9)
            .step_by(every)
            .map(|k| 50.0 * f64::from(1 << k))
            .collect()
    }

    /// ρ⁰max, P/m², in increasing order.
    pub fn rest_densities(self) -> Vec<f64> {
        if self.quick {
            vec![3.0, 5.0, 8.0]
        } else {
            vec![3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
        }
    }

    /// K^ag, in increasing order.
    pub fn stiffnesses(self) -> Vec<f64> {
        if self.quick {
            vec![0.0, 1e3, 1e4]
        } else {
            vec![0.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4]
        }
    }

    /// μ, in increasing order.
    pub fn viscosities(self) -> Vec<f64> {
        if self.quick {
            vec![0.0, 5.0, 35.0]
        } else {
            vec![0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 35.0, 50.0, 70.0, 100.0]
        }
    }

    /// The crowds that the fit does not use.
    pub fn held_out(self) -> Vec<Rest> {
        let every = if self.quick { 7 } else { 1 };
        let places = HELD_OUT.into_iter().step_by(every);
        let crowd = |[gas_constant, rest_density_max, agent_stiffness, viscosity]: [f64; 4]| Rest {
            gas_constant,
            rest_density_max,
            agent_stiffness,
            viscosity,
        };
        places.map(crowd).collect()
    }

    /// All distinct crowds of the maps.
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

    /// The label of the hard case that is left out: the soak, or its shorter form.
    pub fn omitted_case(self) -> &'static str {
        if self.quick { "soak" } else { "short_soak" }
    }

    /// Number of bisections in the search for a step.
    pub fn bisections(self) -> u32 {
        if self.quick { 3 } else { 4 }
    }
}

//! Step 1B: density, personal rest density and pressure of one agent (§4.2, §4.3).

use crate::boundary::WallMethod;
use crate::frame::Frame;
use crate::math::Vector;

/// What an agent's SPH density and pressure depend on; one set for all profiles of a blend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphParameters {
    /// h, metres (§5.2).
    pub support_radius: f64,
    /// k (§5.5).
    pub gas_constant: f64,
    /// ρ⁰min, P/m² (§5.5).
    pub rest_density_min: f64,
    /// ρ⁰max, P/m² (§5.5).
    pub rest_density_max: f64,
    /// T^ρ, seconds (§5.5).
    pub averaging_time: f64,
}

impl Default for SphParameters {
    fn default() -> Self {
        Self {
            support_radius: 1.0,
            gas_constant: 200.0,
            rest_density_min: 0.0,
            rest_density_max: 5.0,
            averaging_time: 0.1,
        }
    }
}

impl SphParameters {
    /// Eq. 8: the moving average ρ̂, one step on.
    pub fn averaged(&self, mean_density: f64, density: f64, time_step: f64) -> f64 {
        let alpha = (time_step / self.averaging_time).min(1.0);
        (1.0 - alpha) * mean_density + alpha * density
    }

    /// ρ⁰: the moving average ρ̂ in its allowed range (§4.2).
    pub fn rest_density(&self, mean_density: f64) -> f64 {
        mean_density.clamp(self.rest_density_min, self.rest_density_max)
    }

    /// Eq. 5.
    pub fn pressure(&self, density: f64, rest_density: f64) -> f64 {
        self.gas_constant * (density - rest_density)
    }
}

/// Everything that step 1B knows of one agent; units as in [`Fields`](crate::frame::Fields).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphState {
    /// ρ_i.
    pub density: f64,
    /// The walls' part of it.
    pub density_from_walls: f64,
    /// ρ̂_i, one step on.
    pub mean_density: f64,
    /// ρ_i⁰ of the frame before.
    pub rest_density_before: f64,
    /// ρ_i⁰.
    pub rest_density: f64,
    /// p_i.
    pub pressure: f64,
    /// Σ_k ∫ ∇W over P_k.
    pub wall_gradient: Vector,
}

/// Eqs. 9, 10, 8 and 5, in this order, after the sum `from_agents` of Eq. 9 in P/m²; the walls use the
/// rest density of the frame before.
pub fn sph_state(
    frame: &Frame,
    i: usize,
    from_agents: f64,
    sph: &SphParameters,
    walls: WallMethod,
) -> SphState {
    let mean_before = if frame.agents.newcomer[i] {
        from_agents
    } else {
        frame.agents.mean_density[i]
    };
    let (mut kernel, mut wall_gradient) = (0.0, Vector::zeros());
    let near_walls = frame.neighbors.near_walls(i);
    if !near_walls.is_empty() {
        walls.shares(
            frame.walls,
            near_walls,
            frame.agents.position[i],
            sph.support_radius,
            |share| {
                kernel += share.kernel;
                wall_gradient += share.gradient;
            },
        );
    }
    let rest_density_before = sph.rest_density(mean_before);
    let density_from_walls = rest_density_before * kernel;
    let density = from_agents + density_from_walls;
    let mean_density = sph.averaged(mean_before, density, frame.clock.time_step());
    let rest_density = sph.rest_density(mean_density);
    SphState {
        density,
        density_from_walls,
        mean_density,
        rest_density_before,
        rest_density,
        pressure: sph.pressure(density, rest_density),
        wall_gradient,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_moving_average_forgets_at_the_rate_of_its_averaging_time() {
        let sph = SphParameters::default();
        let after = (0..5).fold(0.0, |mean, _| sph.averaged(mean, 1.0, 0.02));
        assert!((after - (1.0 - 0.8_f64.powi(5))).abs() < 1e-15);
        assert_eq!(sph.averaged(7.0, 3.0, 0.5), 3.0);
    }

    #[test]
    fn the_rest_density_is_clamped_and_the_pressure_changes_sign_there() {
        let sph = SphParameters::default();
        assert_eq!(sph.rest_density(7.0), 5.0);
        assert_eq!(sph.rest_density(-1.0), 0.0);
        assert_eq!(sph.pressure(4.0, 5.0), -200.0);
        assert_eq!(sph.pressure(5.5, 5.0), 100.0);
    }
}

//! Step 1B: density, personal rest density and pressure (§4.2, §4.3).

use crate::engine::boundary::WallMethod;
use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// Parameters of SPH density and pressure, shared by all profiles of a blend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphParameters {
    /// h, meters (§5.2).
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
    /// Eq. 8: the moving average ρ̂ after one step.
    pub fn averaged(&self, mean_density: f64, density: f64, time_step: f64) -> f64 {
        let alpha = (time_step / self.averaging_time).min(1.0);
        (1.0 - alpha) * mean_density + alpha * density
    }

    /// ρ⁰: the moving average ρ̂, clamped to its allowed range (§4.2).
    pub fn rest_density(&self, mean_density: f64) -> f64 {
        mean_density.clamp(self.rest_density_min, self.rest_density_max)
    }

    /// Eq. 5.
    pub fn pressure(&self, density: f64, rest_density: f64) -> f64 {
        self.gas_constant * (density - rest_density)
    }
}

/// Results of step 1B for consecutive agents; units as in [`Fields`](crate::engine::frame::Fields).
pub struct SphStates<'a> {
    /// Input: Eq. 9 without walls. Output: ρ_i.
    pub density: &'a mut [f64],
    /// The part of ρ_i from walls. Sorting resets it to zero, and it stays zero if no walls are near these agents
    /// (see [`Fields::forget_walls`](crate::engine::frame::Fields::forget_walls)).
    pub density_from_walls: &'a mut [f64],
    /// ρ̂_i after this step.
    pub mean_density: &'a mut [f64],
    /// ρ_i⁰.
    pub rest_density: &'a mut [f64],
    /// p_i.
    pub pressure: &'a mut [f64],
    /// Σ_k ∫ ∇W over P_k; reset to zero like `density_from_walls`.
    pub wall_gradient: &'a mut [Vector],
}

/// ρ̂ of the previous frame, P/m²; for a newcomer, the sum `from_agents` of Eq. 9.
pub fn mean_density_before(frame: &Frame, i: usize, from_agents: f64) -> f64 {
    if frame.agents.newcomer[i] {
        from_agents
    } else {
        frame.agents.mean_density[i]
    }
}

impl SphStates<'_> {
    /// Eqs. 9, 10, 8 and 5, in this order, for agents `from` and up, `dt` seconds after the moving average was last
    /// stored. Walls use the rest density of the previous frame. `sph` holds the parameters if all these agents
    /// share them, and `sph_of` returns those of one agent.
    pub fn update<'s>(
        &mut self,
        frame: &Frame,
        dt: f64,
        from: usize,
        walls: WallMethod,
        sph: Option<SphParameters>,
        sph_of: impl Fn(usize) -> &'s SphParameters,
    ) {
        let walled = self.see_walls(frame, from, walls, &sph_of);
        let to = from + self.density.len();
        let newcomer = &frame.agents.newcomer[from..to];
        let before = &frame.agents.mean_density[from..to];
        for k in 0..to - from {
            let sph = sph.unwrap_or_else(|| *sph_of(from + k));
            let before = if newcomer[k] {
                self.density[k]
            } else {
                before[k]
            };
            let mut density = self.density[k];
            if walled {
                self.density_from_walls[k] *= sph.rest_density(before);
                density += self.density_from_walls[k];
            }
            let mean_density = sph.averaged(before, density, dt);
            let rest_density = sph.rest_density(mean_density);
            self.density[k] = density;
            self.mean_density[k] = mean_density;
            self.rest_density[k] = rest_density;
            self.pressure[k] = sph.pressure(density, rest_density);
        }
    }

    /// Stores Σ_k ∫ W over P_k in `density_from_walls` and Σ_k ∫ ∇W in `wall_gradient`. Does nothing and returns
    /// `false` if no walls are near.
    fn see_walls<'s>(
        &mut self,
        frame: &Frame,
        from: usize,
        walls: WallMethod,
        sph_of: impl Fn(usize) -> &'s SphParameters,
    ) -> bool {
        let agents = from..from + self.density.len();
        let mut near_walls = frame.neighbors.agents_near_walls(agents).peekable();
        if near_walls.peek().is_none() {
            return false;
        }
        self.density_from_walls.fill(0.0);
        self.wall_gradient.fill(Vector::zeros());
        for (i, near) in near_walls {
            let (r_i, h) = (frame.agents.position[i], sph_of(i).support_radius);
            walls.shares(frame.walls, near, r_i, h, |share| {
                self.density_from_walls[i - from] += share.kernel;
                self.wall_gradient[i - from] += share.gradient;
            });
        }
        true
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

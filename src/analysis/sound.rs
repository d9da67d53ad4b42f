//! Linear theory: the speed of a small disturbance in a uniform dense crowd.
//!
//! Let a crowd be at rest at a density ρ₀ above ρ⁰max, so that ρ⁰ = ρ⁰max is constant. A small displacement
//! u(x, t) is applied. Eq. 11 divided by ρ_i is −1/ρ_i Σ_j m_j/ρ_j · ½(p_i + p_j) ∇W(r_ij). To first order:
//!
//! - δp_i multiplies Σ_j m_j/ρ_j ∇W, which is zero around every agent inside a uniform crowd: half of the pressure
//!   has no effect.
//! - δp_j gives −(1/2ρ₀) ∇δp for waves much longer than h, because the potential of Eq. 14 integrates to 1, and
//!   δp = k δρ = −k ρ₀ ∇·u by Eqs. 5 and 9.
//! - The base pressure p₀ enters through δ(m_j/ρ_j) and through δ∇W, with opposite signs. For long waves the two
//!   cancel.
//!
//! So ü = (k/2) ∇(∇·u): c² = k/2 at any density, half of ∂p/∂ρ. Discs in contact add springs (Eq. 22):
//! c² = k/2 + K^ag M, with the contact modulus M = ½ Σ_j r_ij² cos⁴θ_ij/m_i over the discs in contact, minus a small
//! correction for their overlap. M = (9/8) d² on a hexagonal lattice whose discs just touch at distance d, and
//! M = (3/16) z d² for z isotropic contacts per agent.

use engine::math::Vector;
use engine::scene::Region;
use engine::simulation::Simulation;

/// c in m/s for waves much longer than h, without contacts.
pub fn speed_of_fluid(gas_constant: f64) -> f64 {
    (gas_constant / 2.0).sqrt()
}

/// c in m/s with contacts; `modulus` is M in m².
pub fn speed_with_contacts(gas_constant: f64, agent_stiffness: f64, modulus: f64) -> f64 {
    (gas_constant / 2.0 + agent_stiffness * modulus).sqrt()
}

/// M in m² of a hexagonal lattice whose discs, of mass 1, just touch at `distance` meters.
pub fn touching_modulus(distance: f64) -> f64 {
    9.0 / 8.0 * distance * distance
}

/// Contacts in the current frame of a crowd.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Contacts {
    /// M in m² along the x axis, averaged over all agents.
    pub modulus: f64,
    /// Mean number of contacts per agent.
    pub per_agent: f64,
    /// The mean SPH density, P/m²; `None` in a frame without densities.
    pub density: Option<f64>,
}

/// The contacts of all agents in a region; `None` if the region is empty. The neighbor lists of the frame must
/// extend to the largest contact distance.
pub fn contacts(simulation: &Simulation, region: &Region) -> Option<Contacts> {
    let frame = simulation.frame();
    let agents = frame.agents;
    let radius = |i: usize| agents.radius[i] * simulation.blend(i).reach().contact_scale;
    let found = (0..agents.len()).filter(|&i| region.contains(agents.position[i]));
    let inside: Vec<usize> = found.collect();
    let count = inside.len() as f64;
    let (mut modulus, mut touching) = (0.0, 0usize);
    let widest = (0..agents.len()).map(&radius).fold(0.0, f64::max);
    for &i in &inside {
        for (j, r_ij) in frame.near(i, radius(i) + widest) {
            let reach = radius(i) + radius(j);
            if r_ij.norm() < reach {
                modulus += 0.5 * stiffness(r_ij, reach) * r_ij.x * r_ij.x / agents.mass[i];
                touching += 1;
            }
        }
    }
    let densities = &frame.fields.density;
    (count > 0.0).then(|| Contacts {
        modulus: modulus / count,
        per_agent: touching as f64 / count,
        density: (!densities.is_empty())
            .then(|| inside.iter().map(|&i| densities[i]).sum::<f64>() / count),
    })
}

/// −∂f_x/∂x of Eq. 22, divided by K^ag, for discs in contact: cos²θ − (overlap/r) sin²θ.
pub fn stiffness(r: Vector, reach: f64) -> f64 {
    let distance = r.norm();
    let along = (r.x / distance).powi(2);
    along - (reach / distance - 1.0) * (1.0 - along)
}

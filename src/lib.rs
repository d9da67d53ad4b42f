//! A research sandbox for dense crowds: simulation, measurement and inspection of people at up to ten
//! per square meter.
//!
//! It implements *SPH crowds: Agent-based crowd simulation up to extreme densities using fluid
//! dynamics* (van Toll, Chatagnon, Braga, Solenthaler, Pettré, Computers & Graphics 2021,
//! doi 10.1016/j.cag.2021.06.005): agents that are also fluid particles. Section and equation numbers
//! in these docs are that paper's. SI units; mass is dimensionless, 1 = an average person, so a density
//! is in persons per square meter, P/m².
//!
//! | paper | here | | paper | here |
//! |---|---|---|---|---|
//! | O_k | [`Wall`](engine::geometry::Wall) | | K^goal, K^ag, K^obs | `goal_scale`, `agent_stiffness`, `wall_stiffness` |
//! | D_i | `radius` | | V₀, σ / U₀, R | `agent_strength`, `agent_range` / `wall_strength`, `wall_range` |
//! | h | `support_radius` | | T^ρ, T, τ | `averaging_time`, `anticipation_time`, `relaxation_time` |
//! | ρ, ρ̂, ρ⁰ | `density`, `mean_density`, `rest_density` | | Δt_fine, Δt_coarse | `time_step`, `coarse_every` (frames) |
//! | k, μ | `gas_constant`, `viscosity` | | r_k*, r_k^o | `nearest_point`, `representative_point` |
//! | Π, {(Π, ρ)} | [`Profile`](engine::profile::Profile), [`Blend`](engine::profile::Blend) | | P_k, a(P_k) | [`HiddenRegion`](engine::geometry::HiddenRegion), `hidden_area` |
//! | w | `collision_weight` | | v^pref, s_pref, s_max | `preferred_velocity`, `preferred_speed`, `max_speed` |
//!
//! The code has seven wings, one module each. A wing uses only the wings above it in this list, and a module uses only
//! the modules above it in its wing (except in `scenario` and `cli`); `tests/architecture.rs` checks both.
//! `docs/architecture.md` describes the loop, the path from a scenario file to a recording, and recipes for extensions.

#![warn(missing_docs, clippy::unwrap_used)]

pub use sandbox_scenario::{analysis, engine, runs, scenario};

#[cfg(feature = "program")]
pub mod output;

#[cfg(feature = "program")]
pub mod lab;

#[cfg(feature = "program")]
pub mod cli;

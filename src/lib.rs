//! A research sandbox for dense crowds: simulation, measurement and inspection of people at up to ten
//! per square metre.
//!
//! It implements *SPH crowds: Agent-based crowd simulation up to extreme densities using fluid
//! dynamics* (van Toll, Chatagnon, Braga, Solenthaler, Pettré, Computers & Graphics 2021,
//! doi 10.1016/j.cag.2021.06.005): agents that are also fluid particles. Section and equation numbers
//! in these docs are that paper's. SI units; mass is dimensionless, 1 = an average person, so a density
//! is in persons per square metre, P/m².
//!
//! | paper | here | | paper | here |
//! |---|---|---|---|---|
//! | O_k | [`geometry::Wall`] | | K^goal, K^ag, K^obs | `goal_scale`, `agent_stiffness`, `wall_stiffness` |
//! | D_i | `radius` | | V₀, σ / U₀, R | `agent_strength`, `agent_range` / `wall_strength`, `wall_range` |
//! | h | `support_radius` | | T^ρ, T, τ | `averaging_time`, `anticipation_time`, `relaxation_time` |
//! | ρ, ρ̂, ρ⁰ | `density`, `mean_density`, `rest_density` | | Δt_fine, Δt_coarse | `time_step`, `coarse_every` (frames) |
//! | k, μ | `gas_constant`, `viscosity` | | r_k*, r_k^o | `nearest_point`, `representative_point` |
//! | Π, {(Π, ρ)} | [`profile::Profile`], [`profile::Blend`] | | P_k, a(P_k) | [`geometry::HiddenRegion`], `hidden_area` |
//! | w | `collision_weight` | | v^pref, s_pref, s_max | `preferred_velocity`, `preferred_speed`, `max_speed` |
//!
//! Modules use only what stands above them here.

#![warn(missing_docs, clippy::unwrap_used)]

pub mod math;

pub mod random;

pub mod quote;

pub mod input;

pub mod geometry;

pub mod floor_plan;

pub mod kernel;

pub mod clock;

pub mod agents;

pub mod neighbors;

pub mod pairs;

pub mod boundary;

pub mod frame;

pub mod density;

pub mod forces;

pub mod profile;

pub mod catalog;

pub mod placement;

pub mod scene;

pub mod sound;

pub mod stability;

pub mod simulation;

pub mod metrics;

pub mod breakdown;

pub mod scenario;

pub mod drive;

pub mod outputs;

pub mod checkpoint;

pub mod summary;

pub mod statistics;

pub mod wave;

pub mod table;

#[cfg(any(feature = "recording", feature = "plot"))]
pub mod colors;

#[cfg(feature = "recording")]
pub mod recording;

#[cfg(feature = "trajectory")]
pub mod trajectory;

#[cfg(feature = "plot")]
pub mod plot;

#[cfg(feature = "trajectory")]
pub mod measure;

pub mod reproduce;

pub mod job;

pub mod sweep;

#[cfg(feature = "bench")]
pub mod bench;

pub mod stress;

#[cfg(feature = "bench")]
pub mod accuracy;

#[cfg(feature = "cli")]
pub mod cli;

//! A research sandbox for dense crowds: simulation, measurement and inspection of people at up to ten
//! per square meter.
//!
//! It implements *SPH crowds: Agent-based crowd simulation up to extreme densities using fluid
//! dynamics* (van Toll, Chatagnon, Braga, Solenthaler, Pettré, Computers & Graphics 2021,
//! doi 10.1016/j.cag.2021.06.005): agents that are also fluid particles. Section and equation numbers
//! in these docs are that paper's. SI units; mass is dimensionless, 1 = an average person, so a density
//! is in persons per square meter, P/m².
//!
//! Fifty people who start close together:
//!
//! ```
//! use sandbox::prelude::*;
//!
//! let mut scene = Scene::default();
//! let sph = catalog::named("sph", &Parameters::default())?;
//! let crowd = scene.add_group(Group::new("crowd", sph));
//! let goal = Vector::new(20.0, 0.0);
//! for k in 0..50 {
//!     let place = Vector::new(0.4 * f64::from(k % 10), 0.4 * f64::from(k / 10));
//!     scene.agents.push(NewAgent::at(place, goal, crowd));
//! }
//! let mut simulation = Simulation::new(scene)?;
//! while simulation.frame().clock.time() < 2.0 {
//!     simulation.step()?;
//! }
//! let density = &simulation.evaluate()?.fields.density;
//! println!("{:.2} P/m² at most", density.iter().copied().fold(0.0, f64::max));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Scenario::load`](scenario::Scenario::load) reads the same from a file, and [`Run`](runs::drive::Run) simulates it
//! to its end. The folder `examples/` has a crowd behind a pillar and a force from outside the crate.
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
//! The code has ten layers: the crates common, engine, analysis, scenario, runs, figures, output, lab and studio, and
//! the module cli. A layer uses only those before it in this list, and a module uses only the modules above it in its
//! crate; the compiler and `tests/architecture.rs` check this.
//! `docs/reference/architecture.md` describes the loop and the path from a scenario file to a recording, and
//! `docs/reference/extending.md` has recipes for extensions.

#![warn(missing_docs, clippy::unwrap_used)]

pub use {engine, runs, scenario};

#[cfg(feature = "program")]
pub use output;

// Public only because the tests, the experiments, the Python package and `main.rs` are crates of their own.
#[doc(hidden)]
pub use analysis;
#[cfg(feature = "program")]
#[doc(hidden)]
pub use lab;

#[cfg(feature = "program")]
#[doc(hidden)]
pub mod cli;

/// What most users of the library need: `use sandbox::prelude::*;`.
pub mod prelude {
    pub use crate::engine::agents::NewAgent;
    pub use crate::engine::breakdown::Breakdown;
    pub use crate::engine::clock::Clock;
    pub use crate::engine::forces::model::{Gives, Model, OwnModel};
    pub use crate::engine::forces::own::Force;
    pub use crate::engine::forces::rates::{Extremes, Rates};
    pub use crate::engine::frame::Frame;
    pub use crate::engine::geometry::Polygon;
    pub use crate::engine::math::Vector;
    pub use crate::engine::placement::Grid;
    pub use crate::engine::profile::{Blend, BlendStep, Navigation, Profile};
    pub use crate::engine::scene::{Action, Group, Integrator, Intervention, Region, Scene};
    pub use crate::engine::simulation::{ActionError, Added, Fault, Outcome, Simulation};
    pub use crate::runs::drive::{End, Observer, Run};
    pub use crate::scenario::catalog::{self, Parameters};
    pub use crate::scenario::{Scenario, ScenarioError, Setting};
}

//! Walls in SPH: what each way of seeing them makes of density and force, beside the exact integrals.
//!
//! For an agent at r_i the walls' density is ρ_i⁰ ∫ W and their force −p_i ∫ ∇W (Eqs. 10 and 12),
//! over one of two [`Region`]s: what the walls *hide* (the paper's P_k together, counted once) or
//! the *solid* itself. The engine's methods mean the first. Boundary particles and volume maps, which
//! the paper argues against (§3.4) and which live here alone, mean the second, but for Akinci's
//! particles, whose volumes make a body of every wall. Each is measured against what it means; how
//! far the two are apart is a finding of its own.

mod case;
mod integrals;
mod map;
mod measure;
mod method;
mod particles;
mod pictures;
mod report;
mod timing;

pub use case::{Case, Place, cases};
pub use integrals::{Integrals, Region};
pub use map::{Map, Stored};
pub use measure::{CaseReport, Error, MethodReport, WallReport, measure};
pub use method::{METHODS, Method, Prepared};
pub use particles::{Particles, Volumes};

/// h of the paper's experiments (§5.2), metres.
pub const SUPPORT_RADIUS: f64 = 1.0;

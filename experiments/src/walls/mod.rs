//! Walls in SPH: the density and force of each method of including them, compared with the exact integrals.
//!
//! For an agent at r_i the walls' density is ρ_i⁰ ∫ W and their force −p_i ∫ ∇W (Eqs. 10 and 12), over one of two
//! [`Region`]s: the region that the walls *hide* (the union of the paper's P_k, counted once), or the *solid* itself.
//! The engine's methods integrate over the hidden region. Boundary particles and volume maps, which the paper argues
//! against (§3.4) and which exist only here, integrate over the solid. Akinci's particles are an exception: their
//! volumes make a solid body of every wall, so they count as a method for the hidden region. Each method is measured
//! against its region. The difference between the two regions is reported separately.

mod case;
mod integrals;
mod map;
mod measure;
mod method;
mod particles;
mod pictures;
mod report;

pub use case::{Case, Place, cases};
pub use integrals::{Integrals, Region};
pub use map::{Map, Stored};
pub use measure::{CaseReport, Error, MethodReport, WallReport, measure};
pub use method::{METHODS, Method, Prepared};
pub use particles::{Particles, Volumes};

/// A description, in one line.
pub const ABOUT: &str =
    "density and force of five ways to treat walls, compared with the exact integrals";
/// The name of the tables in a document.
pub const TABLES: &str = "wall-integrals";
/// The name of the files.
pub const NAME: &str = "walls";

/// h of the paper's experiments (§5.2), meters.
pub const SUPPORT_RADIUS: f64 = 1.0;

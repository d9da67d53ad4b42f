//! Limits of parameters, far beyond all that makes sense: numbers stay finite within them.

/// The largest strength or stiffness.
pub const STRONGEST: f64 = 1e9;
/// The highest density, P/m².
pub const HIGHEST_DENSITY: f64 = 1000.0;
/// The longest range of a force, meters.
pub const FARTHEST: f64 = 100.0;

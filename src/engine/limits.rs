//! Limits of parameters, far beyond all that makes sense: numbers stay finite within them.

/// The largest strength or stiffness.
pub const STRONGEST: f64 = 1e9;
/// The highest speed that agents can want, m/s.
pub const FASTEST: f64 = 100.0;
/// The most agents per second at an exit or entrance.
pub const MOST_PER_SEC: f64 = 1e4;
/// The factors of zones on preferred speeds.
pub const SPEED_FACTORS: [f64; 2] = [0.01, 10.0];
/// The highest density, P/m².
pub const HIGHEST_DENSITY: f64 = 1000.0;
/// The longest range of a force, meters.
pub const FARTHEST: f64 = 100.0;

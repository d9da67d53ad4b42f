//! The paper's tables and figures (§6), regenerated.

pub mod concert;
#[cfg(feature = "plot")]
pub mod figures;
pub mod snapshot;
pub mod study;

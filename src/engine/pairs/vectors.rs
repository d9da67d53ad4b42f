//! Which vectors the processor has.

use std::fmt;

use fearless_simd::{Level, Simd, dispatch, prelude::*};

use super::real::LANES;

/// The vectors that sums over pairs are taken in, chosen when the program runs.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Vectors {
    /// The instructions, for example AVX2.
    pub level: String,
    /// Single-precision numbers in a vector; more than [`LANES`] are never used.
    pub lanes: usize,
}

impl Vectors {
    /// Those of this processor.
    pub fn here() -> Self {
        let level = Level::new();
        // The name of the variant: Avx2(…), Sse4_2(…).
        let name = format!("{level:?}");
        let name = name.split('(').next().unwrap_or_default();
        Self {
            level: name.to_uppercase().replace('_', "."),
            lanes: dispatch!(level, simd => lanes(simd)).min(LANES),
        }
    }
}

impl fmt::Display for Vectors {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}, {} × f32", self.level, self.lanes)
    }
}

#[inline(always)]
fn lanes<S: Simd>(_: S) -> usize {
    S::f32s::LEN
}

//! The SIMD vectors of the processor.

use std::fmt;

use fearless_simd::{Level, Simd, dispatch, prelude::*};

use super::real::LANES;

/// The SIMD vectors used for sums over pairs, chosen at run time.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Vectors {
    /// The instruction set, for example AVX2.
    pub level: String,
    /// The single-precision numbers in a vector, at most [`LANES`].
    pub lanes: usize,
}

impl Vectors {
    /// The vectors of this processor.
    pub fn here() -> Self {
        let level = Level::new();
        // Debug prints the variant: Avx2(…), Sse4_2(…).
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

//! The SIMD vectors of the processor.

use std::fmt;
use std::sync::LazyLock;

use fearless_simd::{Level, Simd, dispatch, prelude::*};

use super::real::LANES;

/// The environment variable that names the vectors to use in place of the longest that the processor has. Results are
/// the same to the last bit: it shows this, and how much faster longer vectors are.
pub const VARIABLE: &str = "SANDBOX_VECTORS";

/// The vectors to use, or why those that [`VARIABLE`] names cannot be used.
static CHOSEN: LazyLock<Result<Level, String>> = LazyLock::new(|| match std::env::var(VARIABLE) {
    Ok(name) => named(&name),
    Err(_) => Ok(Level::new()),
});

/// The vectors that all loops of the engine use.
#[inline]
pub fn level() -> Level {
    match &*CHOSEN {
        Ok(level) => *level,
        Err(_) => Level::new(),
    }
}

/// The vectors of this processor, the longest last.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let all = [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let all = [Some(best)];
    all.into_iter().flatten().collect()
}

fn named(name: &str) -> Result<Level, String> {
    let is_meant = |level: &&Level| name_of(**level).eq_ignore_ascii_case(name);
    let levels = levels();
    let found = levels.iter().find(is_meant).copied();
    found.ok_or_else(|| {
        let names: Vec<String> = levels.iter().map(|&level| name_of(level)).collect();
        format!(
            "{VARIABLE}: this processor has {}, not {name:?}",
            names.join(", ")
        )
    })
}

/// The name of an instruction set, for example AVX2.
fn name_of(level: Level) -> String {
    // Debug prints the variant: Avx2(…), Sse4_2(…).
    let name = format!("{level:?}");
    let name = name.split('(').next().unwrap_or_default();
    name.to_uppercase().replace('_', ".")
}

/// The SIMD vectors used for sums over pairs, chosen at run time.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Vectors {
    /// The instruction set, for example AVX2.
    pub level: String,
    /// The single-precision numbers in a vector, at most [`LANES`].
    pub lanes: usize,
}

impl Vectors {
    /// The vectors in use.
    pub fn here() -> Self {
        Self {
            level: name_of(level()),
            lanes: dispatch!(level(), simd => lanes(simd)).min(LANES),
        }
    }

    /// The names of all vectors that this processor has, the longest last.
    pub fn all() -> Vec<String> {
        levels().into_iter().map(name_of).collect()
    }

    /// Checks that [`VARIABLE`], if it is set, names vectors that this processor has.
    ///
    /// # Errors
    /// It does not; those of the processor would be used.
    pub fn check() -> Result<(), String> {
        CHOSEN.clone().map(|_| ())
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

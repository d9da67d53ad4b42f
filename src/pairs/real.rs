//! The numbers that sums over pairs are taken in.

use fearless_simd::{Simd, f32x8, f64x8, i32x8, prelude::*};

/// Neighbours that are looked at together. The same on every processor, and so are the bits.
pub const LANES: usize = 8;

/// A number for sums over pairs, and how it holds coordinates.
pub trait Real: SimdFloatElement + Copy + Default + Send + Sync + 'static {
    /// A coordinate; only differences of near ones mean anything.
    type Coordinate: Copy + Default + Send + Sync + 'static;
    /// [`LANES`] numbers.
    type Lanes<S: Simd>: SimdFloat<S, Element = Self>;

    /// A squared distance (in units of h²) that divides without overflow, far below all real ones.
    const TINY: f64;

    /// The nearest number.
    fn of(value: f64) -> Self;

    /// The number as it is.
    fn double(self) -> f64;

    /// `metres` in units of `unit` metres.
    fn coordinate(metres: f64, unit: f64) -> Self::Coordinate;

    /// `from` minus each of the first [`LANES`] of `to`.
    fn differences<S: Simd>(
        simd: S,
        from: Self::Coordinate,
        to: &[Self::Coordinate],
    ) -> Self::Lanes<S>;
}

impl Real for f64 {
    type Coordinate = f64;
    type Lanes<S: Simd> = f64x8<S>;

    const TINY: f64 = 1e-200;

    fn of(value: f64) -> Self {
        value
    }

    fn double(self) -> f64 {
        self
    }

    fn coordinate(metres: f64, unit: f64) -> f64 {
        metres / unit
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, from: f64, to: &[f64]) -> f64x8<S> {
        f64x8::splat(simd, from) - f64x8::from_slice(simd, to)
    }
}

/// Coordinates are whole numbers modulo 2³²: differences are exact wherever in the plane they are
/// taken, as long as they are shorter than 2³¹ units.
impl Real for f32 {
    type Coordinate = i32;
    type Lanes<S: Simd> = f32x8<S>;

    const TINY: f64 = 1e-30;

    fn of(value: f64) -> Self {
        value as f32
    }

    fn double(self) -> f64 {
        f64::from(self)
    }

    fn coordinate(metres: f64, unit: f64) -> i32 {
        (metres / unit) as i64 as i32
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, from: i32, to: &[i32]) -> f32x8<S> {
        (i32x8::splat(simd, from) - i32x8::from_slice(simd, to)).to_float()
    }
}

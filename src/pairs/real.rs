//! The numbers that sums over pairs are taken in.

use fearless_simd::{Simd, f32x8, f64x8, i32x8, prelude::*};

/// Agents whose sums are taken together: a cluster, on every processor.
pub const LANES: usize = crate::neighbors::CLUSTER;

/// A number for sums over pairs, and how it holds coordinates.
pub trait Real: SimdFloatElement + Copy + Default + Send + Sync + 'static {
    /// A coordinate; only differences of near ones mean anything.
    type Coordinate: Copy + Default + Send + Sync + 'static;
    /// [`LANES`] numbers.
    type Lanes<S: Simd>: SimdFloat<S, Element = Self>;
    /// [`LANES`] coordinates.
    type Places<S: Simd>: Copy;

    /// A squared distance in units² that divides without overflow, far below all real ones.
    const TINY: f64;

    /// The nearest number.
    fn of(value: f64) -> Self;

    /// The number as it is.
    fn double(self) -> f64;

    /// `metres` in units, of which there are `per_metre` in a metre.
    fn coordinate(metres: f64, per_metre: f64) -> Self::Coordinate;

    /// The first [`LANES`] of `places`.
    fn places<S: Simd>(simd: S, places: &[Self::Coordinate]) -> Self::Places<S>;

    /// Each of `from`, minus `to`.
    fn differences<S: Simd>(simd: S, from: Self::Places<S>, to: Self::Coordinate)
    -> Self::Lanes<S>;
}

impl Real for f64 {
    type Coordinate = f64;
    type Lanes<S: Simd> = f64x8<S>;
    type Places<S: Simd> = f64x8<S>;

    const TINY: f64 = 1e-200;

    fn of(value: f64) -> Self {
        value
    }

    fn double(self) -> f64 {
        self
    }

    fn coordinate(metres: f64, per_metre: f64) -> f64 {
        metres * per_metre
    }

    #[inline(always)]
    fn places<S: Simd>(simd: S, places: &[f64]) -> f64x8<S> {
        f64x8::from_slice(simd, &places[..LANES])
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, from: f64x8<S>, to: f64) -> f64x8<S> {
        from - f64x8::splat(simd, to)
    }
}

/// Coordinates are whole numbers modulo 2³²: differences are exact wherever in the plane they are
/// taken, as long as they are shorter than 2³¹ units, and longer ones wrap.
impl Real for f32 {
    type Coordinate = i32;
    type Lanes<S: Simd> = f32x8<S>;
    type Places<S: Simd> = i32x8<S>;

    const TINY: f64 = 1e-6;

    fn of(value: f64) -> Self {
        value as f32
    }

    fn double(self) -> f64 {
        f64::from(self)
    }

    fn coordinate(metres: f64, per_metre: f64) -> i32 {
        (metres * per_metre) as i64 as i32
    }

    #[inline(always)]
    fn places<S: Simd>(simd: S, places: &[i32]) -> i32x8<S> {
        i32x8::from_slice(simd, &places[..LANES])
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, from: i32x8<S>, to: i32) -> f32x8<S> {
        (from - i32x8::splat(simd, to)).to_float()
    }
}

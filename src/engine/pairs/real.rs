//! Number types for sums over pairs.

use std::fmt::Debug;

use fearless_simd::{Simd, f32x8, f64x8, i32x8, prelude::*};

use crate::math::{Vector, greatest};

/// The number of agents whose sums are computed together: one cluster, on every processor.
pub const LANES: usize = crate::neighbors::CLUSTER;

/// [`LANES`] numbers of type `R`.
pub type Lanes<R, S> = <R as Real>::Lanes<S>;

/// The result of a comparison of [`Lanes`].
pub type Mask<R, S> = <Lanes<R, S> as SimdBase<S>>::Mask;

/// A number type for sums over pairs, with its representation of coordinates.
pub trait Real: SimdFloatElement + Into<f64> + Copy + Default + Send + Sync + 'static {
    /// A coordinate; only differences between near coordinates are meaningful.
    type Coordinate: SimdElement + Copy + Debug + Default + Send + Sync + 'static;
    /// [`LANES`] numbers.
    type Lanes<S: Simd>: SimdFloat<S, Element = Self>;
    /// [`LANES`] coordinates.
    type Places<S: Simd>: SimdBase<S, Element = Self::Coordinate, Mask = Mask<Self, S>>;

    /// Lower bound to which squared distances are clamped, in units²: far below real distances, but large enough to
    /// divide by.
    const TINY: f64;

    /// The number nearest to `value`.
    fn of(value: f64) -> Self;

    /// `meters` in coordinate units, `per_meter` of which make a meter.
    fn coordinate(meters: f64, per_meter: f64) -> Self::Coordinate;

    /// The [`coordinate`](Self::coordinate)s of some points along x and along y.
    #[inline(always)]
    fn coordinates(points: &[Vector], per_meter: f64, [x, y]: [&mut [Self::Coordinate]; 2]) {
        for ((x, y), point) in x.iter_mut().zip(y).zip(points) {
            *x = Self::coordinate(point.x, per_meter);
            *y = Self::coordinate(point.y, per_meter);
        }
    }

    /// Loads the first [`LANES`] coordinates of `places`.
    #[inline(always)]
    fn places<S: Simd>(simd: S, places: &[Self::Coordinate]) -> Self::Places<S> {
        Self::Places::from_slice(simd, &places[..LANES])
    }

    /// Each coordinate of `places` minus `times` times `way`.
    fn moved<S: Simd>(
        simd: S,
        places: Self::Places<S>,
        way: Self::Coordinate,
        times: i32,
    ) -> Self::Places<S>;

    /// `place` in all lanes.
    #[inline(always)]
    fn place<S: Simd>(simd: S, place: Self::Coordinate) -> Self::Places<S> {
        Self::Places::splat(simd, place)
    }

    /// Writes the `kept` coordinates of `places`, side by side, then zeros.
    #[inline(always)]
    fn store_kept<S: Simd>(
        places: Self::Places<S>,
        kept: Mask<Self, S>,
        out: &mut [Self::Coordinate],
    ) {
        places.compress(kept).store_slice(out);
    }

    /// Each coordinate of `from` minus `to`.
    #[inline(always)]
    fn differences<S: Simd>(
        simd: S,
        from: Self::Places<S>,
        to: Self::Coordinate,
    ) -> Self::Lanes<S> {
        Self::between(from, Self::place(simd, to))
    }

    /// Each coordinate of `from` minus that of `to`.
    fn between<S: Simd>(from: Self::Places<S>, to: Self::Places<S>) -> Self::Lanes<S>;

    /// 2ˣ for x ≤ 0; results below 2⁻¹²⁶ may be clamped to it.
    fn exp2<S: Simd>(simd: S, x: Self::Lanes<S>) -> Self::Lanes<S>;

    /// [`exp2`](Self::exp2) of both, in one vector if the processor has one that is as long.
    #[inline(always)]
    fn exp2_of_both<S: Simd>(simd: S, [x, y]: [Self::Lanes<S>; 2]) -> [Self::Lanes<S>; 2] {
        [Self::exp2(simd, x), Self::exp2(simd, y)]
    }
}

impl Real for f64 {
    type Coordinate = f64;
    type Lanes<S: Simd> = f64x8<S>;
    type Places<S: Simd> = f64x8<S>;

    const TINY: f64 = 1e-200;

    fn of(value: f64) -> Self {
        value
    }

    fn coordinate(meters: f64, per_meter: f64) -> f64 {
        meters * per_meter
    }

    #[inline(always)]
    fn moved<S: Simd>(simd: S, places: f64x8<S>, way: f64, times: i32) -> f64x8<S> {
        places - f64x8::splat(simd, way * f64::from(times))
    }

    #[inline(always)]
    fn between<S: Simd>(from: f64x8<S>, to: f64x8<S>) -> f64x8<S> {
        from - to
    }

    #[inline(always)]
    fn exp2<S: Simd>(simd: S, x: f64x8<S>) -> f64x8<S> {
        f64x8::from_fn(simd, |lane| libm::exp2(x[lane]))
    }
}

/// Coordinates are integers modulo 2³². Anywhere in the plane, differences shorter than 2³¹ units are exact before
/// they are rounded to single precision; longer differences wrap.
impl Real for f32 {
    type Coordinate = i32;
    type Lanes<S: Simd> = f32x8<S>;
    type Places<S: Simd> = i32x8<S>;

    const TINY: f64 = 1e-6;

    fn of(value: f64) -> Self {
        value as f32
    }

    fn coordinate(meters: f64, per_meter: f64) -> i32 {
        (meters * per_meter) as i64 as i32
    }

    /// Near the origin, adding 1.5 · 2⁵² moves the whole part to the low bits: vectors have no conversion of doubles to
    /// 64-bit integers.
    #[inline(always)]
    fn coordinates(points: &[Vector], per_meter: f64, [x, y]: [&mut [i32]; 2]) {
        const SHIFT: f64 = 1.5 * (1_u64 << 52) as f64;
        const NEAR: f64 = (1_u64 << 51) as f64;
        let whole = |meters: f64| ((meters * per_meter).trunc() + SHIFT).to_bits() as i32;
        let farthest = greatest(points, |p| p.x.abs().max(p.y.abs()));
        let is_near = farthest * per_meter < NEAR;
        let coordinate = |meters| match is_near {
            true => whole(meters),
            false => Self::coordinate(meters, per_meter),
        };
        for ((x, y), point) in x.iter_mut().zip(y).zip(points) {
            (*x, *y) = (coordinate(point.x), coordinate(point.y));
        }
    }

    #[inline(always)]
    fn moved<S: Simd>(simd: S, places: i32x8<S>, way: i32, times: i32) -> i32x8<S> {
        places - i32x8::splat(simd, way.wrapping_mul(times))
    }

    #[inline(always)]
    fn between<S: Simd>(from: i32x8<S>, to: i32x8<S>) -> f32x8<S> {
        (from - to).to_float()
    }

    #[inline(always)]
    fn exp2<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
        exp2(simd, x)
    }

    #[inline(always)]
    fn exp2_of_both<S: Simd>(simd: S, [x, y]: [f32x8<S>; 2]) -> [f32x8<S>; 2] {
        let (x, y) = exp2(simd, x.combine(y)).split();
        [x, y]
    }
}

/// Computes 2ⁿ 2ʳ with |r| ≤ 1/2, where 2ʳ = e^(r ln 2) is a Taylor series.
///
/// Adding `ROUNDING` rounds x to n, which the sum has in its lowest bits; shifted, n is added to the exponent of 2ʳ. No
/// exponent is below the least: n = −126 is the rounded x only for r ≥ 0, for which 2ʳ ≥ 1.
#[inline(always)]
fn exp2<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, x: V) -> V {
    let mut c = [V::splat(simd, 0.0); SERIES.len()];
    for (lanes, coefficient) in c.iter_mut().zip(SERIES) {
        *lanes = V::splat(simd, coefficient);
    }
    let x = x.max(V::splat(simd, -126.0));
    let rounding = V::splat(simd, ROUNDING);
    let rounded = x + rounding;
    let r = x - (rounded - rounding);
    let r2 = r * r;
    let low = c[3]
        .mul_add_precise(r, c[2])
        .mul_add_precise(r2, c[1].mul_add_precise(r, c[0]));
    let high = c[6].mul_add_precise(r2, c[5].mul_add_precise(r, c[4]));
    let power = high.mul_add_precise(r2 * r2, low);
    V::from_bits(power.to_bits() + (rounded.to_bits() << 23))
}

/// 1.5 · 2²³: numbers near it are integers.
const ROUNDING: f32 = 12_582_912.0;

/// (ln 2)ᵏ/k!; the next term of 2ʳ is below 1.2 · 10⁻⁷.
#[expect(clippy::excessive_precision, reason = "rounded by the compiler")]
const SERIES: [f32; 7] = [
    1.0,
    std::f32::consts::LN_2,
    0.240_226_506_959_101,
    0.055_504_108_664_821_6,
    0.009_618_129_107_628_48,
    0.001_333_355_814_642_84,
    0.000_154_035_303_933_816,
];

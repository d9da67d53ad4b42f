//! The scalar type is `f64`, the vector type is nalgebra's. Lengths are in meters, and y points up.

use std::ops::{AddAssign, Mul};

/// A position, velocity or force in the plane.
pub type Vector = nalgebra::Vector2<f64>;

/// `v` turned by 90° counterclockwise.
pub fn perpendicular(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// `v / |v|`, or zero for the zero vector.
#[inline]
pub fn direction(v: Vector) -> Vector {
    let length = v.norm();
    if length > 0.0 {
        v / length
    } else {
        Vector::zeros()
    }
}

/// 1/(2k)! and 1/(2k + 1)!. Up to an eighth of a turn, the omitted terms are below 2⁻⁵³ of the first.
const SERIES: [[f64; 2]; 9] = {
    let mut series = [[1.0; 2]; 9];
    let mut k = 1;
    while k < series.len() {
        let n = 2.0 * k as f64;
        let even = series[k - 1][1] / n;
        series[k] = [even, even / (n + 1.0)];
        k += 1;
    }
    series
};

/// The unit vector at an angle of `turn` / 2³² of a full turn.
///
/// Computes sine and cosine by Taylor series up to an eighth of a turn, and by symmetry beyond. Unlike library
/// functions, this gives the same bits on all platforms.
#[inline(always)]
pub fn unit_vector(turn: u32) -> Vector {
    // The nearest quarter turn, and the angle from there in radians.
    let quarter = turn.wrapping_add(1 << 29) >> 30;
    let rest = turn.wrapping_sub(quarter << 30) as i32;
    let x =
        f64::from(rest) * (std::f64::consts::TAU / f64::from(1_u32 << 16) / f64::from(1_u32 << 16));
    let minus_squared = -x * x;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for [even, odd] in SERIES.into_iter().rev() {
        cosine = cosine * minus_squared + even;
        sine = sine * minus_squared + odd;
    }
    let sine = sine * x;
    // The cosine and the sine of the quarter turns, chosen without a table: loops over this function use vectors.
    let [along, across] = [0, 1].map(|odd| match quarter.wrapping_sub(odd) & 3 {
        0 => 1.0,
        2 => -1.0,
        _ => 0.0,
    });
    Vector::new(
        along * cosine - across * sine,
        across * cosine + along * sine,
    )
}

/// `v`, clamped to length `limit`.
#[inline]
pub fn clamp_length(v: Vector, limit: f64) -> Vector {
    let squared = v.norm_squared();
    if squared > limit * limit {
        v * (limit / squared.sqrt())
    } else {
        v
    }
}

/// The lower left and the upper right corner of the rectangle around some points; `None` without points.
pub fn bounds(points: impl IntoIterator<Item = Vector>) -> Option<[Vector; 2]> {
    let corners = points.into_iter().map(|p| [p; 2]);
    corners.reduce(|[low, high], [p, _]| [low.inf(&p), high.sup(&p)])
}

/// The sides of a closed ring of points: each point with the one that follows it.
pub fn sides<T: Copy>(ring: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    let ends = ring.iter().cycle().skip(1);
    ring.iter().copied().zip(ends.copied())
}

/// Sums and maxima that the functions below compute side by side: none waits for another.
const SUMS: usize = 8;

/// The greatest of some numbers, at least 0. NaNs are ignored.
#[inline(always)]
pub fn greatest<T>(items: &[T], number: impl Fn(&T) -> f64) -> f64 {
    let greater = |a: f64, b: f64| if b > a { b } else { a };
    let (whole, rest) = items.as_chunks::<SUMS>();
    let mut most = [0.0; SUMS];
    for some in whole {
        for (most, item) in most.iter_mut().zip(some) {
            *most = greater(*most, number(item));
        }
    }
    let last = rest.iter().map(number).fold(0.0, greater);
    most.into_iter().fold(last, greater)
}

/// The memory that an array takes, bytes.
pub fn bytes_of<T>(array: &Vec<T>) -> usize {
    array.capacity() * size_of::<T>()
}

/// Whether both coordinates are finite.
pub fn is_finite(v: Vector) -> bool {
    v.x.is_finite() && v.y.is_finite()
}

/// Whether all numbers, or the coordinates of all vectors, are finite.
pub fn are_finite<T>(items: &[T]) -> bool
where
    T: Copy + Default + PartialEq + AddAssign + Mul<f64, Output = T>,
{
    // Zero times an infinity or a NaN is NaN, and NaN propagates through a sum. Several sums do not wait for each
    // other.
    let (whole, rest) = items.as_chunks::<SUMS>();
    let mut zeros = [T::default(); SUMS];
    for some in whole {
        for (zero, &item) in zeros.iter_mut().zip(some) {
            *zero += item * 0.0;
        }
    }
    for (zero, &item) in zeros.iter_mut().zip(rest) {
        *zero += item * 0.0;
    }
    zeros == [T::default(); SUMS]
}

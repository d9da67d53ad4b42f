//! The scalar is `f64` and the vector nalgebra's; lengths in metres, y up.

/// A position, velocity or force in the plane.
pub type Vector = nalgebra::Vector2<f64>;

/// `v` turned by 90° counter-clockwise.
pub fn perpendicular(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// `v / |v|`, and zero for the zero vector: coincident points give no direction.
pub fn direction(v: Vector) -> Vector {
    let length = v.norm();
    if length > 0.0 {
        v / length
    } else {
        Vector::zeros()
    }
}

/// `v`, shortened to length `limit` if it is longer.
pub fn clamp_length(v: Vector, limit: f64) -> Vector {
    let squared = v.norm_squared();
    if squared > limit * limit {
        v * (limit / squared.sqrt())
    } else {
        v
    }
}

/// Are both coordinates finite?
pub fn is_finite(v: Vector) -> bool {
    v.x.is_finite() && v.y.is_finite()
}

/// Are all coordinates finite?
pub fn are_finite(vectors: &[Vector]) -> bool {
    // Zero times anything else is no number, and stays it: one comparison for all.
    let zero: Vector = vectors.iter().map(|v| v * 0.0).sum();
    zero == Vector::zeros()
}

/// Are all numbers finite?
pub fn numbers_are_finite(numbers: &[f64]) -> bool {
    numbers.iter().map(|number| number * 0.0).sum::<f64>() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_that_is_none_is_seen_among_many() {
        let mut numbers = vec![1e300; 99];
        assert!(numbers_are_finite(&numbers) && numbers_are_finite(&[]));
        let mut vectors = vec![Vector::new(-1e300, 0.0); 99];
        assert!(are_finite(&vectors) && are_finite(&[]));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            numbers[57] = bad;
            vectors[57].y = bad;
            assert!(!numbers_are_finite(&numbers) && !are_finite(&vectors));
        }
    }
}

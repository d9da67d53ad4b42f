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

//! Longitudes and latitudes → meters east and north in the plane that touches the ellipsoid of WGS 84 at a point.
//!
//! Within 1 km of the point, distances in this plane are off by 1e-8 of themselves.

use libm::{cos, sin, sqrt};

/// The half axis of WGS 84, meters, and the square of its eccentricity.
const HALF_AXIS: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_141_317e-3;

/// The plane at a point.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// Its longitude and its latitude, degrees.
    origin: [f64; 2],
}

impl Plane {
    pub fn at(origin: [f64; 2]) -> Self {
        Self { origin }
    }

    /// A longitude and a latitude, degrees, as meters east and north.
    pub fn meters(&self, [longitude, latitude]: [f64; 2]) -> [f64; 2] {
        let [east, up, north] = on_ellipsoid(longitude - self.origin[0], latitude);
        let [_, own_up, own_north] = on_ellipsoid(0.0, self.origin[1]);
        let own = self.origin[1].to_radians();
        let ahead = (north - own_north) * cos(own) - (up - own_up) * sin(own);
        [east, ahead]
    }
}

/// The place of a longitude and a latitude, degrees: meters toward the east, away from the axis at longitude 0, and
/// along the axis.
fn on_ellipsoid(longitude: f64, latitude: f64) -> [f64; 3] {
    let [longitude, latitude] = [longitude, latitude].map(f64::to_radians);
    let sine = sin(latitude);
    let normal = HALF_AXIS / sqrt(1.0 - ECCENTRICITY_SQUARED * sine * sine);
    let away = normal * cos(latitude);
    [
        away * sin(longitude),
        away * cos(longitude),
        normal * (1.0 - ECCENTRICITY_SQUARED) * sine,
    ]
}

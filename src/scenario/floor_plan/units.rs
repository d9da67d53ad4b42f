//! Units of coordinates, and those of coordinate systems.

use std::sync::OnceLock;

use serde::Deserialize;

use super::error::FloorPlanError;
use crate::error::quote::shown;
use crate::input::embedded;

/// Units of length.
pub const UNITS: [Unit; 8] = [
    Unit::new("in", "inches", 1, 0.0254),
    Unit::new("ft", "feet", 2, 0.3048),
    Unit::new("mm", "millimeters", 4, 0.001),
    Unit::new("cm", "centimeters", 5, 0.01),
    Unit::new("m", "meters", 6, 1.0),
    Unit::new("km", "kilometers", 7, 1000.0),
    Unit::new("yd", "yards", 10, 0.9144),
    Unit::new("dm", "decimeters", 14, 0.1),
];

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Its name in the key `plan.unit`.
    pub name: &'static str,
    pub plural: &'static str,
    /// Its number in the header of drawings.
    pub number: i64,
    /// Its length, meters.
    pub length: f64,
}

impl Unit {
    const fn new(name: &'static str, plural: &'static str, number: i64, length: f64) -> Self {
        Self {
            name,
            plural,
            number,
            length,
        }
    }

    /// The unit that a scenario names.
    ///
    /// # Errors
    /// It is unknown.
    pub fn named(word: &str) -> Result<Self, FloorPlanError> {
        let found = UNITS.into_iter().find(|unit| unit.name == word.trim());
        found.ok_or_else(|| FloorPlanError::Geometry {
            place: "plan.unit".to_owned(),
            reason: format!(
                "`{}` is no unit of plans; write m, cm, mm, ft or in",
                shown(word)
            ),
        })
    }
}

/// The units of the coordinate systems of EPSG's registry that are not in meters.
#[derive(Deserialize)]
struct Systems {
    degrees: Vec<Codes>,
    units: Vec<OfSystems>,
}

#[derive(Deserialize)]
struct OfSystems {
    name: String,
    meters: f64,
    codes: Vec<Codes>,
}

/// A code, or the first and the last of a range.
#[derive(Deserialize)]
#[serde(untagged)]
enum Codes {
    One(u32),
    Range([u32; 2]),
}

impl Codes {
    fn contain(&self, code: u32) -> bool {
        match *self {
            Self::One(one) => one == code,
            Self::Range([first, last]) => (first..=last).contains(&code),
        }
    }
}

/// What the coordinates of a coordinate system are.
#[derive(Debug, PartialEq)]
pub enum Coordinates {
    Meters,
    Degrees,
    /// Another unit: its name and its meters.
    Other(String, f64),
    /// The system is not known.
    Unknown,
}

/// The coordinates of the system with a name, such as `urn:ogc:def:crs:EPSG::2263`, `EPSG:25832` or `NAD83 / Texas
/// South (ftUS)`.
pub fn of_system(name: &str) -> Coordinates {
    static SYSTEMS: OnceLock<Systems> = OnceLock::new();
    let systems = SYSTEMS.get_or_init(|| embedded("epsg.json", include_str!("epsg.json")));
    let upper = name.to_uppercase();
    let code: Option<u32> = name
        .rsplit(':')
        .next()
        .and_then(|code| code.trim().parse().ok());
    let is_of = |codes: &[Codes], code: u32| codes.iter().any(|one| one.contain(code));
    let us_foot = || {
        systems
            .units
            .iter()
            .find(|unit| unit.name.starts_with("US survey"))
    };
    match code.filter(|_| upper.contains("EPSG") || !upper.contains(':')) {
        Some(code) if is_of(&systems.degrees, code) => Coordinates::Degrees,
        Some(code) => {
            let other = systems.units.iter().find(|unit| is_of(&unit.codes, code));
            other.map_or(Coordinates::Meters, |unit| {
                Coordinates::Other(unit.name.clone(), unit.meters)
            })
        }
        None if upper.contains("CRS84") => Coordinates::Degrees,
        None if upper.contains("FTUS") || upper.contains("FOOT_US") => us_foot()
            .map_or(Coordinates::Unknown, |unit| {
                Coordinates::Other(unit.name.clone(), unit.meters)
            }),
        None if upper.contains("(FT)") => Coordinates::Other("foot".to_owned(), 0.3048),
        None if upper.contains("UTM") || upper.contains("METER") => Coordinates::Meters,
        None => Coordinates::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinate_systems_have_the_units_of_the_registry() {
        let found = [
            "urn:ogc:def:crs:EPSG::2263",
            "EPSG:25832",
            "4326",
            "urn:ogc:def:crs:OGC:1.3:CRS84",
        ];
        let [york, utm, world, ogc] = found.map(of_system);
        let Coordinates::Other(name, meters) = york else {
            panic!("{york:?}")
        };
        assert_eq!(name, "US survey foot");
        assert!((meters - 1200.0 / 3937.0).abs() < 1e-15);
        assert_eq!(
            [utm, world, ogc],
            [
                Coordinates::Meters,
                Coordinates::Degrees,
                Coordinates::Degrees
            ]
        );
        assert_eq!(
            of_system("EPSG:2222"),
            Coordinates::Other("foot".to_owned(), 0.3048)
        );
        assert_eq!(of_system("a hall"), Coordinates::Unknown);
    }
}

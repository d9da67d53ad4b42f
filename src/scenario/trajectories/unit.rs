//! Units of coordinates.

use std::fmt::{self, Display, Formatter};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The unit of the coordinates in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub enum Unit {
    /// Meters.
    #[serde(rename = "m")]
    Meter,
    /// Centimeters.
    #[serde(rename = "cm")]
    Centimeter,
    /// Millimeters.
    #[serde(rename = "mm")]
    Millimeter,
    /// Feet of 0.3048 m.
    #[serde(rename = "ft")]
    Foot,
}

/// The names of all units.
pub const UNITS: [&str; 4] = ["m", "cm", "mm", "ft"];

impl Unit {
    /// All units, in the order of their names.
    pub const ALL: [Self; 4] = [Self::Meter, Self::Centimeter, Self::Millimeter, Self::Foot];

    /// Its length in meters.
    pub fn meters(self) -> f64 {
        match self {
            Self::Meter => 1.0,
            Self::Centimeter => 0.01,
            Self::Millimeter => 0.001,
            Self::Foot => 0.3048,
        }
    }

    /// The unit called `name`.
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|unit| unit.to_string() == name)
    }
}

impl Display for Unit {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(UNITS[*self as usize])
    }
}

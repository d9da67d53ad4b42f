//! Errors in floor plans.

use crate::error::Problem;
use crate::error::quote::{shown, shown_message};
use std::path::PathBuf;

/// Why a file or text is not a floor plan, with advice.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FloorPlanError {
    /// An error in a file.
    #[error("{}: {error}", shown_message(&path.display().to_string()))]
    File {
        /// The file.
        path: PathBuf,
        /// The error.
        error: Box<Self>,
    },
    /// The file cannot be read; with the system's message.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The text is not valid WKT, GeoJSON or XML.
    #[error("not valid {format}: {}", shown_message(reason))]
    Syntax {
        /// WKT, GeoJSON or XML.
        format: &'static str,
        /// The parser's message, with the place.
        reason: String,
    },
    /// A geometry without coordinates.
    #[error("{}the geometry is empty; remove it", at(.0))]
    EmptyGeometry(String),
    /// The plan has no polygons.
    #[error("has no polygons")]
    Empty,
    /// The file declares a coordinate system in degrees.
    #[error(
        "the coordinates are degrees ({}); a floor plan must be in meters: project it, for example to UTM, and \
         subtract an origin near the site",
        shown(.0)
    )]
    Degrees(String),
    /// The plan is so small that it must be a mistake.
    #[error(
        "too small for a person: everything lies within {width} by {height} m. Coordinates are in meters; if these \
         are degrees, project them, for example to UTM, and subtract an origin near the site"
    )]
    TooSmall {
        /// Extent along x, meters.
        width: f64,
        /// Extent along y, meters.
        height: f64,
    },
    /// The file's levels are none, or wrong as a whole.
    #[error("{0}")]
    Levels(String),
    /// Holes and obstacles fill the walkable area.
    #[error("holes and obstacles leave no room for a person")]
    NoRoom,
    /// A geometry is not a polygon, is too far from the origin, or has an invalid ring.
    #[error("{}{reason}", at(.place))]
    Geometry {
        /// Which feature, geometry and ring.
        place: String,
        /// The reason.
        reason: String,
    },
}

impl FloorPlanError {
    /// The same error, of a level.
    pub(super) fn of_level(self, level: &str) -> Self {
        let (place, reason) = match self {
            Self::Geometry { place, reason } => (place, reason),
            Self::EmptyGeometry(place) => (place, "the geometry is empty; remove it".to_owned()),
            other => (String::new(), other.to_string()),
        };
        let comma = if place.is_empty() { "" } else { ", " };
        Self::Geometry {
            place: format!("{level}{comma}{place}"),
            reason,
        }
    }

    /// A geometry of the type `found` where only polygons and lines make sense.
    pub(super) fn no_area(place: &str, found: &str) -> Self {
        Self::Geometry {
            place: place.to_owned(),
            reason: format!(
                "a {found} has no area; a floor plan consists of polygons, and of lines that are walls"
            ),
        }
    }
}

/// A place as the prefix of a message; empty if there is none.
fn at(place: &str) -> String {
    match place {
        "" => String::new(),
        place => format!("{}: ", shown(place)),
    }
}

/// The place of an error becomes the path if it is an index.
impl From<FloorPlanError> for Problem {
    fn from(error: FloorPlanError) -> Self {
        match error {
            FloorPlanError::Geometry { place, reason } => Self::new(place, reason),
            FloorPlanError::EmptyGeometry(place) => Self::new(place, "has no rings"),
            other => Self::new("", other.to_string()),
        }
    }
}

//! What can be wrong with a floor plan.

use std::path::PathBuf;

use crate::scenario::quote::{shown, shown_message};

/// Why a file or text is no floor plan, and what to do about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FloorPlanError {
    /// Something is wrong with a file.
    #[error("{}: {error}", shown_message(&path.display().to_string()))]
    File {
        /// The file.
        path: PathBuf,
        /// What.
        error: Box<Self>,
    },
    /// What the system said.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The text is not what it begins as.
    #[error("no {format}: {}", shown_message(reason))]
    Syntax {
        /// WKT or GeoJSON.
        format: &'static str,
        /// What and where.
        reason: String,
    },
    /// A geometry that has no area.
    #[error("{}a {found} has no area; a floor plan is made of polygons", at(.place))]
    NoPolygon {
        /// Which feature or geometry.
        place: String,
        /// Its type.
        found: &'static str,
    },
    /// A geometry without coordinates.
    #[error("{}the geometry is empty; remove it", at(.0))]
    EmptyGeometry(String),
    /// Nothing at all.
    #[error("has no polygons")]
    Empty,
    /// Degrees, as the file says itself.
    #[error(
        "the coordinates are degrees ({}); a floor plan is in metres: project it, to UTM for example",
        shown(.0)
    )]
    Degrees(String),
    /// So small that it must be a mistake, metres.
    #[error(
        "no person fits in: everything lies within {width} by {height} m. Coordinates are metres; if these \
         are degrees, project them, to UTM for example"
    )]
    TooSmall {
        /// Along x, metres.
        width: f64,
        /// Along y, metres.
        height: f64,
    },
    /// The obstacles fill the walkable area.
    #[error("the obstacles leave no room for anybody")]
    NoRoom,
    /// A point where lengths lose their digits.
    #[error(
        "{}({x}, {y}) is out of range: x and y must be at least -1e6 and at most 1e6 m; move the plan \
         near to the origin", at(.place)
    )]
    TooFar {
        /// Which feature or geometry.
        place: String,
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// A ring that is none.
    #[error("{}{reason}", at(.place))]
    Ring {
        /// Which feature, geometry and ring.
        place: String,
        /// Why.
        reason: String,
    },
}

/// A place before what is wrong there.
fn at(place: &str) -> String {
    if place.is_empty() {
        String::new()
    } else {
        format!("{}: ", shown(place))
    }
}

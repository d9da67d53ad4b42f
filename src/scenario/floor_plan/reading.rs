//! What a plan's file does not say itself: the key `plan`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::shape::Shape;
use super::units::Unit;

/// How the files of `walkable_area`, `obstacles` and `levels` are read: what they do not say themselves
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Reading {
    /// Where walls are lines, the floor is what can be reached from these points without crossing one. Default: the
    /// largest enclosed area.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inside: Vec<[f64; 2]>,
    /// What layers of a drawing are, by their names: `floor`, `obstacle`, `wall`, `door`, `exit`, `entrance`, `crowd`,
    /// `waypoint`, `waiting area`, `queue`, `zone`, `place` or `none`. Default: what the names themselves say.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub layers: BTreeMap<String, String>,
    /// The unit of the coordinates: `m`, `cm`, `mm`, `ft` or `in`. Default: what the file says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// The point of the file that becomes the origin, meters; of a file in degrees, its longitude and latitude.
    /// Default: its own origin; for one drawing far from that and for degrees, the lower left corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<[f64; 2]>,
    /// Ends of lines this near to another line meet it, meters. Default: 0.02.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub gap: Option<f64>,
    /// The storey that is read, of several: its name, or its height in meters as a text. Default: all, if they do not
    /// overlap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub storey: Option<String>,
    /// The height from one ordinal of a file's levels to the next, meters, where the levels have no `elevation`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.5, max = 100))]
    pub storey_height: Option<f64>,
}

/// What the names of layers mean that scenarios leave out.
const NONE: &str = "none";

impl Reading {
    /// The distance within which ends of lines meet other lines, meters.
    pub fn gap(&self) -> f64 {
        self.gap.unwrap_or(0.02)
    }

    /// What a layer is: as `layers` says, else as its own name says. `Some(None)`: it is left out on purpose; `None`:
    /// nothing says what it is. An unknown word is an error, with the word.
    pub fn kind_of(&self, layer: &str) -> Result<Option<Option<Kind>>, String> {
        let mut layers = self.layers.iter();
        let given = layers.find(|(name, _)| name.to_lowercase() == layer.to_lowercase());
        match given {
            None => Ok(Kind::of_layer(layer).map(Some)),
            Some((_, word)) if word == NONE => Ok(Some(None)),
            Some((_, word)) => match Kind::of_word(word) {
                Some(kind) => Ok(Some(Some(kind))),
                None => Err(word.clone()),
            },
        }
    }
}

/// What a file has.
#[derive(Debug, Default)]
pub struct Drawn {
    /// Its geometries, meters.
    pub shapes: Vec<Shape>,
    /// The unit that the file declares, and its meters; `None` for meters, or if it declares none.
    pub unit: Option<(String, f64)>,
    /// What readers of the results should know of how it was read.
    pub notes: Vec<String>,
}

impl Drawn {
    /// Converts the coordinates to meters from the origin that `reading` gives.
    ///
    /// # Errors
    /// The unit is unknown.
    pub fn place(&mut self, reading: &Reading) -> Result<(), FloorPlanError> {
        let unit = reading.unit.as_deref().map(Unit::named).transpose()?;
        let typed = unit.map(|unit| unit.length);
        let declared = self.unit.take().filter(|_| typed.is_none());
        if let Some((name, _)) = &declared {
            self.notes.push(format!(
                "the coordinates are converted from {name} to meters"
            ));
        }
        let meters = typed.or(declared.map(|(_, meters)| meters)).unwrap_or(1.0);
        let [x, y] = reading.origin.unwrap_or_default();
        if meters == 1.0 && [x, y] == [0.0, 0.0] {
            return Ok(());
        }
        for point in self
            .shapes
            .iter_mut()
            .flat_map(|shape| &mut shape.rings)
            .flatten()
        {
            *point = [point[0] * meters - x, point[1] * meters - y];
        }
        Ok(())
    }
}

//! A value over time: in the scenario, or in a text file.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_untagged::UntaggedEnumVisitor;

use crate::error::Problem;
use crate::error::quote::shown;
use crate::keys::limits::STRONGEST;

/// Points in the order of time, or the name of a text file with two columns, relative to this file's folder
#[derive(Debug, Clone, JsonSchema)]
#[schemars(untagged, inline)]
pub enum Curve {
    Points(#[schemars(length(min = 1))] Vec<CurvePoint>),
    File(String),
}

/// [seconds, value]
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct CurvePoint(#[schemars(inner(range(min = -STRONGEST, max = STRONGEST)))] pub [f64; 2]);

impl Curve {
    /// The points, whose times must rise.
    pub fn points(&self) -> Result<Vec<[f64; 2]>, Problem> {
        let points: Vec<[f64; 2]> = match self {
            Self::Points(points) => points.iter().map(|point| point.0).collect(),
            Self::File(name) => {
                // Files are read before keys are checked.
                return Err(Problem::new("", format!("{} was not read", shown(name))));
            }
        };
        let falls = points.windows(2).position(|two| two[0][0] >= two[1][0]);
        falls.map_or(Ok(()), |k| {
            let reason = format!("must be later than the point before, at {} s", points[k][0]);
            Err(Problem::new(format!("[{}]", k + 1), reason))
        })?;
        Ok(points)
    }
}

/// Not derived: the errors of a derived untagged enum do not name the wrong value.
impl<'de> Deserialize<'de> for Curve {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("a list of [seconds, m/s²], or the name of a file")
            .string(|name| Ok(Self::File(name.to_owned())))
            .seq(|points| Ok(Self::Points(points.deserialize()?)))
            .deserialize(deserializer)
    }
}

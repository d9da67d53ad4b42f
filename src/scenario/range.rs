//! Ranges of allowed numbers, with their error messages and schemas.

use std::fmt;

use serde_json::{Value, json};

use super::error::Problem;
use crate::engine::clock::SHORTEST_TIME_STEP;
use crate::engine::math::Vector;
use crate::engine::scene::Region;

/// An interval of finite numbers that includes its upper end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    lowest: f64,
    /// Is `lowest` itself excluded?
    open: bool,
    highest: f64,
}

/// x or y of any point, meters. Beyond this, walls and contacts lose precision.
pub(super) const COORDINATE: Range = Range::at_least(-1e6, 1e6);
/// Times and durations, seconds.
pub(super) const TIME: Range = Range::at_least(0.0, 1e7);
/// Δt_fine, seconds.
pub(super) const TIME_STEP: Range = Range::at_least(SHORTEST_TIME_STEP, 1.0);
/// Δt_coarse in frames.
pub(super) const COARSE_EVERY: Range = Range::at_least(1.0, 1e6);
/// s_pref, m/s.
pub(super) const PREFERRED_SPEED: Range = Range::at_least(0.0, 100.0);
/// s_max, m/s.
pub(super) const MAX_SPEED: Range = Range::above(0.0, 100.0);

impl Range {
    pub(super) const fn at_least(lowest: f64, highest: f64) -> Self {
        Self {
            lowest,
            open: false,
            highest,
        }
    }

    pub(super) const fn above(lowest: f64, highest: f64) -> Self {
        Self {
            lowest,
            open: true,
            highest,
        }
    }

    /// The range as JSON Schema; `number` is the type, `number` or `integer`.
    pub(super) fn schema(&self, number: &str) -> Value {
        let lowest = if self.open {
            "exclusiveMinimum"
        } else {
            "minimum"
        };
        let plain = |bound: f64| match bound as i64 {
            whole if whole as f64 == bound => json!(whole),
            _ => json!(bound),
        };
        json!({"type": number, lowest: plain(self.lowest), "maximum": plain(self.highest)})
    }

    /// Returns `value` if it is in range; the error names `key`.
    pub(super) fn check(&self, key: &str, value: f64) -> Result<f64, Problem> {
        let high_enough = value > self.lowest || (value == self.lowest && !self.open);
        if high_enough && value <= self.highest {
            Ok(value)
        } else {
            Err(Problem::new(
                key,
                format!("must be {self}, not {}", brief(value)),
            ))
        }
    }

    /// Returns `value` if it is `None` or in range; the error names `key`.
    pub(super) fn check_given(
        &self,
        key: &str,
        value: Option<f64>,
    ) -> Result<Option<f64>, Problem> {
        value.map(|value| self.check(key, value)).transpose()
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let from = if self.open { "above" } else { "at least" };
        let (lowest, highest) = (brief(self.lowest), brief(self.highest));
        write!(f, "{from} {lowest} and at most {highest}")
    }
}

/// Very large and very small numbers in scientific notation, others in decimal notation.
fn brief(value: f64) -> String {
    let plain = value == 0.0 || (1e-4..1e6).contains(&value.abs());
    if plain {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A point with both coordinates in range.
pub(super) fn point(key: &str, [x, y]: [f64; 2]) -> Result<Vector, Problem> {
    let checked = |place: &str, value| COORDINATE.check(&format!("{key}{place}"), value);
    Ok(Vector::new(checked("[0]", x)?, checked("[1]", y)?))
}

/// A region from its lower left and upper right corner, which must be in this order.
pub(super) fn region(key: &str, [min, max]: [[f64; 2]; 2]) -> Result<Region, Problem> {
    let region = Region {
        min: point(&format!("{key}[0]"), min)?,
        max: point(&format!("{key}[1]"), max)?,
    };
    ordered(&region).map_err(|reason| Problem::new(key, reason))?;
    Ok(region)
}

/// Checks that `min` is not above or right of `max`.
pub(super) fn ordered(region: &Region) -> Result<(), String> {
    let (min, max) = (region.min, region.max);
    if min.x <= max.x && min.y <= max.y {
        return Ok(());
    }
    Err(format!(
        "the lower left corner comes first: ({}, {}) is not below and left of ({}, {})",
        min.x, min.y, max.x, max.y
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_belong_to_a_range_unless_it_is_open() {
        let closed = Range::at_least(0.0, 1.0);
        let open = Range::above(0.0, 1.0);
        assert!(closed.check("a", 0.0).is_ok() && closed.check("a", 1.0).is_ok());
        assert!(open.check("a", 0.0).is_err() && open.check("a", 1.0).is_ok());
        assert!(closed.check("a", f64::NAN).is_err());
        assert!(closed.check("a", f64::INFINITY).is_err());
        assert_eq!(open.to_string(), "above 0 and at most 1");
    }
}

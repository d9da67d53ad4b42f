//! When and where measurements that sample the crowd look at it.

use schemars::JsonSchema;
use serde::Deserialize;

use super::is_due;
use crate::error::Problem;
use crate::floor_plan::parts_on_floor;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, wide_region};
use analysis::body_forces::BODY_MASS;
use analysis::evaluated::Evaluated;
use analysis::local::Local;
use engine::geometry::{Area, Ring};
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;

/// Time between two samples if none is given, seconds.
fn every() -> f64 {
    1.0
}

/// The largest mass of an average person, kg.
pub const MOST_MASS: f64 = 1000.0;

/// The mass of an average person if none is given, kg.
pub fn body_mass() -> f64 {
    BODY_MASS
}

/// The part of a region in which people walk and count, square meters: without the floors behind exits and entrances.
pub fn walkable_area(region: Region, scene: &Scene) -> f64 {
    let whole = region.area();
    let corners = Ring::new(region.corners().to_vec());
    let parts = corners.map(|corners| parts_on_floor(&corners, &scene.walls, &scene.behind));
    let Ok(Ok(parts)) = parts else {
        return whole;
    };
    let free: f64 = parts.iter().map(Area::area).sum();
    // Without walls in it, rounding must not change its area.
    if free > whole * (1.0 - 1e-9) {
        whole
    } else {
        free
    }
}

/// When a measurement samples the crowd.
///
/// serde cannot refuse unknown keys in structs that flatten it or [`Window`]: `file::range::check_names` does, where
/// they have `#[schemars(deny_unknown_fields)]`.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct Samples {
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(default)]
    pub from_secs: f64,
    /// The end, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
    /// Time between two samples, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    #[serde(default = "every")]
    pub every_secs: f64,
}

impl Samples {
    /// Checks the keys of the measurement `name`.
    ///
    /// # Errors
    /// They end before they start.
    pub fn check(&self, name: &str) -> Result<(), Problem> {
        let Some(until) = self.until_secs.filter(|until| *until < self.from_secs) else {
            return Ok(());
        };
        let from = self.from_secs;
        let reason = format!("must not be before `from_secs`, {from}, but is {until}");
        Err(Problem::new(format!("{name}.until_secs"), reason))
    }

    /// Whether the current frame is due.
    pub fn is_due(&self, simulation: &Simulation) -> bool {
        let until = self.until_secs.unwrap_or(f64::MAX);
        is_due(simulation, [self.from_secs, until], self.every_secs)
    }

    /// The time between two samples, seconds: whole frames.
    pub fn secs(&self, simulation: &Simulation) -> f64 {
        let clock = simulation.frame().clock;
        clock.time_at(clock.frame_at(self.every_secs).max(1))
    }
}

/// When and where a measurement samples the crowd.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct Window {
    /// The region: lower left and upper right corner, meters; everywhere if missing.
    pub region: Option<Corners>,
    #[serde(flatten)]
    pub samples: Samples,
}

impl Window {
    /// Checks the keys of the measurement `name`.
    ///
    /// # Errors
    /// The window is empty.
    pub fn check(&self, name: &str) -> Result<(), Problem> {
        self.samples.check(name)?;
        let key = format!("{name}.region");
        self.region
            .map_or(Ok(()), |corners| wide_region(&key, corners).map(|_| ()))
    }

    /// The region.
    pub fn region(&self) -> Option<Region> {
        self.region.map(Region::from)
    }

    /// The agents in the region with what is around them, with pressures if `pressure`.
    pub fn people<'a>(
        &self,
        evaluated: &'a Evaluated,
        pressure: bool,
    ) -> impl Iterator<Item = &'a Local> {
        let region = self.region();
        let people = evaluated.people(pressure).iter();
        people.filter(move |person| region.is_none_or(|region| region.contains(person.position)))
    }
}

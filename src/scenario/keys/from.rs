//! The keys of `from`: the people of a trajectory file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Problem;
use crate::keys::limits::{FARTHEST, HIGHEST_DENSITY, LONGEST_TIME};
use crate::keys::people::People;
use crate::trajectories::Unit;
use engine::math::Vector;

/// The key.
pub const FROM: &str = "from";
/// The file, for messages about outputs that would replace it.
pub const FILE: &str = "from.trajectory";
/// The people of a trajectory file at one time, and those who appear in it later: `trajectory` or `people`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(deny_unknown_fields)]
pub struct FromData {
    /// The name in reports. Default: `from`.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The trajectory file, relative to this file's folder: SQLite (JuPedSim), HDF5, CSV or text.
    #[schemars(length(min = 1))]
    pub trajectory: Option<String>,
    /// With `trajectory`: the time in the file at which the scenario begins, seconds; frame f is at f / `fps`. Before
    /// the first frame it is that of this frame. Default: the first frame.
    #[schemars(range(min = -LONGEST_TIME, max = LONGEST_TIME))]
    pub at_secs: Option<f64>,
    /// With `trajectory`: people who appear in the file after this time in it are left out, seconds. Default: all
    /// enter.
    #[schemars(range(min = -LONGEST_TIME, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
    /// With `trajectory`: the unit of its coordinates. Default: as the file says.
    pub unit: Option<Unit>,
    /// With `trajectory`: its frames per second. Default: as the file says.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub fps: Option<f64>,
    /// With `trajectory`: of a building, the level whose people begin the scenario.
    #[schemars(length(min = 1))]
    pub level: Option<String>,
    /// ρ̂ of those who are there at the start, P/m². Higher than the densities around them: they feel no pressure until
    /// it has fallen to these within some tenths of a second. Default: the density by the other agents.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub mean_density: Option<f64>,
    /// Instead of `trajectory`: the people.
    pub people: Option<Vec<Person>>,
    #[serde(flatten)]
    pub all: People,
}

/// A person: [id, seconds until it enters, x, y in meters, velocity along x, y in m/s]
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Person(pub [f64; 6]);

impl Person {
    /// When it enters, seconds; those at 0 are there at the start.
    pub fn enters(&self) -> f64 {
        self.0[1]
    }

    pub fn position(&self) -> Vector {
        Vector::new(self.0[2], self.0[3])
    }

    pub fn velocity(&self) -> Vector {
        Vector::new(self.0[4], self.0[5])
    }

    pub fn check(&self) -> Result<(), Problem> {
        if !(0.0..=LONGEST_TIME).contains(&self.enters()) {
            let reason = format!(
                "enters at {} s; must be 0 to {LONGEST_TIME:e}",
                self.enters()
            );
            return Err(Problem::new("", reason));
        }
        match self.position().amax() > FARTHEST {
            true => {
                let reason =
                    format!("{self} is more than {FARTHEST:e} m from the origin; move the origin");
                Err(Problem::new("", reason))
            }
            false => Ok(()),
        }
    }
}

impl std::fmt::Display for Person {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [id, _, x, y, ..] = self.0;
        write!(f, "person {id} at ({x:.2}, {y:.2}) m")
    }
}

impl FromData {
    pub fn people(&self) -> &[Person] {
        self.people.as_deref().unwrap_or_default()
    }

    /// The number of people at the start.
    pub fn initial(&self) -> u64 {
        let people = self.people().iter();
        people.filter(|person| person.enters() <= 0.0).count() as u64
    }

    /// The number of people who enter later, until `last` seconds.
    pub fn later(&self, last: f64) -> u64 {
        let people = self.people().iter();
        let later = people.filter(|person| person.enters() > 0.0 && person.enters() <= last);
        later.count() as u64
    }
}

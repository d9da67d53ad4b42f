//! The hard cases: extreme scenarios, which careless input can produce.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::watch::{Found, Watch};
use crate::engine::simulation::{Fault, Simulation};
use crate::runs::drive::{Then, drive, unless_over};
use crate::scenario::{Scenario, ScenarioError, Setting};

/// A hard case: a file in `scenarios/stress`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hard {
    /// The file's name, and the scenario's.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
    /// Simulated seconds in a quick run; `None` for all.
    pub quick_secs: Option<u32>,
}

macro_rules! hard {
    ($name:literal, $quick_secs:expr) => {
        Hard {
            name: $name,
            text: include_str!(concat!("../../../scenarios/stress/", $name, ".json")),
            quick_secs: $quick_secs,
        }
    };
}

/// All hard cases.
pub const HARD: [Hard; 17] = [
    hard!("packed", None),
    hard!("one_point", None),
    hard!("two_as_one", None),
    hard!("inside_walls", None),
    hard!("narrow_corridor", None),
    hard!("narrow_door", None),
    hard!("wedge", None),
    hard!("many_edges", None),
    hard!("thin_wall", None),
    hard!("radii", None),
    hard!("far_away", None),
    hard!("stiff_gas", None),
    hard!("stiff_contact", None),
    hard!("long_step", None),
    hard!("full_room", None),
    hard!("goals_inside", None),
    hard!("soak", Some(800)),
];

/// The result of a hard case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Survival {
    /// What the case tests, in one line.
    pub description: String,
    /// What the watch found.
    pub found: Found,
    /// Why the run failed; `None` if it reached its end.
    pub fault: Option<String>,
    /// Computing time, seconds.
    pub computed_in_secs: f64,
}

impl Survival {
    /// Did the run reach its end with finite values and without an agent passing through a wall?
    pub fn is_passed(&self) -> bool {
        self.fault.is_none() && self.found.finite && self.found.passed == 0
    }
}

impl Hard {
    /// The scenario with some settings applied.
    ///
    /// # Errors
    /// A setting is invalid.
    pub fn scenario(&self, settings: &[Setting]) -> Result<Scenario, ScenarioError> {
        Scenario::parse(self.text, &format!("{}.json", self.name), settings)
    }

    /// Runs a scenario of this case.
    pub fn survive(scenario: &Scenario) -> Survival {
        let start = Instant::now();
        let mut seen = None;
        let driven = watched(scenario, &mut seen);
        Survival {
            description: scenario.description.clone(),
            found: seen.unwrap_or_default(),
            fault: driven.err().map(|fault| fault.to_string()),
            computed_in_secs: start.elapsed().as_secs_f64(),
        }
    }
}

/// Runs a scenario and watches it.
fn watched(scenario: &Scenario, seen: &mut Option<Found>) -> Result<(), Fault> {
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let mut watch = Watch::new(&simulation);
    let duration = scenario.duration_secs;
    let driven = drive(&mut simulation, duration, |simulation, _| {
        watch.look(simulation);
        Ok::<Then, Fault>(unless_over(simulation, scenario))
    });
    *seen = Some(watch.found(&simulation));
    driven
}

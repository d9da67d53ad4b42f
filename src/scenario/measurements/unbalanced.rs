//! People who lean as far as they can: where balance is lost.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::window::Window;
use super::{Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::evaluated::Evaluated;
use engine::forces::legs::{self, Legs};
use engine::math::Vector;
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "unbalanced";
/// A lean counts from this part of its limit on: at the limit rounding decides.
const NEARLY: f64 = 1.0 - 1e-6;

/// The people whose lean has reached its limit (parameter `lean_limit`, profiles with `legs`): their share, when it was
/// largest, where they were, how many they were in total. It says where people would have to step or hold on to others,
/// and predicts no falls and no injuries.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Unbalanced {
    /// The beginning of the names of its values. Default: `unbalanced`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) window: Window,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// People with legs, over all samples.
    people: u64,
    /// The sum of their leans, meters.
    leans: f64,
    /// Those at the limit, over all samples.
    unbalanced: u64,
    /// The sum of their positions, meters.
    places: Vector,
    /// The largest share of a sample, and its time, seconds.
    most: Option<(f64, f64)>,
    /// Everybody who was ever at the limit.
    ids: BTreeSet<u32>,
}

impl Measure for Unbalanced {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("unbalanced.region", self.window.region)
    }

    fn check(&self) -> Result<(), Problem> {
        self.window.check(NAME)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let values = [
            (
                "share",
                "",
                "mean share of people whose lean is at its limit, over people and samples",
            ),
            ("max_share", "", "largest share at one time"),
            ("max_at_secs", "s", "when the share was largest"),
            ("x_m", "m", "mean place of people at the limit: x"),
            ("y_m", "m", "mean place of people at the limit: y"),
            (
                "agents",
                "agents",
                "people who were at the limit in at least one sample",
            ),
            ("mean_lean_m", "m", "mean lean over people and samples"),
        ];
        Quantity::all(self.name.as_deref().unwrap_or(NAME), &values)
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if !self.window.samples.is_due(simulation) {
            return;
        }
        let (frame, region) = (simulation.frame(), self.window.region());
        let agents = frame.agents;
        let [mut people, mut unbalanced] = [0_u64; 2];
        for i in agents.present() {
            let position = agents.position[i];
            let Some(law) = Legs::among(simulation.blend(i).forces()) else {
                continue;
            };
            if region.is_some_and(|region| !region.contains(position)) {
                continue;
            }
            people += 1;
            let lean = legs::lean(agents, i).norm();
            seen.leans += lean;
            if lean >= NEARLY * law.lean_limit {
                unbalanced += 1;
                seen.places += position;
                seen.ids.insert(agents.id[i]);
            }
        }
        seen.people += people;
        seen.unbalanced += unbalanced;
        if people > 0 {
            let share = unbalanced as f64 / people as f64;
            if seen.most.is_none_or(|(most, _)| share > most) {
                seen.most = Some((share, frame.clock.time()));
            }
        }
    }

    fn values(&self, seen: &Seen, _: &Simulation) -> Vec<Option<f64>> {
        let mean = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        let place = |sum: f64| mean(sum, seen.unbalanced);
        vec![
            mean(seen.unbalanced as f64, seen.people),
            seen.most.map(|(share, _)| share),
            seen.most.map(|(_, time)| time),
            place(seen.places.x),
            place(seen.places.y),
            seen.most.map(|_| seen.ids.len() as f64),
            mean(seen.leans, seen.people),
        ]
    }
}

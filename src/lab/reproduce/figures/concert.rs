//! The concert's variants (§6.3) and the data to keep of a run. One run serves all figures that show it.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::analysis::wave::{Run, SpaceTime, Strip};
use crate::engine::math::Vector;
use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;
use crate::analysis::sound::{self, Contacts};
use crate::lab::reproduce::case::{Case, CaseResult, Observer, Probe};
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::runner::Results;

/// When the push begins, seconds.
pub const PUSH: f64 = 150.0;
/// End of the runs, seconds: the slowest wave has come back.
pub const UNTIL: f64 = 161.0;
/// The times of the paper's Figs. 7 and 9, seconds.
pub const TIMES: [f64; 6] = [150.3, 151.0, 152.0, 153.0, 154.0, 156.0];
/// The diagram begins this long before the push, seconds.
const BEFORE: f64 = 1.0;
/// Every second frame: meanwhile a wave moves by about one bin.
const EVERY: u64 = 2;

/// The source of the wave, and the obstacle that reflects it.
pub const RUN: Run = Run {
    start: PUSH,
    source: 55.5,
    obstacle: 80.0,
};

/// A concert with settings that differ from the baseline's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// Its name in figures.
    pub label: &'static str,
    /// The scenario's settings.
    pub settings: &'static [(&'static str, f64)],
}

const fn variant(label: &'static str, settings: &'static [(&'static str, f64)]) -> Variant {
    Variant { label, settings }
}

/// Fig. 7(a): k = 200, ρ⁰max = 5, μ = 5, K^ag = 50.
pub const BASELINE: Variant = variant("baseline", &[]);
const K50: Variant = variant("k = 50", &[("gas_constant", 50.0)]);
const K100: Variant = variant("k = 100", &[("gas_constant", 100.0)]);
const K400: Variant = variant("k = 400", &[("gas_constant", 400.0)]);
const K800: Variant = variant("k = 800", &[("gas_constant", 800.0)]);
const DENSITY_4: Variant = variant("ρ⁰max = 4", &[("rest_density_max", 4.0)]);
const DENSITY_6: Variant = variant("ρ⁰max = 6", &[("rest_density_max", 6.0)]);
const INVISCID: Variant = variant("μ = 0", &[("viscosity", 0.0)]);
const STATIC_4: Variant = variant(
    "static ρ⁰ = 4",
    &[("rest_density_min", 4.0), ("rest_density_max", 4.0)],
);
const NO_CONTACT: Variant = variant("Kᵃᵍ = 0", &[("agent_stiffness", 0.0)]);
const DRY_50: Variant = variant(
    "no SPH, Kᵃᵍ = 50",
    &[
        ("gas_constant", 0.0),
        ("viscosity", 0.0),
        ("wall_stiffness", 1000.0),
        ("agent_stiffness", 50.0),
    ],
);
const DRY_1000: Variant = variant(
    "no SPH, Kᵃᵍ = 1000",
    &[
        ("gas_constant", 0.0),
        ("viscosity", 0.0),
        ("wall_stiffness", 1000.0),
        ("agent_stiffness", 1000.0),
    ],
);

/// Fig. 7, from (a) to (f).
pub const FIG7: [Variant; 6] = [BASELINE, K100, K400, DENSITY_4, DENSITY_6, INVISCID];
/// Fig. 8: left, right.
pub const FIG8: [Variant; 2] = [
    STATIC_4,
    Variant {
        label: "dynamic ρ⁰, 0 to 4",
        ..DENSITY_4
    },
];
/// Fig. 9.
pub const FIG9: [Variant; 2] = [DRY_50, DRY_1000];
/// Fig. 10 shows the first; the second is the baseline.
pub const FIG10: [Variant; 2] = [
    NO_CONTACT,
    Variant {
        label: "Kᵃᵍ = 50 (baseline)",
        ..BASELINE
    },
];
/// The runs of the space-time diagrams, each with its k.
pub const SPEEDS: [(f64, Variant); 5] = [
    (50.0, K50),
    (100.0, K100),
    (200.0, BASELINE),
    (400.0, K400),
    (800.0, K800),
];

impl Variant {
    /// The run, which keeps its wave. Figures add the snapshots that they show.
    pub fn case(&self) -> Case {
        self.settings
            .iter()
            .fold(case(), |case, (key, value)| case.set(key, value))
    }

    /// The data kept of the wave.
    ///
    /// # Errors
    /// The case was not run.
    pub fn seen(&self, results: &Results) -> Result<Seen, ReproduceError> {
        Seen::of(results.of(&self.case())?)
    }
}

/// A concert until the wave is over; keeps the data of the wave.
pub fn case() -> Case {
    Case::shipped("concert")
        .set("duration_secs", UNTIL)
        .keep(WaveProbe)
        .taking(12.0)
}

/// The data kept of a concert's wave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Space-time diagram along the middle of the crowd in front of the stage.
    pub diagram: SpaceTime,
    /// Contacts in the same place at the time of the push.
    pub contacts: Option<Contacts>,
}

impl Seen {
    /// The data that a run has kept.
    ///
    /// # Errors
    /// The run has kept no wave.
    pub fn of(result: &CaseResult) -> Result<Self, ReproduceError> {
        result.kept(&WaveProbe.name())
    }
}

/// Keeps a [`Seen`].
#[derive(Debug, Clone, Copy)]
struct WaveProbe;

impl Probe for WaveProbe {
    fn name(&self) -> String {
        "wave before the stage".to_owned()
    }

    fn begin(&self, _: &mut Simulation) -> Box<dyn Observer> {
        let strip = Strip {
            x: [45.0, 80.0],
            half_width: 8.0,
            bin: 0.5,
        };
        Box::new(Watching(Seen {
            diagram: SpaceTime::new(strip),
            contacts: None,
        }))
    }
}

struct Watching(Seen);

impl Observer for Watching {
    fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let (clock, now) = (frame.clock, frame.clock.frame());
        if clock.time() >= PUSH - BEFORE - 1e-6 && now.is_multiple_of(EVERY) {
            self.0.diagram.observe(&frame);
        }
        if now == clock.frame_at(PUSH) {
            self.0.contacts = sound::contacts(&frame, &interior());
        }
    }

    fn finish(self: Box<Self>) -> Value {
        serde_json::to_value(self.0).unwrap_or_default()
    }
}

/// The part of the crowd that the wave runs through, away from its rim and the stage, meters.
fn interior() -> Region {
    Region {
        min: Vector::new(58.0, -8.0),
        max: Vector::new(76.0, 8.0),
    }
}

//! The concert's variants (§6.3) and what is kept of a run. One run serves all figures that show it.

use serde::{Deserialize, Serialize};

use super::snapshot::Snapshot;
use crate::math::Vector;
use crate::scene::Region;
use crate::simulation::Simulation;
use crate::sound::{self, Contacts};
use crate::wave::{Run, SpaceTime, Strip};

/// When the push begins, seconds.
pub const PUSH: f64 = 150.0;
/// Nothing later is shown, seconds: the slowest wave has come back.
pub const UNTIL: f64 = 161.0;
/// When the paper's Figs. 7 and 9 look, seconds.
pub const TIMES: [f64; 6] = [150.3, 151.0, 152.0, 153.0, 154.0, 156.0];
/// The diagram begins so many seconds before the push.
const BEFORE: f64 = 1.0;
/// Every second frame: a wave then moves by about a bin from one time to the next.
const EVERY: u64 = 2;

/// What starts the wave and what throws it back.
pub const RUN: Run = Run {
    start: PUSH,
    source: 55.5,
    obstacle: 80.0,
};

/// A concert that differs from the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variant {
    /// Its name in files.
    pub key: &'static str,
    /// Its name in figures.
    pub label: &'static str,
    /// The scenario's settings.
    pub settings: &'static [&'static str],
}

const fn variant(
    key: &'static str,
    label: &'static str,
    settings: &'static [&'static str],
) -> Variant {
    Variant {
        key,
        label,
        settings,
    }
}

/// Fig. 7(a): k = 200, ρ⁰max = 5, μ = 5, K^ag = 50.
pub const BASELINE: Variant = variant("baseline", "baseline", &[]);
const K50: Variant = variant("k-50", "k = 50", &["gas_constant=50"]);
const K100: Variant = variant("k-100", "k = 100", &["gas_constant=100"]);
const K400: Variant = variant("k-400", "k = 400", &["gas_constant=400"]);
const K800: Variant = variant("k-800", "k = 800", &["gas_constant=800"]);
const DENSITY_4: Variant = variant("rho-4", "ρ⁰max = 4", &["rest_density_max=4"]);
const DENSITY_6: Variant = variant("rho-6", "ρ⁰max = 6", &["rest_density_max=6"]);
const INVISCID: Variant = variant("mu-0", "μ = 0", &["viscosity=0"]);
const STATIC_4: Variant = variant(
    "rho-static-4",
    "static ρ⁰ = 4",
    &["rest_density_min=4", "rest_density_max=4"],
);
const NO_CONTACT: Variant = variant("contact-0", "Kᵃᵍ = 0", &["agent_stiffness=0"]);
const DRY_50: Variant = variant(
    "no-sph-50",
    "no SPH, Kᵃᵍ = 50",
    &[
        "gas_constant=0",
        "viscosity=0",
        "wall_stiffness=1000",
        "agent_stiffness=50",
    ],
);
const DRY_1000: Variant = variant(
    "no-sph-1000",
    "no SPH, Kᵃᵍ = 1000",
    &[
        "gas_constant=0",
        "viscosity=0",
        "wall_stiffness=1000",
        "agent_stiffness=1000",
    ],
);

/// Fig. 7, from (a) to (f).
pub const FIG7: [Variant; 6] = [BASELINE, K100, K400, DENSITY_4, DENSITY_6, INVISCID];
/// Fig. 8: left, right.
pub const FIG8: [Variant; 2] = [STATIC_4, DENSITY_4];
/// Fig. 9.
pub const FIG9: [Variant; 2] = [DRY_50, DRY_1000];
/// Fig. 10 shows the first; the baseline stands beside it.
pub const FIG10: [Variant; 2] = [NO_CONTACT, BASELINE];
/// The space-time diagrams, each with its k.
pub const SPEEDS: [(f64, Variant); 5] = [
    (50.0, K50),
    (100.0, K100),
    (200.0, BASELINE),
    (400.0, K400),
    (800.0, K800),
];

/// What is kept of a concert.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// At the push and at [`TIMES`].
    pub snapshots: Vec<Snapshot>,
    /// Along the middle of the crowd before the stage.
    pub diagram: SpaceTime,
    /// There, at the push.
    pub contacts: Option<Contacts>,
}

impl Default for Seen {
    fn default() -> Self {
        Self {
            snapshots: Vec::new(),
            diagram: SpaceTime::new(Strip {
                x: [45.0, 80.0],
                half_width: 8.0,
                bin: 0.5,
            }),
            contacts: None,
        }
    }
}

impl Seen {
    /// Asks for the densities that will be shown.
    pub fn prepare(simulation: &mut Simulation) {
        simulation.request_density_until(simulation.frame().clock.frame_at(UNTIL) + 1);
    }

    /// Looks at an evaluated frame; `pictures`: keep snapshots too.
    pub fn observe(&mut self, simulation: &Simulation, pictures: bool) {
        let frame = simulation.frame();
        let (clock, now) = (frame.clock, frame.clock.frame());
        let is = |time: f64| now == clock.frame_at(time);
        if clock.time() >= PUSH - BEFORE - 1e-6 && now.is_multiple_of(EVERY) {
            self.diagram.observe(&frame);
        }
        if is(PUSH) {
            self.contacts = sound::contacts(&frame, &interior());
        }
        if pictures && (is(PUSH) || TIMES.into_iter().any(is)) {
            self.snapshots.push(Snapshot::of(simulation));
        }
    }

    /// The snapshot nearest to a time.
    pub fn at(&self, time: f64) -> Option<&Snapshot> {
        let away = |s: &&Snapshot| (s.time - time).abs();
        self.snapshots
            .iter()
            .min_by(|a, b| away(a).total_cmp(&away(b)))
    }
}

/// The crowd that the wave runs through, away from its rim and the stage, metres.
fn interior() -> Region {
    Region {
        min: Vector::new(58.0, -8.0),
        max: Vector::new(76.0, 8.0),
    }
}

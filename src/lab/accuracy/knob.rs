//! What can be chosen about the numerics, and the values that are tried.

use crate::engine::scene::Needs;

/// A numerical choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knob {
    /// Δt of semi-implicit Euler, the paper's reading.
    TimeStep,
    /// The other integrators, at every Δt.
    Integrator,
    /// Neighbour lists with a margin, or the paper's plain reuse.
    Lists,
    /// Δt_coarse in frames: how often RVO chooses.
    Coarse,
    /// The numbers that sums over pairs are taken in.
    Precision,
    /// How walls enter SPH.
    Walls,
    /// Which social forces are left out.
    Tolerance,
    /// How many velocities RVO tries.
    Candidates,
    /// The named presets.
    Preset,
}

/// All of them with their names on the command line.
pub const KNOBS: [(&str, Knob); 9] = [
    ("time-step", Knob::TimeStep),
    ("integrator", Knob::Integrator),
    ("lists", Knob::Lists),
    ("coarse", Knob::Coarse),
    ("precision", Knob::Precision),
    ("walls", Knob::Walls),
    ("tolerance", Knob::Tolerance),
    ("candidates", Knob::Candidates),
    ("preset", Knob::Preset),
];

/// Points that belong together: one knob turned.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The knob.
    pub knob: Knob,
    /// What it is called in legends.
    pub label: String,
    /// The settings of every point, as `--set` takes them.
    pub points: Vec<Vec<String>>,
}

/// The settings that a scene has which says nothing.
const DEFAULTS: [&str; 9] = [
    "time_step_secs=0.02",
    "integrator=semi-implicit",
    "neighbor_lists=complete",
    "coarse_every=5",
    "precision=mixed",
    "wall_method=representative",
    "avoidance_tolerance=0",
    "candidates=250",
    "preset=paper",
];

/// Those of some settings that change anything.
pub fn without_defaults(settings: &[String]) -> Vec<String> {
    let changed = settings
        .iter()
        .filter(|text| !DEFAULTS.contains(&text.as_str()));
    changed.cloned().collect()
}

/// Do these settings change nothing?
pub fn are_default(settings: &[String]) -> bool {
    without_defaults(settings).is_empty()
}

/// Δt, seconds.
const STEPS: [&str; 6] = ["0.0025", "0.005", "0.01", "0.02", "0.04", "0.08"];

/// How much is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Everything.
    All,
    /// All but the finest steps, which statistics cannot tell from the reference.
    Coarser,
    /// A few values.
    Few,
}

impl Knob {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        let found = KNOBS.iter().find(|(_, knob)| *knob == self);
        found.map_or("", |(name, _)| name)
    }

    /// Does it change anything in a scene with these needs?
    pub fn acts(self, needs: &Needs, has_walls: bool) -> bool {
        match self {
            Self::Coarse | Self::Candidates => needs.rvo,
            Self::Tolerance => needs.social,
            Self::Walls => needs.pairs.pressure && has_walls,
            Self::TimeStep | Self::Integrator | Self::Lists | Self::Precision | Self::Preset => {
                true
            }
        }
    }

    /// What is tried.
    pub fn curves(self, detail: Detail) -> Vec<Curve> {
        let steps = match detail {
            Detail::All => &STEPS[..],
            Detail::Coarser => &STEPS[1..],
            Detail::Few => &STEPS[2..5],
        };
        let by_step = |integrator: Option<&str>| {
            let point = |step: &&str| {
                let integrator = integrator.map(|name| format!("integrator={name}"));
                let step = format!("time_step_secs={step}");
                std::iter::once(step).chain(integrator).collect()
            };
            steps.iter().map(point).collect()
        };
        let curve = |label: &str, points| Curve {
            knob: self,
            label: label.to_owned(),
            points,
        };
        match self {
            Self::TimeStep => vec![curve("semi-implicit", by_step(None))],
            Self::Integrator => ["forward-euler", "velocity-verlet", "midpoint"]
                .map(|name| curve(name, by_step(Some(name))))
                .to_vec(),
            _ => {
                let point = |value: &&str| vec![format!("{}={value}", self.key())];
                let values = self.values();
                let from = match detail {
                    Detail::Few => values.len().saturating_sub(3),
                    Detail::All | Detail::Coarser => 0,
                };
                vec![curve(
                    self.name(),
                    values[from..].iter().map(point).collect(),
                )]
            }
        }
    }

    /// The setting that it turns.
    fn key(self) -> &'static str {
        match self {
            Self::TimeStep => "time_step_secs",
            Self::Integrator => "integrator",
            Self::Lists => "neighbor_lists",
            Self::Coarse => "coarse_every",
            Self::Precision => "precision",
            Self::Walls => "wall_method",
            Self::Tolerance => "avoidance_tolerance",
            Self::Candidates => "candidates",
            Self::Preset => "preset",
        }
    }

    /// Its values, the best first where one is.
    fn values(self) -> &'static [&'static str] {
        match self {
            Self::TimeStep | Self::Integrator => &[],
            Self::Lists => &["complete", "coarse"],
            Self::Coarse => &["1", "2", "5", "10", "20"],
            Self::Precision => &["double", "mixed"],
            Self::Walls => &["union", "exact", "representative"],
            Self::Tolerance => &["0", "1e-4", "1e-3", "1e-2", "1e-1"],
            Self::Candidates => &["5000", "1000", "250", "100", "30", "10"],
            Self::Preset => &["paper", "fast", "accurate"],
        }
    }

    /// The settings that its own error is counted from, everything else being equal; `None` where that is
    /// the reference itself.
    pub fn best(self) -> Option<Vec<String>> {
        match self {
            Self::TimeStep | Self::Integrator | Self::Preset => None,
            _ => Some(vec![format!("{}={}", self.key(), self.values()[0])]),
        }
    }
}

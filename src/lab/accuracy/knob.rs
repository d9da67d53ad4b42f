//! The numerical choices ("knobs"), and the values that are tried.

use crate::engine::scene::Needs;

/// A numerical choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knob {
    /// Δt of semi-implicit Euler, the integrator that we read from the paper.
    TimeStep,
    /// The other integrators, at every Δt.
    Integrator,
    /// Neighbor lists with a margin, or the paper's plain reuse.
    Lists,
    /// Δt_coarse in frames: how often RVO chooses a velocity.
    Coarse,
    /// The floating-point precision of sums over pairs.
    Precision,
    /// How walls enter SPH.
    Walls,
    /// The size below which social forces are left out.
    Tolerance,
    /// The number of RVO's candidate velocities.
    Candidates,
    /// The named presets.
    Preset,
}

/// All knobs with their names on the command line.
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

/// Points that are drawn as one curve: values of one knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The knob.
    pub knob: Knob,
    /// Its label in legends.
    pub label: String,
    /// The settings of every point, as `--set` takes them.
    pub points: Vec<Vec<String>>,
}

/// The default settings of a scene.
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

/// Those of `settings` that differ from the defaults.
pub fn without_defaults(settings: &[String]) -> Vec<String> {
    let changed = settings
        .iter()
        .filter(|text| !DEFAULTS.contains(&text.as_str()));
    changed.cloned().collect()
}

/// Are all of these settings defaults?
pub fn are_default(settings: &[String]) -> bool {
    without_defaults(settings).is_empty()
}

/// Δt, seconds.
const STEPS: [&str; 6] = ["0.0025", "0.005", "0.01", "0.02", "0.04", "0.08"];

/// How many values are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// All values.
    All,
    /// All but the finest step, which statistics cannot tell from the reference.
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

    /// Does the knob have an effect in a scene with these needs?
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

    /// The curves to be measured.
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

    /// The key of its setting.
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

    /// Its values. If [`best`](Self::best) exists, it is the first.
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

    /// The settings of the reference for the knob's own error, with all other settings at their defaults. `None` if the
    /// knob has no reference of its own.
    pub fn best(self) -> Option<Vec<String>> {
        match self {
            Self::TimeStep | Self::Integrator | Self::Preset => None,
            _ => Some(vec![format!("{}={}", self.key(), self.values()[0])]),
        }
    }
}

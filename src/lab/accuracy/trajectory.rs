//! The positions of agents in the first seconds, and their distances from the reference.

use std::collections::BTreeMap;
use std::rc::Rc;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::lyapunov::Lyapunov;
use super::results::{Judged, Measured, Quantity};
use super::scenes::{names, scenario, setting, simulation};
use super::trials::Trial;
use crate::error::LabError;
use engine::boundary::WallMethod;
use engine::clock::PAPER_TIME_STEP;
use engine::math::Vector;
use engine::simulation::Simulation;
use scenario::Setting;

/// The sampled times, seconds: about 0.5, 1 and 2, moved to times that are frames of all time steps.
pub const SAMPLES: [f64; 3] = [0.4, 0.8, 2.0];
/// The reference's time step is the paper's, divided by this; the second value is for quick plans.
const FINENESS: [f64; 2] = [64.0, 16.0];

/// Position, velocity and density of all agents at one time, by id.
type Snapshot = BTreeMap<u32, (Vector, Vector, f64)>;

/// A crowd at the times of [`SAMPLES`].
#[derive(Debug, Clone, PartialEq)]
pub struct Motion([Snapshot; 3]);

/// Root mean square errors over all agents, at each of [`SAMPLES`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Meters.
    pub position: [f64; 3],
    /// m/s.
    pub velocity: [f64; 3],
    /// P/m².
    pub density: [f64; 3],
}

impl Motion {
    /// Runs a document under some settings.
    ///
    /// # Errors
    /// A setting is invalid, the run fails, or the time step does not divide all of [`SAMPLES`].
    pub fn of(document: &Value, settings: &[Setting]) -> Result<Self, LabError> {
        let mut simulation = simulation(document, settings)?;
        simulation.request_density_until(u64::MAX);
        let step = simulation.frame().clock.time_step();
        let fault = |fault| LabError::of(names(settings), fault);
        let mut at = |time: f64| {
            let frames = time / step;
            if (frames - frames.round()).abs() > 1e-6 {
                let reason = format!("{time} s are no whole number of frames of {step} s");
                return Err(LabError::Data(reason));
            }
            while simulation.frame().clock.frame() < frames.round() as u64 {
                simulation.step().map_err(fault)?;
            }
            simulation.evaluate().map_err(fault)?;
            Ok(snapshot(&simulation))
        };
        Ok(Self([at(SAMPLES[0])?, at(SAMPLES[1])?, at(SAMPLES[2])?]))
    }

    /// The difference between two motions, over all agents that are in both.
    pub fn errors(&self, other: &Self) -> Errors {
        let pairs = [0, 1, 2].map(|k| distance(&self.0[k], &other.0[k]));
        Errors {
            position: pairs.map(|p| p[0]),
            velocity: pairs.map(|p| p[1]),
            density: pairs.map(|p| p[2]),
        }
    }
}

fn snapshot(simulation: &Simulation) -> Snapshot {
    let frame = simulation.frame();
    let (agents, density) = (frame.agents, &frame.fields.density);
    let period = simulation.scene().period;
    let place = |i: usize| match (period, agents.laps.get(i)) {
        (Some(period), Some(&laps)) => agents.position[i] + period.way(laps),
        _ => agents.position[i],
    };
    let state = |i: usize| (place(i), agents.velocity[i], density[i]);
    let ids = agents.id.iter().enumerate();
    ids.map(|(i, &id)| (id, state(i))).collect()
}

/// Root mean square differences of position, velocity and density, over all agents that are in both.
fn distance(one: &Snapshot, other: &Snapshot) -> [f64; 3] {
    let pairs = one.iter().filter_map(|(id, a)| Some((a, other.get(id)?)));
    let differences = pairs.map(|(a, b)| {
        let [position, velocity] = [a.0 - b.0, a.1 - b.1].map(|off| off.norm_squared());
        [position, velocity, (a.2 - b.2).powi(2)]
    });
    let squares: Vec<[f64; 3]> = differences.collect();
    let sum = |k: usize| squares.iter().map(|squares| squares[k]).sum::<f64>();
    [0, 1, 2].map(|k| (sum(k) / squares.len().max(1) as f64).sqrt())
}

/// The limit of a scene as Δt → 0 with these walls, as settings. Its own error is about as large as the difference from
/// a run at twice the step, which `coarser` = 2 gives.
pub fn limit(walls: WallMethod, quick: bool, coarser: f64) -> Result<Vec<Setting>, LabError> {
    let step = coarser * PAPER_TIME_STEP / FINENESS[usize::from(quick)];
    let all = [
        ("time_step_secs", json!(step)),
        ("wall_method", json!(walls)),
        ("integrator", json!("midpoint")),
        ("precision", json!("double")),
    ];
    all.iter().map(|(key, value)| setting(key, value)).collect()
}

/// The errors of all trials of a scene that is judged by motion, in their order.
#[derive(Serialize, Deserialize)]
pub struct Trajectories {
    /// Errors against the limit, and against the choice's best settings.
    pub trials: Vec<(Errors, Option<Errors>)>,
    /// The approximate error of the limit itself.
    pub limit: Errors,
    /// The growth of small differences.
    pub lyapunov: Lyapunov,
}

impl Trajectories {
    /// Runs a document under the settings of all trials.
    ///
    /// # Errors
    /// As [`Motion::of`].
    pub fn of(document: &Value, trials: &[Trial], quick: bool) -> Result<Self, LabError> {
        let known = Vec::new();
        let mut motions = Motions { document, known };
        let mut errors = Vec::new();
        for trial in trials {
            let motion = motions.get(&trial.settings)?;
            // For a preset, the limit has the preset's own walls; for all other choices, those of the paper.
            let walls = match trial.choice.as_str() {
                "preset" => scenario(document, &trial.settings)?.scene.wall_method,
                _ => WallMethod::default(),
            };
            let total = motion.errors(&*motions.get(&limit(walls, quick, 1.0)?)?);
            let best = trial.best.as_ref().map(|best| motions.get(best));
            errors.push((total, best.transpose()?.map(|best| motion.errors(&best))));
        }
        let [finest, coarser] = [1.0, 2.0].map(|by| limit(WallMethod::default(), quick, by));
        let limit = motions.get(&coarser?)?;
        Ok(Self {
            trials: errors,
            limit: limit.errors(&*motions.get(&finest?)?),
            lyapunov: Lyapunov::of(document)?,
        })
    }

    /// The errors in the form of a report.
    pub(super) fn judge(&self) -> Judged {
        let mut quantities = Vec::new();
        for (name, unit) in [("position", "m"), ("velocity", "m/s"), ("density", "P/m²")] {
            let names = SAMPLES.map(|time| format!("{name} at {time} s"));
            quantities.extend(names.map(|name| Quantity { name, unit }));
        }
        let middle = SAMPLES[1];
        let (name, unit) = (format!("position at {middle} s by this choice alone"), "m");
        quantities.push(Quantity { name, unit });
        let errors = self.trials.iter().map(|(total, own)| {
            let all = [total.position, total.velocity, total.density].concat();
            let own = own.map(|own| own.position[1]);
            let exact = |error| Measured {
                error,
                ..Measured::default()
            };
            let values = all.into_iter().map(Some).chain([own]);
            values.map(|error| error.map(exact)).collect()
        });
        let lyapunov = &self.lyapunov;
        let growth = lyapunov
            .time()
            .map(|time| format!("Lyapunov time {time:.2} s"));
        let notes = format!(
            "Two crowds that began almost alike part by e^({:.1} t), t in seconds ({}); after {} s at most \
             {:.3} times as far as at the start. The reference's own error at {middle} s is some {:.0e} m.",
            lyapunov.rate(),
            growth.unwrap_or_else(|| "they draw together".to_owned()),
            SAMPLES[2],
            lyapunov.growth,
            self.limit.position[1],
        );
        Judged {
            quantities,
            errors: errors.collect(),
            notes,
        }
    }
}

/// Motions of a document, each computed once.
struct Motions<'a> {
    document: &'a Value,
    known: Vec<(Vec<Setting>, Rc<Motion>)>,
}

impl Motions<'_> {
    fn get(&mut self, settings: &[Setting]) -> Result<Rc<Motion>, LabError> {
        let mut known = self.known.iter();
        if let Some((_, motion)) = known.find(|(other, _)| other == settings) {
            return Ok(Rc::clone(motion));
        }
        let motion = Rc::new(Motion::of(self.document, settings)?);
        self.known.push((settings.to_vec(), Rc::clone(&motion)));
        Ok(motion)
    }
}

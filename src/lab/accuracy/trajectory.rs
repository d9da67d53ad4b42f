//! The positions of agents in the first seconds, and how far they are from the reference.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::knob::Knob;
use super::lyapunov::Lyapunov;
use super::scenes::simulation;
use crate::engine::boundary::WallMethod;
use crate::engine::clock::PAPER_TIME_STEP;
use crate::engine::math::Vector;
use crate::engine::simulation::Simulation;
use crate::lab::error::LabError;

/// The sampled times, seconds: about 0.5, 1 and 2, moved to times that are frames of all time steps.
pub const SAMPLES: [f64; 3] = [0.48, 0.96, 1.92];
/// The reference's time step is the paper's, divided by this; the second value is for quick plans.
const FINENESS: [f64; 2] = [64.0, 16.0];

/// All agents at one time, sorted by id.
#[derive(Debug, Clone, PartialEq)]
struct Snapshot {
    id: Vec<u32>,
    position: Vec<Vector>,
    velocity: Vec<Vector>,
    density: Vec<f64>,
}

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
    pub fn of(document: &Value, settings: &[String]) -> Result<Self, LabError> {
        let mut simulation = simulation(document, settings)?;
        simulation.request_density_until(u64::MAX);
        let step = simulation.frame().clock.time_step();
        let fault = |fault| LabError::of(settings.join(" "), fault);
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
            Ok(Snapshot::of(&simulation))
        };
        Ok(Self([at(SAMPLES[0])?, at(SAMPLES[1])?, at(SAMPLES[2])?]))
    }

    /// The limit of a scene as Δt → 0, and its difference from a run at twice the step, which is about as large as the
    /// reference's own error.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn reference(
        document: &Value,
        walls: WallMethod,
        quick: bool,
    ) -> Result<(Self, Errors), LabError> {
        let walls =
            serde_json::to_value(walls).map_err(|error| LabError::Data(error.to_string()))?;
        let at = |step: f64| {
            let settings = [
                format!("time_step_secs={step}"),
                format!("wall_method={walls}"),
                "integrator=midpoint".to_owned(),
                "precision=double".to_owned(),
            ];
            Self::of(document, &settings)
        };
        let step = PAPER_TIME_STEP / FINENESS[usize::from(quick)];
        let reference = at(step)?;
        let errors = at(2.0 * step)?.errors(&reference);
        Ok((reference, errors))
    }

    /// The difference between two motions, over all agents that are in both.
    pub fn errors(&self, other: &Self) -> Errors {
        let pairs = [0, 1, 2].map(|k| self.0[k].distance(&other.0[k]));
        Errors {
            position: pairs.map(|p| p[0]),
            velocity: pairs.map(|p| p[1]),
            density: pairs.map(|p| p[2]),
        }
    }
}

impl Snapshot {
    fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        let mut order: Vec<usize> = (0..agents.len()).collect();
        order.sort_by_key(|&i| agents.id[i]);
        Self {
            id: order.iter().map(|&i| agents.id[i]).collect(),
            position: order.iter().map(|&i| agents.position[i]).collect(),
            velocity: order.iter().map(|&i| agents.velocity[i]).collect(),
            density: order.iter().map(|&i| frame.fields.density[i]).collect(),
        }
    }

    /// Root mean square differences of position, velocity and density.
    fn distance(&self, other: &Self) -> [f64; 3] {
        let (mut sums, mut count, mut k) = ([0.0; 3], 0.0_f64, 0);
        for (i, id) in self.id.iter().enumerate() {
            while other.id.get(k).is_some_and(|other| other < id) {
                k += 1;
            }
            if other.id.get(k) == Some(id) {
                sums[0] += (self.position[i] - other.position[k]).norm_squared();
                sums[1] += (self.velocity[i] - other.velocity[k]).norm_squared();
                sums[2] += (self.density[i] - other.density[k]).powi(2);
                count += 1.0;
            }
        }
        sums.map(|sum| (sum / count.max(1.0)).sqrt())
    }
}

/// The errors of all points of a scene that is judged by motion, in the order of the points.
#[derive(Serialize, Deserialize)]
pub struct Trajectories {
    /// Errors against the reference, and against the knob's best value with all else at the defaults.
    pub points: Vec<(Errors, Option<Errors>)>,
    /// The approximate error of the reference itself.
    pub reference: Errors,
    /// How fast small differences grow.
    pub lyapunov: Lyapunov,
}

/// Runs a scene that is judged by motion under the settings of all points.
pub fn trajectories(
    document: &Value,
    points: &[(Knob, Vec<String>)],
    quick: bool,
) -> Result<Trajectories, LabError> {
    let mut known = Known::default();
    let mut errors = Vec::new();
    for (knob, settings) in points {
        let motion = Motion::of(document, settings)?;
        // The reference is the limit of the paper's model; for a preset, the limit with the preset's own walls.
        let walls = match knob {
            Knob::Preset => simulation(document, settings)?.scene().wall_method,
            _ => WallMethod::default(),
        };
        let (reference, _) = known.reference(document, walls, quick)?;
        let total = motion.errors(reference);
        let own = known.best(document, *knob)?.map(|best| motion.errors(best));
        errors.push((total, own));
    }
    Ok(Trajectories {
        points: errors,
        reference: known.reference(document, WallMethod::default(), quick)?.1,
        lyapunov: Lyapunov::of(document)?,
    })
}

/// The motions that others are compared with, each computed once.
#[derive(Default)]
struct Known {
    references: Vec<(WallMethod, (Motion, Errors))>,
    best: Vec<(Knob, Motion)>,
}

impl Known {
    fn reference(
        &mut self,
        document: &Value,
        walls: WallMethod,
        quick: bool,
    ) -> Result<&(Motion, Errors), LabError> {
        let found = self
            .references
            .iter()
            .position(|(other, _)| *other == walls);
        let k = match found {
            Some(k) => k,
            None => {
                let found = Motion::reference(document, walls, quick)?;
                self.references.push((walls, found));
                self.references.len() - 1
            }
        };
        Ok(&self.references[k].1)
    }

    fn best(&mut self, document: &Value, knob: Knob) -> Result<Option<&Motion>, LabError> {
        let Some(settings) = knob.best() else {
            return Ok(None);
        };
        if !self.best.iter().any(|(other, _)| *other == knob) {
            self.best.push((knob, Motion::of(document, &settings)?));
        }
        let found = self.best.iter().find(|(other, _)| *other == knob);
        Ok(found.map(|(_, motion)| motion))
    }
}

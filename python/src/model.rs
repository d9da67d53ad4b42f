//! Models of one's own in Python: a function of arrays, called once per frame.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use rayon::prelude::*;
use sandbox::engine::forces::model::{Gives, Model, OwnModel};
use sandbox::engine::forces::rates::{Extremes, Rates};
use sandbox::engine::frame::Frame;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Scene;

use crate::error;
use crate::values::{array, vector};

/// Agents per parallel task when pairs are listed.
const TASK: usize = 256;

/// A model as Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct GivenModel {
    function: Py<PyAny>,
    name: String,
    /// `accelerations`, `all accelerations` or `velocities`.
    gives: String,
    coarse: bool,
    reach: f64,
    stiffness: f64,
    friction: f64,
}

impl GivenModel {
    /// Refuses a reach at which people would see one another twice in a periodic scene.
    pub fn check(&self, scene: &Scene) -> PyResult<()> {
        match scene
            .period
            .filter(|period| 2.0 * self.reach > period.length)
        {
            None => Ok(()),
            Some(period) => Err(error(format!(
                "reach={}: at most {} m, half of the period",
                self.reach,
                0.5 * period.length
            ))),
        }
    }

    /// The model for a scene, and the exception that its function raises.
    pub fn model(self) -> (OwnModel, Raised) {
        let gives = match self.gives.as_str() {
            "velocities" => Gives::Velocities,
            "all accelerations" => Gives::AllAccelerations,
            _ => Gives::Accelerations,
        };
        let raised = Raised::default();
        let model = PythonModel {
            function: self.function,
            name: self.name,
            reach: self.reach,
            rates: Rates {
                everywhere: self.stiffness,
                friction: self.friction,
                ..Rates::default()
            },
            raised: raised.clone(),
        };
        let model = Arc::new(model);
        let coarse = self.coarse;
        (
            OwnModel {
                model,
                gives,
                coarse,
            },
            raised,
        )
    }
}

/// The last exception of a function.
#[derive(Debug, Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Takes the exception.
    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn set(&self, error: PyErr) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
    }
}

#[derive(Debug)]
struct PythonModel {
    function: Py<PyAny>,
    name: String,
    reach: f64,
    rates: Rates,
    raised: Raised,
}

/// The agents and walls near agents: who, and where.
#[derive(Default)]
struct Near {
    /// The index of the agent, and of the other one.
    pairs: Vec<[u32; 2]>,
    /// From the other one to the agent, meters.
    separations: Vec<Vector>,
    /// The index of the agent.
    wall_agents: Vec<u32>,
    /// The point of a wall nearest to it, meters.
    wall_points: Vec<Vector>,
}

impl Near {
    fn of(frame: &Frame, reach: f64) -> Self {
        let count = frame.agents.len();
        let tasks = (0..count.div_ceil(TASK)).into_par_iter();
        let parts: Vec<Self> = tasks
            .map(|task| {
                let mut near = Self::default();
                for i in task * TASK..count.min((task + 1) * TASK) {
                    near.add(frame, i, reach);
                }
                near
            })
            .collect();
        let mut all = Self::default();
        for mut part in parts {
            all.pairs.append(&mut part.pairs);
            all.separations.append(&mut part.separations);
            all.wall_agents.append(&mut part.wall_agents);
            all.wall_points.append(&mut part.wall_points);
        }
        all
    }

    fn add(&mut self, frame: &Frame, i: usize, reach: f64) {
        for (j, separation) in frame.near(i, reach) {
            self.pairs.push([i as u32, j as u32]);
            self.separations.push(separation);
        }
        let position = frame.agents.position[i];
        for &wall in frame.neighbors.near_walls(i) {
            let point = frame.walls.wall(wall).nearest_point(position).point;
            if (point - position).norm() < reach {
                self.wall_agents.push(i as u32);
                self.wall_points.push(point);
            }
        }
    }
}

impl Model for PythonModel {
    fn name(&self) -> &str {
        &self.name
    }

    fn reach(&self) -> f64 {
        self.reach
    }

    fn rates(&self, _: &Extremes) -> Rates {
        self.rates
    }

    fn vectors(&self, frame: &Frame) -> Result<Vec<Vector>, String> {
        let near = Near::of(frame, self.reach);
        Python::attach(|py| {
            self.call(py, frame, &near).map_err(|error| {
                let message = error.to_string();
                self.raised.set(error);
                message
            })
        })
    }
}

impl PythonModel {
    fn call(&self, py: Python<'_>, frame: &Frame, near: &Near) -> PyResult<Vec<Vector>> {
        let given = self.function.bind(py).call1(arrays(py, frame, near)?)?;
        let bytes = given.cast::<PyBytes>()?.as_bytes();
        let (numbers, _) = bytes.as_chunks::<8>();
        let (pairs, _) = numbers.as_chunks::<2>();
        let vector =
            |&[x, y]: &[[u8; 8]; 2]| Vector::new(f64::from_ne_bytes(x), f64::from_ne_bytes(y));
        Ok(pairs.iter().map(vector).collect())
    }
}

type Arrays<'py, const COUNT: usize> = [Bound<'py, PyByteArray>; COUNT];
/// The number of a frame, its time and the time step, s.
type Time = (u64, f64, f64);

/// What a model gets of a frame: its time, people, and what is near them, in the order of `Frame` in `_model.py`.
pub fn arrays_of<'py>(
    py: Python<'py>,
    frame: &Frame,
    reach: f64,
) -> PyResult<(Time, Arrays<'py, 8>, Arrays<'py, 5>)> {
    arrays(py, frame, &Near::of(frame, reach))
}

fn arrays<'py>(
    py: Python<'py>,
    frame: &Frame,
    near: &Near,
) -> PyResult<(Time, Arrays<'py, 8>, Arrays<'py, 5>)> {
    let (agents, fields) = (frame.agents, frame.fields);
    let vectors = |of: &[Vector]| array(py, of.len(), |k| vector(of[k]));
    let numbers = |of: &[f64]| array(py, of.len(), |k| of[k].to_ne_bytes());
    let indices = |of: &[u32]| array(py, of.len(), |k| i64::from(of[k]).to_ne_bytes());
    let side = |n: usize| {
        let pairs = &near.pairs;
        array(py, pairs.len(), |k| i64::from(pairs[k][n]).to_ne_bytes())
    };
    let people = [
        indices(&agents.id)?,
        vectors(&agents.position)?,
        vectors(&agents.velocity)?,
        numbers(&agents.radius)?,
        numbers(&agents.mass)?,
        vectors(&fields.preferred_velocity)?,
        numbers(&fields.density)?,
        vectors(&agents.goal)?,
    ];
    let around = [
        side(0)?,
        side(1)?,
        vectors(&near.separations)?,
        indices(&near.wall_agents)?,
        vectors(&near.wall_points)?,
    ];
    let clock = frame.clock;
    let time = (clock.frame(), clock.time(), clock.time_step());
    Ok((time, people, around))
}

//! A copy of one frame, so that another thread can write it.

use super::debug::{Debug, Open};
use crate::engine::math::Vector;
use crate::engine::simulation::{Event, Simulation};

/// A copy of one frame in single precision, with agents in the simulation's order.
#[derive(Default)]
pub struct Snapshot {
    pub frame: i64,
    pub time: f64,
    /// `None` for measured data.
    pub ms_per_frame: Option<f64>,
    pub ids: Vec<u32>,
    pub positions: Vec<[f32; 2]>,
    /// NaN if unknown.
    pub velocities: Vec<[f32; 2]>,
    pub radii: Vec<f32>,
    /// Empty if the masses are unknown.
    pub masses: Vec<f32>,
    /// Empty in a frame without densities, like the next two.
    pub densities: Vec<f32>,
    /// Also empty for measured data, like the next.
    pub rest_densities: Vec<f32>,
    pub pressures: Vec<f32>,
    /// Counted arrivals so far; `None` for measured data.
    pub evacuated: Option<usize>,
    /// Events since the last snapshot, each with its time.
    pub events: Vec<(f64, Event)>,
    /// The debug agents.
    pub open: Vec<Open>,
    /// Whether this is the frame to show first.
    pub opens_here: bool,
}

impl Snapshot {
    /// Starts a new, empty frame and reuses the memory.
    pub fn clear(&mut self, frame: i64, time: f64) {
        self.frame = frame;
        self.time = time;
        self.ids.clear();
        self.positions.clear();
        self.velocities.clear();
        self.radii.clear();
        self.masses.clear();
        self.densities.clear();
        self.rest_densities.clear();
        self.pressures.clear();
        self.open.clear();
        self.events.clear();
    }

    /// Copies the crowd of the current frame and reuses the memory.
    pub fn take(&mut self, simulation: &Simulation, debug: &Debug) {
        let frame = simulation.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        self.frame = frame.clock.frame().cast_signed();
        self.time = frame.clock.time();
        self.ids.clone_from(&agents.id);
        copy_vectors(&mut self.positions, &agents.position);
        copy_vectors(&mut self.velocities, &agents.velocity);
        copy(&mut self.radii, &agents.radius);
        copy(&mut self.masses, &agents.mass);
        copy(&mut self.densities, &fields.density);
        copy(&mut self.rest_densities, &fields.rest_density);
        copy(&mut self.pressures, &fields.pressure);
        self.open = debug.open(simulation);
    }
}

fn copy(to: &mut Vec<f32>, from: &[f64]) {
    to.clear();
    to.extend(from.iter().map(|&x| x as f32));
}

fn copy_vectors(to: &mut Vec<[f32; 2]>, from: &[Vector]) {
    to.clear();
    to.extend(from.iter().map(|v| [v.x as f32, v.y as f32]));
}

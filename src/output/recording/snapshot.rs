//! What one recorded frame needs, copied out of the simulation so that another thread can write it.

use super::debug::{Debug, Open};
use crate::engine::math::Vector;
use crate::engine::simulation::{Event, Simulation};

/// A copy of one frame in single precision, agents in the simulation's order.
#[derive(Default)]
pub struct Snapshot {
    pub frame: i64,
    pub time: f64,
    /// `None` of what was measured.
    pub ms_per_frame: Option<f64>,
    pub ids: Vec<u32>,
    pub positions: Vec<[f32; 2]>,
    /// NaN where not known.
    pub velocities: Vec<[f32; 2]>,
    pub radii: Vec<f32>,
    /// Empty where nobody says how heavy people are.
    pub masses: Vec<f32>,
    /// This and the next two are empty in a frame without densities.
    pub densities: Vec<f32>,
    /// This and the next are empty of what was measured, too.
    pub rest_densities: Vec<f32>,
    pub pressures: Vec<f32>,
    /// Counted arrivals so far; `None` of what was measured.
    pub evacuated: Option<usize>,
    /// Since the last snapshot, each with its time.
    pub events: Vec<(f64, Event)>,
    /// The agents laid open.
    pub open: Vec<Open>,
    /// Is this the frame to look at first?
    pub opens_here: bool,
}

impl Snapshot {
    /// A frame without anybody yet, in the memory that is there.
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

    /// Takes over the crowd of the current frame, in the memory that is there.
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

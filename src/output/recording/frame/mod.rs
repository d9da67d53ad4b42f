//! A frame: a copy of it, so that another thread can write it, and what is written of it.

pub mod colored_lines;
pub mod crowd;
pub mod events;
pub mod stats;

use rerun::{EntityPath, RecordingStream};

use super::debug::{DebugAgents, Open};
use super::draw::{Place, Point, xy, xyz};
use crate::drawing::Drawing;
use crate::events::Line;
use crate::scenery::stage_color;
use colored_lines::{ColoredLines, LEANS, Part, WAITS};
use engine::math::Vector;
use engine::simulation::Simulation;
use figures::colors::Rgb;

/// The timelines.
pub const FRAME: &str = "frame";
pub const SIM_TIME: &str = "sim_time";

/// A copy of one frame in single precision, with agents in the simulation's order.
#[derive(Default)]
pub struct Snapshot {
    pub frame: i64,
    pub time: f64,
    /// `None` for measured data.
    pub ms_per_frame: Option<f64>,
    pub ids: Vec<u32>,
    pub positions: Vec<Point>,
    /// In a building: the numbers of their levels, and their places there.
    pub on_levels: Vec<(usize, Place)>,
    /// NaN if unknown.
    pub velocities: Vec<Point>,
    pub radii: Vec<f32>,
    /// Empty if the masses are unknown.
    pub masses: Vec<f32>,
    /// Empty in a frame without densities, like the next two.
    pub densities: Vec<f32>,
    /// Also empty for measured data, like the next.
    pub rest_densities: Vec<f32>,
    pub pressures: Vec<f32>,
    /// Colors by the stage of the journey; empty in scenes without journeys.
    pub stages: Vec<Rgb>,
    /// The values of the time series of places.
    pub places: Vec<(EntityPath, f64)>,
    /// Counted arrivals so far; `None` for measured data.
    pub evacuated: Option<usize>,
    /// The number of agents that wait at each entrance.
    pub waiting: Vec<u32>,
    /// The log of events since the last snapshot.
    pub events: Vec<Line>,
    /// The layers of colored lines.
    pub lines: Vec<(&'static ColoredLines, Vec<Part>)>,
    /// The debug agents.
    pub open: Vec<Open>,
    /// The places of the followed agents among the debug agents; `None` for absent ones.
    pub followed: Vec<Option<usize>>,
}

impl Snapshot {
    /// The crowd of the current frame, with the debug agents and the followed ones.
    pub fn of(
        simulation: &Simulation,
        (debug, followed): (&DebugAgents, &[Option<u32>]),
        drawing: Option<&Drawing>,
    ) -> Self {
        let frame = simulation.frame();
        let drawn = |p| xy(drawing.map_or(p, |drawing| drawing.place(p)));
        let (agents, fields) = (frame.agents, frame.fields);
        let present: Vec<usize> = agents.present().collect();
        let vectors = |values: &[Vector]| present.iter().map(|&i| xy(values[i])).collect();
        // Fields without values are empty.
        let number = |values: &[f64], i: usize| values.get(i).map(|&x| x as f32);
        let numbers = |values: &[f64]| present.iter().filter_map(|&i| number(values, i)).collect();
        let trips = &agents.trip;
        let on_trips = present.iter().copied().filter(|_| !trips.is_empty());
        let stages = on_trips.map(|i| stage_color(trips.get(i).and_then(Option::as_ref)));
        let mut open = debug.open(simulation, followed);
        if let Some(drawing) = drawing {
            open.iter_mut().for_each(|agent| agent.draw(drawing));
        }
        let levels = simulation.scene().levels.as_deref().into_iter();
        let on_levels = levels.flat_map(|levels| {
            let places = present.iter().map(|&i| agents.position[i]);
            places.map(|p| {
                let number = levels.level(p);
                (number, xyz(&levels.all()[number], levels.in_building(p)))
            })
        });
        let place = |id: u32| {
            open.binary_search_by_key(&id, |agent| agent.breakdown.id)
                .ok()
        };
        let waits = colored_lines::waits(simulation, drawing).map(|parts| (&WAITS, parts));
        let leans = colored_lines::leans(simulation, drawing).map(|parts| (&LEANS, parts));
        let lines = [waits, leans];
        Self {
            followed: followed.iter().map(|id| id.and_then(place)).collect(),
            frame: frame.clock.frame().cast_signed(),
            time: frame.clock.time(),
            ids: present.iter().map(|&i| agents.id[i]).collect(),
            on_levels: on_levels.collect(),
            positions: present.iter().map(|&i| drawn(agents.position[i])).collect(),
            velocities: vectors(&agents.velocity),
            radii: numbers(&agents.radius),
            masses: numbers(&agents.mass),
            densities: numbers(&fields.density),
            rest_densities: numbers(&fields.rest_density),
            pressures: numbers(&fields.pressure),
            stages: stages.collect(),
            places: stats::of_places(simulation),
            lines: lines.into_iter().flatten().collect(),
            open,
            waiting: simulation.backlogs().map(|one| one.waiting).collect(),
            ..Self::default()
        }
    }
}

pub fn set_time(stream: &RecordingStream, frame: i64, time: f64) {
    stream.set_time_sequence(FRAME, frame);
    stream.set_duration_secs(SIM_TIME, time);
}

//! The whole crowd as one entity.
//!
//! Rows are in the order of the ids, so that radii and ids change only when somebody enters or
//! leaves and are logged only then.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float16Array, Float32Array, UInt32Array};
use rerun::external::arrow::datatypes::{ArrowPrimitiveType, Float16Type};
use rerun::{AsComponents, Color, DynamicArchetype, Points2D, Radius, RecordingStream};

use super::colors;
use super::error::RecordingError;
use crate::agents::Agents;
use crate::simulation::Simulation;

type F16 = <Float16Type as ArrowPrimitiveType>::Native;

/// Where the crowd is.
pub const ENTITY: &str = "world/agents";
/// Group of the values that are ours; the viewer shows `agent:density`, and so on.
const ARCHETYPE: &str = "agent";
/// The component with the second colouring.
pub const SPEED_COLORS: &str = "agent:speed_colors";

/// Logs the crowd.
#[derive(Default)]
pub struct Crowd {
    logged_ids: Vec<u32>,
    rows: Rows,
}

pub fn log_style(stream: &RecordingStream) -> Result<(), RecordingError> {
    let style = Points2D::update_fields().with_draw_order(1.0);
    Ok(stream.log_static(ENTITY, &style)?)
}

impl Crowd {
    pub fn log(
        &mut self,
        stream: &RecordingStream,
        simulation: &Simulation,
    ) -> Result<(), RecordingError> {
        let frame = simulation.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        let rows = self.rows.of(agents);
        self.log_bodies(stream, agents, &rows)?;
        let positions = rows.iter().map(|&i| agents.position[i]);
        let mut points =
            Points2D::update_fields().with_positions(positions.map(|p| [p.x as f32, p.y as f32]));
        let speeds = rows.iter().map(|&i| agents.velocity[i].norm());
        let mut values = DynamicArchetype::new(ARCHETYPE)
            .with_component::<rerun::components::Color>(
                "speed_colors",
                speeds.map(|speed| colors::SPEED.color(speed)),
            );
        if fields.density.is_empty() {
            points = points.with_colors([Color::from_rgb(128, 128, 128)]);
        } else {
            let densities = rows.iter().map(|&i| fields.density[i]);
            points = points.with_colors(densities.map(|density| colors::DENSITY.color(density)));
            let pressure = rows.iter().map(|&i| fields.pressure[i] as f32);
            values = values
                .with_component_from_data("density", halves(&rows, &fields.density))
                .with_component_from_data("rest_density", halves(&rows, &fields.rest_density))
                .with_component_from_data(
                    "pressure",
                    Arc::new(Float32Array::from_iter_values(pressure)) as ArrayRef,
                );
        }
        stream.log(ENTITY, &[&points as &dyn AsComponents, &values])?;
        self.rows.give_back(rows);
        Ok(())
    }

    /// What an agent keeps as long as it is there.
    fn log_bodies(
        &mut self,
        stream: &RecordingStream,
        agents: &Agents,
        rows: &[usize],
    ) -> Result<(), RecordingError> {
        let ids = rows.iter().map(|&i| agents.id[i]);
        if ids.clone().eq(self.logged_ids.iter().copied()) {
            return Ok(());
        }
        self.logged_ids.clear();
        self.logged_ids.extend(ids);
        let radii = rows.iter().map(|&i| agents.radius[i] as f32);
        let points = Points2D::update_fields().with_radii(radii.map(Radius::new_scene_units));
        let ids = Arc::new(UInt32Array::from(self.logged_ids.clone())) as ArrayRef;
        let values = DynamicArchetype::new(ARCHETYPE).with_component_from_data("id", ids);
        stream.log(ENTITY, &[&points as &dyn AsComponents, &values])?;
        Ok(())
    }
}

/// Half precision: three digits of a density in half the bytes.
fn halves(rows: &[usize], values: &[f64]) -> ArrayRef {
    let halves = rows.iter().map(|&i| F16::from_f32(values[i] as f32));
    Arc::new(Float16Array::from_iter_values(halves))
}

/// Sorts agents by id in linear time; keeps its memory.
#[derive(Default)]
struct Rows {
    index_of: Vec<u32>,
    rows: Vec<usize>,
}

impl Rows {
    /// Indices of the agents in the order of their ids.
    fn of(&mut self, agents: &Agents) -> Vec<usize> {
        const NOBODY: u32 = u32::MAX;
        let mut rows = std::mem::take(&mut self.rows);
        rows.clear();
        let (Some(&first), Some(&last)) = (agents.id.iter().min(), agents.id.iter().max()) else {
            return rows;
        };
        self.index_of.clear();
        self.index_of.resize((last - first) as usize + 1, NOBODY);
        for (i, id) in agents.id.iter().enumerate() {
            self.index_of[(id - first) as usize] = i as u32;
        }
        let present = self.index_of.iter().filter(|&&i| i != NOBODY);
        rows.extend(present.map(|&i| i as usize));
        rows
    }

    fn give_back(&mut self, rows: Vec<usize>) {
        self.rows = rows;
    }
}
